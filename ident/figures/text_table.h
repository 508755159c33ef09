// ident: text for a terminal: lines, tables, and one screen, which is what a program prints first.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "datasets/files/number_text.h"

namespace pushid {

inline constexpr size_t kTextColumns = 100;  // of all text for a terminal

// Breaks a line at spaces; a word that is wider than the columns keeps its line to itself.
std::vector<std::string> BrokenLine(const std::string& line, size_t columns = kTextColumns);
// Lines of at most kTextColumns.
std::string TextLines(const std::string& text);
// A command to copy: lines end as a shell wants them where they are broken; with quotes it is one.
std::string CommandLines(const std::string& command);

// A cell: words and counts as they are; other numbers at full precision, for files. Tables for
// readers round (Rounded).
struct TableCell {
  TableCell(std::string words) : text(std::move(words)) {}
  TableCell(const char* words) : text(words) {}
  template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
  TableCell(Number number) {
    if constexpr (std::is_integral_v<Number>) {
      text = std::to_string(number);
    } else {
      text = DoubleText(number);
    }
  }

  std::string text;
};

// A table of text, columns padded, numbers to the right. One table serves a terminal (ToString), a
// page and a CSV file (report/document.h).
class TextTable {
 public:
  // A head that begins with ">" is that of a column of numbers, without the ">".
  explicit TextTable(std::vector<std::string> header);
  // A table whose first column is words and whose others are numbers.
  static TextTable OfNumbers(std::vector<std::string> header);

  // An empty row is a blank line.
  void Add(std::vector<std::string> row);
  void Add(std::initializer_list<TableCell> row);
  // Drops all but the header and the first rows.
  void Keep(size_t rows) { rows_.resize(std::min(rows_.size(), rows + 1)); }
  // True where there is only a header.
  bool empty() const { return rows_.size() < 2; }
  std::string ToString() const;

  // The header, then all rows.
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }
  bool IsWords(size_t column) const { return left_[column]; }

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> left_;
};

// Values side by side, each with the name of its column.
template <typename Value>
using NamedValues = std::vector<std::pair<std::string, const Value*>>;

// A table whose columns are named values, and whose rows are the same figure of each.
template <typename Value>
class ColumnTable {
 public:
  ColumnTable(const std::string& title, NamedValues<Value> columns)
      : columns_(std::move(columns)), table_(Header(title, columns_)) {}

  // cell: the text of a value.
  template <typename Cell>
  void Add(const std::string& title, const Cell& cell) {
    std::vector<std::string> row = {title};
    for (const auto& [name, value] : columns_) row.push_back(cell(*value));
    table_.Add(std::move(row));
  }
  std::string ToString() const { return table_.ToString(); }

 private:
  static std::vector<std::string> Header(const std::string& title,
                                         const NamedValues<Value>& columns) {
    std::vector<std::string> header = {title};
    for (const auto& [name, value] : columns) header.push_back(name);
    return header;
  }

  NamedValues<Value> columns_;
  TextTable table_;
};

// "3.2 +- 0.3"; without the error where that is not known.
std::string WithError(double value, double error);

// The head of a column: "mu, N s/m", and the name alone where the unit is "1".
std::string WithUnit(const std::string& name, const std::string& unit);

// The output of a program without --details; `rest` says how to see the rest.
struct Screen {
  std::string title, verdict = {};
  std::vector<TextTable> tables = {};
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> warnings = {};         // the most important first
  std::pair<std::string, std::string> next = {};  // a sentence, and what to type
  std::string rest = {};

  // At most 24 lines: the last table is shortened if necessary, and of the warnings at most three
  // are printed and the rest counted.
  std::string ToString() const;
};

}  // namespace pushid
