// ident: columns of text, padded; numbers to the right.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/number_text.h"

namespace pushid {

class TextTable {
 public:
  // left: which columns are words.
  TextTable(std::vector<std::string> header, std::vector<bool> left);
  void Add(std::vector<std::string> row);
  // A blank line between groups.
  void AddGap();
  std::string ToString() const;

  // The header first; a gap is an empty row.
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }
  bool IsWords(size_t column) const { return left_[column]; }

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> left_;
};

// For `left`: every column is words.
inline std::vector<bool> AllWords(size_t columns) { return std::vector<bool>(columns, true); }

// "3.2 +- 0.3"; without the error where that is not known.
std::string WithError(double value, double error);

// The head of a column: "mu, N s/m", and the name alone where the unit is "1".
std::string WithUnit(const std::string& name, const std::string& unit);

// How files and tables call a metric of a prediction.

struct Metric {
  const char* name;  // "hipADE"
  const char* unit;  // "m"

  // In files: "hipADE_m".
  std::string Key() const { return std::string(name) + "_" + unit; }
  std::string ErrorKey() const { return std::string(name) + "_standard_error_" + unit; }
  // At the head of a column: "hipADE m".
  std::string Title() const {
    std::string title = std::string(name) + " " + unit;
    for (char& c : title) c = c == '_' ? ' ' : c;
    return title;
  }
  // In a sentence: "hipADE 0.1 m".
  std::string Text(double value, int digits) const {
    std::string text = Title();
    const std::size_t unit_at = text.rfind(' ');
    return text.insert(unit_at, " " + Rounded(value, digits));
  }
};

}  // namespace pushid
