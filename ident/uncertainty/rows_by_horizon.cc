// ident: rows of recordings, weighed as the cost weighs them, and condensed.
#include <algorithm>
#include <cmath>

#include "ident/problem/parallel.h"
#include "ident/uncertainty/recording_rows.h"
#include "residuals/cost_functions/plate_residual.h"
#include "residuals/normal_equations.h"

namespace pushid {
namespace {

using Eigen::Index;

// Of one person.
struct PersonSums {
  NormalEquations plain, robust;  // robust: with the loss's own Hessian
  std::vector<NormalEquations> robust_parts;
  std::vector<Eigen::VectorXd> scores;  // J'r, by part
};

class Condenser {
 public:
  Condenser(const FitProblem& problem, const RecordingRows& rows, size_t num_parts, int recording)
      : columns_(static_cast<int>(rows.columns.size())),
        weight_(problem.Weight(recording, 0)),
        loss_(problem.options().sigmas.OfFrames()),
        rows_(rows),
        frame_(RowMajorMatrix::Zero(kFrameResiduals, NormalEquations::PaddedSize(columns_))) {
    const NormalEquations none(columns_);
    people_.resize(static_cast<size_t>(problem.recordings()[recording].num_people()),
                   {none, none, std::vector(num_parts, none),
                    std::vector<Eigen::VectorXd>(num_parts, Eigen::VectorXd::Zero(columns_))});
  }

  // The next rows, times how much of the frame was seen, become those of the cost: with c = sqrt(1
  // + |r|^2 / d^2), residual and Jacobian times weight / sqrt(c); the loss's own Hessian has 1 / c
  // of that along r (frame_residual.h).
  void AddFrame(Index count, double seen, size_t part, PersonSums* to) {
    const auto r = rows_.residuals.segment(next_, count);
    const double squared = r.squaredNorm();
    const double whole = seen > 0.0 ? squared / (seen * seen) : 0.0;  // as if all of it counted
    const double c = loss_ > 0.0 ? std::sqrt(1.0 + whole / (loss_ * loss_)) : 1.0;
    const double scale = weight_ / std::sqrt(c);
    auto by_column = frame_.topLeftCorner(count, columns_);
    by_column = scale * rows_.by_column.middleRows(next_, count);
    residuals_ = scale * r;
    to->plain.Add(static_cast<int>(count), frame_.data(), residuals_.data());
    if (squared > 0.0) {
      along_.noalias() = r.transpose() * by_column;
      to->scores[part] += scale * along_.transpose();
      along_ *= (1.0 / c - 1.0) / squared;
      for (Index i = 0; i < count; ++i) by_column.row(i) += r[i] * along_;
    }
    to->robust_parts[part].Add(static_cast<int>(count), frame_.data(), residuals_.data());
    next_ += count;
  }

  std::vector<PersonSums>& people() { return people_; }

 private:
  int columns_;
  double weight_, loss_;
  const RecordingRows& rows_;
  Index next_ = 0;
  RowMajorMatrix frame_;  // J, padded
  Eigen::VectorXd residuals_;
  Eigen::RowVectorXd along_;
  std::vector<PersonSums> people_;
};

std::vector<PersonSums> Condense(const FitProblem& problem, const RecordingRows& rows,
                                 const std::vector<int>& horizons, int recording) {
  const PendulumRecording& r = problem.recordings()[recording];
  Condenser condenser(problem, rows, horizons.size() + 1, recording);
  std::vector<PersonSums>& people = condenser.people();
  const int begin = PushFrame(r);
  const auto part_of = [&](int frame) {
    return static_cast<size_t>(std::lower_bound(horizons.begin(), horizons.end(), frame - begin) -
                               horizons.begin());
  };
  for (int t = 1; t < r.num_frames(); ++t) {
    for (int n = 0; n < r.num_people(); ++n) {
      condenser.AddFrame(kFrameResiduals, r.Weight(n, t), part_of(t), &people[n]);
    }
  }
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    for (int n = 0; n < r.num_people(); ++n) {
      if (!r.HasPlates(n)) continue;
      condenser.AddFrame(kPlateResiduals, r.plates[n][t].weight, part_of(t), &people[n]);
    }
  }
  for (PersonSums& person : people) {
    for (const NormalEquations& part : person.robust_parts) person.robust.Add(part);
  }
  return std::move(people);
}

// What is told of a recording.
struct Told {
  std::vector<Index> columns;
  std::vector<PersonSums> people;
  int num_rows = 0;  // before they were condensed
};

// Of all of them, then what is no data.
class RowStack {
 public:
  RowStack(Index rows, Index columns, RowsByHorizon* result) : result_(*result) {
    JacobianBlocks& all = result->rows;
    all.jacobian = all.robust_jacobian = Eigen::MatrixXd::Zero(rows, columns);
    all.residuals = Eigen::VectorXd::Zero(rows);
  }

