// apps: flags to a scene.
#include "apps/flags/formation_flags.h"

#include <gflags/gflags.h>

#include <cmath>
#include <set>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/formation_output_flags.h"
#include "datasets/files/number_text.h"

DECLARE_int32(people);
DECLARE_double(fps);

DEFINE_string(
    formation, "",
    "line, diamond or grid: instead of recordings, roll --model out on --people who stand "
    "together; its table judges everybody 2 s after the last push (or the onset, where that is "
    "later), never at the end");
DEFINE_double(spacing, 0.45, "formation: between neighbours, cart to cart, m");
DEFINE_string(pushed, "0",
              "formation: who is pushed, comma-separated; people count from 0, from the back "
              "forwards and in a "
              "row from right to left");
DEFINE_string(
    push, "80",
    "formation: pushes at the hip along +x, comma-separated, N s or N s@start in s, as in "
    "80@0,80@1,112@2; every push acts on everybody of --pushed");
DEFINE_double(push_duration, pushid::HipPush{}.duration,
              "formation: of every push, a half-sine, s");
DEFINE_double(mass, 80.0, "formation: of everybody, kg");
DEFINE_double(rod_length, pushid::kReferenceRod,
              "formation: rod from ankles to hip, of everybody, m");
DEFINE_double(duration, 0.0, "formation: how long, s; 0: until 6 s after the last push");
DEFINE_string(as_setting, "",
              "formation: with the parameters of this setting, where the model has them by setting "
              "(default: the shared ones)");

namespace pushid {
namespace {

constexpr double kMostPersonFrames = 2e6;  // half a gigabyte of forces
constexpr double kWatchSeconds = 6.0;      // after the last push

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    parts.emplace_back(Trimmed(part));
  }
  return parts;
}

Result<FormationShape> Shape() {
  if (FLAGS_formation == "line") return FormationShape::kLine;
  if (FLAGS_formation == "diamond") return FormationShape::kDiamond;
  if (FLAGS_formation == "grid") return FormationShape::kGrid;
  return Error{"--formation is '" + FLAGS_formation + "'; it must be line, diamond or grid"};
}

Result<std::vector<int>> PushedPeople() {
  std::vector<int> people;
  std::set<int> seen;
  for (const std::string& word : Split(FLAGS_pushed, ',')) {
    std::int64_t person = 0;
    if (!ParseInteger(word, &person)) {
      return Error{"--pushed: " + Quoted(word) + " is no person; give numbers as in 0,1,3"};
    }
    if (person < 0 || person >= FLAGS_people) {
      return Error{"--pushed names person " + word +
                   ", but --people=" + std::to_string(FLAGS_people) + " counts them from 0 to " +
                   std::to_string(FLAGS_people - 1)};
    }
    if (!seen.insert(static_cast<int>(person)).second) {
      return Error{"--pushed names person " + word + " twice"};
    }
    people.push_back(static_cast<int>(person));
  }
  if (people.empty())
    return Error{"--pushed is empty; name the people who are pushed, as in 0,1,3"};
  return people;
}

Result<HipPush> ParsePush(const std::string& word) {
  HipPush push;
  push.duration = FLAGS_push_duration;
  const size_t at = word.find('@');
  const std::string start = at == std::string::npos ? "0" : word.substr(at + 1);
  if (!ParseDouble(word.substr(0, at), &push.impulse) || !ParseDouble(start, &push.start)) {
    return Error{"--push: " + Quoted(word) +
                 " is no push; give N s, or N s@start in s, as in 80@0,80@1.5"};
  }
  if (push.impulse <= 0.0 || push.impulse > 2000.0) {
    return Error{"--push: " + Quoted(word) + " has an impulse that is not within 0 to 2000 N s"};
  }
  if (push.start < 0.0 || push.start > 3600.0) {
    return Error{"--push: " + Quoted(word) + " starts at a time that is not within 0 to 3600 s"};
  }
  return push;
}

Result<std::vector<HipPush>> Pushes() {
  std::vector<HipPush> pushes;
  for (const std::string& word : Split(FLAGS_push, ',')) {
    const Result<HipPush> push = ParsePush(word);
    if (!push.ok()) return push.error();
    pushes.push_back(push.value());
  }
  if (pushes.empty()) return Error{"--push is empty; give an impulse in N s, as in 80"};
  return pushes;
}

