// datasets: tables of numbers as text.
#include "datasets/files/numeric_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_set>

#include "datasets/files/atomic_file.h"
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

bool IsMissing(std::string_view cell) {
  return cell.empty() || EqualsIgnoringCase(cell, "nan") || EqualsIgnoringCase(cell, "n/a");
}

class TableReader {
 public:
  TableReader(const std::string& path, TableFormat format, const TableReadOptions& options)
      : format_(format), options_(options) {
    table_.path = path;
  }

  Result<NumericTable> Read() {
    if (MaybeError failed = reader_.Open(table_.path)) return *std::move(failed);
    std::string_view line;
    if (format_ == TableFormat::kStorage) {
      if (MaybeError failed = ReadHead()) return *std::move(failed);
    }
    if (!NextRow(&line)) return Ended("the line of column names");
    if (MaybeError failed = ReadNames(line)) return *std::move(failed);
    while (NextRow(&line)) {
      if (MaybeError failed = ReadRow(line)) return *std::move(failed);
    }
    if (reader_.error()) return *reader_.error();
    const int rows = table_.num_rows();
    if (rows == 0) return reader_.ErrorHere("the table has no rows");
    if (announced_rows_ >= 0 && rows != announced_rows_) {
      return reader_.ErrorHere("the header declares " + std::to_string(announced_rows_) +
                               " rows, the file has " + std::to_string(rows));
    }
    TurnTimesToSeconds(format_, &table_);
    table_.content_hash = reader_.HashHex();
    return std::move(table_);
  }

 private:
  Error Ended(const char* where) const {
    if (reader_.error()) return *reader_.error();
    return reader_.ErrorHere(std::string("the file ends where ") + where +
                             " should be: it is empty or truncated");
  }

  bool NextRow(std::string_view* line) {
    while (reader_.NextNonBlank(line)) {
      if (format_ != TableFormat::kCsv || Trimmed(*line).front() != '#') return true;
    }
    return false;
  }

  MaybeError ReadHead() {
    std::string_view line;
    while (reader_.NextNonBlank(&line)) {
      line = Trimmed(line);
      if (EqualsIgnoringCase(line, "endheader")) return std::nullopt;
      // name=value, or "name value" in old files.
      const std::size_t split = line.find_first_of("= \t");
      const std::string_view key = line.substr(0, split);
      const std::string_view value =
          split == std::string_view::npos ? "" : Trimmed(line.substr(split + 1));
      if (EqualsIgnoringCase(key, "inDegrees"))
        table_.in_degrees = EqualsIgnoringCase(value, "yes");
      if (EqualsIgnoringCase(key, "DataType") && !EqualsIgnoringCase(value, "double")) {
        return reader_.ErrorHere("DataType is " + Quoted(value) +
                                 ": its cells hold several numbers; flatten the table (OpenSim: "
                                 "TimeSeriesTableVec3.flatten()) and export it again");
      }
      const bool rows = EqualsIgnoringCase(key, "nRows") || EqualsIgnoringCase(key, "datarows");
      const bool columns =
          EqualsIgnoringCase(key, "nColumns") || EqualsIgnoringCase(key, "datacolumns");
      if (!rows && !columns) continue;
      std::int64_t number = 0;
      if (!ParseInteger(value, &number) || number < 0) {
        return reader_.ErrorHere(std::string(key) + " must be a whole number, not " +
                                 Quoted(value));
      }
      (rows ? announced_rows_ : announced_columns_) = number;
    }
    return Ended("endheader");
  }

  MaybeError ReadNames(std::string_view line) {
    separator_ = format_ == TableFormat::kCsv ? SeparatorOf(line) : kBlanks;
    TableCells cells(line, separator_);
    std::unordered_set<std::string> seen;
    for (std::string_view cell; cells.Next(&cell);) {
      const std::string name(cell);
      double number = 0.0;
      if (ParseDouble(name, &number)) {
        return reader_.ErrorHere("a column is called " + Quoted(name) +
                                 ": the first line must hold the names of the columns");
      }
      if (!name.empty() && !seen.insert(name).second) {
        return reader_.ErrorHere("two columns are called " + Quoted(name));
      }
      table_.names.push_back(name);
      if (table_.names.size() > kMostColumns)
        return reader_.ErrorHere("there are too many columns");
    }
    // A separator at the end of every line makes a last column without a name.
    if (table_.names.size() > 1 && table_.names.back().empty()) {
      table_.names.pop_back();
      trailing_ = true;
    }
    if (announced_columns_ >= 0 &&
        announced_columns_ != static_cast<std::int64_t>(table_.names.size())) {
      return reader_.ErrorHere("the header declares " + std::to_string(announced_columns_) +
                               " columns, but there are " + std::to_string(table_.names.size()));
    }
    MaybeError wrong = Choose();
    if (wrong && wrong->line == 0) wrong->line = reader_.line_number();
    return wrong;
  }

  MaybeError Choose() {
    if (options_.choose) {
      Result<std::vector<int>> chosen = options_.choose(table_.names);
      if (!chosen.ok()) return chosen.error();
      table_.chosen = std::move(chosen.value());
    } else {
      for (std::size_t i = 0; i < table_.names.size(); ++i) {
        table_.chosen.push_back(static_cast<int>(i));
      }
    }
    table_.data.resize(table_.chosen.size());
    row_.resize(table_.names.size());
    return std::nullopt;
  }

