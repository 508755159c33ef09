// datasets: tables of numbers as text.
#include "datasets/files/numeric_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr std::size_t kMostColumns = 100000;
constexpr double kEvenness = 0.01;  // of a time step
// Times of so many rows that grow by so much from row to row are in ms: nothing is recorded as
// rarely in s for so long, while knots drawn by hand may lie a second apart.
constexpr double kSurelyMilliseconds = 0.5;
constexpr int kSurelyRecorded = 50;
// Names of time columns as PlainName has them: first those in ms, then those without a unit, then
// those in s.
constexpr const char* kTimes[] = {"timems", "tms", "time",    "t",
                                  "times",  "ts",  "timesec", "seconds"};
constexpr int kInMilliseconds = 2, kInSecondsSurely = 4;

int TimeNameOf(const std::string& name) {
  return static_cast<int>(std::find(std::begin(kTimes), std::end(kTimes), PlainName(name)) -
                          std::begin(kTimes));
}

// Storage files have their times in s by definition.
void TurnTimesToSeconds(TableFormat format, NumericTable* table) {
  const auto found = std::find_if(table->chosen.begin(), table->chosen.end(), [table](int column) {
    return TimeNameOf(table->names[column]) < static_cast<int>(std::size(kTimes));
  });
  if (found == table->chosen.end() || table->num_rows() < 2) return;
  std::vector<double>& time = table->data[found - table->chosen.begin()];
  const double step = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  const bool surely = format == TableFormat::kCsv && step >= kSurelyMilliseconds &&
                      table->num_rows() >= kSurelyRecorded;
  if (TimeNameOf(table->names[*found]) >= (surely ? kInSecondsSurely : kInMilliseconds)) return;
  for (double& t : time) t /= 1000.0;
}

class TableReader {
 public:
  TableReader(const std::string& path, TableFormat format, const Choice& choose)
      : format_(format), choose_(choose), reader_(path) {
    table_.path = path;
  }

  NumericTable Read() {
    std::string_view line;
    if (format_ == TableFormat::kStorage) ReadHead();
    if (!NextRow(&line)) throw Ended("the line of column names");
    ReadNames(line);
    while (NextRow(&line)) ReadRow(line);
    const int rows = table_.num_rows();
    if (rows == 0) throw reader_.ErrorHere("the table has no rows");
    if (announced_rows_ >= 0 && rows != announced_rows_) {
      throw reader_.ErrorHere(
          StrCat("the header declares ", announced_rows_, " rows, the file has ", rows));
    }
    TurnTimesToSeconds(format_, &table_);
    table_.content_hash = reader_.HashHex();
    return std::move(table_);
  }

 private:
  Error Ended(const std::string& where) const {
    return reader_.ErrorHere("the file ends where " + where +
                             " should be: it is empty or truncated");
  }

  bool NextRow(std::string_view* line) {
    return format_ == TableFormat::kCsv ? reader_.NextRow(line) : reader_.NextNonBlank(line);
  }

  void ReadHead() {
    for (std::string_view line; reader_.NextNonBlank(&line);) {
      line = Trimmed(line);
      if (EqualsIgnoringCase(line, "endheader")) return;
      // name=value, or "name value" in old files.
      const std::size_t split = std::min(line.find_first_of("= \t"), line.size());
      const std::string_view key = line.substr(0, split);
      const std::string_view value = Trimmed(line.substr(std::min(split + 1, line.size())));
      const auto is = [key](const char* name) { return EqualsIgnoringCase(key, name); };
      if (is("DataType") && !EqualsIgnoringCase(value, "double")) {
        throw reader_.ErrorHere("DataType is " + Quoted(value) +
                                ": its cells hold several numbers; flatten the table (OpenSim: "
                                "TimeSeriesTableVec3.flatten()) and export it again");
      }
      const bool rows = is("nRows") || is("datarows");
      if (!rows && !is("nColumns") && !is("datacolumns")) continue;
      std::int64_t& number = rows ? announced_rows_ : announced_columns_;
      if (!ParseInteger(value, &number) || number < 0) {
        throw reader_.ErrorHere(std::string(key) + " must be a whole number, not " + Quoted(value));
      }
    }
    throw Ended("endheader");
  }

  void ReadNames(std::string_view line) {
    separator_ = format_ == TableFormat::kCsv ? SeparatorOf(line) : kBlanks;
    std::unordered_set<std::string> seen;
    for (const std::string_view cell : CellsOf(line, separator_)) {
      const std::string name(cell);
      double number = 0.0;
      if (ParseDouble(name, &number)) {
        throw reader_.ErrorHere("a column is called " + Quoted(name) +
                                ": the first line must hold the names of the columns");
      }
      if (!name.empty() && !seen.insert(name).second) {
        throw reader_.ErrorHere("two columns are called " + Quoted(name));
      }
      table_.names.push_back(name);
      if (table_.names.size() > kMostColumns) throw reader_.ErrorHere("there are too many columns");
    }
    // A separator at the end of every line makes a last column without a name.
    trailing_ = table_.names.size() > 1 && table_.names.back().empty();
    if (trailing_) table_.names.pop_back();
    const auto columns = static_cast<std::int64_t>(table_.names.size());
    if (announced_columns_ >= 0 && announced_columns_ != columns) {
      throw reader_.ErrorHere(
          StrCat("the header declares ", announced_columns_, " columns, but there are ", columns));
    }
    table_.chosen.resize(table_.names.size());
    std::iota(table_.chosen.begin(), table_.chosen.end(), 0);
    try {
      if (choose_) table_.chosen = choose_(table_.names);
    } catch (Error& error) {
      if (error.line == 0) error.line = reader_.line_number();
      throw;
    }
    table_.data.resize(table_.chosen.size());
    row_.resize(table_.names.size());
  }

