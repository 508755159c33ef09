// datasets: clips found and read, and their windows.
#include "datasets/loading/mocap_folder.h"

#include <algorithm>
#include <filesystem>
#include <random>
#include <vector>

#include "datasets/files/input_file.h"
#include "datasets/files/name_pattern.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;
constexpr char kSkeletonFile[] = "skeleton.json", kTestFolder[] = "test",
               kTestSubjectFolder[] = "S5";

Result<std::string> FindSkeleton(const std::string& folder) {
  const fs::path place = fs::path(folder).lexically_normal();
  std::error_code ignored;
  const fs::path here = place / kSkeletonFile, above = place / ".." / kSkeletonFile;
  if (fs::exists(here, ignored)) return here.string();
  if (fs::exists(place / kTestSubjectFolder, ignored)) return std::string();  // Human3.6M's
  if (fs::exists(above, ignored)) return above.string();
  return Error{std::string("there is no ") + kSkeletonFile +
                   " here or one folder higher; give a folder of clips by --folder",
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

struct ExponentialMapMotion {
  Eigen::MatrixXd maps;  // 3 numbers a joint; a column a frame
  std::string content_hash;
};

// Appends the numbers of a line.
MaybeError ReadLine(const LineReader& reader, std::string_view line, int expected,
                    std::vector<double>* numbers) {
  const auto complain = [&](const char* at, const std::string& problem) {
    Error error = reader.ErrorHere(problem);
    error.column = static_cast<int>(at - line.data()) + 1;
    return error;
  };
  const std::string needed = "; a line has " + std::to_string(expected) +
                             " numbers, separated by commas (3 of translation, then 3 a joint)";
  std::string_view rest = line;
  for (int i = 0; i < expected; ++i) {
    const size_t comma = rest.find(',');
    const std::string_view cell = Trimmed(rest.substr(0, comma));
    double value = 0.0;
    if (!ParseDouble(cell, &value)) {
      return complain(rest.data(),
                      "number " + std::to_string(i + 1) + ": " + NumberProblem(cell) + needed);
    }
    numbers->push_back(value);
    const bool more = comma != std::string_view::npos;
    if (more != (i + 1 < expected)) {
      return complain(rest.data(),
                      more ? "the line has more numbers than it should" + needed
                           : "the line ends after " + std::to_string(i + 1) + " numbers" + needed);
    }
    if (more) rest.remove_prefix(comma + 1);
  }
  return std::nullopt;
}

// Motion capture as the human-motion-prediction literature shares it: a line a frame, a number of
// translation or of an exponential map after the other, separated by commas.
Result<ExponentialMapMotion> ReadExponentialMapText(const std::string& path, int joints) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  const int expected = kTranslationNumbers + 3 * joints;
  std::vector<double> numbers;
  std::string_view line;
  while (reader.NextNonBlank(&line)) {
    if (MaybeError error = ReadLine(reader, line, expected, &numbers)) return *std::move(error);
  }
  if (reader.error()) return *reader.error();
  if (numbers.empty()) return reader.ErrorHere("the file has no frames");
  const int frames = static_cast<int>(numbers.size()) / expected;
  const Eigen::Map<const Eigen::MatrixXd> all(numbers.data(), expected, frames);
  return ExponentialMapMotion{all.bottomRows(3 * joints), reader.HashHex()};
}

Result<MocapClip> ReadClip(const fs::path& folder, const std::string& name,
                           const MocapSkeleton& skeleton) {
  const fs::path path = folder / name;
  const Result<ExponentialMapMotion> read =
      ReadExponentialMapText(path.string(), skeleton.tree.num_joints());
  if (!read.ok()) return read.error();
  const Eigen::MatrixXd& maps = read.value().maps;
  MocapClip clip;
  clip.action = path.parent_path().filename().string();
  clip.name = path.stem().string();
  clip.content_hash = read.value().content_hash;
  clip.is_test = fs::path(name).begin()->string() == kTestFolder;
  clip.subject = SubjectOf(clip.action);
  if (clip.subject > 0) {
    clip.action = clip.name.substr(0, clip.name.rfind('_'));
    clip.is_test = clip.subject == kTestSubject;
  }
  clip.motion.resize(skeleton.layout.num_coordinates(), maps.cols());
  for (Eigen::Index t = 0; t < maps.cols(); ++t) {
    const Eigen::Matrix3Xd joints = JointPositions(skeleton.tree, maps.col(t));
    for (size_t i = 0; i < skeleton.used.size(); ++i) {
      clip.motion.col(t).segment<3>(3 * i) = joints.col(skeleton.used[i]).cast<float>();
    }
  }
  return clip;
}

}  // namespace

