#include "ident/prediction/futures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/figures/text_table.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/statistics.h"
#include "models/decompositions.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kShares[] = {0.05, 0.25, 0.5, 0.75, 0.95};
// Quantiles of fewer error paths end at the largest, which a new recording often exceeds.
constexpr size_t kEnoughErrors = 19;

double ChiSquare(int freedom, Random* random) {
  double sum = 0.0;
  for (int i = 0; i < freedom; ++i) sum += std::pow(random->Normal(), 2);
  return sum;
}

// The factor on one of few error paths, each of which stands for a normal distribution of unknown
// spread: either sign, and Student's t of as many degrees of freedom.
double SpreadOfFew(size_t paths, Random* random) {
  if (paths >= kEnoughErrors) return 1.0;
  const int freedom = static_cast<int>(paths);
  const double side = random->Unit() < 0.5 ? -1.0 : 1.0;
  return side * std::sqrt(freedom / ChiSquare(freedom, random));
}

std::vector<ParameterSet<double>> FromCovariance(const FitResult& result,
                                                 const BandOptions& options) {
  const std::vector<Parameter> free = result.options.table.Free();
  const Eigen::Index size = static_cast<Eigen::Index>(free.size());
  const Uncertainty& u = result.uncertainty;
  // Null directions make it semi-definite: roots by eigenvalues.
  const SymmetricEigen roots = DecomposeSymmetric(u.covariance.topLeftCorner(size, size));
  const Eigen::MatrixXd root = roots.vectors * roots.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const int freedom = std::max(1, u.freedom);
  Random random(options.seed);
  std::vector<ParameterSet<double>> sets;
  for (int s = 0; s < options.samples; ++s) {
    Eigen::VectorXd z(size);
    for (Eigen::Index i = 0; i < size; ++i) z[i] = random.Normal();
    const Eigen::VectorXd move = root * z / std::sqrt(ChiSquare(freedom, &random) / freedom);
    ParameterSet<double> set = result.parameters;
    for (Eigen::Index i = 0; i < size; ++i) {
      const ParameterSpec& spec = result.options.table[free[i]];
      const double value =
          ToNatural(spec.transform, ToFitted(spec.transform, set[free[i]]) + move[i]);
      set[free[i]] = std::clamp(value, spec.lower, spec.upper);
    }
    sets.push_back(set);
  }
  return sets;
}

std::vector<ParameterSet<double>> FromBootstrap(const FitResult& result,
                                                const BandOptions& options) {
  const Bootstrap& b = *options.bootstrap;
  if (b.values.empty()) return {};
  Random random(options.seed);
  std::vector<ParameterSet<double>> sets;
  for (int s = 0; s < options.samples; ++s) {
    const size_t row =
        std::min(b.values.size() - 1, static_cast<size_t>(random.Unit() * b.values.size()));
    ParameterSet<double> set = result.parameters;
    for (size_t i = 0; i < b.names.size(); ++i) {
      const ParameterSpec* spec = result.options.table.Find(b.names[i]);  // none for combinations
      if (spec != nullptr) set[spec->id] = b.values[row][i];
    }
    sets.push_back(set);
  }
  return sets;
}

BandPoint PointOf(const Vector3<double>& hip, const PendulumState<double>& state) {
  BandPoint point;
  point << hip, state.q.tail<2>();
  return point;
}

std::vector<BandPoint> PathOf(const Prediction& prediction, int person) {
  std::vector<BandPoint> path;
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    path.push_back(PointOf(prediction.hip[person][t], prediction.path.At(t, person)));
  }
  return path;
}

bool StepsAreSpread(const IdentifiedModel& model) {
  return model.options.stance == Stance::kSteps && model.step_probability &&
         model.step_probability->coefficients[1] > 0.0;
}

// A rollout by the drawn parameters until a foot leaves the ground, then by the person's own: only
// the first step is drawn, and a support of millimetres would make people march on.
RolloutStatus RollDrawn(const Scene& scene, const ModelOptions& options,
                        std::vector<ParameterSet<double>> now,
                        const std::vector<ParameterSet<double>>& own,
                        const FrameTable<Vector4<double>>* noise, RolloutPath<double>* path) {
  ModelStep<double> forces(scene, options, now);
  StartPath(scene, InitialVelocities(scene), path);
  for (int t = 0; t + 1 < path->num_frames(); ++t) {
    const RolloutStatus status = StepOn<double>(scene, &forces, t, path, nullptr, noise);
    if (!status.ok) return status;
    for (int n = 0; n < scene.num_people(); ++n) {
      if (path->At(t + 1, n).feet.swings != 0) now[n] = own[n];
    }
  }
  return {};
}

}  // namespace

