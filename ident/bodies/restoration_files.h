// ident: a restoration in a folder: restoration.json (what it is, how it was trained) and
// weights.npy (its numbers, float32). Both load without the training code and without LibTorch.
#pragma once

#include <cstdint>
#include <exception>
#include <iterator>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/kept_json.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_recording.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

// A network in a folder: a JSON file that says what it is, and weights.npy with its numbers.
//
//   {"schema": "pushid-network/1", "format": 1, "kind": "window", "settings": {...}, "weights":
//   "weights.npy",
//    "weights_hash": "...",
//    "tensors": [{"name": "network.0.weights", "rows": 256, "columns": 107}, ...],
//    "training": {...}}
//
// The tensors stand in weights.npy one after the other, each column by column. Restorations and
// generators are such folders.

struct TensorFolderKind {
  const char* what;    // "restoration", for messages; the JSON file has this name
  const char* flag;    // "--restoration", which names the folder
  const char* writer;  // "pushid-train-restoration --out", which wrote it
  int format;          // the newest that is read
  std::vector<std::string> (*kinds)();
};

struct TensorFolder {
  std::string kind;
  KeptJson settings{};  // of the kind
  KeptJson training{};  // provenance
  TensorList tensors;
};

std::string JsonFileOf(const TensorFolderKind& kind, const std::string& folder);

// The JSON comes last: without it the folder holds nothing.
MaybeError WriteTensorFolder(const TensorFolderKind& kind, const std::string& folder,
                             const TensorFolder& content);

// Errors: no such folder, another kind, a newer format, weights that are not those of the JSON (by
// their hash).
Result<TensorFolder> ReadTensorFolder(const TensorFolderKind& kind, const std::string& folder);

// make(reader) of the folder's tensors; path: of its JSON. Errors: exceptions of make, whose text
// is `setting` and theirs; missing or misshapen tensors by name.
template <typename Make>
auto FromTensors(const TensorFolder& content, const std::string& path, const char* setting,
                 Make make) -> Result<decltype(make(std::declval<TensorFields*>()))> {
  TensorFields reader(content.tensors);
  constexpr char kAgain[] = "; train again with this version";
  try {
    auto made = make(&reader);
    if (!reader.problem().empty()) return Error{reader.problem() + kAgain, path};
    return Result<decltype(made)>(std::move(made));
  } catch (const std::exception& problem) {
    return Error{std::string(setting) + problem.what() + kAgain, path};
  }
}

// Numbers in NumPy's .npy format (version 1.0, little-endian float32, one dimension), so that any
// language can read weights: numpy.load("weights.npy"). Writes atomically.
MaybeError WriteNpy(const std::string& path, const std::vector<float>& values);

// Errors: no .npy file, another type, order or number of dimensions, cut off.
Result<std::vector<float>> ReadNpy(const std::string& path);

// Keys in the settings of a restoration: a name of RestorationView (of kWindow and kCvae), of
// CvaeCoordinates, whether the body has two networks, and a name of CvaeTraining (of kCvae). Files
// of before have none of them.
inline constexpr char kViewKey[] = "sees";
inline constexpr char kCvaeCoordinatesKey[] = "coordinates";
inline constexpr char kCvaeHalvesKey[] = "halves";
inline constexpr char kCvaeTrainingKey[] = "training";

// Key in its training: the most people of one recording that it learned from.
inline constexpr char kMostPeopleKey[] = "most_people";

std::vector<std::string> TrainedKinds();  // names of the restorations that have a folder
inline constexpr TensorFolderKind kRestorationFolder = {
    "restoration", "--restoration", "pushid-train-restoration --out", 1, TrainedKinds};

// The restoration of a folder's content; folder: for messages. Errors: a kind that is no
// restoration, missing or misshapen tensors by name.
Result<std::unique_ptr<Restoration>> MakeRestoration(const TensorFolder& content,
                                                     const std::string& folder);

// True where it learned from people alone, whose bodies stay on tiptoe when others push them; false
// where the file does not say.
Result<bool> LearnedAlone(const std::string& folder);

// The restoration in a folder; "rigid" needs none: the name is enough.
Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder);

// The choice of z of a `cvae` (models/restoration/cvae_restoration.h).
struct LatentChoice {
  CvaeLatent latent = CvaeLatent::kMean;
  uint64_t seed = 1;  // of kDraw
};
// Errors: kDraw of another kind, or without samplers.
MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration);

// The functions that make and train each kind of restoration, one row each in the order of
// RestorationKindRow, which has what else there is to a kind. A new kind adds a maker and a trainer
// here, and defines both in files of its own.
//
// The tables are two, because nothing but the programs that train needs LibTorch: a program links
// everything in the tables it reads.

// Throws where a setting is of none of its names.
using RestorationMaker = std::unique_ptr<Restoration>(const nlohmann::ordered_json& settings,
                                                      TensorFields* reader);
RestorationMaker MakeWindow, MakeCvae;
inline constexpr RestorationMaker* kRestorationMakers[] = {nullptr, MakeWindow, MakeCvae};

struct RestorationSample;           // ident/training/restoration_training.h
struct RestorationTrainingOptions;  // ident/training/restoration_training.h
struct RestorationTraining;         // ident/training/restoration_training.h

// training, held: samples to learn from and to stop early by.
using RestorationTrainer = RestorationTraining(const std::vector<RestorationSample>& training,
                                               const std::vector<RestorationSample>& held,
                                               const RestorationTrainingOptions& options);
RestorationTrainer TrainWindow, TrainCvae;
inline constexpr RestorationTrainer* kRestorationTrainers[] = {nullptr, TrainWindow, TrainCvae};

constexpr bool EveryTrainedKindIsMadeAndTrained() {
  for (const RestorationKindRow& row : kRestorationKinds) {
    const auto kind = static_cast<std::size_t>(row.value);
    if ((kRestorationMakers[kind] != nullptr) != row.trained) return false;
    if ((kRestorationTrainers[kind] != nullptr) != row.trained) return false;
  }
  return std::size(kRestorationMakers) == std::size(kRestorationKinds);
}
static_assert(EveryTrainedKindIsMadeAndTrained(), "a kind has no maker or no trainer");

}  // namespace pushid
