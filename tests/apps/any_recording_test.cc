// Recordings in other formats than BVH, from the user's side: looked at, listed, fitted, pushed.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/point_motion.h"
#include "datasets/loading/load_recordings.h"
#include "tests/apps/app_fixture.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/simulators/table_files.h"

namespace pushid {
namespace {

class AnyRecordingTest : public AppTest {
 protected:
  // The recordings of the folder again as `format`, with markers of their own names in mm; returns
  // --recordings=... of the manifest.
  std::string As(MotionFormat format, const std::string& ending) {
    const auto loaded = Unwrapped(LoadRecordings(manifest_));
    nlohmann::ordered_json json = Json(manifest_);
    json.erase("units");
    json.erase("length_unit");
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      const Recording& recording = loaded[i];
      const std::string file = recording.id + ending;
      Write(recording, format, Path(file));
      auto& entry = json["recordings"][i];
      entry.erase("bvh");
      entry.erase("joints");
      entry[format == MotionFormat::kC3d   ? "c3d"
            : format == MotionFormat::kTrc ? "trc"
                                           : "csv"] = {file};
      entry["joints"]["hip"] = {"WL", "WR"};
      entry["joints"]["left_ankle"] = "AL";
      entry["joints"]["right_ankle"] = "AR";
    }
    return "--recordings=" + WriteText("other.json", json.dump(1));
  }

  void Write(const Recording& recording, MotionFormat format, const std::string& path) {
    PointMotion motion;
    motion.rate_hz = recording.fps;
    motion.unit = LengthUnit::kMillimetre;
    motion.names = {"WL", "WR", "AL", "AR"};
    motion.positions.resize(4);
    const RecordedPerson& person = recording.people[0];
    for (int t = 0; t < recording.num_frames(); ++t) {
      const Eigen::Vector3d side(0.0, 0.15, 0.0);
      motion.positions[0].push_back(1e3 * (person.hip[t] + side));
      motion.positions[1].push_back(1e3 * (person.hip[t] - side));
      motion.positions[2].push_back(1e3 * person.left_ankle[t]);
      motion.positions[3].push_back(1e3 * person.right_ankle[t]);
    }
    if (format == MotionFormat::kTrc) {
      EXPECT_FALSE(WriteTrc(path, motion));
    } else if (format == MotionFormat::kC3d) {
      C3dFile c3d;
      c3d.point_rate_hz = motion.rate_hz;
      c3d.point_unit = "mm";
      c3d.point_names = motion.names;
      c3d.points = motion.positions;
      EXPECT_FALSE(WriteC3d(path, c3d));
    } else {
      NumericTable table;
      for (std::size_t i = 0; i < 4; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          table.chosen.push_back(static_cast<int>(table.names.size()));
          table.names.push_back(motion.names[i] + "." + "xyz"[axis]);
          table.data.emplace_back();
          for (const auto& p : motion.positions[i]) table.data.back().push_back(p[axis]);
        }
      }
      EXPECT_FALSE(WriteNumericTable(path, TableFormat::kCsv, table));
    }
  }

  static std::vector<double> Values(const std::string& model) {
    std::vector<double> values;
    const auto read = Json(model);  // lives longer than a temporary in the loop's head
    for (const auto& [name, value] : read.at("values").items()) values.push_back(value);
    return values;
  }
};

TEST_F(AnyRecordingTest, TheFitIsThatOfTheBvhFiles) {
  const std::vector<double> bvh = Values(FitModel());
  struct Case {
    MotionFormat format;
    std::string ending;
    double tolerance;  // relative; C3D keeps 24 bits
  };
  for (const Case& one :
       {Case{MotionFormat::kTrc, ".trc", 1e-6}, Case{MotionFormat::kCsv, ".csv", 1e-6},
        Case{MotionFormat::kC3d, ".c3d", 1e-3}}) {
    SCOPED_TRACE(one.ending);
    const AppRun run = Succeeded(RunApp(
        "pushid-fit", {As(one.format, one.ending), "--model_out=" + Path("other_model.json")}));
    EXPECT_FALSE(Contains(run.err, "warning")) << run.err;
    const std::vector<double> values = Values(Path("other_model.json"));
    ASSERT_EQ(values.size(), bvh.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(values[i], bvh[i], one.tolerance * (std::abs(bvh[i]) + 0.01)) << i;
    }
  }
}

