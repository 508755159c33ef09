// datasets: numbers from and to text, independent of the locale; rows of text tables in
// cells.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// Spaces, tabs and a carriage return; newlines never reach the callers.
inline bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view Trimmed(std::string_view text);

// Takes the next run of non-blank characters off the front of `text`; empty when there is none.
std::string_view NextToken(std::string_view* text);

// "A" and "a" are the same (ASCII).
bool EqualsIgnoringCase(std::string_view a, std::string_view b);

// A finite decimal number that fills `token` entirely; a leading + is allowed. On failure the
// reason follows from NumberProblem.
bool ParseDouble(std::string_view token, double* value);
bool ParseInteger(std::string_view token, std::int64_t* value);

// Why `token` is no number: "'abc' is not a number", "'nan' is not a finite number", ...
std::string NumberProblem(std::string_view token);

// `text` in single quotes, shortened and with unprintable bytes replaced, fit for a message.
std::string Quoted(std::string_view text);

// A value as a shell takes it, in a command that is printed: quoted where it needs that.
std::string ShellQuoted(const std::string& value);

// Texts, characters and whole numbers one after the other.
template <typename... Parts>
std::string StrCat(const Parts&... parts) {
  std::string text;
  const auto append = [&text](const auto& part) {
    using Part = std::decay_t<decltype(part)>;
    static_assert(!std::is_floating_point_v<Part> && !std::is_enum_v<Part>);
    if constexpr (std::is_integral_v<Part> && !std::is_same_v<Part, char>) {
      text += std::to_string(part);
    } else {
      text += part;
    }
  };
  (append(parts), ...);
  return text;
}

// Appends the shortest text that reads back to the same double; never -0 or a locale's comma.
void AppendDouble(double value, std::string* out);
std::string DoubleText(double value);

// "%.<digits>g" for messages, without an exponent from 1 to a million: 1050, not 1.05e+03.
std::string Rounded(double value, int digits = 6);

// A row of a text table taken apart, and what separates its cells.

inline constexpr char kBlanks = '\0';  // as a separator: runs of blanks

// The separator that stands most often in the line of names. Names may hold the others, which do
// not count in quotes and brackets ("force (N, up)"), nor do tabs that only align what follows
// another separator. Of equal counts, that of the one that names hold least often.
char SeparatorOf(std::string_view names);

// The separator's name for messages, in the plural.
const char* SeparatorName(char separator);

// The cells of a row. A separator in quotes belongs to its cell.
std::vector<std::string_view> CellsOf(std::string_view row, char separator);
void SplitCells(std::string_view row, char separator, std::vector<std::string_view>* cells);

}  // namespace pushid
