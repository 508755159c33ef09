// BVH: any text is an Error or a motion; what is read as raw values and as positions agrees in
// length.
#include "datasets/formats/bvh.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<BvhMotion> raw = ReadBvh(path);
  const Result<BvhPositions> positions = ReadBvhPositions(path);
  Demand(raw.ok() == positions.ok());
  if (raw.ok()) Demand(raw.value().num_frames() == positions.value().num_frames());
  return 0;
}
