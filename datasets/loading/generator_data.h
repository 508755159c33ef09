// datasets: data beside recordings of pushes that generators learn from and are judged by: states
// of people as annotators have them, and a folder of motion-capture clips by action, as particles,
// with the windows of the clips that forecasts are made from.
//
//   FOLDER/skeleton.json               joints, parents, offsets_mm, used, duplicates, mirror
//   FOLDER/train/walking/walking_1.txt  clips to learn from; FOLDER/test/... those kept apart
//
// A folder without train and test holds the actions themselves; skeleton.json may stand one
// folder higher. Human3.6M has folders of subjects, FOLDER/S5/walking_1.txt, and needs no
// skeleton.json: 32 joints, 99 numbers a line. S5 is tested, S11 validates. Joints are particles
// where they are `used`; `duplicates` share the place of a used one and count in means over all
// joints, the others never move and only count as right.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/enum_names.h"
#include "models/particles.h"

namespace pushid {

struct MocapSkeleton {
  JointTree tree;
  std::vector<int> used;  // the joint of each particle
  ParticleLayout layout;
};

struct MocapClip {
  std::string action, name;  // "walking", "walking_1"
  Trajectories motion;       // at the file's rate, twice the protocol's
  std::string content_hash;
  bool is_test = false;  // below test/, or subject 5
  int subject = 0;       // 0: none is named
};

struct MocapFolder {
  MocapSkeleton skeleton;
  std::vector<MocapClip> clips;  // by action, then by number
};

// An empty path: that of Human3.6M.
Result<MocapSkeleton> ReadMocapSkeleton(const std::string& path);

// Errors: no skeleton, no clips, a clip that is malformed (file, line, column).
Result<MocapFolder> ReadMocapFolder(const std::string& folder);

// The protocol by which forecasts of motion capture are made and judged: the eight actions
// of CMU's clips.
//
// Every second frame of a clip, 25 a second: 25 frames are observed, the next 25 forecast. The test
// windows are eight per clip, drawn as the literature does; the validation split is our own, the
// last clip of every action, from which no model learns.
inline constexpr int kObservedFrames = 25, kForecastFrames = 25;
inline constexpr double kForecastRate = 25.0;  // Hz
// Output frames, counted from 0, at which errors are given: 80, 160, 320, 400 and 1000 ms.
inline constexpr std::array<int, 5> kHorizonFrames = {1, 3, 7, 9, 24};
inline int HorizonMs(int frame) { return static_cast<int>((frame + 1) * 1000 / kForecastRate); }

enum class ForecastProtocol { kTest, kValidation, kAll };
constexpr EnumNames<ForecastProtocol, 3> Names(ForecastProtocol) {
  return {{{"test", ForecastProtocol::kTest},
           {"validation", ForecastProtocol::kValidation},
           {"all", ForecastProtocol::kAll}}};
}

struct ForecastWindow {
  std::string action;
  Trajectories observed, future;
};

// Every second frame, from `phase` (0 or 1) on.
Trajectories EverySecond(const Trajectories& motion, int phase);

// Starts i of the protocol's eight test windows in a clip of `frames` (after taking every second):
// observed are the frames from i + 25 on. MT19937 of seed 1234567890, words masked to the smallest
// 2^b - 1 >= frames - 76 and rejected above it.
std::vector<int> TestWindowStarts(int frames);

// Human3.6M's: four starts in each of the two clips of an action of the tested subject, drawn in
// turn by one MT19937 of that seed, from 16 to below frames - 150; observed are the frames from
// i + 25 on, as above. None where a clip is too short.
std::vector<std::pair<int, int>> PairedWindowStarts(int frames, int frames_of_other);

// Whether a clip belongs to the validation split: subject 11, or the last of its action.
bool IsValidationClip(const MocapFolder& mocap, const MocapClip& clip);

// test: eight windows of every clip below test/, or of subject 5;
// validation: of the validation clips every start that is a multiple of `stride`; all: the same of
// every clip. stride 0: 8 in clips of more than a thousand windows, otherwise 2.
std::vector<ForecastWindow> MakeForecastWindows(const MocapFolder& mocap, ForecastProtocol protocol,
                                                int stride = 0);

// All clips to learn from, as motions at the protocol's rate. phases: 2, or 1 for the lines of the
// protocol alone.
struct LearntMotion {
  std::string action;
  Trajectories motion;
  int phase = 0;  // 1: the lines that the protocol leaves out
};
std::vector<LearntMotion> LearntMotions(const MocapFolder& mocap, bool with_validation,
                                        int phases = 2);

// States of people as annotators have them, in one CSV file for all recordings:
//
//   recording,frame,person,symbol
//   talk_01,0,S01,speak
//   talk_01,0,S02,listen
//   talk_01,95,S01,listen
//
// A symbol holds until the person's next row, so that changes suffice; rows come in any order.
// person: the id of a subject of the manifest. frame: of the recording as it is loaded, from 0.
// Lines that start with # are comments.
struct StateRow {
  std::string recording, person;
  int frame = 0;
  std::string symbol = {};
  int line = 0;
};

struct StateTable {
  std::string path;
  std::vector<StateRow> rows;
};

// Errors name the line: other columns, a frame that is no whole number from 0 on, no recording or
// symbol, a frame of a person twice.
Result<StateTable> ReadStates(const std::string& path);

// Error: a row of a recording that is not among the ids.
MaybeError CheckRecordings(const StateTable& table, const std::vector<std::string>& ids);

// Frame by frame.
struct RecordedStates {
  std::string recording;
  std::vector<std::string> subjects;
  std::vector<std::vector<std::string>> people = {};  // [person][frame]; empty: none are known
};

// The states of a recording of so many frames. Errors: a row of nobody in it, or behind its end;
// people some of whom have no states; states that do not begin at frame 0.
Result<RecordedStates> StatesOf(const StateTable& table, const std::string& recording,
                                const std::vector<std::string>& subjects, int frames);

// Frame 0 and changes. Error: the file cannot be written.
MaybeError WriteStates(const std::string& path, const std::vector<RecordedStates>& recordings);

}  // namespace pushid
