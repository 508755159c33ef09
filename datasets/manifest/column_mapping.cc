// datasets: mapping files.
#include "datasets/manifest/column_mapping.h"

#include <nlohmann/json.hpp>

#include "datasets/formats/axes.h"
#include "datasets/formats/frame_rate.h"
#include "datasets/manifest/mapping_json.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

void ReadColumns(JsonFields* fields, ColumnMapping* mapping) {
  if (!fields->Has("columns")) return;
  const Json& columns = fields->At("columns");
  if (!columns.is_object()) {
    fields->Fail("columns", "must be an object of \"point\": [\"x\", \"y\", \"z\"]");
    return;
  }
  for (const auto& [name, item] : columns.items()) {
    bool names = item.is_array() && item.size() == 3;
    for (std::size_t i = 0; names && i < 3; ++i) names = item[i].is_string();
    if (!names || name.empty()) {
      fields->Fail("columns",
                   "of " + Quoted(name) + " must be three column names, not " + Shown(item));
      return;
    }
    mapping->columns.push_back(
        {name, item[0].get<std::string>(), item[1].get<std::string>(), item[2].get<std::string>()});
  }
}

}  // namespace

Result<ColumnMapping> ReadColumnMapping(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  JsonFields fields(document.value(), document.value().content, "", "mapping");
  ColumnMapping mapping;
  if (fields.error()) return *fields.error();
  fields.Only(
      {"columns", "joints", "time", "frame_rate", "length_unit", "length_scale", "up", "forward"});
  ReadColumns(&fields, &mapping);
  mapping.joints = ReadJointMapping(document.value(), &fields);
  mapping.time_column = fields.OptionalText("time", "");
  if (fields.Has("frame_rate")) {
    mapping.frame_rate = fields.Number("frame_rate", "the frames per second");
    const std::string problem = FrameRateProblem(mapping.frame_rate);
    if (!problem.empty()) fields.Fail("frame_rate", problem);
  }
  mapping.length_unit = ReadLengthUnit(&fields, "length_unit");
  mapping.length_scale = ReadLengthScale(&fields);
  mapping.up = fields.OptionalText("up", "");
  mapping.forward = fields.OptionalText("forward", "");
  if (mapping.up.empty() != mapping.forward.empty()) {
    fields.Fail(mapping.up.empty() ? "forward" : "up", "needs the other one: give up and forward");
  }
  if (!mapping.up.empty() && !fields.error()) {
    const Result<Eigen::Matrix3d> axes = AxesRotation(mapping.up, mapping.forward);
    if (!axes.ok()) fields.Fail("up", "and forward: " + axes.error().message);
  }
  if (fields.error()) return *fields.error();
  return mapping;
}

}  // namespace pushid
