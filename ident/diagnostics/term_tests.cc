// ident: score tests of terms that are held at zero.
#include "ident/diagnostics/term_tests.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/clusters.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr size_t kMostColumns = 60;
constexpr Parameter kTerms[] = {kBx, kBy, kTx, kTy, kAy, kCq, kDq};

// The options with the terms freed that are held at zero.
FitOptions WithTerms(const FitOptions& options, std::vector<Parameter>* terms) {
  FitOptions with = options;
  for (Parameter id : kTerms) {
    ParameterSpec& spec = with.table[id];
    if (spec.free || spec.nominal != 0.0) continue;
    spec.free = true;
    spec.pooled = false;
    spec.prior.reset();
    terms->push_back(id);
  }
  return with;
}

// The estimate in the larger problem, whose table knows more free parameters.
FitPoint Lifted(const FitProblem& small, const FitProblem& large, const FitPoint& estimate) {
  FitPoint point = estimate;
  point.shared = large.NominalPoint().shared;
  for (size_t i = 0; i < small.map().fitted.size(); ++i) {
    for (size_t k = 0; k < large.map().fitted.size(); ++k) {
      if (large.map().fitted[k].parameter == small.map().fitted[i].parameter) {
        point.shared[k] = estimate.shared[i];
      }
    }
  }
  return point;
}

double Statistic(const Eigen::VectorXd& scores) {
  const double groups = static_cast<double>(scores.size());
  const double scatter = (scores.array() - scores.mean()).matrix().squaredNorm();
  return scatter > 0.0 ? scores.sum() / std::sqrt(groups / (groups - 1.0) * scatter) : 0.0;
}

}  // namespace

std::vector<TermTest> TestTerms(const FitProblem& problem, const FitPoint& estimate) {
  std::vector<Parameter> terms;
  const FitOptions options = WithTerms(problem.options(), &terms);
  const Clusters clusters = MakeClusters(problem.recordings(), options.cluster);
  const bool skip = options.model.learned != nullptr || terms.empty() ||
                    estimate.Flat().size() > kMostColumns || clusters.count() < 3;
  if (skip) return {};
  const FitProblem large(problem.recordings(), options, problem.counts());
  FitPoint point = Lifted(problem, large, estimate);
  JacobianBlocks score = EvaluateJacobianBlocks(large.Build(&point, 0));
  const RowClusters rows = ClusterRows(large, clusters, score).first;

  std::vector<int> known, tested;
  for (int i = 0; i < score.jacobian.cols(); ++i) {
    const bool shared = i < large.map().num_shared();
    const bool is_term = shared && std::find(terms.begin(), terms.end(),
                                             large.map().fitted[i].parameter) != terms.end();
    (is_term ? tested : known).push_back(i);
  }
  const Eigen::MatrixXd of_known = score.jacobian(Eigen::all, known);
  const Eigen::MatrixXd explained = of_known.transpose() * score.jacobian(Eigen::all, tested);
  const Eigen::MatrixXd columns =
      score.jacobian(Eigen::all, tested) -
      of_known * SolveSymmetric(of_known.transpose() * of_known, explained);
  std::vector<TermTest> tests;
  for (size_t k = 0; k < tested.size(); ++k) {
    Eigen::VectorXd scores = Eigen::VectorXd::Zero(clusters.count());
    for (Eigen::Index row = 0; row < columns.rows(); ++row) {
      const int cluster = rows.of_row[static_cast<size_t>(row)];
      if (cluster < 0) continue;
      scores[cluster] += columns(row, static_cast<Eigen::Index>(k)) * score.residuals[row];
    }
    const double t = Statistic(scores);
    const int freedom = clusters.count() - 1;
    tests.push_back({options.table[large.map().fitted[tested[k]].parameter].name, t, freedom,
                     StudentTail(t, freedom)});
  }
  return tests;
}

}  // namespace pushid
