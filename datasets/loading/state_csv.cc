// datasets: annotated states from and to CSV.
#include "datasets/loading/state_csv.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr char kHead[] = "recording,frame,person,symbol";
constexpr std::int64_t kMostFrames = 100000000;

bool IsRow(LineReader* reader, std::string_view* line) {
  while (reader->NextNonBlank(line)) {
    if (line->front() != '#') return true;
  }
  return false;
}

std::string WhoseText(const StateRow& row) {
  return Quoted(row.person) + " of recording " + Quoted(row.recording);
}

Result<StateRow> RowOfCells(const LineReader& reader, std::string_view line) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  if (cells.size() != 4) {
    return reader.ErrorHere("a row has the four cells " + std::string(kHead) + ", not " +
                            std::to_string(cells.size()));
  }
  std::vector<std::string> texts;
  for (const std::string_view cell : cells) texts.emplace_back(Trimmed(cell));
  std::int64_t frame = 0;
  if (!ParseInteger(texts[1], &frame) || frame < 0 || frame > kMostFrames) {
    return reader.ErrorHere("frame is " + Quoted(texts[1]) +
                            "; it must be a whole number from 0 on");
  }
  if (texts[0].empty()) return reader.ErrorHere("the recording is missing; give its id");
  if (texts[3].empty()) return reader.ErrorHere("the symbol is missing; name the state");
  return StateRow{texts[0], texts[2], static_cast<int>(frame), texts[3], reader.line_number()};
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

void AppendChanges(const std::string& recording, const std::string& person,
                   const std::vector<std::string>& symbols, std::string* text) {
  for (size_t t = 0; t < symbols.size(); ++t) {
    if (t > 0 && symbols[t] == symbols[t - 1]) continue;
    *text += recording + "," + std::to_string(t) + "," + person + "," + symbols[t] + "\n";
  }
}

}  // namespace

Result<StateTable> ReadStates(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  StateTable table{path, {}};
  std::string_view line;
  if (!IsRow(&reader, &line)) {
    return reader.error() ? *reader.error() : Error{"the file lists no states", path};
  }
  if (Trimmed(line) != kHead) {
    return reader.ErrorHere("the first line must be " + std::string(kHead) + ", not " +
                            Quoted(line));
  }
  std::set<std::tuple<std::string, std::string, int>> seen;
  while (IsRow(&reader, &line)) {
    Result<StateRow> row = RowOfCells(reader, line);
    if (!row.ok()) return row.error();
    const StateRow& r = row.value();
    if (!seen.emplace(r.recording, r.person, r.frame).second) {
      return reader.ErrorHere("the state of " + WhoseText(r) + " at frame " +
                              std::to_string(r.frame) + " was given before");
    }
    table.rows.push_back(std::move(row.value()));
  }
  if (reader.error()) return *reader.error();
  if (table.rows.empty()) return reader.ErrorHere("the file lists no states");
  return table;
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
      return Error{"frame " + std::to_string(row.frame) + " is behind the end of recording " +
                       Quoted(recording) + ", which has " + std::to_string(frames) + " frames",
                   table.path, row.line};
    }
    by_person[row.person][row.frame] = row.symbol;
  }
  for (const auto& [person, from] : by_person) {
    if (from.begin()->first == 0) continue;
    return Error{"the states of " + WhoseText({recording, person}) + " begin at frame " +
                     std::to_string(from.begin()->first) + "; give that of frame 0",
                 table.path, last_line};
  }
  if (by_person.empty()) return states;
  for (const std::string& subject : subjects) {
    if (by_person.count(subject) == 0) {
      return Error{"there are no states of " + WhoseText({recording, subject}) +
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
      AppendChanges(states.recording, states.subjects[n], states.people[n], &text);
    }
  }
  return WriteFileAtomically(path, text);
}

}  // namespace pushid
