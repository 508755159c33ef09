// One screen: what does not fit is counted and named, and no line is wider than a terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "ident/figures/text_table.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

size_t NumLines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

void ExpectNarrow(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), kTextColumns) << line;
}

// A title, a verdict, two rows, a warning and a step, by hand.
TEST(Screen, HasItsPartsInOrder) {
  TextTable table({"name", ">value"});
  table.Add({"mu", "30"});
  table.Add({"Kp", "1800"});
  Screen screen{"title", "verdict", {table}, {"gains"}, {"careful"}, {"go on", "pushid-fit"}};
  screen.rest = "the rest";
  EXPECT_EQ(screen.ToString(),
            "title\nverdict\n\nname  value\nmu       30\nKp     1800\n\ngains\nwarning: careful\n"
            "next: go on\n  pushid-fit\nthe rest\n");
}

TEST(Screen, StaysOneScreenWhateverThereIs) {
  TextTable table({"name", ">value"});
  for (int i = 0; i < 60; ++i) table.Add({"row" + std::to_string(i), "1"});
  const std::string sentence(150, 'x'), words = "some words of a long sentence " + sentence;
  Screen screen{"title", words, {table}, {words}, {}, {words, "pushid-fit --a=1"}};
  for (int i = 0; i < 7; ++i) screen.warnings.push_back("warning " + std::to_string(i));
  const std::string text = screen.ToString();
  EXPECT_EQ(NumLines(text), 24u) << text;
  EXPECT_TRUE(Contains(text, "warning: warning 2\n4 more warnings by --details\n"));
  EXPECT_TRUE(Contains(text, "more by --details: row"));
}

TEST(Screen, WideTablesFollowBelowAndLongWordsBreak) {
  TextTable table({"name", "first", "second", "third", "words"});
  const std::string wide(35, 'w');
  std::string words;
  while (words.size() < 300) words += "word ";
  table.Add({"row", wide, wide, wide, words});
  const std::string text = table.ToString();
  ExpectNarrow(text);
  EXPECT_TRUE(Contains(text, "\n\nname  third"));
  EXPECT_EQ(static_cast<size_t>(std::count(text.begin(), text.end(), 'w')), 3 * 35u + 60u + 3u);
  ExpectNarrow(TextLines(words));
}

TEST(Screen, CommandsBreakOutsideQuotes) {
  std::string command = "pushid-crossvalidate --recordings=M/manifest.json";
  for (int i = 0; i < 10; ++i) command += " --flag_of_some_length=" + std::to_string(i);
  std::string lines = CommandLines(command);
  ExpectNarrow(lines);
  EXPECT_GT(NumLines(lines), 2u);
  for (size_t at; (at = lines.find(" \\\n    ")) != std::string::npos;) lines.replace(at, 7, " ");
  EXPECT_EQ(lines, "  " + command + "\n");
  EXPECT_EQ(CommandLines(command + " 'a b'"), "  " + command + " 'a b'\n");
}

}  // namespace
}  // namespace pushid
