// datasets: a push as a CSV file.
#include "datasets/formats/push_csv.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr char kHeader[] = "frame,fx,fy,ftheta,fphi";
constexpr const char* kPushColumns[] = {"frame", "fx", "fy", "ftheta", "fphi"};
constexpr std::size_t kNumColumns = 5;

bool IsHeader(std::string_view line) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  return std::equal(cells.begin(), cells.end(), std::begin(kPushColumns), std::end(kPushColumns));
}

MaybeError ParseRow(const LineReader& reader, std::string_view line, std::int64_t expected_frame,
                    Eigen::Vector4d* force) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  for (std::size_t i = 0; i < kNumColumns; ++i) {
    if (i == cells.size()) {
      return reader.ErrorHere("the row has " + std::to_string(i) + " values, not " +
                              std::to_string(kNumColumns) + " (" + kHeader + ")");
    }
    const std::string_view field = cells[i];
    if (i > 0) {
      if (!ParseDouble(field, &(*force)[i - 1])) {
        return reader.ErrorHere(std::string(kPushColumns[i]) + ": " + NumberProblem(field));
      }
      continue;
    }
    std::int64_t frame = 0;
    if (!ParseInteger(field, &frame)) {
      return reader.ErrorHere("frame: " + Quoted(field) + " is not a whole number");
    }
    if (frame != expected_frame) {
      return reader.ErrorHere("frame is " + std::to_string(frame) + " where " +
                              std::to_string(expected_frame) +
                              " was expected; rows must count 0, 1, 2, ... without gaps (a late "
                              "push is given by start_frame in the manifest)");
    }
  }
  if (cells.size() > kNumColumns) {
    return reader.ErrorHere("the row has more than " + std::to_string(kNumColumns) + " values (" +
                            kHeader + ")");
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<Eigen::Vector4d>> ReadPushCsv(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  std::string_view line;
  if (!reader.NextNonBlank(&line)) {
    if (reader.error()) return *reader.error();
    return Error{std::string("the file is empty; a push starts with the line ") + kHeader, path, 0};
  }
  if (!IsHeader(line)) {
    return reader.ErrorHere("the header is " + Quoted(line) + ", not " + kHeader);
  }
  std::vector<Eigen::Vector4d> force;
  while (reader.NextNonBlank(&line)) {
    Eigen::Vector4d row;
    if (MaybeError failed = ParseRow(reader, line, static_cast<std::int64_t>(force.size()), &row)) {
      return *std::move(failed);
    }
    force.push_back(row);
  }
  if (reader.error()) return *reader.error();
  if (force.empty()) {
    return reader.ErrorHere(
        "the push has no rows; leave push_csv out of the manifest for a recording without a push");
  }
  return force;
}

MaybeError WritePushCsv(const std::string& path, const std::vector<Eigen::Vector4d>& force) {
  if (force.empty()) return Error{"a push without rows is not written", path, 0};
  std::string text = std::string(kHeader) + "\n";
  for (std::size_t frame = 0; frame < force.size(); ++frame) {
    if (!force[frame].allFinite()) {
      return Error{"row " + std::to_string(frame) + " of the push to write is not finite", path, 0};
    }
    text += std::to_string(frame);
    for (int i = 0; i < 4; ++i) {
      text += ',';
      AppendDouble(force[frame][i], &text);
    }
    text += '\n';
  }
  return WriteFileAtomically(path, text);
}

}  // namespace pushid
