#include "ident/prediction/futures.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/statistics.h"
#include "models/decompositions.h"

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

}  // namespace pushid
