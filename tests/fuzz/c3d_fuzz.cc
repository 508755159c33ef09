// C3D: any bytes are an Error or a file whose parts fit together.
#include "datasets/formats/c3d.h"
#include "datasets/sensors/force_sensors.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const Result<C3dFile> read = ReadC3d(file.Fill(data, size), size % 2 == 0);
  if (!read.ok()) return 0;
  const C3dFile& c3d = read.value();
  Demand(c3d.point_names.size() == c3d.points.size() && c3d.num_frames() >= 1);
  Demand(c3d.num_frames() <= c3d.announced_frames);
  for (const auto& track : c3d.points) {
    Demand(static_cast<int>(track.size()) == c3d.num_frames());
  }
  for (std::size_t i = 0; i < c3d.platforms.size(); ++i) {
    const auto platform = EvaluatePlatform(c3d, static_cast<int>(i), LengthUnit::kMillimetre);
    if (platform.ok()) Demand(platform.value().force.size() == c3d.analog[0].samples.size());
  }
  return 0;
}
