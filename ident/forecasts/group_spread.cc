// ident: sampled groups against what they did.
#include "ident/forecasts/group_spread.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"

namespace pushid {

void AddSpread(const MotionGenerator& generator, const BodyRecording& recording,
               const GroupHips& hips, int observed, const NormalSource& normal,
               GroupSpread* spread) {
  const std::vector<ObservedMotion> whole = GroupOf(recording, hips);
  std::vector<ObservedMotion> people = whole;
  for (ObservedMotion& person : people) {
    person.frames = Trajectories(person.frames.leftCols(observed));
  }
  const int after = recording.num_frames() - observed;
  const auto futures = generator.Sample(people, after, spread->samples, normal);
  for (size_t n = 0; n < people.size(); ++n) {
    for (int t = 0; t < after; ++t) {
      float low = futures[n].front().motion(0, t), high = low;
      for (const SampledFuture& future : futures[n]) {
        low = std::min(low, future.motion(0, t));
        high = std::max(high, future.motion(0, t));
      }
      const float recorded = whole[n].frames(0, observed + t);
      spread->inside_sum += recorded >= low && recorded <= high ? 1.0 : 0.0;
      spread->width_sum += high - low;
      spread->frames += 1.0;
    }
  }
}

nlohmann::ordered_json ToJson(const GroupSpread& spread) {
  return {{"samples", spread.samples},
          {"hip_x_inside", spread.Inside()},
          {"hip_x_width_m", spread.Width()}};
}

std::string SpreadText(const GroupSpread& spread) {
  const double ideal = (spread.samples - 1.0) / (spread.samples + 1.0);
  return "the recorded hip lies among " + std::to_string(spread.samples) + " sampled futures in " +
         Rounded(100.0 * spread.Inside(), 3) + " % of frames (" + Rounded(100.0 * ideal, 3) +
         " % if their spread is correct); they are " + Rounded(spread.Width(), 3) + " m wide\n";
}

}  // namespace pushid
