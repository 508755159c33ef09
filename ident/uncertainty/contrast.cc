// ident: differences between two values of a label.
#include "ident/uncertainty/contrast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "ident/problem/fit_problem.h"
#include "ident/problem/statistics.h"

namespace pushid {
namespace {

constexpr double kLeastLevel = 1e-16;

// P(|T| > t); normal where nothing is estimated.
double TailOf(double t, double freedom) {
  return std::isfinite(freedom) ? StudentTail(t, freedom) : std::erfc(t / std::sqrt(2.0));
}

double QuantileAt(double level, double freedom) {
  double low = 0.0, high = 1.0;
  while (TailOf(high, freedom) > level && high < 1e12) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (TailOf(t, freedom) > level ? low : high) = t;
  }
  return 0.5 * (low + high);
}

// In order of first appearance, by the values that they were recorded with.
void AddPeople(const std::vector<PendulumRecording>& recordings, Contrast* contrast) {
  std::vector<std::string> order;
  std::map<std::string, std::set<std::string>> values;
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      const std::string& id = recording.subject_ids[n];
      if (values.count(id) == 0) order.push_back(id);
      values[id].insert(LabelOf(recording, n, contrast->label));
    }
  }
  for (const std::string& id : order) {
    const bool first = values[id].count(contrast->first) > 0;
    const bool second = values[id].count(contrast->second) > 0;
    if (!first && !second) continue;
    (first && second ? contrast->both
     : first         ? contrast->only_first
                     : contrast->only_second)
        .push_back(id);
  }
}

}  // namespace

double ProbabilityOfZero(const Scatter& scatter, const Eigen::VectorXd& coefficients,
                         double value) {
  std::vector<ScatterOf> parts;
  double sum = 0.0;
  for (const Scatter::Part& part : scatter.parts) {
    parts.push_back(Scatter{{part}}.Of(coefficients));
    sum += parts.back().standard_error * parts.back().standard_error;
  }
  if (!std::isfinite(sum) || !std::isfinite(value) || sum <= 0.0) return 1.0;
  double low = std::log(kLeastLevel), high = 0.0;  // of the level
  for (int i = 0; i < 60; ++i) {
    const double level = std::exp(0.5 * (low + high));
    double squared_width = 0.0;
    for (const ScatterOf& part : parts) {
      const double variance = part.standard_error * part.standard_error;
      if (variance <= 0.0) continue;
      const double quantile = QuantileAt(level, part.freedom);
      squared_width += quantile * quantile * variance;
    }
    (squared_width > value * value ? low : high) = std::log(level);
  }
  return std::exp(0.5 * (low + high));
}

bool JudgeByPeople(Transform transform, const std::vector<OwnEstimate>& people, ContrastRow* row) {
  std::array<double, 2> count{}, mean{};
  for (const OwnEstimate& one : people) ++count[one.second];
  if (std::min(count[0], count[1]) < 2.0) return false;
  for (const OwnEstimate& one : people) mean[one.second] += one.fitted / count[one.second];

  // Moves of the two means by each person, with Bessel's correction.
  std::map<std::string, std::array<double, 2>> moves;
  double within = 0.0;
  for (const OwnEstimate& one : people) {
    const double n = count[one.second], off = one.fitted - mean[one.second];
    moves[one.person][one.second] += off / std::sqrt(n * (n - 1.0));
    within += off * off / (count[0] + count[1] - 2.0);
  }
  const auto variance = [&moves](double by_first, double by_second) {
    double sum = 0.0;
    for (const auto& [person, move] : moves) {
      const double own = by_second * move[1] - by_first * move[0];
      sum += own * own;
    }
    return sum;
  };
  const double of_people = static_cast<double>(moves.size());
  const double v = variance(1.0, 1.0), first = variance(1.0, 0.0), second = variance(0.0, 1.0);
  if (!(within > 0.0 && v > 0.0)) return false;
  const bool apart = of_people == count[0] + count[1];
  const double freedom =
      apart ? v * v / (first * first / (count[0] - 1.0) + second * second / (count[1] - 1.0))
            : std::min(count[0], count[1]) - 1.0;
  const double b = mean[1] - mean[0];
  row->first = ToNatural(transform, mean[0]);
  row->second = ToNatural(transform, mean[1]);
  row->difference = row->second - row->first;
  const double width =
      StudentQuantile95(freedom) * std::sqrt(variance(TransformSlope(transform, row->first),
                                                      TransformSlope(transform, row->second)));
  row->lower95 = row->difference - width;
  row->upper95 = row->difference + width;
  row->p = StudentTail(std::abs(b) / std::sqrt(v), freedom);
  row->effect = b / std::sqrt(within);
  return true;
}

void CorrectForRows(Contrast* contrast) {
  std::vector<ContrastRow*> counted;
  for (ContrastRow& row : contrast->rows) {
    row.p_holm = 1.0;
    if (row.status != EstimateStatus::kUnidentifiable) counted.push_back(&row);
  }
  std::stable_sort(counted.begin(), counted.end(),
                   [](const ContrastRow* a, const ContrastRow* b) { return a->p < b->p; });
  double largest = 0.0;
  for (size_t k = 0; k < counted.size(); ++k) {
    const double times = static_cast<double>(counted.size() - k);
    largest = std::max(largest, std::min(1.0, times * counted[k]->p));
    counted[k]->p_holm = largest;
  }
}

std::optional<Contrast> ContrastAt(const FitProblem& problem, const FitPoint& point,
                                   const Uncertainty& u) {
  const FitOptions& options = problem.options();
  const Eigen::Index fitted = static_cast<Eigen::Index>(problem.map().fitted.size());
  const Eigen::Index size = u.covariance.rows();
  const ParameterSet<double> values = problem.Parameters(point, "");
  Contrast contrast;
  for (const ParameterSpec& slope : options.table.specs) {
    if (!slope.free || !slope.slope_of || !slope.slope_of->covariate.is_contrast()) continue;
    const Covariate& between = slope.slope_of->covariate;
    contrast.label = between.key;
    contrast.first = between.first;
    contrast.second = between.second;
    const ParameterSpec& of = options.table[slope.slope_of->target];
    const auto shared = static_cast<Eigen::Index>(problem.FittedIndex(of.id));
    const auto own = static_cast<Eigen::Index>(problem.FittedIndex(slope.id));
    if (own >= fitted) continue;
    const double b = values[slope.id];
    ContrastRow row;
    row.name = of.name;
    row.unit = of.unit;
    row.first = Shifted(of.transform, values[of.id], -0.5 * b);
    row.second = Shifted(of.transform, values[of.id], 0.5 * b);
    row.difference = row.second - row.first;
    row.status = u.estimates[own].status;
    if (row.status == EstimateStatus::kUnidentifiable) {
      row.upper95 = std::numeric_limits<double>::infinity();
      row.lower95 = -row.upper95;
    } else {
      const double to_first = TransformSlope(of.transform, row.first);
      const double to_second = TransformSlope(of.transform, row.second);
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
      gradient[own] = 0.5 * (to_first + to_second);
      if (shared < fitted) gradient[shared] = to_second - to_first;
      const double width = u.scatter.Of(gradient).HalfWidth();
      row.lower95 = row.difference - width;
      row.upper95 = row.difference + width;
      row.p = ProbabilityOfZero(u.scatter, Eigen::VectorXd::Unit(size, own), b);
    }
    contrast.rows.push_back(std::move(row));
  }
  if (contrast.rows.empty()) return std::nullopt;
  CorrectForRows(&contrast);
  AddPeople(problem.recordings(), &contrast);
  return contrast;
}

}  // namespace pushid