Result<MocapFolder> ReadMocapFolder(const std::string& folder) {
  const Result<std::string> skeleton_file = FindSkeleton(folder);
  if (!skeleton_file.ok()) return skeleton_file.error();
  Result<MocapSkeleton> skeleton = ReadMocapSkeleton(skeleton_file.value());
  if (!skeleton.ok()) return skeleton.error();
  MocapFolder mocap;
  mocap.skeleton = std::move(skeleton.value());
  const Result<std::vector<std::string>> files = FilesBelow(folder);
  if (!files.ok()) return files.error();
  for (const std::string& name : files.value()) {
    const fs::path path(name);
    if (path.extension() != ".txt" || !path.has_parent_path()) continue;
    Result<MocapClip> clip = ReadClip(folder, name, mocap.skeleton);
    if (!clip.ok()) return clip.error();
    mocap.clips.push_back(std::move(clip.value()));
  }
  if (mocap.clips.empty()) {
    return Error{
        "there are no clips below this folder; they are text files in a folder per "
        "action (train/walking/walking_1.txt)",
        folder};
  }
  std::stable_sort(mocap.clips.begin(), mocap.clips.end(),
                   [](const auto& a, const auto& b) { return OrderOf(a) < OrderOf(b); });
  return mocap;
}

namespace {

constexpr int kWindow = kObservedFrames + kForecastFrames;
constexpr int kTestWindows = 8, kTestSeed = 1234567890;
constexpr int kManyWindows = 1000, kWideStride = 8, kNarrowStride = 2;

ForecastWindow WindowAt(const MocapClip& clip, const Trajectories& motion, int start) {
  return {clip.action, motion.middleCols(start, kObservedFrames),
          motion.middleCols(start + kObservedFrames, kForecastFrames)};
}

}  // namespace

Trajectories EverySecond(const Trajectories& motion, int phase) {
  Trajectories half(motion.rows(), (motion.cols() - phase + 1) / 2);
  for (Eigen::Index t = 0; t < half.cols(); ++t) half.col(t) = motion.col(2 * t + phase);
  return half;
}

std::vector<int> TestWindowStarts(int frames) {
  const int largest = frames - kObservedFrames - kWindow - 1;
  std::vector<int> starts;
  if (largest < 0) return starts;
  uint32_t mask = 0;
  while (mask < static_cast<uint32_t>(largest)) mask = 2 * mask + 1;
  std::mt19937 random(kTestSeed);
  while (starts.size() < kTestWindows) {
    const uint32_t word = static_cast<uint32_t>(random()) & mask;
    if (word <= static_cast<uint32_t>(largest)) starts.push_back(static_cast<int>(word));
  }
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

namespace {

// Of Human3.6M: the clip's share of the windows that it has with the other one of its action; none
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

}  // namespace

std::vector<ForecastWindow> MakeForecastWindows(const MocapFolder& mocap, ForecastProtocol protocol,
                                                int stride) {
  const bool has_test = std::any_of(mocap.clips.begin(), mocap.clips.end(),
                                    [](const MocapClip& clip) { return clip.is_test; });
  std::vector<ForecastWindow> windows;
  for (const MocapClip& clip : mocap.clips) {
    const Trajectories motion = EverySecond(clip.motion, 0);
    const int frames = static_cast<int>(motion.cols());
    if (protocol == ForecastProtocol::kTest) {
      if (clip.is_test != has_test) continue;
      const bool paired = clip.is_test && clip.subject > 0;
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

std::vector<LearntMotion> LearntMotions(const MocapFolder& mocap, bool with_validation) {
  std::vector<LearntMotion> motions;
  for (const MocapClip& clip : mocap.clips) {
    if (clip.is_test || (!with_validation && IsValidationClip(mocap, clip))) continue;
    for (int phase : {0, 1}) {
      motions.push_back({clip.action, EverySecond(clip.motion, phase), phase});
    }
  }
  return motions;
}

}  // namespace pushid
