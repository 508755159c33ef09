// ident: tables of text, columns padded, numbers to the right; how a column is called.
//
// One table serves a terminal (ToString), a page and a CSV file (report/document.h).
#pragma once

#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

#include "datasets/files/number_text.h"

namespace pushid {

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

class TextTable {
 public:
  // A head that begins with ">" is that of a column of numbers, without the ">".
  explicit TextTable(std::vector<std::string> header);
  // A table whose first column is words and whose others are numbers.
  static TextTable OfNumbers(std::vector<std::string> header);

  // An empty row is a blank line.
  void Add(std::vector<std::string> row);
  void Add(std::initializer_list<TableCell> row);
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

// "3.2 +- 0.3"; without the error where that is not known.
std::string WithError(double value, double error);

// The head of a column: "mu, N s/m", and the name alone where the unit is "1".
std::string WithUnit(const std::string& name, const std::string& unit);

}  // namespace pushid
