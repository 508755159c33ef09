// datasets: clips of motion capture, the skeleton that their angles move, and annotated states.
#include "datasets/loading/generator_data.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <tuple>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;
constexpr char kSkeletonFile[] = "skeleton.json", kTestFolder[] = "test",
               kTestSubjectFolder[] = "S5";

std::string FindSkeleton(const std::string& folder) {
  const fs::path place = fs::path(folder).lexically_normal();
  std::error_code ignored;
  const fs::path here = place / kSkeletonFile, above = place / ".." / kSkeletonFile;
  if (fs::exists(here, ignored)) return here.string();
  if (fs::exists(place / kTestSubjectFolder, ignored)) return "";  // Human3.6M's
  if (fs::exists(above, ignored)) return above.string();
  throw Error{StrCat("there is no ", kSkeletonFile,
                     " here or one folder higher; give a folder of clips by --folder"),
              folder};
}

constexpr int kTestSubject = 5, kValidationSubject = 11;

// 5 of "S5"; 0 of a folder that is no subject's.
int SubjectOf(const std::string& folder) {
  int64_t number = 0;
  const bool is = folder.size() > 1 && folder[0] == 'S' && ParseInteger(folder.substr(1), &number);
  return is && number > 0 && number < 1000 ? static_cast<int>(number) : 0;
}

// walking_2 before walking_10.
std::pair<std::string, int64_t> OrderOf(const MocapClip& clip) {
  int64_t number = 0;
  ParseInteger(clip.name.substr(clip.name.rfind('_') + 1), &number);
  return {clip.action, number};
}

constexpr int kTranslationNumbers = 3;  // in front of every line's maps

// Appends the numbers of a line.
void ReadLine(const LineReader& reader, std::string_view line, int expected,
              std::vector<double>* numbers) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  const auto fail = [&](std::string_view at, const std::string& problem) {
    Error error = reader.ErrorHere(
        StrCat(problem, "; a line has ", expected,
               " numbers, separated by commas (3 of translation, then 3 a joint)"));
    error.column = static_cast<int>(at.data() - line.data()) + 1;
    throw error;
  };
  const int count = static_cast<int>(cells.size());
  for (int i = 0; i < std::min(count, expected); ++i) {
    double& value = numbers->emplace_back();
    if (ParseDouble(cells[i], &value)) continue;
    fail(cells[i], StrCat("number ", i + 1, ": ", NumberProblem(cells[i])));
  }
  if (count > expected) fail(cells[expected], "the line has more numbers than it should");
  if (count < expected) fail(cells.back(), StrCat("the line ends after ", count, " numbers"));
}

// A clip as the human-motion-prediction literature shares it: a line a frame, a number of
// translation or of an exponential map after the other, separated by commas.
MocapClip ReadClip(const fs::path& folder, const std::string& name, const MocapSkeleton& skeleton) {
  const fs::path path = folder / name;
  LineReader reader(path.string());
  const int maps = 3 * skeleton.tree.num_joints(), expected = kTranslationNumbers + maps;
  std::vector<double> numbers;
  for (std::string_view line; reader.NextNonBlank(&line);) {
    ReadLine(reader, line, expected, &numbers);
  }
  if (numbers.empty()) throw reader.ErrorHere("the file has no frames");
  MocapClip clip;
  clip.action = path.parent_path().filename().string();
  clip.name = path.stem().string();
  clip.content_hash = reader.HashHex();
  clip.is_test = fs::path(name).begin()->string() == kTestFolder;
  clip.subject = SubjectOf(clip.action);
  if (clip.subject > 0) {
    clip.action = clip.name.substr(0, clip.name.rfind('_'));
    clip.is_test = clip.subject == kTestSubject;
  }
  const int frames = static_cast<int>(numbers.size()) / expected;
  const Eigen::Map<const Eigen::MatrixXd> all(numbers.data(), expected, frames);
  clip.motion.resize(skeleton.layout.num_coordinates(), frames);
  for (int t = 0; t < frames; ++t) {
    const Eigen::Matrix3Xd joints = JointPositions(skeleton.tree, all.col(t).tail(maps));
    for (size_t i = 0; i < skeleton.used.size(); ++i) {
      clip.motion.col(t).segment<3>(3 * i) = joints.col(skeleton.used[i]).cast<float>();
    }
  }
  return clip;
}