  MaybeError ReadRow(std::string_view line) {
    // A row that is cut behind a tab would have an empty cell.
    const bool tabs =
        format_ == TableFormat::kStorage && reader_.ended_in_newline() &&
        std::count(line.begin(), line.end(), '\t') + 1 == static_cast<std::ptrdiff_t>(row_.size());
    TableCells cells(line, tabs ? '\t' : separator_);
    std::size_t count = 0;
    for (std::string_view cell; cells.Next(&cell); ++count) {
      if (count == row_.size()) {
        if (trailing_ && cell.empty() && !cells.Next(&cell)) break;
        return WrongLength(count + 1);
      }
      if (IsMissing(cell)) {
        row_[count] = std::numeric_limits<double>::quiet_NaN();
      } else if (!ParseDouble(cell, &row_[count])) {
        // A row separated otherwise than the names is one long cell, and no number either.
        const std::string problem = table_.names[count] + ": " + NumberProblem(cell) + kMissingCell;
        while (++count < row_.size()) {
          if (!cells.Next(&cell)) return WrongLength(count);
        }
        return reader_.ErrorHere(problem);
      }
    }
    if (count != row_.size()) return WrongLength(count);
    for (std::size_t i = 0; i < table_.chosen.size(); ++i) {
      table_.data[i].push_back(row_[table_.chosen[i]]);
    }
    if (options_.keep_lines) table_.lines.push_back(reader_.line_number());
    return std::nullopt;
  }

  // count: no more than one beyond the columns.
  Error WrongLength(std::size_t count) const {
    const std::string columns = std::to_string(row_.size());
    return reader_.ErrorHere(
        "the row has " +
        (count > row_.size() ? "more than the " + columns + " values of the columns"
                             : std::to_string(count) + " values, not " + columns) +
        ", separated by " + SeparatorName(separator_) +
        " as in the line of names: the file is truncated or damaged" +
        (separator_ == kBlanks ? "" : ", or a name with a separator in it is not in quotes"));
  }

  const TableFormat format_;
  const TableReadOptions& options_;
  LineReader reader_;
  NumericTable table_;
  char separator_ = ',';
  bool trailing_ = false;
  std::int64_t announced_rows_ = -1, announced_columns_ = -1;
  std::vector<double> row_;
};

}  // namespace

const std::vector<double>* NumericTable::Column(int index) const {
  const auto found = std::find(chosen.begin(), chosen.end(), index);
  return found == chosen.end() ? nullptr : &data[found - chosen.begin()];
}

Result<NumericTable> ReadNumericTable(const std::string& path, TableFormat format,
                                      const TableReadOptions& options) {
  return TableReader(path, format, options).Read();
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

namespace {

int LineOf(const NumericTable& table, int row) {
  return row < static_cast<int>(table.lines.size()) ? table.lines[static_cast<std::size_t>(row)]
                                                    : 0;
}

}  // namespace

Result<double> EvenTimeStep(const NumericTable& table, int time_column) {
  const std::vector<double>* time = table.Column(time_column);
  const int rows = table.num_rows();
  if (time == nullptr || rows < 2) return Error{"there are fewer than two times", table.path};
  const double step = ((*time)[rows - 1] - (*time)[0]) / (rows - 1);
  // The second part is what three decimals leave of a time.
  const double slack = kEvenness * step + std::fmin(1.1e-3, 0.3 * step);
  std::vector<double> steps;
  bool even = true;
  for (int i = 1; i < rows; ++i) {
    const double now = (*time)[i] - (*time)[i - 1];
    if (!std::isfinite(now)) return Error{"a time is missing", table.path, LineOf(table, i)};
    steps.push_back(now);
    even = even && now > 0.0 && std::fabs(now - step) <= slack;
  }
  if (even) return step;
  // From the mean every row is off where some are missing; the one that is farthest from the median
  // tells where.
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double usual = *middle;
  const auto nearer = [usual](double a, double b) {
    return std::fabs(a - usual) < std::fabs(b - usual);
  };
  const auto at = std::max_element(steps.begin(), steps.end(), nearer);
  const int row = 1 + static_cast<int>(at - steps.begin());
  return Error{*at <= 0.0 ? "the times do not ascend: " + Rounded((*time)[row], 9) +
                                " s comes after " + Rounded((*time)[row - 1], 9) + " s"
                          : "the times do not ascend in even steps: " + Rounded(*at) + " s where " +
                                Rounded(usual) + " s is usual; resample the file",
               table.path, LineOf(table, row)};
}

MaybeError WriteNumericTable(const std::string& path, TableFormat format,
                             const NumericTable& table) {
  const bool storage = format == TableFormat::kStorage;
  const char separator = storage ? '\t' : ',';
  if (table.chosen.size() != table.names.size() || table.num_rows() == 0) {
    return Error{"a table without rows, or with columns left out, is not written", path};
  }
  std::string text;
  if (storage) {
    text = "pushid\nversion=1\nnRows=" + std::to_string(table.num_rows()) +
           "\nnColumns=" + std::to_string(table.names.size()) +
           "\ninDegrees=" + (table.in_degrees ? "yes" : "no") + "\nendheader\n";
  }
  const std::size_t columns = table.names.size();
  for (std::size_t i = 0; i < columns; ++i) {
    text += table.names[i] + (i + 1 < columns ? separator : '\n');
  }
  for (int row = 0; row < table.num_rows(); ++row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const double value = table.data[i][row];
      if (std::isfinite(value)) {
        AppendDouble(value, &text);
      } else if (storage) {
        text += "nan";
      }
      text += i + 1 < columns ? separator : '\n';
    }
  }
  return WriteFileAtomically(path, text);
}

}  // namespace pushid
