// Manifests, mapping files and lists of sensors.
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/sensor_choice.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<Manifest> manifest = ReadManifest(path);
  if (manifest.ok()) {
    for (const ManifestRecording& recording : manifest.value().recordings) {
      Demand(recording.motion.size() == recording.subjects.size());
    }
  }
  (void)ReadColumnMapping(path);
  const auto sensors = ReadSensorList(path);
  if (sensors.ok()) Demand(!sensors.value().empty());
  return 0;
}
