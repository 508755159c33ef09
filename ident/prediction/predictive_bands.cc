// ident: sampling, rolling out, and quantiles by frame.
#include "ident/prediction/predictive_bands.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "ident/model/push_range.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/bootstrap.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kShares[] = {0.05, 0.25, 0.5, 0.75, 0.95};

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
    double chi_square = 0.0;
    for (int i = 0; i < freedom; ++i) chi_square += std::pow(random.Normal(), 2);
    const Eigen::VectorXd move = root * z / std::sqrt(chi_square / freedom);
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

std::vector<ParameterSet<double>> FromBootstrap(const FitResult& result, const Bootstrap& b,
                                                const BandOptions& options) {
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

BandPoint PointOf(const Prediction& prediction, int frame, int person) {
  return PointOf(prediction.hip[person][frame], prediction.path.At(frame, person));
}

// Quantiles over draws of one person's path.
PathBand QuantilesOf(const DrawnPaths& draws, int person) {
  PathBand band;
  std::vector<BandPoint>* const rows[] = {&band.lower90, &band.lower50, &band.middle, &band.upper50,
                                          &band.upper90};
  const size_t frames = draws[0][person].size();
  for (auto* row : rows) row->assign(frames, BandPoint::Zero());
  for (size_t t = 0; t < frames; ++t) {
    for (int axis = 0; axis < BandPoint::RowsAtCompileTime; ++axis) {
      const std::vector<double> values = ValuesAt(draws, person, t, axis);
      for (size_t q = 0; q < 5; ++q) (*rows[q])[t][axis] = Quantile(values, kShares[q]);
    }
  }
  return band;
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

Result<std::vector<ParameterSet<double>>> SampleParameters(const FitResult& result,
                                                           const BandOptions& options) {
  if (options.bootstrap == nullptr) return FromCovariance(result, options);
  if (options.bootstrap->values.empty()) {
    return Error{
        "the model's bootstrap has no replicas; repeat it by pushid-check --bootstrap=199"};
  }
  return FromBootstrap(result, *options.bootstrap, options);
}

std::vector<ErrorPath> ErrorPaths(const FitResult& result,
                                  const std::vector<PendulumRecording>& fitted) {
  std::vector<ErrorPath> paths;
  const IdentifiedModel model = ModelOf(result);
  for (const PendulumRecording& recording : fitted) {
    const double speed = PushSpeed(recording);
    const Prediction prediction = Predict(model, recording);
    if (!prediction.status.ok || speed <= 0.0) continue;
    ErrorPath path{recording.id, {}};
    const int person = recording.pushed_person;
    for (int t = 0; t < recording.num_frames(); ++t) {
      const BandPoint measured = PointOf(recording.hip[person][t], recording.states[person][t]);
      path.path.push_back((measured - PointOf(prediction, t, person)) / speed);
    }
    paths.push_back(path);
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
      std::vector<BandPoint> path;
      for (int t = 0; t < prediction.path.num_frames(); ++t) {
        path.push_back(PointOf(prediction, t, n));
      }
      if (!others.empty() && n == recording.pushed_person) {
        const size_t last = others.size() - 1;
        const size_t drawn = static_cast<size_t>(draw * static_cast<double>(others.size()));
        const std::vector<BandPoint>& error = others[std::min(last, drawn)]->path;
        for (size_t t = 0; t < path.size(); ++t) {
          path[t] += speed * error[std::min(t, error.size() - 1)];
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
    for (size_t t = 0; t < draws[0][n].size(); ++t) {
      BandPoint by = PointOf(rollout, static_cast<int>(t), n);
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
    bands.people.push_back(QuantilesOf(draws, n));
  }
  return bands;
}

}  // namespace pushid