constexpr int kWindow = kObservedFrames + kForecastFrames;
constexpr int kTestWindows = 8, kTestSeed = 1234567890;
constexpr int kManyWindows = 1000, kWideStride = 8, kNarrowStride = 2;

// Words masked to the smallest 2^b - 1 >= largest, and rejected above it; none is drawn for 0.
int DrawnUpTo(int largest, std::mt19937* random) {
  uint32_t mask = 0;
  while (mask < static_cast<uint32_t>(largest)) mask = 2 * mask + 1;
  if (mask == 0) return 0;
  uint32_t word = 0;
  do {
    word = static_cast<uint32_t>((*random)()) & mask;
  } while (word > static_cast<uint32_t>(largest));
  return static_cast<int>(word);
}

ForecastWindow WindowAt(const MocapClip& clip, const Trajectories& motion, int start) {
  return {clip.action, motion.middleCols(start, kObservedFrames),
          motion.middleCols(start + kObservedFrames, kForecastFrames)};
}

// Human3.6M: the clip's share of the windows that it has with the other one of its action; none
// where there is no such pair.
std::vector<int> PairedStarts(const MocapFolder& mocap, const MocapClip& clip) {
  std::vector<const MocapClip*> pair;
  for (const MocapClip& other : mocap.clips) {
    if (other.is_test && other.action == clip.action) pair.push_back(&other);
  }
  std::vector<int> starts;
  if (pair.size() != 2) return starts;
  const auto frames = [](const MocapClip* of) {
    return static_cast<int>(of->motion.cols() + 1) / 2;
  };
  for (const auto& [first, second] : PairedWindowStarts(frames(pair[0]), frames(pair[1]))) {
    starts.push_back(&clip == pair[0] ? first : second);
  }
  return starts;
}

using Json = nlohmann::ordered_json;
constexpr int kMostJoints = 1000;
constexpr int kUpAxis = 1;  // the literature's clips have y up
constexpr double kMetresPerMillimetre = 1e-3;

// Parents and offsets as the literature's forward kinematics has them. Of 32 joints ten are hips'
// roots, or stand where another does.
constexpr char kHuman36mSkeleton[] = R"({
  "joints": 32,
  "parents": [-1, 0, 1, 2, 3, 4, 0, 6, 7, 8, 9, 0, 11, 12, 13, 14, 12, 16, 17, 18, 19, 20, 19, 22,
    12, 24, 25, 26, 27, 28, 27, 30],
  "offsets_mm": [[0, 0, 0], [-132.948591, 0, 0], [0, -442.894612, 0], [0, -454.206447, 0],
    [0, 0, 162.767078], [0, 0, 74.999437], [132.948826, 0, 0], [0, -442.894413, 0],
    [0, -454.20659, 0], [0, 0, 162.767426], [0, 0, 74.999948], [0, 0.1, 0], [0, 233.383263, 0],
    [0, 257.077681, 0], [0, 121.134938, 0], [0, 115.002227, 0], [0, 257.077681, 0],
    [0, 151.034226, 0], [0, 278.882773, 0], [0, 251.733451, 0], [0, 0, 0], [0, 0, 99.999627],
    [0, 100.000188, 0], [0, 0, 0], [0, 257.077681, 0], [0, 151.031437, 0], [0, 278.892924, 0],
    [0, 251.72868, 0], [0, 0, 0], [0, 0, 99.999888], [0, 137.499922, 0], [0, 0, 0]],
  "used": [2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 21, 22, 25, 26, 27, 29, 30],
  "duplicates": {"16": 13, "20": 19, "23": 22, "24": 13, "28": 27, "31": 30},
  "mirror": "x -> -x; joints 1-5 <-> 6-10, 16-23 <-> 24-31"
})";

