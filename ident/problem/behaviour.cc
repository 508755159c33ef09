// ident: the settling simulations and the free modes.
#include "ident/problem/behaviour.h"

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "datasets/files/number_text.h"
#include "models/decompositions.h"
#include "models/enum_names.h"
#include "models/learned_terms.h"
#include "models/reaction_delay.h"
#include "models/rollout.h"
#include "models/self_terms.h"
#include "residuals/cost_functions/rest_residual.h"

namespace pushid {
namespace {

constexpr double kOnTheSpot = 0.01;  // m

std::vector<double> ImpulsesFor(Stance stance, const double (&impulses)[3]) {
  const int held_to = stance == Stance::kFixed ? 1 : 3;
  return {impulses, impulses + held_to};
}

// Simulations of so many people, of every mass after every impulse.
std::vector<SettlingSimulation> Simulate(const ModelOptions& options,
                                         const ParameterSet<double>& parameters,
                                         const std::vector<double>& masses,
                                         const std::vector<double>& impulses, int people) {
  std::vector<SettlingSimulation> simulations;
  std::vector<Scene> scenes;
  for (double mass : masses) {
    for (double impulse : impulses) {
      simulations.push_back({"", people, mass, impulse});
      scenes.push_back(SettlingScene(mass, impulse, people));
    }
  }
  const int frames = scenes[0].SettledFrame(options) + 1;
  SceneRollouts rollouts(scenes, options, 0, frames);
  rollouts.Roll({parameters});
  for (int scene = 0; scene < static_cast<int>(scenes.size()); ++scene) {
    SettlingSimulation& result = simulations[scene];
    result.fell = !rollouts.StaysInside(scene);
    for (int n = 0; n < people; ++n) {
      for (int t = 0; t < frames; ++t) {
        const double lean = rollouts.At(scene, t, n).q.tail<2>().cwiseAbs().maxCoeff();
        result.fell = result.fell || lean > kFallAngle;
      }
      const PendulumState<double> end = rollouts.At(scene, frames - 1, n);
      const Vector4<double> moved = end.q - scenes[scene].people[n].start.q;
      result.speed = std::max(result.speed, end.qd.head<2>().norm());
      result.lean = std::max(result.lean, end.q.tail<2>().cwiseAbs().maxCoeff());
      result.distance += moved.head<2>().norm() / people;
      result.advance += moved.x() / people;
      if (n == 0) result.pushed_advance = moved.x();
    }
    result.settled = !result.fell && result.speed < kSettledSpeed && result.lean < kSettledLean;
  }
  return simulations;
}

// Seconds from the push until everybody in all of these scenes stands still and stays so; infinite
// as in SettlingSeconds.
double SecondsUntilStill(const std::vector<Scene>& scenes, const ModelOptions& options,
                         const ParameterSet<double>& parameters) {
  constexpr double kLongest = 10.0;  // s
  const double dt = scenes[0].dt;
  const int end = scenes[0].LastPushEnd();
  const int frames = end + static_cast<int>(std::lround(kLongest / dt));
  SceneRollouts rollouts(scenes, options, end, frames);
  if (!rollouts.Roll({parameters})) return std::numeric_limits<double>::infinity();
  int last_moving = end;
  for (int scene = 0; scene < static_cast<int>(scenes.size()); ++scene) {
    for (int n = 0; n < scenes[0].num_people(); ++n) {
      for (int t = end; t < frames; ++t) {
        const PendulumState<double> state = rollouts.At(scene, t, n);
        const bool still = state.qd.head<2>().norm() < kSettledSpeed &&
                           state.q.tail<2>().cwiseAbs().maxCoeff() < kSettledLean;
        if (!still) last_moving = std::max(last_moving, t + 1);
      }
    }
  }
  if (last_moving >= frames) return std::numeric_limits<double>::infinity();
  return (last_moving - end) * dt;
}

// The free state about rest: [theta, phi, qd], and the cart's velocity one step earlier (of which
// the cart's derivative is made). LDP's networks, which remember, have no rest.
constexpr int kPreviousAt = 6, kFreeState = 8;

// The learned self force about rest, by central differences (it is smooth, and its values are of
// order one): d[force]/d(free state).
Eigen::MatrixXd LearnedForce(const LearnedTerms& network, const SelfForce& self) {
  constexpr double kDifference = 1e-5;
  const auto force = [&](const Eigen::VectorXd& from) {
    NetworkState<double> memory(network.shape, network.weights.data(), self.body);
    SetMotionInputs<double>(from[0], from[1], from.segment<4>(2), &memory.inputs);
    return StepNetwork(network.shape, network.weights.data(), &memory);
  };
  Eigen::MatrixXd jacobian(4, kFreeState);
  for (int i = 0; i < kFreeState; ++i) {
    const Eigen::VectorXd move = kDifference * Eigen::VectorXd::Unit(kFreeState, i);
    jacobian.col(i) = (force(move) - force(-move)) / (2.0 * kDifference);
  }
  return jacobian;
}

// The part of a velocity one step on that is perceived late: columns of the state now, and of those
// before it, lag by lag.
struct LateVelocity {
  Eigen::Matrix<double, 4, 6> by_now = Eigen::Matrix<double, 4, 6>::Zero();
  Eigen::MatrixXd by_past;  // 4 x 6 lags