IdentifiedModel WithShared(const IdentifiedModel& model, const ParameterSet<double>& shared) {
  IdentifiedModel drawn = model;
  drawn.parameters = shared;
  const auto shift = [&](ParameterSet<double>* set) {
    for (const ParameterSpec& spec : model.table.specs) {
      const auto fitted = [&](const ParameterSet<double>& of) {
        return ToFitted(spec.transform, of[spec.id]);
      };
      double& value = (*set)[spec.id];
      if (value == model.parameters[spec.id]) {
        value = shared[spec.id];
      } else {
        value = ToNatural(spec.transform, fitted(shared) + fitted(*set) - fitted(model.parameters));
      }
    }
  };
  for (auto& [unit, set] : drawn.by_unit) shift(&set);
  return drawn;
}

std::vector<ParameterSet<double>> SampleParameters(const FitResult& result,
                                                   const BandOptions& options) {
  return options.bootstrap == nullptr ? FromCovariance(result, options)
                                      : FromBootstrap(result, options);
}

std::vector<ErrorPath> ErrorPaths(const FitResult& result,
                                  const std::vector<PendulumRecording>& fitted) {
  std::vector<ErrorPath> paths;
  const IdentifiedModel model = ModelOf(result);
  for (const PendulumRecording& recording : fitted) {
    const double speed = PushSpeed(recording);
    const Prediction prediction = Predict(model, recording);
    if (!prediction.status.ok || speed <= 0.0) continue;
    const int person = recording.pushed_person;
    ErrorPath& error = paths.emplace_back(ErrorPath{recording.id, PathOf(prediction, person)});
    for (int t = 0; t < recording.num_frames(); ++t) {
      const BandPoint measured = PointOf(recording.hip[person][t], recording.states[person][t]);
      error.path[t] = (measured - error.path[t]) / speed;
    }
  }
  return paths;
}

std::vector<double> ValuesAt(const DrawnPaths& draws, int person, size_t frame, int axis) {
  std::vector<double> values;
  for (const auto& draw : draws) values.push_back(draw[person][frame][axis]);
  return values;
}

DrawnPaths DrawPaths(const FitResult& result, const std::vector<ParameterSet<double>>& samples,
                     const std::vector<ErrorPath>& errors, const PendulumRecording& recording,
                     uint64_t seed, int num_frames) {
  const double speed = PushSpeed(recording);
  Random random(seed);
  std::vector<const ErrorPath*> others;
  for (const ErrorPath& error : errors) {
    if (error.recording != recording.id) others.push_back(&error);
  }
  DrawnPaths draws;
  const IdentifiedModel model = ModelOf(result);
  for (const ParameterSet<double>& sample : samples) {
    const double draw = random.Unit();
    const Prediction prediction = Predict(WithShared(model, sample), recording, num_frames);
    if (!prediction.status.ok) continue;
    draws.emplace_back();
    for (int n = 0; n < recording.scene.num_people(); ++n) {
      std::vector<BandPoint> path = PathOf(prediction, n);
      if (!others.empty() && n == recording.pushed_person) {
        const size_t last = others.size() - 1;
        const size_t drawn = static_cast<size_t>(draw * static_cast<double>(others.size()));
        const std::vector<BandPoint>& error = others[std::min(last, drawn)]->path;
        const double scale = speed * SpreadOfFew(others.size(), &random);
        for (size_t t = 0; t < path.size(); ++t) {
          path[t] += scale * error[std::min(t, error.size() - 1)];
        }
      }
      draws.back().push_back(std::move(path));
    }
  }
  return draws;
}

DrawnPaths PathsAround(const FitResult& result, const std::vector<ParameterSet<double>>& samples,
                       const std::vector<ErrorPath>& errors, const PendulumRecording& recording,
                       uint64_t seed) {
  DrawnPaths draws = DrawPaths(result, samples, errors, recording, seed);
  const Prediction rollout = Predict(ModelOf(result), recording);
  if (draws.empty() || !rollout.status.ok) return draws;
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    const std::vector<BandPoint> path = PathOf(rollout, n);
    for (size_t t = 0; t < path.size(); ++t) {
      BandPoint by = path[t];
      for (int axis = 0; axis < by.size(); ++axis) {
        by[axis] -= Quantile(ValuesAt(draws, n, t, axis), 0.5);
      }
      for (auto& draw : draws) draw[n][t] += by;
    }
  }
  return draws;
}

