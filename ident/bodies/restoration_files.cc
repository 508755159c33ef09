// ident: restorations written and read.
#include "ident/bodies/restoration_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "datasets/files/content_hash.h"
#include "datasets/files/json_fields.h"
#include "datasets/files/json_file.h"
#include "datasets/files/npy.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/window_features.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr char kJsonFile[] = "restoration.json", kWeightsFile[] = "weights.npy";
constexpr int kLargestSide = 1 << 20;

std::string InFolder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

MaybeError ReadTensors(const JsonDocument& document, const std::vector<float>& numbers,
                       TensorList* tensors) {
  size_t at = 0;
  int index = 0;
  for (const Json& entry : document.content.at("tensors")) {
    JsonFields fields(document, entry, "/tensors/" + std::to_string(index++), "tensor");
    NamedTensor tensor;
    tensor.name = fields.OptionalText("name", "");
    const int rows = fields.Whole("rows", "a number of rows", 1, kLargestSide);
    const int columns = fields.Whole("columns", "a number of columns", 1, kLargestSide);
    if (fields.error()) return fields.error();
    const size_t size = static_cast<size_t>(rows) * static_cast<size_t>(columns);
    if (at + size > numbers.size()) break;
    tensor.values = Eigen::Map<const Eigen::MatrixXf>(numbers.data() + at, rows, columns);
    tensors->push_back(std::move(tensor));
    at += size;
  }
  if (at == numbers.size() && tensors->size() == document.content.at("tensors").size()) {
    return std::nullopt;
  }
  return document.ErrorAt("/tensors", "the tensors do not fit the " +
                                          std::to_string(numbers.size()) +
                                          " numbers of the weights file");
}

}  // namespace

MaybeError WriteRestorationFile(const std::string& folder, const RestorationFile& file) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return Error{"cannot make this folder: " + failed.message(), folder};
  std::vector<float> numbers;
  Json tensors = Json::array();
  for (const NamedTensor& tensor : file.tensors) {
    const Eigen::MatrixXf& values = tensor.values;
    tensors.push_back({{"name", tensor.name}, {"rows", values.rows()}, {"columns", values.cols()}});
    numbers.insert(numbers.end(), values.data(), values.data() + values.size());
  }
  std::filesystem::remove(InFolder(folder, kJsonFile), failed);
  const std::string weights = InFolder(folder, kWeightsFile);
  if (MaybeError error = WriteNpy(weights, numbers)) return error;
  const Result<std::string> hash = HashFile(weights);
  if (!hash.ok()) return hash.error();
  Json json = {{"format", kRestorationFormat}, {"kind", Name(file.kind)}};
  json["settings"] = file.settings;
  json["weights"] = kWeightsFile;
  json["weights_hash"] = hash.value();
  json["tensors"] = tensors;
  json["training"] = file.training;
  return WriteJson(InFolder(folder, kJsonFile), json);
}

Result<RestorationFile> ReadRestorationFile(const std::string& folder) {
  const std::string path = InFolder(folder, kJsonFile);
  const Result<JsonDocument> read = ReadJsonDocument(path);
  if (!read.ok()) {
    Error error = read.error();
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
      error.message += "; --restoration names the folder that pushid-train-restoration --out wrote";
    }
    return error;
  }
  const JsonDocument& document = read.value();
  JsonFields fields(document, document.content, "", "restoration");
  const int format = fields.Whole("format", "the format's number", 1, 1 << 20);
  RestorationFile file;
  const std::string kinds = TrainedRestorationKinds();
  fields.Require("kind", kinds);
  file.kind = fields.Choice("kind", &RestorationKindFromName, file.kind, kinds.c_str());
  const std::string hash = fields.OptionalText("weights_hash", "");
  fields.Require("weights_hash", "the weights file's hash");
  fields.Require("tensors", "the list of tensors");
  fields.List("tensors");
  if (fields.error()) return *fields.error();
  if (format > kRestorationFormat) {
    return document.ErrorAt("/format", "this restoration has format " + std::to_string(format) +
                                           "; this program reads up to " +
                                           std::to_string(kRestorationFormat) +
                                           ": use a newer one, or train again");
  }
  if (fields.Has("settings")) file.settings = document.content.at("settings");
  if (fields.Has("training")) file.training = document.content.at("training");
  const std::string weights = InFolder(folder, kWeightsFile);
  const Result<std::vector<float>> numbers = ReadNpy(weights);
  if (!numbers.ok()) return numbers.error();
  const Result<std::string> found = HashFile(weights);
  if (!found.ok()) return found.error();
  if (found.value() != hash) {
    return Error{"these are not the weights that " + path +
                     " describes (its weights_hash differs): the file is damaged or comes from "
                     "another training; train again",
                 weights};
  }
  if (MaybeError error = ReadTensors(document, numbers.value(), &file.tensors)) return *error;
  return file;
}

namespace {

using MadeRestoration = Result<std::unique_ptr<Restoration>>;

MadeRestoration MakeWindow(const RestorationFile&, const std::string&, TensorReader* reader) {
  WindowWeights weights;
  weights.inputs = TakeScaling("inputs", kWindowInputs, reader);
  weights.network = TakeNetwork("network", 3, kWindowInputs, kWindowOutputs, reader);
  return std::unique_ptr<Restoration>(new WindowRestoration(std::move(weights)));
}

MadeRestoration MakeCvae(const RestorationFile& file, const std::string& path,
                         TensorReader* reader) {
  const std::string name = file.settings.value(kCvaeCoordinatesKey, Name(CvaeCoordinates::kTip));
  const std::optional<CvaeCoordinates> coordinates = CvaeCoordinatesFromName(name);
  if (!coordinates) {
    return Error{
        std::string(kCvaeCoordinatesKey) + " is " + Quoted(name) + "; it must be tip or ldp", path};
  }
  return std::unique_ptr<Restoration>(new CvaeRestoration(TakeCvae(reader), *coordinates));
}

struct Maker {
  RestorationKind kind;
  MadeRestoration (*make)(const RestorationFile& file, const std::string& path,
                          TensorReader* reader);
};

constexpr Maker kMakers[] = {
    {RestorationKind::kWindow, MakeWindow},
    {RestorationKind::kCvae, MakeCvae},
};

}  // namespace

Result<std::unique_ptr<Restoration>> MakeRestoration(const RestorationFile& file,
                                                     const std::string& folder) {
  const std::string path = InFolder(folder, kJsonFile);
  std::string known;
  for (const Maker& maker : kMakers) {
    known += (known.empty() ? "" : " and ") + std::string(Name(maker.kind));
    if (maker.kind != file.kind) continue;
    TensorReader reader(file.tensors);
    MadeRestoration restoration = maker.make(file, path, &reader);
    if (restoration.ok() && !reader.problem().empty()) {
      return Error{reader.problem() + "; train again with this version", path};
    }
    return restoration;
  }
  return Error{"the kind is " + Quoted(Name(file.kind)) + "; known are " + known +
                   " (simlpe is named by --peer)",
               path};
}

Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder) {
  if (folder == Name(RestorationKind::kRigid)) {
    return std::unique_ptr<Restoration>(new RigidRestoration());
  }
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return MakeRestoration(file.value(), folder);
}

}  // namespace pushid
