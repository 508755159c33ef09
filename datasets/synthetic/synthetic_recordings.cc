// datasets: drawing people and pushes, and rolling them out.
#include "datasets/synthetic/synthetic_recordings.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "models/ground_reaction.h"

namespace pushid {
namespace {

struct Subject {
  std::string id;
  double mass_kg;
  SyntheticSkeleton skeleton;
  ParameterSet<double> parameters;
};

// A parameter for each of so many draws, or none: with another number of them every recording of a
// known seed would change.
constexpr int kSpreadDraws = 35;

// Not of delays, of bodies and of dry friction, nor of the rod's lift and what is behind it.
constexpr bool IsSpread(int id) {
  return id < kRodLift && id != kCoulombFriction && (id < kReactionDelay || id > kPushGain);
}

ParameterSet<double> Spread(ParameterSet<double> parameters, double sigma, Random* random) {
  constexpr int kNotSpread = 2 + kPushGain - kReactionDelay;
  static_assert(kRodLift - kNotSpread <= kSpreadDraws);
  int draws = 0;
  for (int i = 0; i < kRodLift; ++i) {
    if (!IsSpread(i)) continue;
    parameters[i] *= std::exp(sigma * random->Normal());
    ++draws;
  }
  for (; draws < kSpreadDraws; ++draws) random->Normal();
  return parameters;
}

std::string TwoDigits(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

// The rows of a push of peak force mass * acceleration, in the plane of `direction` (0: forwards).
std::vector<Vector4<double>> DrawPush(const SyntheticOptions& options, const ScenePerson& person,
                                      double acceleration, Random* random) {
  const bool external = options.push_kind == PushKind::kExternal;
  const double shortest = options.min_push_s > 0.0 ? options.min_push_s : (external ? 0.15 : 0.05);
  const double longest = options.max_push_s > 0.0 ? options.max_push_s : (external ? 0.35 : 0.15);
  const double duration = random->Uniform(shortest, longest);
  const double direction = random->Normal(0.0, options.direction_sigma_rad);
  const double height = random->Uniform(options.min_height, options.max_height);
  const int rows = std::max(2, static_cast<int>(std::lround(duration * options.fps)));
  std::vector<Vector4<double>> force;
  for (int k = 0; k < rows; ++k) {
    const double phase = (k + 0.5) / rows * (external ? M_PI : 0.5 * M_PI);
    const double size = person.body.mass * acceleration * std::sin(phase);
    const Vector3<double> f(size * std::cos(direction), size * std::sin(direction), 0.0);
    force.push_back(GeneralizedForce(person.body, person.start.q, f, height));
  }
  return force;
}

RolloutStatus Roll(const SyntheticOptions& options, const ModelOptions& model,
                   SyntheticRecording* made, ForceTrace* forces = nullptr,
                   const FrameTable<Vector4<double>>* noise = nullptr) {
  return Rollout<double>(made->scene, model, made->parameters, InitialVelocities(made->scene),
                         options.frames, &made->path, forces, nullptr, noise);
}

// The motion, driven by process noise where the truth has any.
RolloutStatus RollDriven(const SyntheticOptions& options, Random* random,
                         SyntheticRecording* made) {
  if (options.model.process_noise == ProcessNoise::kNone) return Roll(options, options.model, made);
  FrameTable<Vector4<double>> noise(options.frames, made->scene.num_people());
  for (int t = 0; t < options.frames; ++t) {
    for (int n = 0; n < made->scene.num_people(); ++n) {
      for (double& w : noise.At(t, n)) w = random->Normal();
    }
  }
  return Roll(options, options.model, made, nullptr, &noise);
}

// Where a push stands for other forces too while it lasts, its rows must contain them. They are
// taken from a rollout in which the drawn push is added to everything else.
RolloutStatus AbsorbOtherForces(const SyntheticOptions& options, SyntheticRecording* made) {
  const ModelOptions& model = options.model;
  if (model.push == PushUse::kAdded || options.push_kind == PushKind::kExternal) return {};
  if (made->scene.pushes.empty()) return {};
  ModelOptions added = model;
  added.push = PushUse::kAdded;
  ForceTrace forces;
  const RolloutStatus status = Roll(options, added, made, &forces);
  if (!status.ok) return status;
  ScenePush& push = made->scene.pushes[0];
  std::vector<Vector4<double>> rows;
  for (int t = push.start_frame; t < std::min(push.EndFrame(), options.frames); ++t) {
    NetForce<double> force = forces.At(t, 0);
    if (options.push_kind == PushKind::kNetWithoutFriction) force[ForcePart::kFriction].setZero();
    rows.push_back(force.Total());
  }
  push = MakeScenePush(0, push.start_frame, push.kind, rows);
  return {};
}

RecordedPerson ObservePerson(const SyntheticOptions& options, const SyntheticRecording& made,
                             const Subject& subject, int n, Random* noise) {
  RecordedPerson person;
  person.subject_id = subject.id;
  person.mass_kg = subject.mass_kg;
  person.file = "synthetic";
  for (int t = 0; t < options.frames; ++t) {
    const PendulumState<double>& state = made.path.At(t, n);
    const Vector4<double>& q = state.q;
    const Body body = BodyNow(made.scene.people[n].body, state.rod, made.parameters[n][kRodLift]);
    const double sigma = t == 0 && !options.noise_at_first_frame ? 0.0 : options.joint_noise_m;
    const Vector4<double>& start = made.path.At(0, n).q;
    const auto observed = [&](const Vector3<double>& position) {
      const double x = noise->Normal(), y = noise->Normal(), z = noise->Normal();
      const Vector3<double> seen =
          made.scene.ground.moves()
              ? PointInLaboratory(made.scene.ground.PoseAt(t),
                                  {start[0], start[1], body.cart_height}, position)
              : position;
      return Vector3<double>(seen + sigma * Vector3<double>(x, y, z));
    };
    const Vector3<double> cart(q[0], q[1], body.cart_height);
    person.hip.push_back(observed(HipPosition(body, q)));
    const Vector3<double> half(0.5 * state.feet.apart[0], 0.5 * state.feet.apart[1], 0.0);
    person.left_ankle.push_back(observed(cart + half));
    person.right_ankle.push_back(observed(cart - half));
  }
  return person;
}

// What platforms under the person measure, which move with the ground.
std::vector<PlateSample> ObservePlates(const SyntheticOptions& options,
                                       const SyntheticRecording& made, int n, Random* noise) {
  std::vector<PlateSample> plates;
  const Scene& scene = made.scene;
  const BodyOf<double> body = DynamicBody(options.model, scene.people[n].body, made.parameters[n],
                                          options.model.stance == Stance::kFixed);
  for (int t = 0; t < options.frames; ++t) {
    const int at = std::min(t, options.frames - 2);  // the last frame has no step
    const PendulumState<double>& state = made.path.At(at, n);
    const GroundStep& ground = scene.ground.StepAt(at);
    const Vector4<double> felt =
        (made.path.At(at + 1, n).qd - state.qd) / scene.dt + ground.acceleration;
    const ReactionForce<double> force(body, Angles<double>(state.q), state.qd, felt, ground.gravity,
                                      PushForceAt(scene, n, at));
    const GroundReactionOf<double> reaction = ReactionOn(force, body.cart_height, state.q);
    const auto err = [&](double sigma) { return sigma * noise->Normal(); };
    PlateSample sample;
    sample.force = {reaction[0] + err(options.plate_noise_n),
                    reaction[1] + err(options.plate_noise_n),
                    force.vertical + err(options.plate_noise_n)};
    sample.centre = {reaction[2] + err(options.plate_noise_m),
                     reaction[3] + err(options.plate_noise_m), 0.0};
    sample.weight = 1.0;
    plates.push_back(sample);
  }
  return plates;
}

std::vector<Subject> DrawSubjects(const SyntheticOptions& options, Random* people, Random* spread) {
  std::vector<Subject> subjects;
  for (int s = 0; s < options.subjects; ++s) {
    // To 0.1 kg, as scales show it.
    const double mass =
        std::round(10.0 * people->Uniform(options.min_mass_kg, options.max_mass_kg)) / 10.0;
    const SyntheticSkeleton skeleton(people->Uniform(options.min_rod_m, options.max_rod_m));
    subjects.push_back({"S" + TwoDigits(s + 1), mass, skeleton,
                        Spread(options.parameters, options.subject_spread, spread)});
  }
  return subjects;
}

// The row of people of one recording, the pushed one first, in the posture and place they start in.
void PlaceRow(const SyntheticOptions& options, const std::vector<const Subject*>& row,
              Random* motion, Random* spread, SyntheticRecording* made) {
  double x = 0.0;
  for (const Subject* subject : row) {
    made->skeletons.push_back(subject->skeleton);
    made->parameters.push_back(Spread(subject->parameters, options.recording_spread, spread));
    ScenePerson person;
    person.body = {subject->mass_kg, subject->skeleton.rod_length(),
                   subject->skeleton.cart_height()};
    double y = 0.0;
    if (row.size() > 1) {
      y = motion->Normal(0.0, options.sideways_sigma_m);
      if (!made->scene.people.empty()) {
        x += motion->Uniform(options.min_spacing_m, options.max_spacing_m);
      }
    }
    const double theta = motion->Normal(0.0, options.lean_sigma_rad);
    const double phi = motion->Normal(0.0, options.lean_sigma_rad);
    person.start.q = {x, y, theta, phi};
    person.start.feet.apart = 2.0 * subject->skeleton.HalfStance().head<2>();
    made->scene.people.push_back(person);
  }
}

}  // namespace

Result<std::vector<SyntheticRecording>> MakeSyntheticRecordings(const SyntheticOptions& options) {
  if (const MaybeError wrong = CheckSyntheticOptions(options)) return *wrong;
  Random root(options.seed);
  Random people(root.Fork()), motion(root.Fork()), spread(root.Fork());
  const uint64_t own_noise = root.Fork();
  Random noise(options.noise_seed != 0 ? options.noise_seed : own_noise);
  Random driving(root.Fork()), on_plates(root.Fork());

  const std::vector<Subject> subjects = DrawSubjects(options, &people, &spread);
  std::vector<SyntheticRecording> result;
  for (int s = 0; s < options.subjects; ++s) {
    std::vector<const Subject*> row;
    for (int n = 0; n < options.people_in_row; ++n) {
      row.push_back(&subjects[(s + n) % subjects.size()]);
    }
    for (int r = 0; r < options.recordings_per_subject; ++r) {
      const PushStrength& strength = options.strengths[r % options.strengths.size()];
      const std::string id = row[0]->id + "_" + TwoDigits(r) + "_" + strength.name;
      SyntheticRecording made;
      made.scene.dt = 1.0 / options.fps;
      PlaceRow(options, row, &motion, &spread, &made);
      if (options.ground != GroundKind::kNone) {
        made.scene.ground = GroundThrough(
            options.ground == GroundKind::kFile
                ? options.ground_poses
                : SyntheticGround(options.ground,
                                  r % 2 == 0 ? options.ground_size_m : -options.ground_size_m,
                                  options.frames, made.scene.dt, Eigen::Vector2d::UnitX()),
            made.scene.dt);
      }
      std::vector<Vector4<double>> rows =
          DrawPush(options, made.scene.people[0], strength.acceleration, &motion);
      const size_t room = options.frames - 1 - options.push_start_frame;
      if (rows.size() > room) rows.resize(room);
      if (options.pushes) {
        made.scene.pushes.push_back(
            MakeScenePush(0, options.push_start_frame, options.push_kind, rows));
      }

      RolloutStatus status = AbsorbOtherForces(options, &made);
      if (status.ok) status = RollDriven(options, &driving, &made);
      if (!status.ok) {
        return Error{"simulated recording " + id + " leaves the model at frame " +
                     std::to_string(status.frame) + " (" + std::string(status.quantity) +
                     "): choose weaker pushes, firmer gains or less spread"};
      }
      Recording& recording = made.recording;
      for (size_t n = 0; n < row.size(); ++n) {
        recording.people.push_back(
            ObservePerson(options, made, *row[n], static_cast<int>(n), &noise));
      }
      for (size_t n = 0; options.plates && n < row.size(); ++n) {
        recording.people[n].plates = ObservePlates(options, made, static_cast<int>(n), &on_plates);
      }
      recording.ground = made.scene.ground.poses;
      recording.id = id;
      recording.labels.Set(kMagnitudeLabel, strength.name);
      recording.labels.Set(kSettingLabel, row.size() > 1 ? "row" : "single");
      recording.fps = options.fps;
      recording.push_kind = options.push_kind;
      for (const ScenePush& push : made.scene.pushes) {
        recording.pushes.push_back({0, push.start_frame, push.force, "synthetic"});
      }
      result.push_back(std::move(made));
    }
  }
  return result;
}

std::vector<Recording> Recordings(const std::vector<SyntheticRecording>& synthetic) {
  std::vector<Recording> recordings;
  for (const SyntheticRecording& made : synthetic) recordings.push_back(made.recording);
  return recordings;
}

}  // namespace pushid
