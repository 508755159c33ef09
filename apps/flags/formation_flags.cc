// apps: flags to a scene.
#include "apps/flags/formation_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "apps/flags/command_line.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/trajectories.h"
#include "datasets/loading/load_recordings.h"
#include "ident/formations/formation_run.h"

DEFINE_string(
    formation, "",
    "line, diamond or grid of --people, or a trajectory file (.txt), whose people at "
    "--formation_frame are taken; the table judges everybody 2 s after the last push (or after "
    "the onset, if later)");
DEFINE_int32(people, 4, "number of people in a line, diamond or grid");
DEFINE_double(fps, 60.0, "frames per second");
DEFINE_int32(
    formation_frame, 0,
    "of a trajectory file: frame of the file that gives the positions (default: its first)");
DEFINE_double(spacing, 0.45, "distance between neighbours, cart to cart, m");
DEFINE_string(pushed, "0",
              "who is pushed, comma-separated numbers; people are counted from 0, from "
              "back to front, and in a row from right to left");
DEFINE_string(push, "80",
              "pushes at the hip, comma-separated, N s or N s@start in s, as "
              "in 80@0,80@1,112@2; every push acts on all of --pushed");
DEFINE_double(push_duration, pushid::HipPush{}.duration, "duration of each push (a half-sine), s");
DEFINE_double(push_direction, 0.0, "direction of all pushes, degrees from +x to the left");
DEFINE_double(mass, 80.0, "mass of each person, kg");
DEFINE_double(rod_length, pushid::kReferenceRod, "rod length (ankles to hip) of each person, m");
DEFINE_string(people_from, "",
              "manifest.json of recordings whose people stand in the formation, each once and in "
              "their order, then from the first again: their masses, and the postures (rod length, "
              "lean, skeleton) in which their first recordings begin");
DEFINE_double(duration, 0.0, "duration, s; 0: until 6 s after the last push");
DEFINE_string(as_setting, "",
              "use the parameters of this setting, for models with parameters by "
              "setting (default: the shared ones)");

