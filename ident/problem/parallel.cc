// ident: counts of evaluations.
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

std::atomic<int> jacobians_so_far{0}, costs_so_far{0};

}  // namespace

void CountEvaluations(const Evaluations& more) {
  jacobians_so_far.fetch_add(more.jacobians, std::memory_order_relaxed);
  costs_so_far.fetch_add(more.costs, std::memory_order_relaxed);
}

Evaluations EvaluationsSoFar() { return {jacobians_so_far, costs_so_far}; }

void WorkLog::Add(const std::string& purpose) {
  auto part = std::find_if(parts_.begin(), parts_.end(),
                           [&](const Work& w) { return w.purpose == purpose; });
  if (part == parts_.end()) {
    parts_.push_back({purpose, {}, 0.0});
    part = parts_.end() - 1;
  }
  const Evaluations now = EvaluationsSoFar();
  part->evaluations.jacobians += now.jacobians - from_.jacobians;
  part->evaluations.costs += now.costs - from_.costs;
  from_ = now;
  const double time = Now();
  part->seconds += time - since_;
  since_ = time;
}

}  // namespace pushid
