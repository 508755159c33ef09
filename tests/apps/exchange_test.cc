// pushid-export and what it writes, read again; crowds as formations.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using ExchangeTest = AppTest;

TEST_F(ExchangeTest, TheFitOfTheDatasetIsThatOfTheRecordings) {
  const std::string model = FitModel();
  const std::string bids = Path("bids");
  const AppRun run = Succeeded(RunApp("pushid-export", {Recordings(), "--out=" + bids}));
  EXPECT_TRUE(Contains(run.out, "12 recordings written to " + bids));
  for (const char* file : {"dataset_description.json", "participants.tsv", "README"}) {
    EXPECT_TRUE(std::filesystem::exists(bids + "/" + file)) << file;
  }
  const AppRun fit = Succeeded(RunApp("pushid-fit", {"--recordings=" + bids + "/manifest.json",
                                                     "--model_out=" + Path("again.json")}));
  EXPECT_FALSE(Contains(fit.err, "warning")) << fit.err;
  const auto first = Json(model), again = Json(Path("again.json"));
  for (const auto& [name, value] : first.at("values").items()) {
    EXPECT_NEAR(again.at("values").at(name).get<double>(), value.get<double>(),
                1e-6 * (std::abs(value.get<double>()) + 0.01))
        << name;
  }
  EXPECT_TRUE(Refused(RunApp("pushid-export", {Recordings(), "--out=" + bids}),
                      {"already exists", "--overwrite"}));
  Succeeded(RunApp("pushid-export", {Recordings(), "--out=" + bids, "--overwrite"}));
}

// A newcomer's own way to it: inspect a file, then a manifest by pattern and participants.
TEST_F(ExchangeTest, ADatasetWithoutManifest) {
  const std::string bids = Path("bids");
  Succeeded(RunApp("pushid-export", {Recordings(), "--out=" + bids}));
  std::filesystem::remove(bids + "/manifest.json");
  Succeeded(RunApp(
      "pushid-manifest",
      {"--folder=" + bids, "--masses=" + bids + "/participants.tsv", "--out=" + bids + "/m.json",
       "--pattern=sub-{subject}/motion/sub-{subject}_task-push_tracksys-body_acq-{take}_motion.tsv",
       "--magnitude=weak", "--setting=single"}));
  const auto json = Json(bids + "/m.json");
  EXPECT_EQ(json.at("recordings").size(), 12u);
  const std::string file = json.at("recordings")[0].at("tsv")[0];
  EXPECT_EQ(json.at("recordings")[0].at("pushes")[0].at("csv"), file) << "the push it holds";
  const AppRun seen = Succeeded(RunApp("pushid-inspect", {bids + "/" + file}));
  EXPECT_TRUE(Contains(seen.out, "Motion-BIDS"));
  EXPECT_TRUE(Contains(seen.out, "push_fx"));
  EXPECT_TRUE(Contains(seen.out, "impulse"));
}

// A load cell in a channel of its own.
TEST_F(ExchangeTest, ASensorInADataset) {
  const std::string bids = Path("bids");
  Succeeded(RunApp("pushid-export", {Recordings(), "--out=" + bids}));
  const auto entry = Json(bids + "/manifest.json").at("recordings")[0];
  const std::string file = bids + "/" + entry.at("tsv")[0].get<std::string>();
  const std::string channels = file.substr(0, file.size() - 10) + "channels.tsv";
  std::string text = ReadText(channels);
  text.replace(text.find("push_fx"), 7, "cell");
  std::ofstream(channels, std::ios::binary) << text;
  std::string motion = ReadText(file);
  for (size_t at = motion.find("n/a"); at != std::string::npos; at = motion.find("n/a", at)) {
    motion.replace(at, 3, "0");
  }
  std::ofstream(file, std::ios::binary) << motion;
  auto json = Json(bids + "/manifest.json");
  json["recordings"][0].erase("pushes");
  std::ofstream(bids + "/manifest.json") << json.dump(1);
  const std::vector<std::string> arguments = {"--recordings=" + bids + "/manifest.json",
                                              "--id=" + id_, "--sensor=" + file,
                                              "--out=" + Path("push.csv")};
  EXPECT_TRUE(Refused(RunApp("pushid-push", arguments), {"--sensor_column", "cell"}));
  std::vector<std::string> with = arguments;
  with.push_back("--sensor_column=cell");
  Succeeded(RunApp("pushid-push", with));
  EXPECT_TRUE(Contains(ReadText(Path("push.csv")), "frame,fx,fy,ftheta,fphi"));
}

