// ident: propagation over recordings: ratios of sums, errors clustered by recording.
#include <cmath>

#include "ident/prediction/propagation.h"

namespace pushid {
namespace {

// v = sum s_r / sum w_r; its variance by linearization, n/(n-1) sum (s_r - v w_r)^2 / (sum w_r)^2.
PropagationMean RatioMean(const std::vector<const PropagationScore*>& scores, int figure) {
  PropagationMean mean;
  double sum = 0.0, recordings = 0.0;
  for (const PropagationScore* score : scores) {
    const Ratio& ratio = score->figures[figure];
    sum += ratio.sum;
    mean.weight += ratio.weight;
    recordings += ratio.weight > 0.0 ? 1.0 : 0.0;
  }
  if (!mean.known()) return mean;
  mean.value = sum / mean.weight;
  if (recordings < 2.0) return mean;
  double squares = 0.0;
  for (const PropagationScore* score : scores) {
    const Ratio& ratio = score->figures[figure];
    squares += std::pow(ratio.sum - mean.value * ratio.weight, 2);
  }
  mean.error = std::sqrt(recordings / (recordings - 1.0) * squares) / mean.weight;
  return mean;
}

}  // namespace

PropagationSummary SummarizePropagation(const std::vector<const PropagationScore*>& scores) {
  PropagationSummary summary;
  for (const PropagationScore* score : scores) {
    const Ratio &missed = score->figures[kMissedMovers], &moved = score->figures[kFalseMovers];
    if (missed.weight + moved.weight <= 0.0) continue;  // a single person
    ++summary.recordings;
    summary.movers += missed.weight;
    summary.missed_movers += missed.sum;
    summary.bystanders += moved.weight;
    summary.false_movers += moved.sum;
  }
  for (int i = 0; i < kNumPropagationFigures; ++i) summary.figures[i] = RatioMean(scores, i);
  return summary;
}

std::optional<PropagationMean> Speed(const PropagationMean& slowness) {
  if (!slowness.known() || !(slowness.value > 0.0)) return std::nullopt;
  PropagationMean speed = slowness;
  speed.value = 1.0 / slowness.value;
  speed.error = slowness.error / (slowness.value * slowness.value);
  return speed;
}

}  // namespace pushid
