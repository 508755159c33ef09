// Pushes measured by force sensors, from the user's side.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/formats/c3d.h"
#include "datasets/loading/load_recordings.h"
#include "tests/apps/app_fixture.h"
#include "tests/datasets/c3d_writer.h"

namespace pushid {
namespace {

class PushesFromSensorsTest : public AppTest {};

// The push of a recording through a C3D channel and a list of two halves.
TEST_F(PushesFromSensorsTest, OfAChannelOrAList) {
  SyntheticOptions options;
  options.subjects = 1;
  options.recordings_per_subject = 1;
  options.frames = 90;
  options.push_kind = PushKind::kExternal;
  options.push_start_frame = 15;
  options.direction_sigma_rad = 0.0;
  options.min_height = options.max_height = 1.0;
  options.model.push_tail = PushTail::kNone;
  const auto made = Unwrapped(MakeSyntheticRecordings(options));
  ASSERT_FALSE(WriteSyntheticRecordings(Path("external"), options, made));
  const Recording& recording = made[0].recording;
  const Push& push = recording.pushes[0];
  C3dFile c3d;
  c3d.point_rate_hz = 60.0;
  c3d.point_unit = "mm";
  c3d.point_names = {"spare"};
  c3d.points = {std::vector<Eigen::Vector3d>(90, Eigen::Vector3d::Ones())};
  c3d.analog = {{"rod", "V", {}}};
  for (int i = 0; i < 90 * 20; ++i) {
    const int row = i / 20 - push.start_frame;
    const bool pushed = row >= 0 && row < static_cast<int>(push.force.size());
    c3d.analog[0].samples.push_back(pushed ? push.force[row].x() / -50.0 : 0.0);
  }
  ASSERT_FALSE(WriteC3d(Path("rod.c3d"), c3d));
  const std::vector<std::string> common = {"--recordings=" + Path("external/manifest.json"),
                                           "--id=" + recording.id, "--out=" + Path("p.csv"),
                                           "--overwrite"};
  const auto with = [&common](std::vector<std::string> flags) {
    return RunApp("pushid-push", With(flags, common));
  };
  const std::string c3d_flag = "--sensor=" + Path("rod.c3d");
  const auto listed = [this](const std::string& file, const std::string& more = "") {
    return "--sensor=" +
           WriteText("list.json", "[{\"file\": \"" + file +
                                      "\", \"column\": \"rod\", \"gain\": -50" + more + "}]");
  };
  AppRun run = Succeeded(with({listed("rod.c3d")}));
  double impulse = 0.0;
  for (const Eigen::Vector4d& row : push.force) impulse += row.x() / 60.0;
  char said[64];
  std::snprintf(said, sizeof said, "impulse %.3g N s forwards", impulse);
  EXPECT_TRUE(Contains(run.out, said));
  const std::string alone = ReadText(Path("p.csv"));

  WriteText("halves.json",
            "[{\"file\": \"rod.c3d\", \"column\": \"rod\", \"gain\": -25},"
            " {\"file\": \"rod.c3d\", \"column\": \"rod\", \"gain\": -25}]");
  run = with({"--sensor=" + Path("halves.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(ReadText(Path("p.csv")), alone);
  EXPECT_TRUE(Contains(run.out, "from 2 sensors together"));

  // Every recording its own file, into a folder that is made; one that breaks off is told of.
  run = RunApp("pushid-push", {common[0], "--ids=" + recording.id, "--sensor_column=rod",
                               "--sensor=" + Path("{id}.c3d"), "--out=" + Path("made/{id}.csv")});
  EXPECT_TRUE(Refused(run, {recording.id + ".c3d"}));
  auto& samples = c3d.analog[0].samples;
  samples.resize(20 * (push.start_frame + push.force.size() / 2));
  c3d.points[0].resize(samples.size() / 20);
  ASSERT_FALSE(WriteC3d(Path(recording.id + ".c3d"), c3d));
  run = Succeeded(RunApp("pushid-push", {common[0], "--ids=" + recording.id, listed("{id}.c3d"),
                                         "--out=" + Path("made/{id}.csv")}));
  EXPECT_TRUE(std::filesystem::exists(Path("made/" + recording.id + ".csv")));
  EXPECT_TRUE(Contains(run.err, "part of the push is missing"));

  EXPECT_TRUE(Refused(with({c3d_flag}), {"--sensor_column", "it has rod"}));
  EXPECT_TRUE(Refused(with({c3d_flag, "--sensor_column=x"}), {"no analog channel 'x'", "rod"}));
  EXPECT_TRUE(Refused(with({"--sensor_column=rod"}), {"--sensor_column needs --sensor"}));
  EXPECT_TRUE(Refused(with({listed("rod.c3d"), "--height=1"}), {"--height", "the list"}));
  EXPECT_TRUE(Refused(with({c3d_flag, "--resample_fps=30"}), {"leave --resample_fps out"}));
}

// The manifest's entry says who is pushed, and at which height; the written push replaces it.
TEST_F(PushesFromSensorsTest, TheManifestHasThePersonAndTheHeight) {
  Succeeded(RunApp("pushid-simulate", {"--group_size=3", "--people=3", "--recordings_per_person=1",
                                       "--push_kind=external", "--out=" + Path("row")}));
  nlohmann::ordered_json json = Json(Path("row/manifest.json"));
  nlohmann::ordered_json& entry = json["recordings"][0];
  entry["pushed_person"] = 2;
  entry.erase("push_csv");
  entry.erase("pushes");
  std::string record = "time,force\n";
  for (int i = 0; i < 150; ++i) {
    const double t = 0.01 * i, force = i < 10 || i > 30 ? 0.0 : 200.0;
    record += std::to_string(t) + "," + std::to_string(force) + "\n";
  }
  const std::string sensor = "--sensor=" + WriteText("force.csv", record);
  std::vector<std::string> rows;
  for (double height : {0.6, 0.9}) {
    entry["push_height_m"] = height;
    const std::string manifest = WriteText("row/given.json", json.dump(1));
    const AppRun run = Succeeded(RunApp(
        "pushid-push", {"--recordings=" + manifest, "--id=" + entry["id"].get<std::string>(),
                        sensor, "--out=" + Path("row/made.csv"), "--overwrite", "--update"}));
    EXPECT_TRUE(Contains(run.out, "push on person 2")) << run.out;
    const nlohmann::ordered_json written = Json(manifest)["recordings"][0];
    EXPECT_FALSE(written.contains("push_height_m"));
    EXPECT_EQ(written["pushes"][0]["person"], 2);
    LoadOptions all;
    EXPECT_TRUE(LoadRecordings(manifest, all).ok());
    rows.push_back(ReadText(Path("row/made.csv")));
  }
  EXPECT_NE(rows[0], rows[1]) << "other torques";
}

// A load cell's file as its program wrote it: ms, semicolons, units in quoted heads; its range ends
// at 60 N.
TEST_F(PushesFromSensorsTest, OfAFileFromALoadCellWhoseRangeIsExceeded) {
  SyntheticOptions options;
  options.subjects = options.recordings_per_subject = 1;
  options.frames = 90;
  options.pushes = false;
  const auto made = Unwrapped(MakeSyntheticRecordings(options));
  ASSERT_FALSE(WriteSyntheticRecordings(Path("quiet"), options, made));
  for (const double limit : {1000.0, 60.0}) {
    std::string text = "\"Time (ms)\";\"Force (N)\"\n";
    double impulse = 0.0;
    for (int i = 0; i < 1400; ++i) {
      const double pulse = i > 400 && i < 900 ? 100.0 * std::sin(M_PI * (i - 400) / 500.0) : 0.0;
      const double force = std::min(limit, pulse + 0.5 * std::sin(0.01 * i * i));
      impulse += 0.001 * std::min(limit, pulse);
      text += std::to_string(i) + ";" + std::to_string(force) + "\n";
    }
    const AppRun run = Succeeded(RunApp(
        "pushid-push", {"--recordings=" + Path("quiet/manifest.json"), "--out=" + Path("p.csv"),
                        "--sensor=" + WriteText("cell.csv", text), "--overwrite"}));
    char said[64];
    std::snprintf(said, sizeof said, "impulse %.3g", impulse);
    EXPECT_TRUE(Contains(run.out, said));
    EXPECT_EQ(run.err.find("the sensor's range was exceeded") != std::string::npos, limit == 60.0)
        << run.err;
  }
}

}  // namespace
}  // namespace pushid