TEST_F(ExchangeTest, TrajectoriesOfRecordings) {
  Succeeded(RunApp("pushid-export", {Recordings(), "--format=txt", "--out=" + Path("crowd")}));
  const std::string file = Path("crowd") + "/" + id_ + ".txt";
  EXPECT_TRUE(Contains(ReadText(file), "# framerate: 60\n"));
  const AppRun seen = Succeeded(RunApp("pushid-inspect", {file}));
  EXPECT_TRUE(Contains(seen.out, "45 at 60 per second"));
  EXPECT_TRUE(
      Refused(RunApp("pushid-export", {Recordings(), "--format=txt", "--out=" + Path("crowd")}),
              {"already exists"}));
}

TEST_F(ExchangeTest, ExportRefuses) {
  EXPECT_TRUE(Refused(RunApp("pushid-export", {Recordings()}), {"--out is missing"}));
  EXPECT_TRUE(Refused(RunApp("pushid-export", {Recordings(), "--out=x", "--format=fbx"}),
                      {"bids, txt or sqlite"}));
  // The folder of the recordings themselves.
  EXPECT_TRUE(Refused(RunApp("pushid-export", {Recordings(), "--out=" + folder_.string()}),
                      {"manifest.json", "not an output of pushid-export"}));
  // Another one's data set, whatever --overwrite says.
  const std::string theirs = Path("theirs");
  std::filesystem::create_directories(theirs);
  for (const char* file : {"participants.tsv", "dataset_description.json"}) {
    WriteText(std::string("theirs/") + file, R"({"Name": "Gait", "BIDSVersion": "1.9.0"})");
    EXPECT_TRUE(Refused(RunApp("pushid-export", {Recordings(), "--out=" + theirs, "--overwrite"}),
                        {file, "not an output of pushid-export"}));
  }
  EXPECT_TRUE(Contains(ReadText(theirs + "/dataset_description.json"), "Gait"));
  const std::string twins = ChangedManifest([](nlohmann::ordered_json& json) {
    json["recordings"][0]["id"] = "a_1";
    json["recordings"][1]["id"] = "a1";
  });
  EXPECT_TRUE(Refused(RunApp("pushid-export", {twins, "--out=" + Path("bids")}),
                      {"recording 'a1' and 'a_1'", "rename"}));
}

TEST_F(ExchangeTest, ACrowdIsAFormation) {
  const std::string model = "--model=" + FitModel();
  const std::string crowd = WriteText("crowd.txt",
                                      "# framerate: 10\n# id frame x/m y/m\n21 0 0 0\n21 1 0 0\n"
                                      "30 1 0.5 0.02\n44 1 1.0 -0.01\n");
  const AppRun run = Succeeded(RunApp(
      "pushid-formation", {model, "--formation=" + crowd, "--formation_frame=1", "--pushed=1",
                           "--push=20", "--duration=2", "--trajectories_out=" + Path("out.txt")}));
  EXPECT_TRUE(Contains(run.out, "3 people of " + crowd + ", frame 1"));
  const std::string out = ReadText(Path("out.txt"));
  EXPECT_TRUE(Contains(out, "\n30\t0\t0.5\t0.02\t"));
  EXPECT_FALSE(Contains(out, "person")) << "ids are the file's own";
  // The result is itself a crowd.
  Succeeded(RunApp("pushid-formation",
                   {model, "--formation=" + Path("out.txt"), "--push=20", "--formation_frame=60",
                    "--trajectories_out=" + Path("out.sqlite")}));
  const auto refused = [&](const std::vector<std::string>& more, const std::string& says) {
    return Refused(RunApp("pushid-formation", With({model, "--formation=" + crowd}, more)), {says});
  };
  EXPECT_TRUE(refused({"--formation_frame=7"}, "there is no frame 7"));
  EXPECT_TRUE(refused({"--people=3"}, "--people is for line, diamond and grid"));
  EXPECT_TRUE(refused({"--formation_frame=1", "--pushed=3"}, "the 3 people of the file count"));
  EXPECT_TRUE(refused({"--formation_frame=1", "--pushed=44"}, "the file's id 44 is person 2"));
  EXPECT_TRUE(refused({"--trajectories_out=" + crowd}, "both name"));
  EXPECT_TRUE(refused({"--trajectories_out=a.csv"}, "trajectories end in .txt"));
  EXPECT_TRUE(
      Refused(RunApp("pushid-formation", {model, "--formation=line", "--formation_frame=1"}),
              {"--formation_frame needs a trajectory file"}));
}

}  // namespace
}  // namespace pushid
