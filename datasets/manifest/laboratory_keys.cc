// datasets: reading the keys of a laboratory.
#include "datasets/manifest/laboratory_keys.h"

#include <cmath>

#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

void ReadAxes(JsonFields* given, std::string* up, std::string* forward) {
  *up = given->OptionalText("up", "");
  *forward = given->OptionalText("forward", "");
  const auto axes = Caught([&] { return AxesGiven(*up, *forward); });
  if (!given->failed() && !axes.ok()) {
    given->Fail(up->empty() ? "forward" : "up", axes.error().message);
  }
}

std::vector<std::string> ReadNames(JsonFields* given, const char* key) {
  const Json& list = given->List(key);
  const auto other =
      std::find_if_not(list.begin(), list.end(), [](const Json& item) { return item.is_string(); });
  if (other != list.end()) given->Fail(key, "must be a list of names, not of " + Shown(*other));
  return ListOf<std::string>(list).value_or(std::vector<std::string>());
}

constexpr char kClock[] = "the file's clock at frame 0 in s";

std::optional<Eigen::Vector3d> ReadOrigin(JsonFields* given) {
  if (!given->Has("origin")) return std::nullopt;
  const auto xyz = ListOf<double>(given->List("origin"));
  if (xyz && xyz->size() == 3) return Eigen::Vector3d(xyz->data());
  given->Fail("origin", "must be three numbers, [x, y, z] in m");
  return std::nullopt;
}

ManifestPlates ReadPlates(JsonFields* given, int people) {
  ManifestPlates plates;
  plates.use = given->Choice("use", PlateUse::kMeasure);
  plates.person = given->OptionalWhole("person", "the index of a subject, from 0", 0,
                                       std::max(0, people - 1), 0);
  plates.file = given->OptionalText("file", "");
  plates.plates = ReadNames(given, "plates");
  plates.start_s = given->NumberIfAny("start", kClock);
  plates.lowpass_hz = given->OptionalNumber("lowpass_hz", "a cut-off in Hz", 0.0);
  if (!given->failed() && !(plates.lowpass_hz >= 0.0 && std::isfinite(plates.lowpass_hz))) {
    given->Fail("lowpass_hz", "must be a cut-off in Hz, or 0 for 0.4 of the frame rate");
  }
  ReadAxes(given, &plates.up, &plates.forward);
  plates.origin = ReadOrigin(given);
  given->OnlyAsked();
  return plates;
}

}  // namespace

ManifestGround ReadGroundKey(JsonFields* fields) {
  ManifestGround ground;
  if (!fields->Has("ground")) return ground;
  JsonFields given = fields->Inside(fields->At("ground"), "ground", "ground");
  ground.csv = given.Text("csv", "the file of how the ground moves");
  ground.quantity = given.Choice("quantity", GroundQuantity::kDisplacement);
  ground.start_s = given.NumberIfAny("start", kClock);
  ReadAxes(&given, &ground.up, &ground.forward);
  given.OnlyAsked();
  fields->Add(given);
  return ground;
}

std::vector<ManifestPlates> ReadPlatesKey(JsonFields* fields, int people) {
  std::vector<ManifestPlates> plates;
  const std::string key = "force_plates";
  if (!fields->Has(key.c_str())) return plates;
  const Json& value = fields->At(key.c_str());
  const auto read = [&](const Json& item, const std::string& place, const std::string& label) {
    JsonFields given = fields->Inside(item, place, label);
    plates.push_back(ReadPlates(&given, people));
    fields->Add(given);
  };
  if (!value.is_array()) read(value, key, key);
  for (size_t i = 0; value.is_array() && i < value.size(); ++i) {
    read(value[i], StrCat(key, "/", i), StrCat(key, " ", i));
    for (size_t k = 0; k < i; ++k) {
      const bool both = plates[k].use == PlateUse::kMeasure && plates[i].use == PlateUse::kMeasure;
      if (!both || plates[k].person != plates[i].person) continue;
      fields->Fail(key, StrCat("names person ", plates[i].person,
                               " twice; platforms of one file under one person are one entry "
                               "(\"plates\"), and each entry needs its \"person\""));
    }
  }
  return plates;
}

bool ReadPlatesAlone(JsonFields* fields) {
  const std::string motion = fields->OptionalText("motion", "");
  if (motion.empty()) return false;
  if (motion != "none") {
    fields->Fail("motion", "is " + Quoted(motion) +
                               "; it may be \"none\", for a person on force plates without "
                               "markers; motion files are listed under " +
                               MotionKeys());
    return false;
  }
  std::vector<std::string> refused = {"joints", "mapping",   "push_csv",   "pushes",
                                      "frames", "end_frame", "first_frame"};
  for (const MotionFormatRow& row : kMotionFormats) refused.emplace_back(row.name);
  for (const std::string& key : refused) {
    if (fields->Has(key.c_str())) {
      fields->Fail(key,
                   "is given together with \"motion\": \"none\", a person who stands on force "
                   "plates and is seen by nothing else; leave one of them out");
    }
  }
  return true;
}

void CheckPlatesAlone(const ManifestRecording& recording, JsonFields* fields) {
  if (!recording.plates_alone) return;
  const std::string alone = "\"motion\": \"none\" ";
  if (recording.subjects.size() > 1) {
    fields->Fail("subjects", StrCat("names ", recording.subjects.size(), " people; ", alone,
                                    "is for one person on force plates"));
  }
  if (!fields->Require("force_plates", "{\"use\": \"measure\", \"file\": ...}, without which " +
                                           alone + "leaves nothing that was measured")) {
    return;
  }
  const bool measured = recording.plates.size() == 1 &&
                        recording.plates[0].use == PlateUse::kMeasure &&
                        !recording.plates[0].file.empty();
  if (!measured) {
    fields->Fail("force_plates", "needs \"use\": \"measure\" and \"file\", once: with " + alone +
                                     "nothing else was measured");
  }
}

StatedErrors ReadStatedErrors(JsonFields* fields, StatedErrors stated) {
  const std::string key = "stated_errors";
  if (!fields->Has(key.c_str())) return stated;
  JsonFields given = fields->Inside(fields->At(key.c_str()), key, key);
  for (const StatedErrorRow& row : kStatedErrors) {
    double& value = stated.*row.value;
    value = given.OptionalNumber(row.key, "a standard deviation above 0", value);
    if (!given.failed() && !(value > 0.0 && std::isfinite(value))) {
      given.Fail(row.key, "must be a standard deviation above 0");
    }
    if (!given.failed() && row.share && value > 1.0) {
      given.Fail(row.key, "is a share: 0.05 means 5 %");
    }
  }
  given.OnlyAsked();
  fields->Fail(given.error());
  return stated;
}

}  // namespace pushid