// Four markers are a pendulum and no body: it is shown alone, and bodies that are asked for are
// refused by the names of what they lack.
TEST_F(AnyRecordingTest, PendulumsAloneAreShown) {
  const std::string model = "--model=" + FitModel();
  const std::vector<std::string> arguments = {model, As(MotionFormat::kTrc, ".trc"), "--id=" + id_};
  const AppRun shown =
      Succeeded(RunApp("pushid-animate", With(arguments, {"--out=" + Path("m.html")})));
  EXPECT_TRUE(Contains(shown.err, "right_knee")) << shown.err;
  EXPECT_TRUE(Contains(shown.err, "only pendulums are shown"));
  EXPECT_TRUE(Contains(ReadText(Path("m.html")), "<html"));
  EXPECT_TRUE(Refused(
      RunApp("pushid-animate", With(arguments, {"--restoration=rigid", "--out=" + Path("n.html")})),
      {"right_knee", "\"joints\""}));
  EXPECT_TRUE(Refused(
      RunApp("pushid-predict", With(arguments, {"--restoration=rigid", "--out=" + Path("m.bvh")})),
      {"right_knee", "WL, WR, AL, AR"}));
  Succeeded(RunApp("pushid-predict", With(arguments, {"--out=" + Path("m.csv")})));
}

