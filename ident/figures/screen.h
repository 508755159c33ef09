// ident: text for a terminal, and what a program prints first: one screen.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ident/figures/text_table.h"

namespace pushid {

inline constexpr size_t kTextColumns = 100;  // of all text for a terminal

// Breaks a line at spaces; a word that is wider than the columns keeps its line to itself.
std::vector<std::string> BrokenLine(const std::string& line, size_t columns = kTextColumns);
// Lines of at most kTextColumns.
std::string TextLines(const std::string& text);
// A command to copy: lines end as a shell wants them where they are broken; with quotes it is one.
std::string CommandLines(const std::string& command);

// The rest is printed by --details, or where `rest` says.
struct Screen {
  std::string title, verdict = {};
  std::vector<TextTable> tables = {};
  std::vector<std::string> paragraphs = {};
  std::vector<std::string> warnings = {};         // the most important first
  std::pair<std::string, std::string> next = {};  // a sentence, and what to type
  std::string rest = {};

  // At most 24 lines: the last table loses rows and warnings are only counted where there are too
  // many, of which three are printed at most.
  std::string ToString() const;
};

}  // namespace pushid
