// Folds that a file gives, and files that give none.
#include <gtest/gtest.h>

#include "ident/problem/folds.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class FoldFileTest : public TempDirTest {
 protected:
  FoldFileTest() {
    for (const char* id : {"a", "b", "c"}) recordings_.emplace_back().id = id;
  }
  Result<std::vector<Fold>> Read(const std::string& text) {
    return ReadFolds(WriteText("folds.json", text), recordings_);
  }

  std::vector<PendulumRecording> recordings_;
};

TEST_F(FoldFileTest, HoldsOutWhatItSays) {
  const auto folds = Unwrapped(Read(
      R"({"folds": [{"name": "x", "held_out": ["c", "a", "c"]}, {"name": "y", "held_out": ["c"]}]})"));
  ASSERT_EQ(folds.size(), 2u);
  EXPECT_EQ(folds[0].name, "x");
  EXPECT_EQ(folds[0].held_out, (std::vector<int>{0, 2}));
  EXPECT_EQ(folds[1].held_out, std::vector<int>{2});
}

TEST_F(FoldFileTest, SaysWhatIsNoFold) {
  struct Case {
    std::string text, says;
  };
  const std::vector<Case> cases = {
      {"[]", "folds.json:1"},
      {"{\n\"folds\": []}", "a list of at least one"},
      {"{\"folds\": [\n3]}", "folds.json:2:1: a fold needs a name"},
      {"{\"folds\": [\n{\"name\": \"x\"}]}", "folds.json:2:1: a fold needs held_out"},
      {"{\"folds\": [{\"name\": \"x\", \"held_out\": [\"a\",\n\"d\"]}]}",
       "folds.json:2:1: no recording that was loaded has the id \"d\""},
      {"{\"folds\": [{\"name\": \"x\", \"held_out\": [\"a\",\n1]}]}",
       "folds.json:2:1: no recording that was loaded has the id 1"},
      {R"({"folds": [{"name": "x", "held_out": []}]})", "'x' holds out nothing"},
      {R"({"folds": [{"name": "x", "held_out": ["a", "b", "c"]}]})", "'x' holds out everything"},
      {"{\"folds\": [{\"name\": \"x\", \"held_out\": [\"a\"]},\n"
       "{\"name\": \"x\", \"held_out\": [\"b\"]}]}",
       "folds.json:2:1: there is a fold 'x' before"},
  };
  for (const Case& one : cases) {
    EXPECT_TRUE(Contains(ProblemOf(Read(one.text)), one.says));
  }
}

}  // namespace
}  // namespace pushid