  void ReadRow(std::string_view line) {
    // A row that is cut behind a tab would have an empty cell.
    const bool tabs =
        format_ == TableFormat::kStorage && reader_.ended_in_newline() &&
        std::count(line.begin(), line.end(), '\t') + 1 == static_cast<std::ptrdiff_t>(row_.size());
    SplitCells(line, tabs ? '\t' : separator_, &cells_);
    const std::size_t columns = row_.size();
    if (trailing_ && cells_.size() == columns + 1 && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() < columns) throw WrongLength(cells_.size());
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string_view cell = cells_[i];
      if (cell.empty() || EqualsIgnoringCase(cell, "nan") || EqualsIgnoringCase(cell, "n/a")) {
        row_[i] = std::numeric_limits<double>::quiet_NaN();
      } else if (!ParseDouble(cell, &row_[i])) {
        throw reader_.ErrorHere(table_.names[i] + ": " + NumberProblem(cell) + kMissingCell);
      }
    }
    if (cells_.size() > columns) throw WrongLength(columns + 1);
    for (std::size_t i = 0; i < table_.chosen.size(); ++i) {
      table_.data[i].push_back(row_[table_.chosen[i]]);
    }
    table_.lines.push_back(reader_.line_number());
  }

  // count: no more than one beyond the columns.
  Error WrongLength(std::size_t count) const {
    const std::string columns = std::to_string(row_.size());
    return reader_.ErrorHere(
        "the row has " +
        (count > row_.size() ? "more than the " + columns + " values of the columns"
                             : StrCat(count, " values, not ", columns)) +
        ", separated by " + SeparatorName(separator_) +
        " as in the line of names: the file is truncated or damaged" +
        (separator_ == kBlanks ? "" : ", or a name with a separator in it is not in quotes"));
  }

  const TableFormat format_;
  const Choice& choose_;
  LineReader reader_;
  NumericTable table_;
  char separator_ = ',';
  bool trailing_ = false;
  std::int64_t announced_rows_ = -1, announced_columns_ = -1;
  std::vector<double> row_;
  std::vector<std::string_view> cells_;  // of the row
};

}  // namespace

Result<NumericTable> ReadNumericTable(const std::string& path, TableFormat format,
                                      const Choice& choose) {
  return Caught([&] { return TableReader(path, format, choose).Read(); });
}

std::string PlainName(std::string_view name) {
  std::string plain;
  for (char c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    // A sign before the name and the letters of other alphabets say what the plain name does not.
    const bool other = static_cast<unsigned char>(c) >= 0x80 || (c == '-' && plain.empty());
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || other) plain += c;
  }
  return plain;
}

int FindTimeColumn(const std::vector<std::string>& names, const std::string& wanted) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_time = TimeNameOf(names[i]) < static_cast<int>(std::size(kTimes));
    if (wanted.empty() ? is_time : names[i] == wanted) return static_cast<int>(i);
  }
  return -1;
}

double UpperMedian(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Result<double> EvenTimeStep(const NumericTable& table, int time_column) {
  const auto chosen = std::find(table.chosen.begin(), table.chosen.end(), time_column);
  const int rows = table.num_rows();
  if (rows < 2) return Error{"there are fewer than two times", table.path};
  const std::vector<double>& time = table.data[chosen - table.chosen.begin()];
  const double step = (time[rows - 1] - time[0]) / (rows - 1);
  // The second part is what three decimals leave of a time.
  const double slack = kEvenness * step + std::fmin(1.1e-3, 0.3 * step);
  std::vector<double> steps;
  bool even = true;
  for (int i = 1; i < rows; ++i) {
    const double now = time[i] - time[i - 1];
    if (!std::isfinite(now)) return Error{"a time is missing", table.path, table.lines[i]};
    steps.push_back(now);
    even = even && now > 0.0 && std::fabs(now - step) <= slack;
  }
  if (even) return step;
  // From the mean every row is off where some are missing; the one that is farthest from the median
  // tells where.
  const double usual = UpperMedian(steps);
  const auto at = std::max_element(steps.begin(), steps.end(), [usual](double a, double b) {
    return std::fabs(a - usual) < std::fabs(b - usual);
  });
  const int row = 1 + static_cast<int>(at - steps.begin());
  return Error{*at <= 0.0 ? "the times do not ascend: " + Rounded(time[row], 9) +
                                " s comes after " + Rounded(time[row - 1], 9) + " s"
                          : "the times do not ascend in even steps: " + Rounded(*at) + " s where " +
                                Rounded(usual) + " s is usual; resample the file",
               table.path, table.lines[row]};
}

}  // namespace pushid