  // inverse: of the mass matrix, times the step.
  LateVelocity(const ModelOptions& options, const ParameterSet<double>& p, const SelfForce& self,
               const Eigen::Matrix4d& inverse, double dt) {
    const double longest = std::max(p[kReactionDelay], p[StepDelayOf(options.delay)]);
    const int lags = static_cast<int>(longest / dt) + DelayedFrames<double>::kCount;
    by_past = Eigen::MatrixXd::Zero(4, 6 * lags);
    const auto add = [&](RestInput input, Parameter delay,
                         const Eigen::Array<double, 6, 1>& share) {
      const Eigen::Matrix<double, 4, 6> by =
          inverse * LinearizeAtRest(options, self, p, input).by_state;
      const auto add_lag = [&](int lag, const Eigen::Array<double, 6, 1>& weight) {
        const Eigen::Matrix<double, 4, 6> part = by * weight.matrix().asDiagonal();
        if (lag <= 0) {
          by_now += part;
        } else {
          by_past.middleCols<6>(6 * (lag - 1)) += part;
        }
      };
      // Two angles, and the rates of all four.
      Eigen::Array<double, 6, 1> pose, rate;
      pose << 1.0, 1.0, 0.0, 0.0, 0.0, 0.0;
      rate = 1.0 - pose;
      add_lag(0, share * (pose + kRateAhead * rate));
      add_lag(1, share * (1.0 - kRateAhead) * rate);
      const DelayedPlace<double> place(p[delay], dt);
      for (int i = 0; i < DelayedFrames<double>::kCount; ++i) {
        add_lag(place.of_pose.back + i, place.of_pose.weight[i] * (1.0 - share) * pose);
        add_lag(place.of_rate.back + i, place.of_rate.weight[i] * (1.0 - share) * rate);
      }
    };
    // The ankles feel the cart's motion late in all its parts (Perceive).
    Eigen::Array<double, 6, 1> passive;
    passive << p[kPassiveStiffness], p[kPassiveStiffness], 0.0, 0.0, p[kPassiveDamping],
        p[kPassiveDamping];
    add(RestInput::kAnkle, kReactionDelay, passive);
    add(RestInput::kStep, StepDelayOf(options.delay), Eigen::Array<double, 6, 1>::Zero());
  }
};

// Eigenvalues of one free step about rest, as growth rates. Where the cart stands does not matter:
// x and y are no part of the state.
double FastestGrowth(const ModelOptions& options, const ParameterSet<double>& parameters) {
  const Scene scene = SettlingScene(80.0, 0.0);
  const Body& body = scene.people[0].body;
  const SelfForce self(options, body, scene.people[0].start.q, scene.dt);
  const bool late = options.delay != Delay::kNone;
  RestJacobian rest =
      LinearizeAtRest(options, self, parameters, late ? RestInput::kState : RestInput::kAll);
  const Body at_rest = BodyAtRest(options, body, parameters);
  const Eigen::Matrix4d inverse =
      InverseMassMatrix<double>(at_rest, Angles<double>(), at_rest.mass + scene.dt * rest.ground);
  for (int i = 0; i < 2; ++i) rest.by_state(i, 2 + i) -= rest.ground;
  Eigen::MatrixXd learned = Eigen::MatrixXd::Zero(4, kFreeState);
  const auto& network = options.learned;
  // LDP's networks have no rest: their simulations tell.
  if (network != nullptr && !network->shape.ldp() && !network->rod.moves()) {
    learned = LearnedForce(*network, self);
  }
  std::optional<LateVelocity> of_past;
  if (late) of_past.emplace(options, parameters, self, scene.dt * inverse, scene.dt);
  const Eigen::Index known = kFreeState;
  const Eigen::Index past = late ? of_past->by_past.cols() : 0, size = known + past;
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(size, size);
  auto velocity = step.middleRows<4>(2);
  velocity.middleCols<4>(2).setIdentity();
  velocity.leftCols<6>() += scene.dt * inverse * rest.by_state;
  velocity.middleCols<2>(kPreviousAt) +=
      scene.dt * inverse.leftCols<2>() * rest.by_previous.asDiagonal();
  velocity.leftCols(known) += scene.dt * inverse * learned;
  if (late) {
    velocity.leftCols<6>() += of_past->by_now;
    velocity.rightCols(past) += of_past->by_past;
    step.block<6, 6>(known, 0).setIdentity();
    step.block(known + 6, known, past - 6, past - 6).setIdentity();
  }
  step.topLeftCorner<2, 2>().setIdentity();
  step.topRows<2>() += scene.dt * velocity.bottomRows<2>();
  step.block<2, 2>(kPreviousAt, 2).setIdentity();
  return std::log(SpectralRadius(step)) / scene.dt;
}

}  // namespace

std::vector<std::vector<Scene>> SettlingScenes(const ModelOptions& options) {
  std::vector<std::vector<Scene>> scenes(1);
  for (double impulse : ImpulsesFor(options.stance, kSettlingImpulses)) {
    scenes[0].push_back(SettlingScene(kSettlingMasses[0], impulse));
  }
  if (!options.interaction.Any()) return scenes;
  scenes.emplace_back();
  for (double impulse : ImpulsesFor(options.stance, kLineImpulses)) {
    scenes.back().push_back(SettlingScene(kSettlingMass, impulse, kLinePeople));
  }
  return scenes;
}

double SettlingSeconds(const ModelOptions& options, const ParameterSet<double>& parameters) {
  double slowest = 0.0;
  for (const std::vector<Scene>& scenes : SettlingScenes(options)) {
    slowest = std::max(slowest, SecondsUntilStill(scenes, options, parameters));
  }
  return slowest;
}

const SettlingSimulation* Behaviour::FarthestBehind() const {
  const SettlingSimulation* farthest = nullptr;
  for (const SettlingSimulation& d : simulations) {
    if (d.fell || d.pushed_advance > -kBehind) continue;
    if (farthest == nullptr || d.pushed_advance < farthest->pushed_advance) farthest = &d;
  }
  return farthest;
}

void Behaviour::Add(const Behaviour& other, const std::string& setting) {
  for (SettlingSimulation d : other.simulations) {
    d.setting = setting;
    simulations.push_back(d);
  }
  fastest_growth = std::max(fastest_growth, other.fastest_growth);
  settles = settles && other.settles;
  harder_moves_farther = harder_moves_farther && other.harder_moves_farther;
  self_propelling = self_propelling || other.self_propelling;
}

Behaviour ComputeBehaviour(const ModelOptions& options, const ParameterSet<double>& parameters) {
  Behaviour behaviour;
  std::vector<SettlingSimulation>& all = behaviour.simulations;
  all = Simulate(options, parameters, {kSettlingMasses, kSettlingMasses + 3},
                 ImpulsesFor(options.stance, kSettlingImpulses), 1);
  if (options.interaction.Any()) {
    const std::vector<SettlingSimulation> lines =
        Simulate(options, parameters, {kSettlingMass}, ImpulsesFor(options.stance, kLineImpulses),
                 kLinePeople);
    for (size_t i = 1; i < lines.size(); ++i) {
      // Lines that stay where they are need not move farther.
      const double least = options.stance == Stance::kSlide ? 0.0 : -kOnTheSpot;
      behaviour.harder_moves_farther =
          behaviour.harder_moves_farther && lines[i].advance - lines[i - 1].advance > least;
    }
    all.insert(all.end(), lines.begin(), lines.end());
  }
  behaviour.fastest_growth = FastestGrowth(options, parameters);
  behaviour.settles = true;
  behaviour.self_propelling =
      behaviour.unstable() ||
      (Acts(kMu, options) && CartDampings(options.friction)[0].Of(parameters) < 0.0);
  for (const SettlingSimulation& d : all) {
    behaviour.settles = behaviour.settles && d.settled;
    behaviour.self_propelling = behaviour.self_propelling || d.fell;
  }
  return behaviour;
}

namespace {

// "4, 25 and 80"
std::string ListText(const std::set<double>& values) {
  std::vector<std::string> texts;
  for (double value : values) texts.push_back(Rounded(value, 4));
  return Listed(texts, "and");
}

std::string GrowthText(const Behaviour& behaviour) {
  return Rounded(behaviour.fastest_growth, 2) + " 1/s";
}

}  // namespace

Verdict VerdictOf(const Behaviour& behaviour) {
  if (!behaviour.settles) {
    return behaviour.self_propelling ? Verdict::kSelfPropelling : Verdict::kSlowToSettle;
  }
  if (!behaviour.self_propelling) return Verdict::kSettles;
  if (!behaviour.unstable()) return Verdict::kNegativeDrag;
  return Verdict::kUnstableThoughSettled;
}

std::string VerdictName(Verdict verdict) {
  if (verdict == Verdict::kSettles) return "";
  return verdict == Verdict::kSlowToSettle ? kSlowToSettleText : "self-propelling";
}

std::string VerdictSentence(Verdict verdict, const Behaviour& behaviour,
                            const ModelOptions& model) {
  const std::string settles = "the fitted person settles within " + WaitText(model);
  const std::string stands = "the fitted person stands still after " + WaitText(model);
  const bool falls = std::any_of(behaviour.simulations.begin(), behaviour.simulations.end(),
                                 [](const SettlingSimulation& d) { return d.fell; });
  switch (verdict) {
    case Verdict::kSettles:
      return settles + " after every push of the settling simulations";
    case Verdict::kSlowToSettle:
      return "the fitted person settles later than " + WaitText(model) + " after some pushes";
    case Verdict::kSelfPropelling:
      return !behaviour.unstable() && falls ? "the fitted person falls after some pushes"
                                            : "the fitted forces drive the person after a push";
    case Verdict::kUnstableThoughSettled:
      return stands + ", but is unstable at rest: the slightest deviation grows at " +
             GrowthText(behaviour);
    case Verdict::kNegativeDrag:
      return settles +
             ", but c_x is negative: the friction drives the cart, and only other "
             "forces bring it to rest";
  }
  return "";
}

std::string Capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(text[0]));
  return text;
}

