// datasets: a list of sensors as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/json_fields.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/sensor_choice.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

double OptionalNumber(JsonFields* fields, const char* key, const char* what, double fallback) {
  return fields->Has(key) ? fields->Number(key, what) : fallback;
}

void ReadDirection(JsonFields* fields, SensorChoice* sensor) {
  if (!fields->Has("direction")) return;
  const Json& value = fields->At("direction");
  bool numbers = value.is_array() && value.size() == 3;
  for (std::size_t i = 0; numbers && i < 3; ++i) numbers = value[i].is_number();
  if (!numbers) {
    fields->Fail("direction", "must be [x, y, z], as in [1, 0, 0], not " + Shown(value));
    return;
  }
  for (int i = 0; i < 3; ++i) sensor->direction[i] = value[i].get<double>();
}

}  // namespace

Result<std::vector<SensorChoice>> ReadSensorList(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  const Json& content = document.value().content;
  if (!content.is_array() || content.empty()) {
    return document.value().ErrorAt("", "a list of sensors is expected, [{\"file\": ...}, ...]");
  }
  std::vector<SensorChoice> sensors;
  for (std::size_t i = 0; i < content.size(); ++i) {
    JsonFields fields(document.value(), content[i], "/" + std::to_string(i),
                      "sensor " + std::to_string(i));
    fields.Only({"file", "column", "gain", "up", "forward", "direction", "height", "height_m",
                 "start", "idle_force", "zero"});
    SensorChoice sensor;
    sensor.file = ResolvePath(path, fields.Text("file", "the name of a file with forces"));
    sensor.column = fields.OptionalText("column", "");
    sensor.gain = OptionalNumber(&fields, "gain", "the N per unit", 1.0);
    sensor.up = fields.OptionalText("up", "");
    sensor.forward = fields.OptionalText("forward", "");
    ReadDirection(&fields, &sensor);
    sensor.height_fraction = OptionalNumber(&fields, "height", "a fraction of the rod", 1.0);
    if (fields.Has("height_m")) sensor.height_m = fields.Number("height_m", "a height in m");
    if (fields.Has("height") && fields.Has("height_m")) {
      fields.Fail("height", "is given together with height_m; give one of them");
    }
    if (fields.Has("start")) sensor.start_s = fields.Number("start", "its clock at frame 0 in s");
    sensor.idle_force = OptionalNumber(&fields, "idle_force", "a force in N", 0.0);
    sensor.zero_n = OptionalNumber(&fields, "zero", "what it reads at rest in N", 0.0);
    if (!fields.error() && !(sensor.idle_force >= 0.0)) {
      fields.Fail("idle_force", "must be a force of at least 0 N");
    }
    if (fields.error()) return *fields.error();
    sensors.push_back(sensor);
  }
  return sensors;
}

}  // namespace pushid