// A list of whole numbers from `lowest` to below `joints`.
std::vector<int> Indices(const char* key, int lowest, int joints, JsonFields* fields) {
  if (!fields->Require(key, "a list of joints")) return {};
  const Json& list = fields->List(key);
  const auto other = std::find_if_not(list.begin(), list.end(), [&](const Json& value) {
    return value.is_number_integer() && value.get<int>() >= lowest && value.get<int>() < joints;
  });
  if (other == list.end()) return list.get<std::vector<int>>();
  fields->Fail(key, StrCat("holds ", Shown(*other), "; its numbers are joints, below ", joints));
  return {};
}

Eigen::Matrix3Xd Offsets(int joints, JsonFields* fields) {
  Eigen::Matrix3Xd offsets = Eigen::Matrix3Xd::Zero(3, joints);
  if (!fields->Require("offsets_mm", "three numbers a joint")) return offsets;
  const Json& list = fields->List("offsets_mm");
  bool right = static_cast<int>(list.size()) == joints;
  for (int i = 0; right && i < joints; ++i) {
    const auto xyz = ListOf<double>(list[i]);
    right = xyz && xyz->size() == 3;
    if (right) offsets.col(i) = kMetresPerMillimetre * Eigen::Vector3d(xyz->data());
  }
  if (!right) {
    fields->Fail("offsets_mm", StrCat("must be ", joints, " lists of three numbers"));
  }
  return offsets;
}

// "x -> -x; joints 1-6 <-> 7-12, 20-28 <-> 29-37": the joint on the other side, and the axis.
std::vector<int> MirroredJoints(const std::string& text, int joints, int* axis,
                                JsonFields* fields) {
  std::vector<int> mirrored(joints);
  std::iota(mirrored.begin(), mirrored.end(), 0);
  std::smatch match;
  static const std::regex kAxis("([xyz]) -> -\\1"), kPair("(\\d+)-(\\d+) <-> (\\d+)-(\\d+)");
  if (!std::regex_search(text, match, kAxis)) {
    fields->Fail("mirror", "must read like 'x -> -x; joints 1-6 <-> 7-12'");
    return mirrored;
  }
  *axis = match[1].str()[0] - 'x';
  for (std::sregex_iterator it(text.begin(), text.end(), kPair), end; it != end; ++it) {
    const int first = std::stoi((*it)[1]), last = std::stoi((*it)[2]);
    const int other = std::stoi((*it)[3]), other_last = std::stoi((*it)[4]);
    if (last < first || other_last - other != last - first ||
        std::max(last, other_last) >= joints) {
      fields->Fail("mirror", "pairs joints that do not match: " + it->str());
      return mirrored;
    }
    for (int i = 0; i <= last - first; ++i) {
      mirrored[first + i] = other + i;
      mirrored[other + i] = first + i;
    }
  }
  return mirrored;
}

// duplicates: joint -> the used joint in the same place.
std::vector<int> Duplicates(int joints, JsonFields* fields) {
  std::vector<int> same(joints, -1);
  if (!fields->Has("duplicates")) return same;
  for (const auto& [key, value] : fields->At("duplicates").items()) {
    int64_t joint = -1;
    if (!ParseInteger(key, &joint) || joint < 0 || joint >= joints || !value.is_number_integer() ||
        value.get<int>() < 0 || value.get<int>() >= joints) {
      fields->Fail("duplicates", "must pair joints, not '" + key + "' and " + Shown(value));
      return same;
    }
    same[joint] = value.get<int>();
  }
  return same;
}

