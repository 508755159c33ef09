// datasets: trajectories of a crowd, inspected.
#include "datasets/inspection/inspect_crowd.h"

#include <algorithm>
#include <limits>

#include "datasets/exchange/crowd_places.h"
#include "datasets/files/list_of_names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// m; of everybody's distance to the nearest other.
double MedianSpacing(const std::vector<CrowdPlace>& places) {
  std::vector<double> nearest;
  for (const CrowdPlace& one : places) {
    double distance = std::numeric_limits<double>::infinity();
    for (const CrowdPlace& other : places) {
      if (&other != &one) distance = std::min(distance, (one.position - other.position).norm());
    }
    nearest.push_back(distance);
  }
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  return nearest[nearest.size() / 2];
}

// The file's frame with most people, counted from its first.
int FullestFrame(const PointMotion& motion) {
  int fullest = 0;
  std::ptrdiff_t most = -1;
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    const auto there =
        std::count_if(motion.positions.begin(), motion.positions.end(),
                      [frame](const auto& track) { return track[frame].allFinite(); });
    if (there > most) fullest = frame, most = there;
  }
  return fullest;
}

}  // namespace

void InspectCrowd(const PointMotion& motion, Inspection* found) {
  found->Fact("people", std::to_string(motion.names.size()) + ": " + ListOfNames(motion.names));
  found->Fact("frames", std::to_string(motion.num_frames()) + " at " + Rounded(motion.rate_hz) +
                            " per second, from " + Rounded(motion.first_time_s) + " s");
  const int frame = FullestFrame(motion);
  const Result<std::vector<CrowdPlace>> places = PlacesAt(motion, frame);
  if (!places.ok()) return;
  const std::size_t people = places.value().size();
  found->Fact("fullest frame",
              std::to_string(frame) + ": " + std::to_string(people) + " people" +
                  (people < 2 ? ""
                              : ", the nearest other " + Rounded(MedianSpacing(places.value()), 3) +
                                    " m away (median)"));
  found->Fact("use", "pushid-simulate --formation=" + motion.path + " --formation_frame=" +
                         std::to_string(frame) + " places people as they stand there");
}

}  // namespace pushid
