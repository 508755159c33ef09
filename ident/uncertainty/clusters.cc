// ident: people, recordings and line-ups as clusters.
#include "ident/uncertainty/clusters.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "ident/problem/fit_problem.h"
#include "models/decompositions.h"

namespace pushid {

namespace {

// Of fewer the scatter cannot be told, and recordings stand for them.
constexpr size_t kFewestLineUps = 4;

// The same for the same people in the same order.
std::string LineUpKey(const PendulumRecording& recording) {
  std::string key;
  for (const std::string& person : recording.subject_ids) key += person + "\n";
  return key;
}

}  // namespace

Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by,
                      const std::vector<int>& counts) {
  std::map<std::string, int> times, index, line_ups;
  bool repeated = false, shared = false;
  const auto counted = [&counts](size_t i) { return counts.empty() || counts[i] > 0; };
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    if (!counted(i)) continue;
    shared = shared || r.num_people() > 1;
    for (const std::string& id : r.subject_ids) repeated = ++times[id] > 1 || repeated;
  }
  Clusters clusters;
  clusters.by = by;
  if (by == ClusterBy::kAuto) {
    clusters.by = repeated && times.size() > 1 ? ClusterBy::kSubject : ClusterBy::kRecording;
  }
  const bool people = clusters.by == ClusterBy::kSubject;
  clusters.two_way = people && shared;
  clusters.people = static_cast<int>(times.size());
  clusters.draws_people = times.size() > 1 && (people || (!repeated && !shared));
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    std::vector<int> of;
    for (int n = 0; counted(i) && n < r.num_people(); ++n) {
      const std::string key = people ? r.subject_ids[n] : std::to_string(i);
      const auto [found, added] = index.emplace(key, clusters.count());
      if (added) clusters.names.push_back(people ? key : r.id);
      of.push_back(found->second);
    }
    clusters.of.push_back(std::move(of));
    const int next = static_cast<int>(line_ups.size());
    clusters.line_up.push_back(line_ups.emplace(LineUpKey(r), next).first->second);
  }
  if (line_ups.size() < kFewestLineUps) {
    std::iota(clusters.line_up.begin(), clusters.line_up.end(), 0);
  }
  return clusters;
}

Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const ResidualRows& score) {
  Clustering rows;
  rows.priors_scatter = true;
  rows.pooled_units =
      problem.map().num_deviations > 0 ? static_cast<int>(problem.NominalPoint().unit.size()) : 0;
  rows.first.count = clusters.count();
  for (size_t row = 0; row < score.cluster_of_row.size(); ++row) {
    const int recording = score.cluster_of_row[row];
    // Of no recording, or of one that does not count.
    if (recording < 0 || clusters.of[recording].empty()) {
      rows.first.of_row.push_back(-1);
      continue;
    }
    rows.first.of_row.push_back(clusters.of[recording][score.person_of_row[row]]);
  }
  if (clusters.two_way) {
    for (size_t row = 0; row < score.cluster_of_row.size(); ++row) {
      const int line_up =
          rows.first.of_row[row] < 0 ? -1 : clusters.line_up[score.cluster_of_row[row]];
      rows.line_ups.of_row.push_back(line_up);
      rows.line_ups.count = std::max(rows.line_ups.count, line_up + 1);
    }
  }
  if (clusters.by == ClusterBy::kSubject) rows.recordings = ClusterByRecording(score);
  return rows;
}

namespace {

constexpr double kLeastKept = 0.01;
constexpr double kNoLeverage = 1e-13;  // moves a score by half as much

Eigen::MatrixXd Centred(const Eigen::MatrixXd& columns) {
  return columns.colwise() - columns.rowwise().mean().eval();
}

// What leaving a cluster out would leave of a direction, by the eigenvalues of M_g. A direction
// that one cluster alone determines is counted as ten times what its score says, no more: with
// second derivatives in H leverages may pass one.
Eigen::ArrayXd Kept(const Eigen::ArrayXd& leverage) { return (1.0 - leverage).max(kLeastKept); }

// F of J base, with F'F that of all its rows.
Eigen::MatrixXd FewRows(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& base) {
  std::vector<Eigen::Index> used, filled;
  for (Eigen::Index column = 0; column < jacobian.cols(); ++column) {
    if (!jacobian.col(column).isZero(0.0)) used.push_back(column);
  }
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    if (!jacobian.row(row).isZero(0.0)) filled.push_back(row);
  }
  const Eigen::MatrixXd packed = jacobian(filled, used), own = base(used, Eigen::all);
  if (filled.size() <= used.size()) return packed * own;  // condensed already
  const SymmetricEigen squares = DecomposeSymmetric(packed.transpose() * packed);
  return squares.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         (squares.vectors.transpose() * own);
}

