#include "ident/figures/text_table.h"

#include <algorithm>

#include "datasets/files/names.h"

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

constexpr size_t kScreenLines = 24, kMostWarnings = 3, kLeastTable = 10;

size_t NumLines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

// The first line of a text, with ... where it was cut.
std::string FirstLine(const std::string& text) {
  const std::vector<std::string> lines = BrokenLine(text, kTextColumns - 4);
  return lines.front() + (lines.size() > 1 ? " ...\n" : "\n");
}

// The table without its last rows, whose names stand below it.
std::string CutTable(TextTable table, size_t kept) {
  const auto& rows = table.rows();
  if (kept + 1 >= rows.size()) return table.ToString();
  std::vector<std::string> cut;
  for (size_t i = kept + 1; i < rows.size(); ++i) {
    if (!rows[i].empty()) cut.push_back(rows[i][0].substr(0, rows[i][0].find(", ")));
  }
  table.Keep(kept);
  return table.ToString() +
         FirstLine(std::to_string(cut.size()) + " more by --details: " + Joined(cut));
}

// The tables between blank lines, of the last one only so many rows.
std::string TablesText(const std::vector<TextTable>& tables, size_t rows) {
  std::string text;
  for (const TextTable& table : tables) {
    text += "\n" + (&table == &tables.back() ? CutTable(table, rows) : table.ToString());
  }
  return text.empty() ? "" : text + "\n";
}

}  // namespace

std::vector<std::string> BrokenLine(const std::string& line, size_t columns) {
  std::vector<std::string> lines;
  size_t at = 0;
  while (line.size() - at > columns) {
    const size_t word = line.find_first_not_of(' ', at);
    size_t end = line.rfind(' ', at + columns);
    if (end == std::string::npos || end <= word) end = line.find(' ', std::max(word, at + columns));
    if (word == std::string::npos || end == std::string::npos) break;
    lines.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  lines.push_back(line.substr(at));
  return lines;
}

std::string TextLines(const std::string& text) {
  std::string lines;
  size_t end = 0;
  for (size_t from = 0; from < text.size(); from = end + 1) {
    end = std::min(text.size(), text.find('\n', from));
    lines += Joined(BrokenLine(text.substr(from, end - from)), "\n") + "\n";
  }
  return lines;
}

std::string CommandLines(const std::string& command) {
  constexpr size_t kColumns = kTextColumns - 6;  // beside an indentation, a space and a backslash
  const bool quotes = command.find('\'') != std::string::npos;  // within which nothing may change
  const std::vector<std::string> lines =
      quotes ? std::vector<std::string>{command} : BrokenLine(command, kColumns);
  return command.empty() ? "" : "  " + Joined(lines, " \\\n    ") + "\n";
}

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

std::string Screen::ToString() const {
  const std::string head = TextLines(title) + TextLines(verdict);
  std::string said, warned, after;
  for (const std::string& paragraph : paragraphs) said += TextLines(paragraph);
  if (!next.first.empty()) after = TextLines("next: " + next.first) + CommandLines(next.second);
  after += TextLines(rest);
  const size_t taken = NumLines(head + said + after);
  size_t left = kScreenLines - std::min(kScreenLines, taken);
  size_t rows = tables.empty() ? 0 : tables.back().rows().size() - 1;
  const size_t kept = std::min(NumLines(TablesText(tables, rows)), kLeastTable);
  const size_t told = std::min(kMostWarnings, warnings.size()), more = warnings.size() - told;
  // Warnings are printed completely if they fit, otherwise one line of each.
  for (auto* const lines : {&TextLines, &FirstLine}) {
    warned.clear();
    for (size_t i = 0; i < told; ++i) warned += lines("warning: " + warnings[i]);
    if (more > 0) warned += CountText(more, "more warning") + " by --details\n";
    if (NumLines(warned) + kept <= left) break;
  }
  left -= std::min(left, NumLines(warned));
  while (rows > 1 && NumLines(TablesText(tables, rows)) > left) --rows;
  return head + TablesText(tables, rows) + said + warned + after;
}

}  // namespace pushid
