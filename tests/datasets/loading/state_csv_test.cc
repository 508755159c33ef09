// States of people from CSV: a file by hand, and mistakes by line.
#include <gtest/gtest.h>

#include <vector>

#include "datasets/loading/generator_data.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr char kHead[] = "recording,frame,person,symbol\n";
const std::vector<std::string> kTwo = {"anna", "ben"};

class StateCsvTest : public TempDirTest {
 protected:
  // Why the states of recording `talk` of anna and ben, five frames, cannot be read.
  std::string Problem(const std::string& text) {
    const Result<StateTable> table = ReadStates(WriteText("states.csv", text));
    if (!table.ok()) return table.error().ToString();
    if (MaybeError error = CheckRecordings(table.value(), {"talk"})) return error->ToString();
    const Result<RecordedStates> states = StatesOf(table.value(), "talk", kTwo, 5);
    return states.ok() ? "" : states.error().ToString();
  }
};

TEST_F(StateCsvTest, ASymbolHoldsUntilTheNext) {
  const std::string path = WriteText("states.csv", std::string("# by hand\n") + kHead +
                                                       "talk,3,anna,listen\ntalk,0,anna,speak\n\n"
                                                       "talk,0,ben, rest \n");
  const StateTable table = Unwrapped(ReadStates(path));
  const auto states = Unwrapped(StatesOf(table, "talk", kTwo, 5));
  using Names = std::vector<std::string>;
  EXPECT_EQ(states.people[0], (Names{"speak", "speak", "speak", "listen", "listen"}));
  EXPECT_EQ(states.people[1], Names(5, "rest"));
  EXPECT_TRUE(StatesOf(table, "other", kTwo, 5).value().people.empty());
  ASSERT_FALSE(WriteStates(Path("again.csv"), {states}));
  EXPECT_EQ(ReadText(Path("again.csv")), std::string(kHead) +
                                             "talk,0,anna,speak\ntalk,3,anna,listen\n"
                                             "talk,0,ben,rest\n");
}

TEST_F(StateCsvTest, MistakesAreNamedByLine) {
  const std::string ben = "talk,0,ben,a\n";
  const struct {
    std::string text, says;
    int line;
  } kMistakes[] = {
      {"", "lists no states", 0},
      {kHead, "lists no states", 1},
      {"recording,person,symbol\n", "the first line must be recording,frame,person,symbol", 1},
      {kHead + std::string("talk,0,anna\n"), "four cells", 2},
      {kHead + std::string("talk,0.5,anna,a\n"), "frame is '0.5'", 2},
      {kHead + std::string("talk,-1,anna,a\n"), "frame is '-1'", 2},
      {kHead + std::string("talk,,anna,a\n"), "frame is ''", 2},
      {kHead + std::string(",0,anna,a\n"), "the recording is missing", 2},
      {kHead + std::string("talk,0,anna,\n"), "the symbol is missing", 2},
      {kHead + ben + ben, "'ben' of recording 'talk' at frame 0 was given before", 3},
      {kHead + std::string("talk,0,,a\n"), "nobody in recording 'talk' is ''", 2},
      {kHead + ben + "talks,0,anna,a\n", "no recording 'talks'", 3},
      {kHead + ben + "talk,0,anne,a\n", "nobody in recording 'talk' is 'anne'", 3},
      {kHead + ben + "talk,5,ben,b\n", "frame 5 is behind the end", 3},
      {kHead + std::string("talk,1,ben,a\n"), "begin at frame 1; give that of frame 0", 2},
      {kHead + ben, "no states of 'anna' of recording 'talk'", 2},
  };
  for (const auto& mistake : kMistakes) {
    const std::string said = Problem(mistake.text);
    EXPECT_TRUE(Contains(said, mistake.says)) << mistake.text << said;
    const std::string where =
        "states.csv:" + (mistake.line > 0 ? std::to_string(mistake.line) + ": " : " ");
    EXPECT_TRUE(Contains(said, where)) << mistake.text << said;
  }
  EXPECT_EQ(Problem(kHead + ben + "talk,0,anna,a\n"), "");
  EXPECT_TRUE(Contains(ReadStates(Path("none.csv")).error().ToString(), "none.csv"));
}

}  // namespace
}  // namespace pushid
