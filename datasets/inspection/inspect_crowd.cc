// datasets: trajectories of a crowd, inspected.
#include "datasets/inspection/inspect_crowd.h"

#include <algorithm>
#include <cstdint>

#include "datasets/exchange/crowd_places.h"
#include "datasets/files/list_of_names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// The file's frame with most people.
std::int64_t FullestFrame(const PointMotion& motion) {
  int fullest = 0;
  std::ptrdiff_t most = -1;
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    const auto there =
        std::count_if(motion.positions.begin(), motion.positions.end(),
                      [frame](const auto& track) { return track[frame].allFinite(); });
    if (there > most) fullest = frame, most = there;
  }
  return FirstFrame(motion) + fullest;
}

}  // namespace

void InspectCrowd(const PointMotion& motion, Inspection* found) {
  found->Fact("people", std::to_string(motion.names.size()) + ": " + ListOfNames(motion.names));
  found->Fact("frames", std::to_string(motion.num_frames()) + " at " + Rounded(motion.rate_hz) +
                            " per second, from the file's frame " +
                            std::to_string(FirstFrame(motion)));
  const std::int64_t frame = FullestFrame(motion);
  const Result<std::vector<CrowdPlace>> places = PlacesAt(motion, frame);
  if (!places.ok()) return;
  const std::size_t people = places.value().size();
  found->Fact("fullest frame",
              std::to_string(frame) + ": " + std::to_string(people) + " people" +
                  (people < 2 ? ""
                              : ", the nearest other " + Rounded(MedianSpacing(places.value()), 3) +
                                    " m away (median)"));
  const std::string odd = OddSpacing(places.value());
  if (!odd.empty()) found->Warn(odd);
  found->Fact("use", "pushid-simulate --formation=" + motion.path + " --formation_frame=" +
                         std::to_string(frame) + " places people as they stand there");
}

}  // namespace pushid
