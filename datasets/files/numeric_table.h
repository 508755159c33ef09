// datasets: tables of numbers as text: CSV, and OpenSim's storage files (.sto, .mot).
//
//   CSV: one line of column names, then rows; separated by commas, semicolons or tabs, whichever
//   the line of names holds most of. Names with a separator in them stand in quotes. Lines that
//   start with # are comments.
//   Storage: a head with `name=value` lines and `endheader`, then a line of column names and rows,
//   separated by blanks, or by tabs, between which cells may be empty.
//
// Cells that are empty, NaN, nan or n/a are missing and come out as NaN. Times in ms come out in s:
// those of a column called so (time_ms), and of a CSV column called time or t that grows by 0.5 or
// more a row for 50 rows, as nothing is recorded so rarely.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// Follows NumberProblem where cells may be missing.
inline constexpr const char* kMissingCell = "; a value that is missing is an empty cell or nan";

enum class TableFormat { kCsv, kStorage };

struct NumericTable {
  std::string path;
  std::vector<std::string> names;         // of every column
  std::vector<int> chosen;                // the columns read: indices into names
  std::vector<std::vector<double>> data;  // [chosen][row]
  std::vector<int> lines;                 // of each row, for messages
  std::string content_hash;

  int num_rows() const { return data.empty() ? 0 : static_cast<int>(data[0].size()); }
};

// The indices of what is to be kept, chosen from the names of all columns, points or joints; throws
// an Error where it is not there. Unset: all of them.
using Choice = std::function<std::vector<int>(const std::vector<std::string>& names)>;

// Errors name the line: no names, a name twice, rows of another length, text that is no number, a
// storage file with other than the announced rows or columns.
Result<NumericTable> ReadNumericTable(const std::string& path, TableFormat format,
                                      const Choice& choose = {});

// The letters and digits of a name in lower case: "Force (N)" is "forcen". A minus before it and
// letters of other alphabets are kept, so that "-Fx" and "Time (µs)" are no other names.
std::string PlainName(std::string_view name);

// The column that holds the time: `wanted` when given, otherwise time, t, time_s, "Time (ms)", ...;
// -1: none.
int FindTimeColumn(const std::vector<std::string>& names, const std::string& wanted);

// The value in the middle; of an even number of them, the upper one. values: at least one.
double UpperMedian(std::vector<double> values);

// Steps of a time column, which was chosen, in s, or an Error where it does not ascend in even
// steps (1 %).
Result<double> EvenTimeStep(const NumericTable& table, int time_column);

}  // namespace pushid