namespace pushid {
namespace {

constexpr double kMostPersonFrames = 2e6;  // half a gigabyte of forces
constexpr double kWatchSeconds = 6.0;      // after the last push
constexpr int kMostPeople = 10000;

bool FromFile() {
  const std::optional<MotionFormat> format = MotionFormatOfFile(FLAGS_formation);
  return format && HoldsCrowd(*format);
}

FormationShape Shape() {
  if (const auto shape = FromName<FormationShape>(FLAGS_formation)) return *shape;
  throw Error{"--formation is '" + FLAGS_formation +
              "'; it must be line, diamond or grid, or a trajectory file (.txt)"};
}

struct Places {
  std::vector<Eigen::Vector2d> positions;
  std::vector<std::string> names;  // of a file's people
};

Places PlacesOfFile() {
  for (const char* flag : {"people", "spacing"}) {
    if (!Given(flag)) continue;
    throw Error{std::string("--") + flag + " is for line, diamond and grid; " + FLAGS_formation +
                " gives the positions"};
  }
  std::optional<std::int64_t> frame;
  if (Given("formation_frame")) frame = FLAGS_formation_frame;
  const std::vector<CrowdPlace> read =
      OrFail(PlacesAt(OrFail(ReadTrajectoryText(FLAGS_formation)), frame));
  const std::string odd = OddSpacing(read);
  if (!odd.empty()) Warn(FLAGS_formation + ": " + odd);
  Places places;
  for (const CrowdPlace& place : read) {
    places.positions.push_back(place.position);
    places.names.push_back(place.name);
  }
  if (places.names.size() > kMostPeople) {
    throw Error{std::to_string(places.names.size()) + " people are too many", FLAGS_formation};
  }
  return places;
}

Places FormationPlaces() {
  if (FromFile()) return PlacesOfFile();
  if (Given("formation_frame")) {
    throw Error{"--formation_frame needs a trajectory file (.txt)"};
  }
  return {FormationPositions(Shape(), FLAGS_people, FLAGS_spacing), {}};
}

// Counted from the back, whatever the file's ids.
std::vector<int> PushedPeople(const Places& places) {
  std::vector<int> people;
  std::set<int> seen;
  for (const std::string& spaced : SplitList(FLAGS_pushed)) {
    const std::string word(Trimmed(spaced));
    std::int64_t person = 0;
    if (!ParseInteger(word, &person)) {
      throw Error{"--pushed: " + Quoted(word) +
                  " is not a person's number; give numbers as in 0,1,3"};
    }
    const int count = static_cast<int>(places.positions.size());
    if (person < 0 || person >= count) {
      const auto named = std::find(places.names.begin(), places.names.end(), word);
      if (named != places.names.end()) {
        throw Error{"--pushed counts people from the back, from 0; the file's id " + word +
                    " is person " + std::to_string(named - places.names.begin())};
      }
      throw Error{"--pushed names person " + word + ", but " +
                  (FromFile() ? "the " + std::to_string(count) + " people of the file count"
                              : "--people=" + std::to_string(count) + " counts them") +
                  " from 0 to " + std::to_string(count - 1)};
    }
    if (!seen.insert(static_cast<int>(person)).second) {
      throw Error{"--pushed names person " + word + " twice"};
    }
    people.push_back(static_cast<int>(person));
  }
  if (people.empty())
    throw Error{"--pushed is empty; give the numbers of the pushed people, as in 0,1,3"};
  return people;
}

HipPush ParsePush(const std::string& word) {
  HipPush push;
  push.duration = FLAGS_push_duration;
  push.direction = FLAGS_push_direction * M_PI / 180.0;
  const size_t at = word.find('@');
  const std::string start = at == std::string::npos ? "0" : word.substr(at + 1);
  if (!ParseDouble(word.substr(0, at), &push.impulse) || !ParseDouble(start, &push.start)) {
    throw Error{"--push: " + Quoted(word) +
                " is not a push; give N s, or N s@start in s, as in 80@0,80@1.5"};
  }
  if (push.impulse <= 0.0 || push.impulse > 2000.0) {
    throw Error{"--push: " + Quoted(word) +
                " has an impulse outside 0 to 2000 N s; --push_direction turns it"};
  }
  if (push.start < 0.0 || push.start > 3600.0) {
    throw Error{"--push: " + Quoted(word) + " starts at a time outside 0 to 3600 s"};
  }
  return push;
}

std::vector<HipPush> Pushes() {
  std::vector<HipPush> pushes;
  for (const std::string& word : SplitList(FLAGS_push)) {
    const HipPush push = ParsePush(std::string(Trimmed(word)));
    pushes.push_back(push);
  }
  if (pushes.empty()) throw Error{"--push is empty; give an impulse in N s, as in 80"};
  return pushes;
}

void CheckFormationNumbers() {
  CheckRange("people", FLAGS_people, 1, kMostPeople);
  CheckRange("fps", FLAGS_fps, 10, 10000);
  CheckRange("spacing", FLAGS_spacing, 0.05, 100);
  CheckRange("push_duration", FLAGS_push_duration, 0.001, 60);
  CheckRange("push_direction", FLAGS_push_direction, -360, 360);
  CheckRange("mass", FLAGS_mass, 1, 400);
  CheckRange("rod_length", FLAGS_rod_length, 0.2, 2);
  CheckRange("duration", FLAGS_duration, 0, 3600);
  CheckExcludes({"mass", "rod_length"}, "people_from",
                "--people_from gives the recorded people's mass and rod length; leave out "
                "--{}");
}

// Their first poses; nobody without the flag.
std::vector<Pose> PlaceFlaggedPeople(Scene* scene) {
  if (FLAGS_people_from.empty()) return std::vector<Pose>();
  LoadOptions options;
  options.keep_all_joints = true;
  const std::vector<Recording> recordings = OrFail(LoadRecordings(FLAGS_people_from, options));
  const std::vector<BodyRecording> bodies =
      OrFail(MakeBodyRecordings(recordings, SkeletonMapping::kExact));
  return PlacePeople(DistinctPeople(bodies), scene);
}

// "10 people in a line, 0.45 m apart".
std::string PeopleText(int people) {
  std::ostringstream text;
  text << people << (FLAGS_people_from.empty() ? "" : " recorded")
       << (people == 1 ? " person" : " people");
  if (FromFile()) {
    text << " of " << FLAGS_formation;
    if (Given("formation_frame")) text << ", frame " << FLAGS_formation_frame;
  } else if (people == 1) {
    text << ", alone";
  } else {
    text << " in a " << FLAGS_formation << ", " << FLAGS_spacing << " m apart";
  }
  return text.str();
}

std::string RunTitle(int people, const std::vector<HipPush>& pushes) {
  std::ostringstream text;
  text << PeopleText(people);
  const char* separator = "; ";
  for (const HipPush& push : pushes) {
    text << separator << push.impulse << " N s at " << push.start << " s";
    separator = ", ";
  }
  text << (FLAGS_pushed.find(',') == std::string::npos ? " on person " : " on people ")
       << FLAGS_pushed;
  if (FLAGS_push_direction != 0.0) {
    text << ", " << std::abs(FLAGS_push_direction) << " degrees to the "
         << (FLAGS_push_direction > 0.0 ? "left" : "right");
  }
  return text.str();
}

int NumFrames(const Scene& scene) {
  const double seconds =
      FLAGS_duration > 0.0 ? FLAGS_duration : scene.LastPushEnd() * scene.dt + kWatchSeconds;
  return static_cast<int>(std::lround(seconds * FLAGS_fps)) + 1;
}

void CheckFrames(int frames, int people, const std::vector<HipPush>& pushes) {
  if (frames < 3) throw Error{"--duration is shorter than two frames"};
  for (const HipPush& push : pushes) {
    if (std::lround(push.start * FLAGS_fps) < frames - 1) continue;
    std::ostringstream text;
    text << "--duration ends at " << FLAGS_duration << " s, before the push of " << push.impulse
         << " N s at " << push.start << " s; lengthen it, or leave the push out";
    throw Error{text.str()};
  }
  if (static_cast<double>(frames) * people > kMostPersonFrames) {
    throw Error{std::to_string(people) + " people over " + std::to_string(frames) +
                " frames are too many; lower --people, --duration or --fps"};
  }
}

}  // namespace

FormationFlags FormationFlagsFromCommandLine() {
  Require("formation", FLAGS_formation, "give line, diamond or grid, or a trajectory file");
  CheckFormationNumbers();
  const Places placed = FormationPlaces();
  const std::vector<Eigen::Vector2d>& positions = placed.positions;
  const int people = static_cast<int>(positions.size());
  const std::vector<int> pushed = PushedPeople(placed);
  const std::vector<HipPush> pushes = Pushes();

  FormationFlags flags;
  flags.title = RunTitle(people, pushes);
  flags.names = placed.names;
  flags.as_setting = FLAGS_as_setting;
  flags.scene = FormationScene(positions, {FLAGS_mass, FLAGS_rod_length, 0.0}, 1.0 / FLAGS_fps);
  const std::vector<Pose> poses = PlaceFlaggedPeople(&flags.scene);
  flags.first_poses = poses;
  for (const HipPush& push : pushes) {
    for (int person : pushed) AddHipPush(person, push, &flags.scene);
  }
  flags.frames = NumFrames(flags.scene);
  CheckFrames(flags.frames, people, pushes);
  return flags;
}

}  // namespace pushid
