// datasets: states of people as annotators have them, in one CSV file for all
// recordings:
//
//   recording,frame,person,symbol
//   talk_01,0,S01,speak
//   talk_01,0,S02,listen
//   talk_01,95,S01,listen
//
// A symbol holds until the person's next row, so that changes suffice; rows come in any order.
// person: the id of a subject of the manifest. frame: of the recording as it is loaded, from 0.
// Lines that start with # are comments.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

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
