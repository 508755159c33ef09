// BVH: any text is an Error or a motion; what is read as raw values and as positions agrees in
// length.
#include "datasets/formats/bvh.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  PointReadOptions raw;
  raw.kept_rows = 1 << 30;
  const Result<PointMotion> values = ReadBvhPoints(path, raw);
  const Result<PointMotion> positions = ReadBvhPoints(path);
  Demand(values.ok() == positions.ok());
  if (!values.ok()) return 0;
  const PointMotion& read = values.value();
  Demand(read.num_frames() == positions.value().num_frames());
  Demand(static_cast<int>(read.values.size()) == read.num_frames() * read.skeleton->num_channels());
  return 0;
}
