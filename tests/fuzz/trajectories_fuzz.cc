// Trajectories of crowds.
#include "datasets/formats/trajectories.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<PointMotion> motion = ReadTrajectoryText(path);
  if (!motion.ok()) return 0;
  Demand(motion.value().num_frames() >= 1 && motion.value().rate_hz >= 1.0 &&
         motion.value().names.size() == motion.value().positions.size());
  return 0;
}