// The directions of M_g = W'W that it is not zero in, and its eigenvalues there.
struct Leverage {
  Eigen::ArrayXd m;
  Eigen::MatrixXd v;  // a column each

  explicit Leverage(const Eigen::MatrixXd& w) : m(0), v(w.cols(), 0) {
    if (w.rows() == 0) return;
    const SymmetricEigen eigen = DecomposeSymmetric(w * w.transpose());
    const Eigen::ArrayXd values = eigen.values.array();
    const Eigen::Index some = (values > kNoLeverage).count();  // they ascend
    m = values.tail(some);
    v = w.transpose() * eigen.vectors.rightCols(some) * m.rsqrt().matrix().asDiagonal();
  }
};

}  // namespace

RowClusters ClusterByRecording(const ResidualRows& score) {
  RowClusters clusters;
  for (int cluster : score.cluster_of_row) {
    clusters.of_row.push_back(std::max(-1, cluster));
    clusters.count = std::max(clusters.count, cluster + 1);
  }
  return clusters;
}

ClusterScores GatherScores(const ResidualRows& score, const RowClusters& clusters,
                           const Eigen::MatrixXd& base) {
  std::vector<std::vector<int>> rows(clusters.count);
  for (int row = 0; row < static_cast<int>(clusters.of_row.size()); ++row) {
    if (clusters.of_row[row] >= 0) rows[clusters.of_row[row]].push_back(row);
  }
  ClusterScores gathered;
  gathered.scores.resize(base.cols(), 0);
  for (const std::vector<int>& of_cluster : rows) {
    if (of_cluster.empty()) continue;
    const Eigen::MatrixXd plain = score.jacobian(of_cluster, Eigen::all);
    const Eigen::VectorXd residuals = score.residuals(of_cluster);
    const bool robust = score.robust_jacobian.size() > 0;
    gathered.factors.push_back(robust ? FewRows(score.robust_jacobian(of_cluster, Eigen::all), base)
                                      : FewRows(plain, base));
    gathered.scores.conservativeResize(Eigen::NoChange, gathered.scores.cols() + 1);
    gathered.scores.rightCols(1) = base.transpose() * (plain.transpose() * residuals);
  }
  return gathered;
}

ClusteredCovariance Cr2(const ClusterScores& scores, const Eigen::MatrixXd& hessian,
                        const Eigen::MatrixXd& coefficients) {
  const Eigen::MatrixXd root = DecomposeSymmetric(hessian).InverseSqrt();
  const Eigen::MatrixXd b = root * coefficients.transpose();  // H^-1/2 c
  const Eigen::Index groups = scores.scores.cols(), size = b.cols();
  Eigen::MatrixXd moves(hessian.rows(), groups);
  Eigen::MatrixXd own(size, groups);  // |p_g|^2
  std::vector<Eigen::MatrixXd> u;     // J_g' p_g over H^1/2, a column a coefficient
  for (Eigen::Index g = 0; g < groups; ++g) {
    const auto [m, v] = Leverage(scores.factors[static_cast<size_t>(g)] * root);
    const Eigen::ArrayXd kept = Kept(m);
    const Eigen::VectorXd score = root * scores.scores.col(g);
    const Eigen::ArrayXd along_v = (v.transpose() * score).array();
    moves.col(g) = root * (score + v * (along_v * (kept.rsqrt() - 1.0)).matrix());
    const Eigen::MatrixXd along = v.transpose() * b;
    own.col(g) = along.cwiseAbs2().transpose() * (m / kept).matrix();
    u.push_back((m / kept.sqrt()).matrix().asDiagonal() * along);
    u.back() = v * u.back();
  }
  ClusteredCovariance result;
  const double most = std::max(1.0, static_cast<double>(groups) - 1.0);
  const Eigen::MatrixXd centred = Centred(moves);
  result.covariance = centred * centred.transpose();
  result.freedom.resize(size);
  for (Eigen::Index c = 0; c < size; ++c) {
    Eigen::MatrixXd at(hessian.rows(), groups);
    for (Eigen::Index g = 0; g < groups; ++g) at.col(g) = u[static_cast<size_t>(g)].col(c);
    Eigen::MatrixXd w = -at.transpose() * at;
    w.diagonal() += own.row(c).transpose();
    const double squares = w.squaredNorm();
    result.freedom[c] =
        squares > 0.0 ? std::clamp(w.trace() * w.trace() / squares, 1.0, most) : 1.0;
  }
  return result;
}

}  // namespace pushid