PredictiveBands ComputeBands(const FitResult& result,
                             const std::vector<ParameterSet<double>>& samples,
                             const std::vector<ErrorPath>& errors,
                             const PendulumRecording& recording, uint64_t seed) {
  const DrawnPaths draws = PathsAround(result, samples, errors, recording, seed);
  PredictiveBands bands;
  bands.id = recording.id;
  bands.samples = static_cast<int>(samples.size());
  bands.failed = bands.samples - static_cast<int>(draws.size());
  for (int n = 0; n < recording.scene.num_people() && !draws.empty(); ++n) {
    PathBand& band = bands.people.emplace_back();
    int quantile = 0;
    for (auto* row : {&band.lower90, &band.lower50, &band.middle, &band.upper50, &band.upper90}) {
      for (size_t t = 0; t < draws[0][n].size(); ++t) {
        BandPoint& point = row->emplace_back();
        for (int axis = 0; axis < point.size(); ++axis) {
          point[axis] = Quantile(ValuesAt(draws, n, t, axis), kShares[quantile]);
        }
      }
      ++quantile;
    }
  }
  return bands;
}

uint64_t SeedOfRecording(uint64_t seed, int recording) {
  return seed * 1000003u + static_cast<uint64_t>(recording);
}

MaybeError CheckDrawsFrom(const IdentifiedModel& model) {
  if (model.options.process_noise != ProcessNoise::kNone || StepsAreSpread(model))
    return std::nullopt;
  return Error{(model.source.empty() ? "the model" : model.source) +
               " has no process noise to draw futures from; fit it with "
               "--likelihood=innovation, or, where it is known who "
               "steps, with --stance=steps"};
}

Result<Futures> DrawFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                            int draws, uint64_t seed, int num_frames) {
  if (MaybeError error = CheckDrawsFrom(model)) return *error;
  const int frames = num_frames > 0 ? num_frames : recording.num_frames();
  const Scene& scene = recording.scene;
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  Futures futures;
  futures.id = recording.id;
  Random random(seed);
  const bool noisy = model.options.process_noise != ProcessNoise::kNone,
             spread = StepsAreSpread(model);
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<ParameterSet<double>> drawn = parameters;
    for (size_t n = 0; spread && n < drawn.size(); ++n) {
      // A person steps if the support is smaller than f b, which has the probability At(margin).
      const auto& c = model.step_probability->coefficients;
      const double u = random.Unit(), margin = (std::log(u / (1.0 - u)) - c[0]) / c[1];
      const double factor = FactorAtMargin(drawn[n][kSupportFront], margin);
      for (Parameter id : {kSupportFront, kSupportBack, kSupportSide}) drawn[n][id] *= factor;
    }
    FrameTable<Vector4<double>> noise(frames, scene.num_people());
    for (int t = 0; noisy && t < frames; ++t) {
      for (int n = 0; n < scene.num_people(); ++n) {
        for (double& w : noise.At(t, n)) w = random.Normal();
      }
    }
    RolloutPath<double> path(frames, scene.num_people());
    const auto roll = [&](const Scene& turned) {
      return RollDrawn(turned, model.options, drawn, parameters, noisy ? &noise : nullptr, &path);
    };
    if (!RollInOwnAxes(recording, model.options, roll, frames, &path).ok) {
      ++futures.failed;
      continue;
    }
    std::vector<std::vector<BandPoint>> people(scene.num_people());
    if (spread) futures.steps.emplace_back();
    for (int n = 0; n < scene.num_people(); ++n) {
      for (int t = 0; t < frames; ++t) {
        const PendulumState<double>& state = path.At(t, n);
        people[n].push_back(PointOf(HipPosition(scene.people[n].body, state.q), state));
      }
      if (spread) {
        futures.steps.back().push_back(static_cast<int>(PredictedSteps(path, n).size()));
      }
    }
    futures.paths.push_back(std::move(people));
  }
  return futures;
}

std::string LastFrameText(const Futures& futures) {
  std::vector<std::string> titles = {">person", ">x m", ">5 %", ">95 %", ">y m", ">5 %", ">95 %"};
  if (!futures.steps.empty()) titles.push_back("steps: share");
  TextTable table(titles);
  if (futures.paths.empty()) return "";
  for (size_t n = 0; n < futures.paths[0].size(); ++n) {
    std::vector<std::string> row = {std::to_string(n)};
    for (int axis : {0, 1}) {
      const std::vector<double> values =
          ValuesAt(futures.paths, static_cast<int>(n), futures.paths[0][n].size() - 1, axis);
      for (double share : {0.5, 0.05, 0.95}) row.push_back(Rounded(Quantile(values, share), 3));
    }
    std::map<int, int> counts;  // of draws by steps: "0: 0.05, 1: 0.62, 2: 0.33"
    for (const std::vector<int>& draw : futures.steps) ++counts[draw[n]];
    std::vector<std::string> shares;
    for (const auto& [steps, count] : counts) {
      const double share = count / static_cast<double>(futures.steps.size());
      shares.push_back(std::to_string(steps) + ": " + Rounded(share, 2));
    }
    if (!shares.empty()) row.push_back(Joined(shares));
    table.Add(row);
  }
  return table.ToString();
}

}  // namespace pushid
