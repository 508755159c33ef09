// The first inputs of the fuzz targets, by the project's own writers: fuzz-seeds FOLDER makes
// FOLDER/<target>/ with a few small files each.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/point_motion.h"
#include "datasets/formats/trajectories.h"
#include "datasets/manifest/manifest.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/datasets/handmade_c3d.h"
#include "tests/fuzz/model_seeds.h"
#include "tests/simulators/table_files.h"

namespace {

using namespace pushid;

void Check(const MaybeError& failed) {
  if (!failed) return;
  std::fprintf(stderr, "%s\n", failed->ToString().c_str());
  std::exit(1);
}

std::string In(const std::string& folder, const std::string& target, const std::string& name) {
  std::filesystem::create_directories(folder + "/" + target);
  return folder + "/" + target + "/" + name;
}

void C3dSeeds(const std::string& out) {
  for (C3dProcessor processor : {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (int type = 1; type <= 4; ++type) {
      C3dFile file = SampleC3d();
      file.processor = processor;
      file.floating = type % 2 == 0;
      file.platforms[0].type = type;
      if (type == 3) file.platforms[0].channels = {0, 1, 2, 3, 4, 5, 6, 6};
      Check(WriteC3d(In(out, "c3d", NameOf(processor) + std::to_string(type) + ".c3d"), file));
    }
  }
  const std::pair<const char*, HandmadeC3d> handmade[] = {
      {"unsigned", UnsignedC3d()}, {"offset", OffsetC3d()},     {"trial", TrialC3d(3)},
      {"long", LongFramesC3d(3)},  {"many", ManyChannelsC3d()},
  };
  for (const auto& [name, file] : handmade) {
    Check(WriteFileAtomically(In(out, "c3d", name + std::string(".c3d")), file.Bytes()));
  }
}

PointMotion SamplePoints() {
  const C3dFile c3d = SampleC3d();
  PointMotion motion;
  motion.rate_hz = 100.0;
  motion.names = c3d.point_names;
  motion.positions = c3d.points;
  return motion;
}

NumericTable SampleTable() {
  NumericTable table;
  table.names = {"time", "hip_x", "hip_y", "hip_z", "force_vx", "force_vy", "force_vz"};
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    table.chosen.push_back(static_cast<int>(i));
    table.data.emplace_back();
    for (int row = 0; row < 8; ++row) {
      table.data[i].push_back(i == 0 ? 0.01 * row : std::sin(static_cast<double>(i * 3 + row)));
    }
  }
  table.data[2][4] = std::nan("");
  return table;
}

void TextSeeds(const std::string& out) {
  Check(WriteTrajectoryText(In(out, "trajectories", "a.txt"), SamplePoints()));
  Check(WriteTrc(In(out, "trc", "a.trc"), SamplePoints()));
  Check(WriteNumericTable(In(out, "trc", "a.sto"), TableFormat::kStorage, SampleTable()));
  Check(WriteNumericTable(In(out, "csv", "table.csv"), TableFormat::kCsv, SampleTable()));
  Check(WritePushCsv(In(out, "csv", "push.csv"),
                     {Eigen::Vector4d(145.18, -115.38, 101.0, 121.19), Eigen::Vector4d::Ones()}));
  Check(WriteFileAtomically(In(out, "csv", "force.csv"), "time,force\n0,0\n0.001,1.7\n0.002,3\n"));
  Check(WriteFileAtomically(In(out, "csv", "vector.csv"),
                            "time,fx,fy,fz\n0,0,0,0\n0.001,1.7,-0.2,0\n0.002,3,0,1e-3\n"));
  Check(WriteFileAtomically(In(out, "csv", "masses.csv"), "id,mass_kg\nanna,62\nben,80.5\n"));
  Check(WriteFileAtomically(
      In(out, "manifest", "mapping.json"),
      "{\"columns\": {\"waist\": [\"wx\", \"wy\", \"wz\"]}, \"joints\": {\"hip\": \"waist\", "
      "\"left_ankle\": 1, \"right_ankle\": [\"a\", 2]}, \"time\": \"t\", \"frame_rate\": 100, "
      "\"length_unit\": \"cm\", \"up\": \"y\", \"forward\": \"z\"}\n"));
  Check(WriteFileAtomically(In(out, "manifest", "sensors.json"),
                            "[{\"file\": \"a.csv\", \"height\": 0.8}, {\"file\": \"t.c3d\", "
                            "\"column\": \"rod\", \"gain\": -250, \"direction\": [1, 0, 0], "
                            "\"height_m\": 1.1, \"start\": 0.2, \"idle_force\": 3}]\n"));
}

void PlanSeeds(const std::string& out) {
  Check(WriteFileAtomically(In(out, "plan", "whole.toml"), R"(# a comment
[data]
recordings = "M/manifest.json"
setting = "single"
ids = ["a", 'b']
[jobs]
group_by = "subject"
folds = 4
bootstrap = 1_000
seed = 0x7f
time_limit_s = 6e1
[[variant]]
name = "physics"
flags = ["--self_force=none"]
[[variant]]
name = "linear"
flags = ["--self_force=linear", "--settling_weight=10"]
restoration = ["--kind=window", "--sees=pose"]
[output]
dir = "out"
)"));
  Check(WriteFileAtomically(In(out, "plan", "inline.toml"), R"(data.recordings = """m\u00e4.json"""
jobs = {seed = 3, folds = 2, time_limit_s = inf}
variant = [{name = "a"}]
output = {dir = '''o'''}
spare = [1979-05-27T07:32:00Z, nan, -0.5, true]
)"));
}

// A BVH and a manifest of a very small study.
void StudySeeds(const std::string& out) {
  SyntheticOptions study;
  study.subjects = 2;
  study.recordings_per_subject = 3;
  study.frames = 30;
  const auto made = MakeSyntheticRecordings(study);
  if (!made.ok()) Check(made.error());
  const std::string folder = out + "/study";
  Check(WriteSyntheticRecordings(folder, study, made.value()));
  std::filesystem::create_directories(out + "/bvh");
  const std::string id = made.value()[0].recording.id;
  const auto overwrite = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(folder + "/bvh/" + id + ".bvh", In(out, "bvh", "a.bvh"), overwrite);
  std::filesystem::copy_file(folder + "/manifest.json", In(out, "manifest", "a.json"), overwrite);
  const Result<std::string> manifest = ReadWholeFile(folder + "/manifest.json");
  if (!manifest.ok()) Check(manifest.error());
  Check(WriteFileAtomically(In(out, "manifest", "marked.json"), "\xEF\xBB\xBF" + manifest.value()));
  // Two that crashed when marks were read as a part of the text.
  Check(WriteFileAtomically(In(out, "manifest", "marked_list.json"),
                            "\xEF\xBB\xBF{\"recordings\":[]}"));
  Check(WriteFileAtomically(In(out, "manifest", "marked_empty.json"), "\xEF\xBB\xBF{}"));
  std::filesystem::remove_all(folder);
  Check(WriteFileAtomically(
      In(out, "bvh", "small.bvh"),
      "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 0 0\n\tCHANNELS 6 Xposition Yposition Zposition "
      "Zrotation Yrotation Xrotation\n\tEnd Site\n\t{\n\t\tOFFSET 0 1 0\n\t}\n}\nMOTION\nFrames: "
      "2\nFrame Time: 0.01\n0 1 2 3 4 5\n1e1 -2 .5 6 7 8\n"));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz-seeds FOLDER\n");
    return 1;
  }
  C3dSeeds(argv[1]);
  TextSeeds(argv[1]);
  PlanSeeds(argv[1]);
  StudySeeds(argv[1]);
  std::filesystem::create_directories(argv[1] + std::string("/model"));
  Check(WriteModelSeeds(argv[1] + std::string("/model")));
  return 0;
}