std::string VerdictRemedy(Verdict verdict, const ModelOptions& options) {
  const bool driven = verdict == Verdict::kSelfPropelling ||
                      verdict == Verdict::kUnstableThoughSettled ||
                      verdict == Verdict::kNegativeDrag;
  if (driven && options.push_tail == PushTail::kNone) {
    return "--push_tail=exponential adds the part of the push that was not recorded";
  }
  switch (verdict) {
    case Verdict::kSettles:
      return "";
    case Verdict::kSlowToSettle:
      return "a larger --settling_weight makes it settle sooner";
    case Verdict::kSelfPropelling:
      return "a larger --settling_weight makes it settle";
    case Verdict::kUnstableThoughSettled:
      return LearnsAlone(options) ? "a smaller --network_prior stabilizes it"
                                  : "priors nearer to a person who stands stabilize it, as "
                                    "--prior=Kp_theta:2000:300, or --self_force=none";
    case Verdict::kNegativeDrag:
      return "--fix=mu=0 shows how much accuracy is lost without it";
  }
  return "";
}

std::string SettlingText(const Behaviour& behaviour, const ModelOptions& model) {
  if (behaviour.settles) {
    std::set<double> masses, impulses, of_lines;
    int line = 0;
    for (const SettlingSimulation& d : behaviour.simulations) {
      (d.people > 1 ? of_lines : impulses).insert(d.impulse);
      if (d.people > 1) line = d.people;
      if (d.people == 1) masses.insert(d.mass);
    }
    return "after a push of " + ListText(impulses) + " N s, people of " + ListText(masses) +
           " kg " + (behaviour.unstable() ? "stand still after " : "settle within ") +
           WaitText(model) +
           (line > 0 ? "; so do lines of " + std::to_string(line) + " after " + ListText(of_lines) +
                           " N s"
                     : "") +
           // Whatever the simulations show by then.
           (behaviour.unstable() ? ", but not for long: they are unstable at rest\n" : "\n");
  }
  std::string text = "NOT SETTLING, " + WaitText(model) + " after a push:\n";
  for (const SettlingSimulation& d : behaviour.simulations) {
    if (d.settled) continue;
    text += "  " + SettlingSimulationName(d, SettingsDiffer(behaviour)) + ": " +
            (d.fell ? kFellText
                    : "still at " + Rounded(d.speed, 2) + " m/s, " + Rounded(d.lean, 2) +
                          " rad from rest") +
            "\n";
  }
  return text;
}

std::string FreeModeText(const Behaviour& behaviour) {
  return "fastest free mode at rest: " + Rounded(behaviour.fastest_growth, 3) + " 1/s (" +
         (behaviour.unstable() ? "UNSTABLE" : "stable") + ")\n";
}

bool SettingsDiffer(const Behaviour& behaviour) {
  return std::any_of(behaviour.simulations.begin(), behaviour.simulations.end(),
                     [](const SettlingSimulation& d) { return !d.setting.empty(); });
}

std::string SettlingSimulationName(const SettlingSimulation& d, bool settings_differ) {
  const std::string who = d.people == 1 ? "" : std::to_string(d.people) + " people in a line, ";
  const std::string where = !d.setting.empty() ? d.setting + ": "
                            : settings_differ  ? "shared values: "
                                               : "";
  return where + who + Rounded(d.mass, 4) + " kg after " + Rounded(d.impulse, 4) + " N s";
}

std::string WaitText(const ModelOptions& model) { return Rounded(WaitSeconds(model), 4) + " s"; }

}  // namespace pushid
