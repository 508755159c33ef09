// Manifests, mapping files and lists of sensors, and the places of their values.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/force_sensors.h"
#include "tests/fuzz/memory_file.h"

namespace {

// Every value is found in the text that it was read from.
void DemandPlaces(const pushid::JsonDocument& document) {
  using namespace pushid;
  const int last_line =
      1 + static_cast<int>(std::count(document.text.begin(), document.text.end(), '\n'));
  int looked_at = 0;  // each takes a walk over the text
  const auto values = document.content.flatten();
  for (const auto& [pointer, value] : values.items()) {
    if (++looked_at > 50) break;
    const Error error = document.ErrorAt(pointer, "");
    Demand(error.line >= 1 && error.line <= last_line && error.column >= 1);
  }
  if (!document.content.is_object() || !document.content.contains("recordings")) return;
  const auto& recordings = document.content["recordings"];
  if (!recordings.is_array()) return;
  const std::vector<int> lines = document.ElementLines("/recordings");
  Demand(lines.size() == recordings.size() && std::is_sorted(lines.begin(), lines.end()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (document.ok()) DemandPlaces(document.value());
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
