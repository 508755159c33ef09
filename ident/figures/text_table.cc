// ident: padding columns.
#include "ident/figures/text_table.h"

#include <algorithm>

namespace pushid {

TextTable::TextTable(std::vector<std::string> header) : left_(header.size(), true) {
  for (size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty() || header[i][0] != '>') continue;
    header[i].erase(0, 1);
    left_[i] = false;
  }
  rows_.push_back(std::move(header));
}

TextTable TextTable::OfNumbers(std::vector<std::string> header) {
  for (size_t i = 1; i < header.size(); ++i) header[i].insert(0, ">");
  return TextTable(std::move(header));
}

void TextTable::Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

void TextTable::Add(std::initializer_list<TableCell> row) {
  rows_.emplace_back();
  for (const TableCell& cell : row) rows_.back().push_back(cell.text);
}

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

std::string Metric::Title() const {
  std::string title = std::string(name) + " " + unit;
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::string Metric::Text(double value, int digits) const {
  std::string text = Title();
  return text.insert(text.rfind(' '), " " + Rounded(value, digits));
}

}  // namespace pushid
