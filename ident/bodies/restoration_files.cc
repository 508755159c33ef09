// ident: restorations written and read.
#include "ident/bodies/restoration_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/random.h"
#include "ident/parameters/json_archive.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr char kWeightsFile[] = "weights.npy";
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

constexpr char kMagic[] = "\x93NUMPY\x01\x00";
constexpr size_t kMagicSize = 8, kPrefix = 10;  // magic, then the header's length in two bytes

Error NotNpy(const std::string& path, const std::string& problem) {
  return {problem +
              "; expected is a one-dimensional little-endian float32 array as numpy.save "
              "writes it",
          path};
}

std::string NpyBytes(const std::vector<float>& values) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(values.size()) + ",), }";
  header.append(64 - (kPrefix + header.size() + 1) % 64, ' ');
  header += '\n';
  std::string bytes(kMagic, kMagicSize);
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  const size_t at = bytes.size();
  bytes.resize(at + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(&bytes[at], values.data(), values.size() * sizeof(float));
  return bytes;
}

constexpr uint64_t kDrawsSeed = 1;  // of a chain without a pendulum

// Begun anew with every call.
std::function<NormalSource()> NormalsOf(uint64_t seed) {
  return [seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
}

RestorationView ViewOf(const Json& settings) {
  RestorationView view = RestorationView::kPendulum;
  JsonArchive(settings).Newer(kViewKey, view);
  return view;
}

}  // namespace

std::string JsonFileOf(const TensorFolderKind& kind, const std::string& folder) {
  return InFolder(folder, std::string(kind.what) + ".json");
}

MaybeError WriteTensorFolder(const TensorFolderKind& kind, const std::string& folder,
                             const TensorFolder& content) {
  if (MaybeError failed = MakeFolder(folder)) return failed;
  std::vector<float> numbers;
  Json tensors = Json::array();
  for (const NamedTensor& tensor : content.tensors) {
    const Eigen::MatrixXf& values = tensor.values;
    tensors.push_back({{"name", tensor.name}, {"rows", values.rows()}, {"columns", values.cols()}});
    numbers.insert(numbers.end(), values.data(), values.data() + values.size());
  }
  std::error_code ignored;
  std::filesystem::remove(JsonFileOf(kind, folder), ignored);
  const std::string weights = InFolder(folder, kWeightsFile);
  if (MaybeError error = WriteNpy(weights, numbers)) return error;
  const Result<std::string> hash = HashFile(weights);
  if (!hash.ok()) return hash.error();
  Json json = {{"schema", "pushid-network/1"}, {"format", kind.format}, {"kind", content.kind}};
  json["settings"] = *content.settings;
  json["weights"] = kWeightsFile;
  json["weights_hash"] = hash.value();
  json["tensors"] = tensors;
  json["training"] = *content.training;
  return WriteJson(JsonFileOf(kind, folder), json);
}

Result<TensorFolder> ReadTensorFolder(const TensorFolderKind& kind, const std::string& folder) {
  const std::string path = JsonFileOf(kind, folder);
  const Result<JsonDocument> read = ReadJsonDocument(path);
  if (!read.ok()) {
    Error error = read.error();
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
      error.message +=
          std::string("; ") + kind.flag + " names the folder that " + kind.writer + " wrote";
    }
    return error;
  }
  const JsonDocument& document = read.value();
  JsonFields fields(document, document.content, "", kind.what);
  const int format = fields.Whole("format", "the format's number", 1, 1 << 20);
  TensorFolder content;
  const std::vector<std::string> names = kind.kinds();
  content.kind = fields.Text("kind", Listed(names, "or"));
  if (fields.Has("kind") && std::count(names.begin(), names.end(), content.kind) == 0) {
    fields.Fail("kind", "is " + Quoted(content.kind) + "; it must be " + Listed(names, "or"));
  }
  const std::string hash = fields.OptionalText("weights_hash", "");
  fields.Require("weights_hash", "the weights file's hash");
  fields.Require("tensors", "the list of tensors");
  fields.List("tensors");
  if (fields.error()) return *fields.error();
  if (format > kind.format) {
    return document.ErrorAt("/format", std::string("this ") + kind.what + " has format " +
                                           std::to_string(format) + "; this program reads up to " +
                                           std::to_string(kind.format) +
                                           ": use a newer one, or train again");
  }
  if (fields.Has("settings")) content.settings = document.content.at("settings");
  if (fields.Has("training")) content.training = document.content.at("training");
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
  if (MaybeError error = ReadTensors(document, numbers.value(), &content.tensors)) return *error;
  return content;
}

