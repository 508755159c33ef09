#include "ident/figures/text_table.h"

#include <algorithm>

#include "ident/figures/screen.h"

namespace pushid {
namespace {

// The cells of a block of columns, on as many lines as broken cells need.
std::string RowText(const std::vector<std::string>& row, const std::vector<size_t>& block,
                    const std::vector<size_t>& width, const std::vector<bool>& left) {
  std::vector<std::vector<std::string>> cells;
  size_t lines = 1;
  for (size_t i : block) {
    cells.push_back(i < row.size() ? BrokenLine(row[i], width[i]) : std::vector<std::string>{""});
    lines = std::max(lines, cells.back().size());
  }
  std::string text;
  for (size_t k = 0; k < lines; ++k) {
    std::string line;
    for (size_t c = 0; c < block.size(); ++c) {
      const std::string cell = k < cells[c].size() ? cells[c][k] : "";
      const size_t wide = width[block[c]];
      const std::string padding(wide > cell.size() ? wide - cell.size() : 0, ' ');
      line += (c > 0 ? "  " : "") + (left[block[c]] ? cell + padding : padding + cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace

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

// Columns that do not fit beside the others follow below, beside the first column again; long words
// are broken.
std::string TextTable::ToString() const {
  constexpr size_t kLeast = 30, kLong = 50;  // columns: that broken words need; that break them
  std::vector<size_t> width(left_.size(), 0);
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  width[0] = std::min(width[0], left_.size() > 1 ? kTextColumns - 2 - kLeast : kTextColumns);
  std::string text;
  for (size_t next = 1; text.empty() || next < left_.size();) {
    std::vector<size_t> block = {0};
    size_t used = width[0];
    for (; next < left_.size(); ++next) {
      const size_t room = used + 2 < kTextColumns ? kTextColumns - used - 2 : 0;
      const bool breaks =
          left_[next] && room >= kLeast && (block.size() == 1 || width[next] > kLong);
      if (width[next] > room && !breaks && block.size() > 1) break;
      if (breaks) width[next] = std::min(width[next], room);
      used += 2 + width[next];
      block.push_back(next);
    }
    if (!text.empty()) text += "\n";
    for (const auto& row : rows_) text += RowText(row, block, width, left_);
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
