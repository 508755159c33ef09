// What happens to a forecast group when others stand near it whom nobody recorded?
//
//   pushid-bystander-study --model=generator --recordings=M/manifest.json --ids=row_1_00,row_2_00
//
// Each group is forecast by itself, with eight people in a block ahead of it, and with eight people
// at its side, all of them standing as the recorded ones do at frame 0. Those ahead may be pushed
// in the end; those aside, 3 m away, are not, and the recorded people's error should stay what it
// is. tests/studies/diffusion.py makes a table of it.
#include <gflags/gflags.h>

#include <cstdio>
#include <sstream>

#include "datasets/loading/load_recordings.h"
#include "ident/generators/push_particles.h"
#include "tests/studies/study.h"

DEFINE_string(model, "", "folder of a generator of groups");
DEFINE_string(recordings, "", "manifest.json of the recordings");
DEFINE_string(ids, "", "the recordings, comma-separated; empty: all groups");

namespace pushid {
namespace {

constexpr int kBystanders = 8;
constexpr float kAhead = 0.6f, kColumn = 0.5f, kAside = 3.0f;  // m

enum class Place { kNobody, kInFront, kAtTheSide };

// Recorded people first. `extra` have the frames and masses of the recorded ones in turn.
std::vector<ObservedMotion> WithBystanders(std::vector<ObservedMotion> group, Place place) {
  if (place == Place::kNobody) return group;
  const size_t recorded = group.size();
  float foremost = group[0].place.x(), outermost = group[0].place.y(), middle = 0.0f;
  for (const ObservedMotion& person : group) {
    foremost = std::max(foremost, person.place.x());
    outermost = std::max(outermost, person.place.y());
    middle += person.place.y() / static_cast<float>(recorded);
  }
  for (int k = 0; k < kBystanders; ++k) {
    ObservedMotion person = group[static_cast<size_t>(k) % recorded];
    person.controls = {};
    const float row = static_cast<float>(k / 2), column = static_cast<float>(k % 2);
    person.place =
        place == Place::kInFront
            ? Eigen::Vector2f(foremost + kAhead * (1.0f + row), middle + kColumn * (column - 0.5f))
            : Eigen::Vector2f(foremost - kAhead * row, outermost + kAside + kColumn * column);
    group.push_back(std::move(person));
  }
  return group;
}

struct Sums {
  double error = 0.0, moved = 0.0;
  int recordings = 0;
};

void Judge(const MotionGenerator& generator, const BodyRecording& recording, Place place,
           Sums* sums) {
  const std::vector<ObservedMotion> whole = GroupOf(recording);
  std::vector<ObservedMotion> seen = whole;
  for (ObservedMotion& person : seen) person.frames = Trajectories(person.frames.leftCols(1));
  const auto forecast = generator.Forecast(WithBystanders(seen, place), recording.num_frames() - 1);
  double error = 0.0, moved = 0.0;
  for (size_t n = 0; n < forecast.size(); ++n) {
    if (n >= whole.size()) {
      moved += (forecast[n].rightCols(1) - seen[n % whole.size()].frames).topRows(2).norm() /
               kBystanders;
      continue;
    }
    const Trajectories miss = forecast[n] - whole[n].frames.rightCols(forecast[n].cols());
    const Eigen::Map<const Eigen::Matrix3Xf> joints(miss.data(), 3, miss.size() / 3);
    error += joints.colwise().norm().mean() / static_cast<double>(whole.size());
  }
  sums->error += error;
  sums->moved += moved;
  ++sums->recordings;
}

int Run() {
  const LoadedGenerator loaded = OrExit(LoadGenerator(FLAGS_model, {}));
  LoadOptions options;
  options.keep_all_joints = true;
  options.setting = "groups";
  std::istringstream ids(FLAGS_ids);
  for (std::string id; std::getline(ids, id, ',');) options.ids.push_back(id);
  const auto recordings = OrExit(LoadRecordings(FLAGS_recordings, options));
  const auto bodies = OrExit(MakeBodyRecordings(recordings));
  std::printf("where they stand, error of the recorded people m, way of the others m\n");
  for (const auto& [name, place] : {std::pair("nobody", Place::kNobody),
                                    {"ahead", Place::kInFront},
                                    {"aside", Place::kAtTheSide}}) {
    Sums sums;
    for (const BodyRecording& recording : bodies) {
      Judge(*loaded.generator, recording, place, &sums);
    }
    std::printf("%s, %.4f, %.4f\n", name, sums.error / sums.recordings,
                sums.moved / sums.recordings);
  }
  return 0;
}

}  // namespace
}  // namespace pushid

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  return pushid::Run();
}