MaybeError WriteNpy(const std::string& path, const std::vector<float>& values) {
  return WriteFileAtomically(path, NpyBytes(values));
}

Result<std::vector<float>> ReadNpy(const std::string& path) {
  const Result<std::string> file = ReadWholeFile(path);
  if (!file.ok()) return file.error();
  const std::string& bytes = file.value();
  if (bytes.size() < kPrefix || bytes.compare(0, kMagicSize, kMagic, kMagicSize) != 0) {
    return NotNpy(path, "this is not a .npy file of version 1.0");
  }
  const size_t length = static_cast<uint8_t>(bytes[8]) + 256u * static_cast<uint8_t>(bytes[9]);
  if (bytes.size() < kPrefix + length) return NotNpy(path, "the file is cut off in its header");
  const std::string header = bytes.substr(kPrefix, length);
  if (header.find("'<f4'") == std::string::npos || header.find("False") == std::string::npos) {
    return NotNpy(path, "the header is " + Quoted(header));
  }
  const size_t open = header.find('('), comma = header.find(",)");
  int64_t count = 0;
  if (open == std::string::npos || comma == std::string::npos || comma < open ||
      !ParseInteger(header.substr(open + 1, comma - open - 1), &count) || count < 0) {
    return NotNpy(path, "the header is " + Quoted(header));
  }
  const size_t data = bytes.size() - kPrefix - length;
  if (data != static_cast<uint64_t>(count) * sizeof(float)) {
    return NotNpy(path, "the file contains " + std::to_string(data) +
                            " bytes of numbers, but its " + "header declares " +
                            std::to_string(count) + " numbers");
  }
  std::vector<float> values(static_cast<size_t>(count));
  if (count > 0) std::memcpy(values.data(), bytes.data() + kPrefix + length, data);
  return values;
}

std::vector<std::string> TrainedKinds() {
  return AllNames<RestorationKind>([](const RestorationKindRow& row) { return row.trained; });
}

std::unique_ptr<Restoration> MakeWindow(const Json& settings, TensorFields* reader) {
  WindowWeights weights;
  weights.view = ViewOf(settings);
  return std::make_unique<WindowRestoration>(TakeTensors("", std::move(weights), reader));
}

std::unique_ptr<Restoration> MakeCvae(const Json& settings, TensorFields* reader) {
  CvaeWeights weights;
  JsonArchive(settings).Newer(kCvaeCoordinatesKey, weights.layout.coordinates);
  weights.layout.pendulum = ViewOf(settings) == RestorationView::kPendulum;
  weights.layout.halves = settings.value(kCvaeHalvesKey, true);
  return std::make_unique<CvaeRestoration>(TakeTensors("", std::move(weights), reader),
                                           NormalsOf(kDrawsSeed));
}

MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration) {
  if (choice.latent == CvaeLatent::kMean) return std::nullopt;
  auto* cvae = dynamic_cast<CvaeRestoration*>(restoration);
  if (cvae == nullptr || !cvae->CanDraw()) {
    return Error{
        "--latent=draw needs a restoration of --kind=cvae and --sees=pendulum: others "
        "have no sampler to draw from"};
  }
  cvae->DrawLatent(NormalsOf(choice.seed));
  return std::nullopt;
}

Result<std::unique_ptr<Restoration>> MakeRestoration(const TensorFolder& content,
                                                     const std::string& folder) {
  const std::string path = JsonFileOf(kRestorationFolder, folder);
  const auto kind = FromName<RestorationKind>(content.kind);
  if (!kind || !RowOf(*kind).trained) {
    return Error{
        "the kind is " + Quoted(content.kind) + "; it must be " + Listed(TrainedKinds(), "or"),
        path};
  }
  return FromTensors(content, path, "", [&](TensorFields* reader) {
    return kRestorationMakers[static_cast<size_t>(*kind)](*content.settings, reader);
  });
}

Result<bool> LearnedAlone(const std::string& folder) {
  if (folder == NameOf(RestorationKind::kRigid)) return false;
  const Result<TensorFolder> read = ReadTensorFolder(kRestorationFolder, folder);
  if (!read.ok()) return read.error();
  return read.value().training->value(kMostPeopleKey, 0) == 1;
}

Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder) {
  if (folder == NameOf(RestorationKind::kRigid)) {
    return std::unique_ptr<Restoration>(new RigidRestoration());
  }
  const Result<TensorFolder> read = ReadTensorFolder(kRestorationFolder, folder);
  if (!read.ok()) return read.error();
  return MakeRestoration(read.value(), folder);
}

}  // namespace pushid
