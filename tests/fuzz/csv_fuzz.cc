// CSV: pushes, sensors, masses and tables with points.
#include "datasets/files/numeric_table.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/inspection/manifest_maker.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const auto push = ReadPushCsv(path);
  if (push.ok()) Demand(!push.value().force.empty());
  const Result<SensorRecord> sensor = ReadSensorCsv(path);
  if (sensor.ok()) Demand(sensor.value().time_s.size() == sensor.value().force.size());
  (void)ReadPeople(path);
  const Result<NumericTable> table = ReadNumericTable(path, TableFormat::kCsv);
  if (table.ok()) Demand(table.value().num_rows() >= 1);
  const Result<PointMotion> motion = ReadPointMotion(path, MotionFormat::kCsv);
  if (motion.ok()) Demand(table.ok() && motion.value().num_frames() == table.value().num_rows());
  return 0;
}