MaybeError CheckNumbers() {
  for (MaybeError error :
       {CheckRange("people", FLAGS_people, 1, 10000), CheckRange("fps", FLAGS_fps, 10, 10000),
        CheckRange("spacing", FLAGS_spacing, 0.05, 100),
        CheckRange("push_duration", FLAGS_push_duration, 0.001, 60),
        CheckRange("mass", FLAGS_mass, 1, 400), CheckRange("rod_length", FLAGS_rod_length, 0.2, 2),
        CheckRange("duration", FLAGS_duration, 0, 3600)}) {
    if (error) return error;
  }
  return std::nullopt;
}

std::string Title(const std::vector<HipPush>& pushes) {
  std::ostringstream text;
  text << FLAGS_people << (FLAGS_people == 1 ? " person, " : " people in a ")
       << (FLAGS_people == 1 ? "alone" : FLAGS_formation);
  if (FLAGS_people > 1) text << ", " << FLAGS_spacing << " m apart";
  const char* separator = "; ";
  for (const HipPush& push : pushes) {
    text << separator << push.impulse << " N s at " << push.start << " s";
    separator = ", ";
  }
  text << (FLAGS_pushed.find(',') == std::string::npos ? " on person " : " on people ")
       << FLAGS_pushed;
  return text.str();
}

// Flags of recordings of single people would be taken and do nothing.
MaybeError CheckNoneOfRecordings() {
  for (const char* flag :
       {"out", "recordings_per_person", "frames", "noise", "push_kind", "recording_spread",
        "subject_spread", "seed", "truth_stance", "truth_noise"}) {
    if (!Given(flag)) continue;
    return Error{std::string("--") + flag +
                 " belongs to recordings of single people, not to --formation"};
  }
  return std::nullopt;
}

int NumFrames(const Scene& scene) {
  const double seconds =
      FLAGS_duration > 0.0 ? FLAGS_duration : scene.LastPushEnd() * scene.dt + kWatchSeconds;
  return static_cast<int>(std::lround(seconds * FLAGS_fps)) + 1;
}

MaybeError CheckFrames(int frames, const std::vector<HipPush>& pushes) {
  if (frames < 3) return Error{"--duration is shorter than two frames"};
  for (const HipPush& push : pushes) {
    if (std::lround(push.start * FLAGS_fps) < frames - 1) continue;
    std::ostringstream text;
    text << "--duration ends at " << FLAGS_duration << " s, before the push of " << push.impulse
         << " N s at " << push.start << " s; lengthen it, or leave the push out";
    return Error{text.str()};
  }
  if (static_cast<double>(frames) * FLAGS_people > kMostPersonFrames) {
    return Error{std::to_string(FLAGS_people) + " people over " + std::to_string(frames) +
                 " frames are too many; lower --people, --duration or --fps"};
  }
  return std::nullopt;
}

}  // namespace

bool FormationGiven() { return !FLAGS_formation.empty(); }

const char* GivenFormationFlag() {
  for (const char* flag : {"spacing", "pushed", "push", "push_duration", "mass", "rod_length",
                           "duration", "as_setting"}) {
    if (Given(flag)) return flag;
  }
  return GivenFormationOutput();
}

Result<FormationFlags> FormationFlagsFromCommandLine() {
  if (MaybeError error = CheckNoneOfRecordings()) return *error;
  const Result<FormationShape> shape = Shape();
  if (!shape.ok()) return shape.error();
  if (MaybeError error = CheckNumbers()) return *error;
  const Result<std::vector<int>> pushed = PushedPeople();
  if (!pushed.ok()) return pushed.error();
  const Result<std::vector<HipPush>> pushes = Pushes();
  if (!pushes.ok()) return pushes.error();

  FormationFlags flags;
  flags.title = Title(pushes.value());
  flags.as_setting = FLAGS_as_setting;
  flags.scene = FormationScene(FormationPositions(shape.value(), FLAGS_people, FLAGS_spacing),
                               {FLAGS_mass, FLAGS_rod_length, 0.0}, 1.0 / FLAGS_fps);
  for (const HipPush& push : pushes.value()) {
    for (int person : pushed.value()) AddHipPush(person, push, &flags.scene);
  }
  flags.frames = NumFrames(flags.scene);
  if (MaybeError error = CheckFrames(flags.frames, pushes.value())) return *error;
  return flags;
}

}  // namespace pushid
