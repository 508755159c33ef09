// datasets: numbers and cells of text.
#include "datasets/files/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

namespace pushid {
namespace {

constexpr double kLargestPlain = 1e6;

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// std::from_chars takes a minus but no plus.
std::string_view WithoutPlus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') {
    token.remove_prefix(1);
  }
  return token;
}

// The place from which the end of the first cell may be looked for: behind its quotes, if it has
// any.
std::size_t BehindQuotes(std::string_view row) {
  const std::size_t opens = row.find_first_not_of(' ');
  if (opens == std::string_view::npos || row[opens] != '"') return 0;
  const std::size_t closes = row.find('"', opens + 1);
  return closes == std::string_view::npos ? 0 : closes + 1;
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view NextToken(std::string_view* text) {
  std::size_t begin = 0;
  while (begin < text->size() && IsBlank((*text)[begin])) ++begin;
  std::size_t end = begin;
  while (end < text->size() && !IsBlank((*text)[end])) ++end;
  const std::string_view token = text->substr(begin, end - begin);
  text->remove_prefix(end);
  return token;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (Lower(a[i]) != Lower(b[i])) return false;
  }
  return true;
}

bool ParseDouble(std::string_view token, double* value) {
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, *value);
  return error == std::errc() && parsed_to == end && std::isfinite(*value);
}

bool ParseInteger(std::string_view token, std::int64_t* value) {
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, *value);
  return error == std::errc() && parsed_to == end;
}

std::string NumberProblem(std::string_view token) {
  const std::string quoted = Quoted(token);
  if (token.empty()) return "a number is missing";
  double value = 0.0;
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, value);
  if (parsed_to == end && error == std::errc::result_out_of_range) {
    return quoted + " does not fit in a double";
  }
  if (parsed_to == end && error == std::errc() && !std::isfinite(value)) {
    return quoted + " is not a finite number";
  }
  if (token.find(',') != std::string_view::npos) {
    return quoted + " is not a number (decimals take a point, not a comma)";
  }
  return quoted + " is not a number";
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted = "'";
  for (char c : text.substr(0, kLongest)) quoted += (c >= 0 && c < ' ') || c == 127 ? '?' : c;
  if (text.size() > kLongest) quoted += "...";
  return quoted + "'";
}

std::string ShellQuoted(const std::string& value) {
  constexpr char kPlain[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%[]";
  if (!value.empty() && value.find_first_not_of(kPlain) == std::string::npos) return value;
  std::string quoted = "'";
  for (const char c : value) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void AppendDouble(double value, std::string* out) {
  char buffer[32];
  if (value == 0.0) value = 0.0;  // no -0: it reads back equal and looks like a mistake
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), value);
  out->append(buffer, end);
}

std::string DoubleText(double value) {
  std::string text;
  AppendDouble(value, &text);
  return text;
}

std::string Rounded(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.*g", digits, value);
  // "1.05e+03" is hard to read: 1050.
  const bool exponent = std::strchr(buffer, 'e') != nullptr;
  if (exponent && std::fabs(value) >= 1.0 && std::fabs(value) < kLargestPlain) {
    std::snprintf(buffer, sizeof(buffer), "%.0f", std::strtod(buffer, nullptr));
  }
  return buffer;
}

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
  return separator == '\t'  ? "tabs"
         : separator == ';' ? "semicolons"
         : separator == ',' ? "commas"
                            : "blanks";
}

void SplitCells(std::string_view row, char separator, std::vector<std::string_view>* cells) {
  cells->clear();
  if (separator == kBlanks) {
    for (auto cell = NextToken(&row); !cell.empty(); cell = NextToken(&row)) cells->push_back(cell);
    return;
  }
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = row.find(separator, BehindQuotes(row));
    std::string_view cell = Trimmed(row.substr(0, end));
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') {
      cell = Trimmed(cell.substr(1, cell.size() - 2));
    }
    cells->push_back(cell);
    if (end != std::string_view::npos) row.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> CellsOf(std::string_view row, char separator) {
  std::vector<std::string_view> cells;
  SplitCells(row, separator, &cells);
  return cells;
}

}  // namespace pushid
