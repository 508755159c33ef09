// datasets: lines of exponential maps.
#include "datasets/formats/exponential_map_text.h"

#include <vector>

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

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

}  // namespace

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

}  // namespace pushid