  void Add(const Told& told, int recording) {
    const Index count = static_cast<Index>(told.columns.size());
    for (int n = 0; n < static_cast<int>(told.people.size()); ++n) {
      const PersonSums& person = told.people[n];
      const RowMajorMatrix plain = person.plain.Factor(), robust = person.robust.Factor();
      for (Index k = 0; k <= count; ++k) {
        const Index row = Next(recording, n);
        result_.rows.residuals[row] = plain(k, count);
        for (Index j = 0; j < count; ++j) {
          result_.rows.jacobian(row, told.columns[j]) = plain(k, j);
          result_.rows.robust_jacobian(row, told.columns[j]) = robust(k, j);
        }
      }
      for (size_t part = 0; part < person.scores.size(); ++part) {
        AddPart(told, person, {recording, n, static_cast<int>(part), {}, {}});
      }
    }
  }

  void AddBeside(const JacobianBlocks& beside, const std::vector<Assumption>& assumptions) {
    const Index estimates = result_.num_estimates;
    for (size_t i = 0; i < beside.cluster_of_row.size(); ++i) {
      const Index from = static_cast<Index>(i), to = Next(beside.cluster_of_row[i], -1);
      result_.rows.jacobian.row(to).head(estimates) = beside.jacobian.row(from);
      result_.rows.residuals[to] = beside.residuals[from];
    }
    for (size_t k = 0; k < assumptions.size(); ++k) {
      const Index to = Next(FitProblem::kPriorCluster, -1);
      const double sigma = assumptions[k].sigma;
      result_.rows.jacobian(to, estimates + static_cast<Index>(k)) =
          sigma > 0.0 ? 1.0 / sigma : 0.0;
    }
  }

 private:
  Index Next(int cluster, int person) {
    result_.rows.cluster_of_row.push_back(cluster);
    result_.rows.person_of_row.push_back(person);
    return next_++;
  }

  void AddPart(const Told& told, const PersonSums& person, DataPart part) {
    const Index estimates = result_.num_estimates;
    const auto beyond = std::lower_bound(told.columns.begin(), told.columns.end(), estimates);
    const std::vector<Index> own(told.columns.begin(), beyond);
    const Index count = static_cast<Index>(own.size());
    const RowMajorMatrix gram =
        person.robust_parts[part.part].information().topLeftCorner(count, count);
    part.score = Eigen::VectorXd::Zero(estimates);
    part.score(own) = person.scores[part.part].head(count);
    part.information = Eigen::MatrixXd::Zero(estimates, estimates);
    part.information(own, own) = Eigen::MatrixXd(gram.selfadjointView<Eigen::Upper>());
    result_.parts.push_back(std::move(part));
  }

  RowsByHorizon& result_;
  Index next_ = 0;
};

// Priors, demands and pooling.
JacobianBlocks RowsBeside(const FitProblem& problem, FitPoint point) {
  return EvaluateJacobianBlocks(problem.WithoutRecordings().Build(&point, 0));
}

}  // namespace

RowsByHorizon EvaluateByHorizon(const FitProblem& problem, const FitPoint& point,
                                const std::vector<Assumption>& assumptions,
                                const std::vector<int>& horizons) {
  const int recordings = static_cast<int>(problem.recordings().size());
  RowsOfRecordings of(problem, point, assumptions);
  std::vector<Told> told(recordings);
  ParallelFor(recordings, problem.options().num_threads, [&](int i) {
    if (problem.Count(i) == 0) return;
    RecordingRows rows = of.Of(i);
    told[i].num_rows = static_cast<int>(rows.residuals.size());
    if (told[i].num_rows == 0) return;
    told[i].people = Condense(problem, rows, horizons, i);
    told[i].columns = std::move(rows.columns);
  });
  RowsByHorizon result;
  for (int i = 0; i < recordings; ++i) {
    if (problem.Count(i) > 0 && told[i].num_rows == 0) return result;
  }
  const JacobianBlocks beside = RowsBeside(problem, point);
  result.num_estimates = static_cast<int>(of.num_estimates());
  Index size = beside.jacobian.rows() + static_cast<Index>(assumptions.size());
  for (const Told& one : told) {
    size += static_cast<Index>(one.people.size() * (one.columns.size() + 1));
  }
  RowStack stack(size, of.num_estimates() + static_cast<Index>(assumptions.size()), &result);
  for (int i = 0; i < recordings; ++i) {
    if (told[i].num_rows == 0) continue;
    result.rows.clusters.push_back(i);
    result.rows.num_data_rows += told[i].num_rows;
    stack.Add(told[i], i);
  }
  stack.AddBeside(beside, assumptions);
  return result;
}

}  // namespace pushid
