// ident: the schema of a model's file.
#include "ident/model/model_file_fields.h"
#include "ident/parameters/json_schema.h"

namespace pushid {

nlohmann::ordered_json ModelSchema() {
  using Ordered = nlohmann::ordered_json;
  Ordered fields, definitions = Ordered::object();
  SchemaArchive archive(&fields, &definitions);
  archive.Add("schema", {{"const", kModelSchema}});
  archive.Add("format", {{"const", "pushid model"}});
  archive.Add("format_version", {{"const", kModelFormat}});
  FittedModel model;
  ModelFields(archive, model, RunInfo{});
  // What is written by lists of its own.
  Ordered& properties = fields["properties"];
  const Ordered number = {{"type", "number"}};
  properties["model"] = {{"type", "object"}, {"additionalProperties", true}};
  properties["values"] = {{"type", "object"}, {"additionalProperties", number}};
  properties["table"] = json_schema::ListOf({{"type", "object"},
                                             {"required", {"name", "unit", "nominal", "bounds"}},
                                             {"additionalProperties", true}});
  Ordered schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"$id", "urn:pushid:model:1"},
                    {"title", "A fitted model: pushid-fit --model_out"}};
  schema.update(fields);
  schema["$defs"] = definitions;
  return schema;
}

}  // namespace pushid