TEST_F(AnyRecordingTest, FilterAndRateAreSaid) {
  const AppRun run =
      Succeeded(RunApp("pushid-fit", {Recordings(), "--lowpass_hz=10", "--resample_fps=30",
                                      "--details", "--model_out=" + Path("m.json")}));
  EXPECT_TRUE(Contains(run.out,
                       "motion: low-pass at 10 Hz (zero-phase Butterworth), resampled to 30 frames "
                       "per second\n"));
  EXPECT_EQ(Json(Path("m.json"))["configuration"]["lowpass_hz"], "10");
  const AppRun report = RunApp("pushid-report", {"--model=" + Path("m.json"), "--details"});
  EXPECT_TRUE(Contains(report.out, "motion: low-pass at 10 Hz"));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--resample_fps=30"}),
                      {"--lowpass_hz=7.5", "recording '"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--max_gap_s=-1"}), {"--max_gap_s"}));
}

TEST_F(AnyRecordingTest, Inspect) {
  ASSERT_FALSE(WriteC3d(Path("a.c3d"), SampleC3d()));
  AppRun run =
      Succeeded(RunApp("pushid-inspect", {Path("a.c3d"), "--svg_out=" + Path("a.svg"), "--quiet"}));
  EXPECT_TRUE(Contains(run.out, Path("a.c3d") + ": C3D, Intel, floats\n"));
  const std::string svg = ReadText(Path("a.svg"));
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  EXPECT_TRUE(Contains(svg, ", N</text>"));
  EXPECT_FALSE(Contains(svg, "nan"));
  // One bad file among good ones.
  const AppRun twice = RunApp("pushid-inspect", {manifest_ + "," + manifest_});
  EXPECT_TRUE(Refused(twice, {"this id is in"}));
  EXPECT_TRUE(Refused(RunApp("pushid-inspect", {Path("a.c3d") + "," + Path("a.c3d")}),
                      {"commas join manifests"}));
  run = RunApp("pushid-inspect", {Path("none.trc"), manifest_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(Contains(run.err, "none.trc: there is no such file"));
  EXPECT_TRUE(Contains(run.out, "12, 12 can be read, 12 have a push"));
  run = RunApp("pushid-inspect", {manifest_, "--svg_out=" + Path("m.svg")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(Contains(run.err, "a manifest contains nothing to draw"));
  EXPECT_FALSE(std::filesystem::exists(Path("m.svg")));
  EXPECT_TRUE(Refused(RunApp("pushid-inspect", {}), {"name one or more files"}));
  EXPECT_TRUE(Refused(RunApp("pushid-inspect", {"a", "b", "--svg_out=" + Path("x.svg")}),
                      {"--svg_out draws one file"}));
}

TEST_F(AnyRecordingTest, Manifest) {
  const std::string pattern = "--pattern=bvh/{subject}_{take}.bvh";
  const std::string push = "--push_pattern=push/{subject}_{take}.csv";
  AppRun run =
      Succeeded(RunApp("pushid-manifest", {"--folder=" + folder_.string(), pattern, push,
                                           "--mass=80", "--push_kind=net", "--length_unit=mm",
                                           "--length_scale=0", "--out=" + Path("made.json")}));
  EXPECT_TRUE(Contains(run.out, "12 recordings from 12 files"));
  run = Succeeded(RunApp("pushid-fit", {"--recordings=" + Path("made.json")}));
  // Measured pushes, the default, have no tail to fit.
  run = Succeeded(RunApp("pushid-manifest", {"--folder=" + folder_.string(), pattern, push,
                                             "--mass=80", "--out=" + Path("measured it.json")}));
  EXPECT_TRUE(Contains(run.out, "pushid-inspect '" + Path("measured it.json") + "'\n"));
  const std::string measured = "--recordings=" + Path("measured it.json");
  run = Succeeded(RunApp("pushid-fit", {measured}));
  EXPECT_TRUE(Contains(run.out, "warning: every push is external"));
  run = RunApp("pushid-fit", {measured, "--fix=mu,Kp_theta,Kd_theta,a_x"});
  EXPECT_TRUE(Refused(run, {"every parameter that acts on these recordings is fixed"}));
  const int files = CountFiles();
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> bad = {
      {{pattern}, {"--folder is missing"}},
      {{"--folder=" + folder_.string()}, {"--pattern is missing"}},
      {{"--folder=" + folder_.string(), pattern}, {"no mass is given for"}},
      {{"--folder=" + folder_.string(), pattern, "--mass=-1"}, {"--mass"}},
      {{"--folder=" + folder_.string(), pattern, "--mass=70", "--fps=0.1"}, {"--fps"}},
      {{"--folder=" + folder_.string(), pattern, "--mass=70", "--push_kind=soft"}, {"'soft'"}},
      {{"--folder=" + folder_.string(), pattern, "--mass=70", "--length_unit=inch"}, {"'inch'"}},
      {{"--folder=" + folder_.string(), pattern, "--masses=" + Path("none.csv")}, {"none.csv"}},
  };
  for (const auto& [flags, says] : bad) {
    std::vector<std::string> all = flags;
    all.push_back("--out=" + Path("bad.json"));
    EXPECT_TRUE(Refused(RunApp("pushid-manifest", all), says)) << flags.back();
  }
  EXPECT_EQ(CountFiles(), files) << "something was written";
}

// Entries that were edited by hand stay.
TEST_F(AnyRecordingTest, ManifestsAreUpdatedOrKept) {
  const std::vector<std::string> flags = {"--folder=" + folder_.string(), "--mass=80",
                                          "--pattern=bvh/{subject}_{take}.bvh",
                                          "--out=" + Path("made.json")};
  Succeeded(RunApp("pushid-manifest", flags));
  nlohmann::ordered_json json = Json(Path("made.json"));
  const std::string missing = json["recordings"][3]["id"];
  json["recordings"].erase(3);
  json["recordings"][0]["magnitude"] = "by hand";
  json["recordings"][1]["id"] = "renamed";
  const std::string edited = json.dump(1);
  WriteText("made.json", edited);
  EXPECT_TRUE(
      Refused(RunApp("pushid-manifest", flags), {Path("made.json"), "--overwrite", "--update"}));
  EXPECT_EQ(ReadText(Path("made.json")), edited);
  std::vector<std::string> update = flags;
  update.push_back("--update");
  const AppRun run = Succeeded(RunApp("pushid-manifest", update));
  EXPECT_TRUE(Contains(run.out, "11 recordings kept as they were, 2 added"));
  EXPECT_TRUE(Contains(run.out, missing));
  EXPECT_TRUE(Contains(run.out, "do not match the pattern: renamed"));
  const auto after = Json(Path("made.json"))["recordings"];
  ASSERT_EQ(after.size(), 13u);
  for (int i = 0; i < 11; ++i) EXPECT_EQ(after[i], json["recordings"][i]);
  update.back() = "--overwrite";
  Succeeded(RunApp("pushid-manifest", update));
  EXPECT_EQ(Json(Path("made.json"))["recordings"].size(), 12u);
}

// Found before a fit: kilonewtons, the wrong axes, a hip that is none.
TEST_F(AnyRecordingTest, InspectDoubtsWhatNobodyCanBe) {
  AppRun run = RunApp("pushid-inspect", {manifest_});
  EXPECT_FALSE(Contains(run.out, " in 1 case")) << run.out;
  EXPECT_FALSE(Contains(run.out, " cases (")) << run.out;
  std::string rows = "frame,fx,fy,ftheta,fphi\n";
  for (int t = 0; t < 5; ++t) rows += std::to_string(t) + (t == 0 ? ",1500" : ",20") + ",0,0,0\n";
  WriteText("push/strong.csv", rows);
  nlohmann::ordered_json json = Json(manifest_);
  json["recordings"][0]["push_csv"] = "push/strong.csv";
  json["recordings"][1]["forward"] = "-x";
  json["recordings"][2]["joints"]["hip"] = "LeftKnee";
  json["recordings"][3]["pushes"] = {
      {{"person", 0}, {"csv", json["recordings"][3]["push_csv"]}, {"start_frame", 30}}};
  json["recordings"][3].erase("push_csv");
  WriteText("odd.json", json.dump(1));
  run = RunApp("pushid-inspect", {Path("odd.json")});
  EXPECT_TRUE(Contains(run.out, "2 more warnings by --details")) << run.out;
  run = RunApp("pushid-inspect", {Path("odd.json"), "--details"});
  run.out = OneLine(run.out);
  const auto id = [&json](int i) { return json["recordings"][i]["id"].get<std::string>(); };
  EXPECT_TRUE(Contains(run.out, "moves against the push in 1 case (" + id(1)));
  EXPECT_TRUE(Contains(run.out, "moves before being pushed in 1 case (" + id(3)));
  EXPECT_TRUE(Contains(run.out, "people do not face forward in 1 case (" + id(1)));
  EXPECT_TRUE(
      Contains(run.out, "the distance between hip and ankles is implausible in 1 case (" + id(2)));
}

// A push in the file of the motion, of which the recording leaves the first ten frames out.
TEST_F(AnyRecordingTest, ASensorInTheFileOfTheMotion) {
  const std::string recordings = As(MotionFormat::kC3d, ".c3d");
  nlohmann::ordered_json json = Json(Path("other.json"));
  nlohmann::ordered_json& entry = json["recordings"][0];
  const std::string file = Path(entry["c3d"][0].get<std::string>());
  C3dFile c3d = Unwrapped(ReadC3d(file));
  const int frames = static_cast<int>(c3d.points[0].size());
  c3d.analog_rate_hz = 20.0 * c3d.point_rate_hz;
  c3d.analog = {{"rod", "N", {}}};
  for (int i = 0; i < 20 * frames; ++i) {
    c3d.analog[0].samples.push_back(i / 20 >= 25 && i / 20 < 30 ? 100.0 : 0.0);
  }
  ASSERT_FALSE(WriteC3d(file, c3d));
  entry.erase("push_csv");
  entry.erase("frames");
  entry["first_frame"] = 10;
  WriteText("other.json", json.dump(1));
  const AppRun run = Succeeded(
      RunApp("pushid-push", {recordings, "--id=" + entry["id"].get<std::string>(),
                             "--sensor=" + file, "--sensor_column=rod", "--out=" + Path("p.csv")}));
  // Five frames long, from one frame to another: half of it is in the rows of each.
  EXPECT_TRUE(Contains(run.out, "6 rows from frame 15")) << run.out;
  EXPECT_TRUE(Contains(run.out, "its clock at frame 0 is 0.1667 s")) << run.out;

  // Plates in a file of its own that began with the motion's, with a load cell that reads 2.3 N.
  std::string text = "time,force\n";
  for (int i = 0; i < 20 * frames; ++i) {
    const double force = c3d.analog[0].samples[i] + 2.3;
    text += std::to_string(i / c3d.analog_rate_hz) + "," + std::to_string(force) + "\n";
  }
  WriteText("force.csv", text);
  const AppRun beside = Succeeded(
      RunApp("pushid-push", {recordings, "--id=" + entry["id"].get<std::string>(), "--overwrite",
                             "--sensor=" + Path("force.csv"), "--out=" + Path("p.csv")}));
  EXPECT_TRUE(Contains(beside.out, "6 rows from frame 15")) << beside.out;
  EXPECT_TRUE(Contains(beside.out, "by the motion's times, its clock at frame 0 is 0.1667 s"));
  EXPECT_TRUE(Contains(beside.out, "2.3 N before the pull subtracted")) << beside.out;
}

}  // namespace
}  // namespace pushid