void SetLayout(const std::vector<int>& mirrored, const std::vector<int>& same, JsonFields* fields,
               MocapSkeleton* skeleton) {
  const int joints = skeleton->tree.num_joints();
  const Eigen::Matrix3Xd rest = JointPositions(skeleton->tree, Eigen::VectorXd::Zero(3 * joints));
  ParticleLayout& layout = skeleton->layout;
  std::vector<int> particle(joints, -1);
  const int count = static_cast<int>(skeleton->used.size());
  for (int i = 0; i < count; ++i) particle[skeleton->used[i]] = i;
  layout.joints = joints;
  layout.up_axis = kUpAxis;
  layout.weights.assign(count, 1.0f);
  layout.fixed = Eigen::Matrix3Xf::Zero(3, count);
  for (int j = 0; j < joints; ++j) {
    if (same[j] < 0) continue;
    if (particle[same[j]] < 0) return fields->Fail("duplicates", "names a joint that is not used");
    layout.weights[particle[same[j]]] += 1.0f;
  }
  for (int i = 0; i < count; ++i) {
    const int joint = skeleton->used[i], parent = skeleton->tree.parents[joint];
    layout.names.push_back(StrCat("joint", joint));
    layout.mirrored.push_back(particle[mirrored[joint]]);
    if (layout.mirrored.back() < 0) {
      return fields->Fail("mirror", "turns used joints into others that are not used");
    }
    const int end = parent >= 0 && same[parent] >= 0 ? same[parent] : parent;
    const bool moves = end >= 0 && particle[end] >= 0;
    layout.parents.push_back(moves ? particle[end] : kFixedPoint);
    // A joint that is not used never moves: it stands where it does at rest.
    if (!moves && end >= 0) layout.fixed.col(i) = rest.col(end).cast<float>();
  }
}

constexpr int kPairs = 4;
constexpr int kFirstStart = 16, kPrefix = 50, kSuffix = 100;  // frames

}  // namespace

Result<MocapFolder> ReadMocapFolder(const std::string& folder) {
  return Caught([&] {
    MocapFolder mocap;
    mocap.skeleton = OrThrow(ReadMocapSkeleton(FindSkeleton(folder)));
    for (const std::string& name : OrThrow(FilesBelow(folder))) {
      const fs::path path(name);
      if (path.extension() != ".txt" || !path.has_parent_path()) continue;
      mocap.clips.push_back(ReadClip(folder, name, mocap.skeleton));
    }
    if (mocap.clips.empty()) {
      throw Error{
          "there are no clips below this folder; they are text files in a folder per "
          "action (train/walking/walking_1.txt)",
          folder};
    }
    std::stable_sort(mocap.clips.begin(), mocap.clips.end(),
                     [](const auto& a, const auto& b) { return OrderOf(a) < OrderOf(b); });
    return mocap;
  });
}

Trajectories EverySecond(const Trajectories& motion, int phase) {
  Trajectories half(motion.rows(), (motion.cols() - phase + 1) / 2);
  for (Eigen::Index t = 0; t < half.cols(); ++t) half.col(t) = motion.col(2 * t + phase);
  return half;
}

std::vector<int> TestWindowStarts(int frames) {
  const int largest = frames - kObservedFrames - kWindow - 1;
  std::vector<int> starts;
  if (largest < 0) return starts;
  std::mt19937 random(kTestSeed);
  while (starts.size() < kTestWindows) starts.push_back(DrawnUpTo(largest, &random));
  return starts;
}

bool IsValidationClip(const MocapFolder& mocap, const MocapClip& clip) {
  if (clip.is_test) return false;
  if (clip.subject > 0) return clip.subject == kValidationSubject;
  const MocapClip* last = nullptr;
  for (const MocapClip& other : mocap.clips) {
    if (other.action == clip.action && !other.is_test) last = &other;
  }
  return last == &clip;
}

std::vector<ForecastWindow> MakeForecastWindows(const MocapFolder& mocap, ForecastProtocol protocol,
                                                int stride) {
  std::vector<ForecastWindow> windows;
  for (const MocapClip& clip : mocap.clips) {
    const Trajectories motion = EverySecond(clip.motion, 0);
    const int frames = static_cast<int>(motion.cols());
    if (protocol == ForecastProtocol::kTest) {
      if (!clip.is_test) continue;
      const bool paired = clip.subject > 0;
      for (int start : paired ? PairedStarts(mocap, clip) : TestWindowStarts(frames)) {
        windows.push_back(WindowAt(clip, motion, start + kObservedFrames));
      }
      continue;
    }
    if (protocol == ForecastProtocol::kValidation && !IsValidationClip(mocap, clip)) continue;
    const int starts = frames - kWindow + 1;
    const int step = stride > 0 ? stride : starts > kManyWindows ? kWideStride : kNarrowStride;
    for (int start = 0; start < starts; start += step) {
      windows.push_back(WindowAt(clip, motion, start));
    }
  }
  return windows;
}

