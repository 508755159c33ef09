// datasets: a row of a text table taken apart.
#include "datasets/files/table_cells.h"

#include <algorithm>
#include <iterator>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Where the end of the first cell may be looked for: behind its quotes, if it has any.
std::size_t BehindQuotes(std::string_view row) {
  const std::size_t opens = row.find_first_not_of(' ');
  if (opens == std::string_view::npos || row[opens] != '"') return 0;
  const std::size_t closes = row.find('"', opens + 1);
  return closes == std::string_view::npos ? 0 : closes + 1;
}

}  // namespace

char SeparatorOf(std::string_view names) {
  constexpr std::string_view kSeparators = "\t;,", kOpening = "\"([", kClosing = "\")]";
  constexpr std::size_t kNone = std::string_view::npos;
  int counts[kSeparators.size()] = {};
  bool closes[kOpening.size()] = {true, true, true};  // somewhere behind; looked for only once
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t opens = kOpening.find(names[i]);
    if (opens != kNone && closes[opens]) {
      const std::size_t end = names.find(kClosing[opens], i + 1);
      closes[opens] = end != kNone;
      if (end != kNone) i = end;
      continue;
    }
    const bool aligns = names[i] == '\t' && i > 0 && (names[i - 1] == ',' || names[i - 1] == ';');
    const std::size_t separator = kSeparators.find(names[i]);
    if (separator != kNone && !aligns) ++counts[separator];
  }
  return kSeparators[std::max_element(std::begin(counts), std::end(counts)) - counts];
}

const char* SeparatorName(char separator) {
  switch (separator) {
    case '\t':
      return "tabs";
    case ';':
      return "semicolons";
    case ',':
      return "commas";
    default:
      return "blanks";
  }
}

TableCells::TableCells(std::string_view row, char separator) : rest_(row), separator_(separator) {
  if (separator_ == kBlanks) rest_ = Trimmed(rest_);
  more_ = separator_ != kBlanks || !rest_.empty();
}

bool TableCells::Next(std::string_view* cell) {
  if (!more_) return false;
  if (separator_ == kBlanks) {
    *cell = NextToken(&rest_);
    rest_ = Trimmed(rest_);
    more_ = !rest_.empty();
    return true;
  }
  const std::size_t end = rest_.find(separator_, BehindQuotes(rest_));
  more_ = end != std::string_view::npos;
  *cell = Trimmed(rest_.substr(0, end));
  rest_.remove_prefix(more_ ? end + 1 : rest_.size());
  return true;
}

}  // namespace pushid
