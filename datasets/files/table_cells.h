// datasets: a row of a text table taken apart, and what separates its cells.
#pragma once

#include <string_view>

namespace pushid {

inline constexpr char kBlanks = '\0';  // as a separator: runs of blanks

// The separator that stands most often in the line of names. Names may hold the others, which do
// not count in quotes and brackets ("force (N, up)"), nor do tabs that only align what follows
// another separator. Of equal counts, that of the one that names hold least often.
char SeparatorOf(std::string_view names);

// Plural, for messages.
const char* SeparatorName(char separator);

// Takes cells off a row one after the other. A separator in quotes belongs to its cell.
class TableCells {
 public:
  TableCells(std::string_view row, char separator);
  bool Next(std::string_view* cell);

 private:
  std::string_view rest_;
  char separator_;
  bool more_;
};

}  // namespace pushid