std::vector<LearntMotion> LearntMotions(const MocapFolder& mocap, bool with_validation,
                                        int phases) {
  std::vector<LearntMotion> motions;
  for (const MocapClip& clip : mocap.clips) {
    if (clip.is_test || (!with_validation && IsValidationClip(mocap, clip))) continue;
    for (int phase = 0; phase < phases; ++phase) {
      motions.push_back({clip.action, EverySecond(clip.motion, phase), phase});
    }
  }
  return motions;
}

Result<MocapSkeleton> ReadMocapSkeleton(const std::string& path) {
  return Caught([&] {
    JsonDocument document{path, kHuman36mSkeleton, {}};
    if (path.empty()) {
      document.content = Json::parse(document.text);
    } else {
      document = OrThrow(ReadJsonDocument(path));
    }
    JsonFields fields(document, document.content, "", "skeleton");
    const int joints = fields.Whole("joints", "a number of joints", 1, kMostJoints);
    MocapSkeleton skeleton;
    std::vector<int>& parents = skeleton.tree.parents;
    parents = Indices("parents", -1, joints, &fields);
    skeleton.tree.offsets = Offsets(joints, &fields);
    skeleton.used = Indices("used", 0, joints, &fields);
    const std::vector<int> same = Duplicates(joints, &fields);
    const std::vector<int> mirrored =
        MirroredJoints(fields.Text("mirror", "which joints a mirror pairs"), joints,
                       &skeleton.layout.mirrored_axis, &fields);
    bool in_order = static_cast<int>(parents.size()) == joints;
    for (int i = 0; in_order && i < joints; ++i) in_order = parents[i] < i;
    if (!in_order) fields.Fail("parents", "must name an earlier joint for each joint, or -1");
    if (!std::is_sorted(skeleton.used.begin(), skeleton.used.end(), std::less_equal<int>()) ||
        skeleton.used.empty()) {
      fields.Fail("used", "must list joints once each, in ascending order");
    }
    if (!fields.failed()) SetLayout(mirrored, same, &fields, &skeleton);
    OrThrow(fields.error());
    return skeleton;
  });
}

std::vector<std::pair<int, int>> PairedWindowStarts(int frames, int frames_of_other) {
  std::vector<std::pair<int, int>> starts;
  const auto range = [](int n) { return n - kPrefix - kSuffix - kFirstStart - 1; };
  if (range(frames) < 0 || range(frames_of_other) < 0) return starts;
  std::mt19937 random(kTestSeed);
  for (int i = 0; i < kPairs; ++i) {
    const int first = kFirstStart + DrawnUpTo(range(frames), &random);
    starts.emplace_back(first, kFirstStart + DrawnUpTo(range(frames_of_other), &random));
  }
  return starts;
}

namespace {

constexpr char kHead[] = "recording,frame,person,symbol";
constexpr std::int64_t kMostFrames = 100000000;

std::string WhoseText(const std::string& person, const std::string& recording) {
  return Quoted(person) + " of recording " + Quoted(recording);
}

StateRow RowOfCells(const LineReader& reader, std::string_view line) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  if (cells.size() != 4) {
    throw reader.ErrorHere(
        StrCat("a row has the four cells ", std::string(kHead), ", not ", cells.size()));
  }
  std::int64_t frame = 0;
  if (!ParseInteger(cells[1], &frame) || frame < 0 || frame > kMostFrames) {
    throw reader.ErrorHere("frame is " + Quoted(cells[1]) +
                           "; it must be a whole number from 0 on");
  }
  if (cells[0].empty()) throw reader.ErrorHere("the recording is missing; give its id");
  if (cells[3].empty()) throw reader.ErrorHere("the symbol is missing; name the state");
  return {std::string(cells[0]), std::string(cells[2]), static_cast<int>(frame),
          std::string(cells[3]), reader.line_number()};
}

