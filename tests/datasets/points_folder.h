// Tests: recordings whose motion is a file of markers.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/point_motion.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/datasets/recording_folder.h"
#include "tests/simulators/table_files.h"
#include "tests/test_support.h"

namespace pushid {

inline const Eigen::Vector3d kHidden =
    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

// The recording of the folder as markers instead of joints: the pelvis as four of them around the
// hip, ankles as LANK and RANK; 20 frames, mm.
class PointsFolderTest : public RecordingFolderTest {
 protected:
  void SetUp() override {
    RecordingFolderTest::SetUp();
    motion_.rate_hz = 60.0;
    motion_.unit = LengthUnit::kMillimetre;
    motion_.names = {"S1:LASI", "S1:RASI", "S1:LPSI", "S1:RPSI", "S1:LANK", "S1:RANK"};
    motion_.positions.resize(6);
    for (int t = 0; t < 20; ++t) {
      const Eigen::Vector3d hip(10.0 * t, 0.0, 950.0);
      const Eigen::Vector3d offsets[4] = {{80, 120, 0}, {80, -120, 0}, {-80, 50, 0}, {-80, -50, 0}};
      for (int i = 0; i < 4; ++i) motion_.positions[i].push_back(hip + offsets[i]);
      motion_.positions[4].push_back({0.0, 100.0, 80.0});
      motion_.positions[5].push_back({0.0, -100.0, 80.0});
    }
    Use("a.trc", MotionFormat::kTrc);
  }

  void Use(const std::string& file, MotionFormat format) {
    entry().motion_format = format;
    entry().motion = {file};
    entry().json->clear();
    if (format == MotionFormat::kTrc) {
      ASSERT_FALSE(WriteTrc(Path(file), motion_));
    }
    if (format != MotionFormat::kC3d) return;
    C3dFile c3d;
    c3d.point_rate_hz = motion_.rate_hz;
    c3d.point_unit = NameOf(*motion_.unit);
    c3d.point_names = motion_.names;
    c3d.points = motion_.positions;
    ASSERT_FALSE(WriteC3d(Path(file), c3d));
  }

  void UseTable(const std::string& file, MotionFormat format, double first_time = 0.0) {
    NumericTable table;
    table.names = {"time"};
    table.data.resize(1);
    for (int t = 0; t < 20; ++t) table.data[0].push_back(first_time + t / 60.0);
    for (std::size_t i = 0; i < motion_.names.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        table.names.push_back(motion_.names[i] + "_" + "xyz"[axis]);
        table.data.emplace_back();
        for (const auto& p : motion_.positions[i]) table.data.back().push_back(p[axis]);
      }
    }
    for (std::size_t i = 0; i < table.names.size(); ++i) table.chosen.push_back(i);
    ASSERT_FALSE(WriteNumericTable(
        Path(file), format == MotionFormat::kCsv ? TableFormat::kCsv : TableFormat::kStorage,
        table));
    Use(file, format);
  }

  void ExpectTheWalker() {
    const auto loaded = Unwrapped(Load());
    EXPECT_TRUE(warnings_.empty()) << warnings_[0].text;
    const RecordedPerson& person = loaded[0].people[0];
    ASSERT_EQ(person.hip.size(), 20u);
    EXPECT_LT((person.hip[7] - Eigen::Vector3d(0.07, 0.0, 0.95)).norm(), 1e-5);
    EXPECT_LT((person.left_ankle[7] - Eigen::Vector3d(0.0, 0.1, 0.08)).norm(), 1e-5);
    EXPECT_LT((person.right_ankle[7] - Eigen::Vector3d(0.0, -0.1, 0.08)).norm(), 1e-5);
    EXPECT_TRUE(person.weight.empty());
  }

  PointMotion motion_;
};

}  // namespace pushid
