// pushid-batch: plans and flags that are wrong are told of before any job, where and why.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

using BatchPlanTest = BatchFixture;

// A word misspelt would fail in every job of its variant.
TEST_F(BatchPlanTest, WrongFlagsAreToldBeforeAnyJob) {
  const std::vector<std::pair<std::string, std::string>> flags = {
      {"--self_froce=none", "there is no flag --self_froce"},
      {"--max_iterations=many", "--max_iterations is 'many'"},
      {"--self_force=bogus", "--self_force is 'bogus'"},
      {"--length_unit=inch", "--length_unit is 'inch'"},
      {"--lowpass_hz=-1", "--lowpass_hz is -1"},
      {"--help", "--help does not run a fit"},
      {"--version", "--version does not run a fit"},
  };
  for (const auto& [flag, says] : flags) {
    SCOPED_TRACE(flag);
    const std::string plan = Plan("", {{"good", ""}, {"it's bad", "\"" + flag + "\""}});
    for (const char* how : {"--list", "--dry_run", "--jobs=2"}) {
      EXPECT_TRUE(Refused(Batch(plan, {how}), {"plan.toml:", says}));
    }
  }
  EXPECT_FALSE(fs::exists(Path("out")));
}

struct BadPlan {
  std::string text, says;
};

TEST_F(BatchPlanTest, BadPlansAreToldWhereAndWhy) {
  const std::string data = "[data]\nrecordings = \"manifest.json\"\n";
  const std::string rest = "[[variant]]\nname = \"a\"\nflags = []\n[output]\ndir = \"out\"\n";
  const std::vector<BadPlan> plans = {
      {"[data\n", "plan.toml:1"},
      {std::string("[\0", 2), "plan.toml:1"},
      {data + "setting = \u00e4\n" + rest, "plan.toml:3"},
      {data + "\u0401 = 1\n" + rest, "plan.toml:3"},
      {rest, "no [data]"},
      {data + "[jobs]\ngroup_by = \"city\"\n" + rest,
       "plan.toml:4: group_by: must be none, recording, subject or a label"},
      {data + "[jobs]\nfolds = 1\n" + rest, "plan.toml:4: folds is 1"},
      {data + "[jobs]\nfolds = -2\n" + rest, "plan.toml:4: folds is -2"},
      {data + "[jobs]\nfolds = \"two\"\n" + rest, "folds must be a whole number"},
      {data + "[jobs]\nbotstrap = 3\n" + rest, "no key 'botstrap'"},
      {data + "[jobs]\ntime_limit_s = -1\n" + rest, "time_limit_s must be"},
      {data + "[output]\ndir = \"out\"\n", "at least one [[variant]]"},
      {data + rest + "[[variant]]\nname = \"a\"\n", "two variants are called 'a'"},
      {data + "[[variant]]\nname = \"a\"\nflags = [3]\n[output]\ndir = \"o\"\n",
       "plan.toml:5: flags must be a list of strings"},
      {data + "[[variant]]\nname = \"a\"\nflags = [\"x\"]\n[output]\ndir = \"o\"\n",
       "'x' is not a flag"},
      {data + "[[variant]]\nname = \"a\"\nflags = [\"--model_out=x\"]\n[output]\ndir = \"o\"\n",
       "--model_out is set by the batch"},
      {"[data]\nrecordings = \"missing.json\"\n" + rest, "plan.toml:2: recordings: "},
      {data + "setting = \"moon\"\n" + rest, "plan.toml:3: setting: "},
      {data + "[jobs]\ngroup_by = \"recording\"\nfolds = 2\n" + rest, "plan.toml:5: folds: group"},
  };
  for (const BadPlan& bad : plans) {
    const AppRun run = Batch("--plan=" + WriteText("plan.toml", bad.text), {"--list"});
    EXPECT_TRUE(Refused(run, {bad.says})) << bad.text;
  }
  EXPECT_TRUE(Refused(Batch("--plan=" + Path("none.toml")), {"none.toml", "no such file"}));
  EXPECT_TRUE(Refused(Batch("--plan=" + folder_.string()), {"is a folder; give the plan in it"}));
  WriteText("wide.toml", std::string("[\0d\0", 4));
  EXPECT_TRUE(
      Refused(Batch("--plan=" + Path("wide.toml")), {"wide.toml:1", "encoded as UTF-16LE"}));
  const std::string good = "--plan=" + WriteText("plan.toml", data + rest);
  EXPECT_TRUE(Refused(Batch(good, {"--shard=3/2"}), {"--shard is '3/2'"}));
  EXPECT_TRUE(Refused(Batch(good, {"--job=zz"}), {"no job 'zz'"}));
  EXPECT_TRUE(Refused(Batch(good, {"--jobs=0"}), {"--jobs must be at least 1"}));
  WriteText("file", "");
  EXPECT_TRUE(Refused(
      Batch("--plan=" + WriteText("blocked.toml", data + "[[variant]]\nname = \"a\"\n[output]\n"
                                                         "dir = \"file/out\"\n")),
      {"file/out"}));
}

}  // namespace
}  // namespace pushid