// States of all frames from the frames at which symbols begin.
std::vector<std::string> Held(const std::map<int, std::string>& from, int frames) {
  std::vector<std::string> held;
  for (auto row = from.begin(); row != from.end(); ++row) {
    const auto next = std::next(row);
    held.resize(next == from.end() ? frames : next->first, row->second);
  }
  return held;
}

}  // namespace

Result<StateTable> ReadStates(const std::string& path) {
  return Caught([&] {
    LineReader reader(path);
    StateTable table{path, {}};
    std::string_view line;
    if (!reader.NextRow(&line)) throw Error{"the file lists no states", path};
    if (Trimmed(line) != kHead) {
      throw reader.ErrorHere("the first line must be " + std::string(kHead) + ", not " +
                             Quoted(line));
    }
    std::set<std::tuple<std::string, std::string, int>> seen;
    while (reader.NextRow(&line)) {
      const StateRow& r = table.rows.emplace_back(RowOfCells(reader, line));
      if (seen.emplace(r.recording, r.person, r.frame).second) continue;
      throw reader.ErrorHere(StrCat("the state of ", WhoseText(r.person, r.recording), " at frame ",
                                    r.frame, " was given before"));
    }
    if (table.rows.empty()) throw reader.ErrorHere("the file lists no states");
    return table;
  });
}

MaybeError CheckRecordings(const StateTable& table, const std::vector<std::string>& ids) {
  for (const StateRow& row : table.rows) {
    if (std::find(ids.begin(), ids.end(), row.recording) != ids.end()) continue;
    Error error = UnknownNameError(table.path, "recording", ids, row.recording);
    error.line = row.line;
    return error;
  }
  return std::nullopt;
}

Result<RecordedStates> StatesOf(const StateTable& table, const std::string& recording,
                                const std::vector<std::string>& subjects, int frames) {
  RecordedStates states{recording, subjects};
  std::map<std::string, std::map<int, std::string>> by_person;
  int last_line = 0;
  for (const StateRow& row : table.rows) {
    if (row.recording != recording) continue;
    last_line = row.line;
    if (std::find(subjects.begin(), subjects.end(), row.person) == subjects.end()) {
      return Error{"nobody in recording " + Quoted(recording) + " is " + Quoted(row.person) +
                       "; there are " + ListOfNames(subjects),
                   table.path, row.line};
    }
    if (row.frame >= frames) {
      return Error{StrCat("frame ", row.frame, " is behind the end of recording ",
                          Quoted(recording), ", which has ", frames, " frames"),
                   table.path, row.line};
    }
    by_person[row.person][row.frame] = row.symbol;
  }
  for (const auto& [person, from] : by_person) {
    if (from.begin()->first == 0) continue;
    return Error{StrCat("the states of ", WhoseText(person, recording), " begin at frame ",
                        from.begin()->first, "; give that of frame 0"),
                 table.path, last_line};
  }
  if (by_person.empty()) return states;
  for (const std::string& subject : subjects) {
    if (by_person.count(subject) == 0) {
      return Error{"there are no states of " + WhoseText(subject, recording) +
                       "; give them, or leave out those of the others",
                   table.path, last_line};
    }
    states.people.push_back(Held(by_person[subject], frames));
  }
  return states;
}

MaybeError WriteStates(const std::string& path, const std::vector<RecordedStates>& recordings) {
  std::string text = std::string(kHead) + "\n";
  for (const RecordedStates& states : recordings) {
    for (size_t n = 0; n < states.people.size(); ++n) {
      const std::vector<std::string>& symbols = states.people[n];
      for (size_t t = 0; t < symbols.size(); ++t) {
        if (t > 0 && symbols[t] == symbols[t - 1]) continue;
        text += StrCat(states.recording, ",", t, ",", states.subjects[n], ",", symbols[t], "\n");
      }
    }
  }
  return WriteFileAtomically(path, text);
}

}  // namespace pushid
