// How fast files are read, bytes per second: BVH (only hip and ankles kept, as a fit keeps them),
// C3D, TRC and CSV. The promise: BVH at 100 MB/s.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "datasets/files/numeric_table.h"
#include "datasets/files/random.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/point_motion.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/simulators/table_files.h"

namespace pushid {
namespace {

constexpr int kBvhFrames = 40000;  // about 20 MB
constexpr int kPointFrames = 20000;
constexpr int kPoints = 40;

// A folder that goes away with the program, and files in it that are made when first asked for.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "pushid-bench-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  template <typename Make>
  std::string File(const std::string& name, const Make& make) {
    const std::string path = path_ + "/" + name;
    if (!std::filesystem::exists(path) && make(path)) std::abort();
    return path;
  }

 private:
  std::string path_;
};

Folder& Files() {
  static Folder folder;
  return folder;
}

// Numbers with six decimals, as motion capture systems write them.
double Rounded6(double value) { return std::round(1e6 * value) / 1e6; }

MaybeError MakeBvh(const std::string& path) {
  Random random(1);
  const SyntheticSkeleton skeleton(0.9);
  BvhMotion motion;
  motion.skeleton = skeleton.Bvh(LengthUnit::kMillimetre);
  motion.frame_time_s = 1.0 / 60.0;
  for (int t = 0; t < kBvhFrames; ++t) {
    SkeletonPose pose;
    pose.theta = 0.1 * random.Normal();
    pose.phi = 0.1 * random.Normal();
    pose.hip = {random.Normal(), random.Normal(), 0.95};
    pose.left_ankle = {random.Normal(), 0.1, 0.08};
    pose.right_ankle = {random.Normal(), -0.1, 0.08};
    skeleton.AppendFrame(pose, LengthUnit::kMillimetre, &motion.values);
  }
  for (double& value : motion.values) value = Rounded6(value + 30.0 * random.Normal());
  return WriteBvh(path, motion);
}

PointMotion Points() {
  Random random(2);
  PointMotion motion;
  motion.rate_hz = 100.0;
  for (int i = 0; i < kPoints; ++i) {
    motion.names.push_back("m" + std::to_string(i));
    motion.positions.emplace_back();
    for (int t = 0; t < kPointFrames; ++t) {
      motion.positions[i].push_back({Rounded6(1e3 * random.Normal()),
                                     Rounded6(1e3 * random.Normal()),
                                     Rounded6(1e3 * random.Normal())});
    }
  }
  return motion;
}

MaybeError MakeC3d(const std::string& path) {
  C3dFile file;
  const PointMotion motion = Points();
  file.point_rate_hz = motion.rate_hz;
  file.point_unit = "mm";
  file.point_names = motion.names;
  file.points = motion.positions;
  return WriteC3d(path, file);
}

MaybeError MakeCsv(const std::string& path) {
  NumericTable table;
  const PointMotion motion = Points();
  for (int i = 0; i < kPoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      table.chosen.push_back(static_cast<int>(table.names.size()));
      table.names.push_back(motion.names[i] + "_" + "xyz"[axis]);
      table.data.emplace_back();
      for (const Eigen::Vector3d& p : motion.positions[i]) table.data.back().push_back(p[axis]);
    }
  }
  return WriteNumericTable(path, TableFormat::kCsv, table);
}

void CountBytes(const std::string& path, benchmark::State* state) {
  state->SetBytesProcessed(static_cast<int64_t>(state->iterations()) *
                           static_cast<int64_t>(std::filesystem::file_size(path)));
}

void BM_ReadBvhHipAndAnkles(benchmark::State& state) {
  const std::string path = Files().File("a.bvh", &MakeBvh);
  PointReadOptions options;
  options.choose = [](const PointMotion&) {
    return std::vector<int>{kHipJoint, kLeftAnkleJoint, kRightAnkleJoint};
  };
  for (auto _ : state) {
    const auto read = ReadBvhPoints(path, options);
    if (!read.ok()) std::abort();
    benchmark::DoNotOptimize(read.value().positions[0].back());
  }
  CountBytes(path, &state);
}
BENCHMARK(BM_ReadBvhHipAndAnkles)->Unit(benchmark::kMillisecond);

void ReadPoints(benchmark::State& state, const std::string& path, MotionFormat format) {
  PointReadOptions options;
  options.choose = [](const PointMotion&) { return std::vector<int>{0, 10, 20}; };
  for (auto _ : state) {
    const auto read = ReadPointMotion(path, format, options);
    if (!read.ok()) std::abort();
    benchmark::DoNotOptimize(read.value().positions[0].back());
  }
  CountBytes(path, &state);
}

void BM_ReadC3d(benchmark::State& state) {
  ReadPoints(state, Files().File("a.c3d", &MakeC3d), MotionFormat::kC3d);
}
BENCHMARK(BM_ReadC3d)->Unit(benchmark::kMillisecond);

void BM_ReadTrc(benchmark::State& state) {
  const auto make = [](const std::string& path) { return WriteTrc(path, Points()); };
  ReadPoints(state, Files().File("a.trc", make), MotionFormat::kTrc);
}
BENCHMARK(BM_ReadTrc)->Unit(benchmark::kMillisecond);

void BM_ReadCsv(benchmark::State& state) {
  ReadPoints(state, Files().File("a.csv", &MakeCsv), MotionFormat::kCsv);
}
BENCHMARK(BM_ReadCsv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pushid
