// ident: padding columns.
#include "ident/figures/text_table.h"

#include <algorithm>

#include "datasets/files/number_text.h"

namespace pushid {

TextTable::TextTable(std::vector<std::string> header, std::vector<bool> left)
    : rows_{std::move(header)}, left_(std::move(left)) {}

void TextTable::Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

void TextTable::AddGap() { rows_.emplace_back(); }

std::string TextTable::ToString() const {
  std::vector<size_t> width(left_.size(), 0);
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(width[i] - row[i].size(), ' ');
      line += (i > 0 ? "  " : "") + (left_[i] ? row[i] + padding : padding + row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string WithUnit(const std::string& name, const std::string& unit) {
  return name + (unit == "1" ? "" : ", " + unit);
}

std::string WithError(double value, double error) {
  return Rounded(value, 3) + (error > 0.0 ? " +- " + Rounded(error, 2) : "");
}

}  // namespace pushid
