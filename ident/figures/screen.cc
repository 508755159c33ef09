#include "ident/figures/screen.h"

#include <algorithm>

#include "datasets/files/names.h"

namespace pushid {

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

namespace {

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
std::string CutTable(const TextTable& table, size_t kept) {
  const auto& rows = table.rows();
  if (kept + 1 >= rows.size()) return table.ToString();
  std::vector<std::string> header = rows[0], cut;
  for (size_t i = 0; i < header.size(); ++i) header[i].insert(0, table.IsWords(i) ? "" : ">");
  TextTable shown(header);
  for (size_t i = 1; i < rows.size(); ++i) {
    if (i <= kept) shown.Add(rows[i]);
    if (i > kept && !rows[i].empty()) cut.push_back(rows[i][0].substr(0, rows[i][0].find(", ")));
  }
  return shown.ToString() +
         FirstLine(std::to_string(cut.size()) + " more by --details: " + Joined(cut));
}

// Between blank lines, of the last one only so many rows.
std::string TablesText(const std::vector<TextTable>& tables, size_t rows) {
  std::string text;
  for (const TextTable& table : tables) {
    text += "\n" + (&table == &tables.back() ? CutTable(table, rows) : table.ToString());
  }
  return text.empty() ? "" : text + "\n";
}

}  // namespace

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
  // Whole warnings if they fit, otherwise a line of each.
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
