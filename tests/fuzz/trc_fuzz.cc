// TRC and OpenSim storage files.
#include "datasets/files/numeric_table.h"
#include "datasets/formats/motion_formats.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<PointMotion> trc = ReadTrc(path);
  if (trc.ok()) {
    Demand(trc.value().num_frames() >= 1 &&
           trc.value().names.size() == trc.value().positions.size());
  }
  const Result<NumericTable> table = ReadNumericTable(path, TableFormat::kStorage);
  if (table.ok()) Demand(table.value().num_rows() >= 1);
  const Result<PointMotion> motion = ReadPointMotion(path, MotionFormat::kStorage);
  if (motion.ok()) Demand(motion.value().num_frames() == table.value().num_rows());
  return 0;
}
