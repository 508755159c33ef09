// ident: a restoration in a folder: restoration.json (what it is, how it was trained) and
// weights.npy (its numbers, float32). Both load without the training code and without LibTorch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
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

// What the folder holds, for messages and as a file name.
struct TensorFolderKind {
  const char* what;    // "restoration"; the JSON file has this name
  const char* flag;    // "--restoration", which names the folder
  const char* writer;  // "pushid-train-restoration --out", which wrote it
  int format;          // the newest that is read
};

struct TensorFolder {
  std::string kind;
  KeptJson settings{};
  KeptJson training{};  // provenance
  TensorList tensors;
};

std::string JsonFileOf(const TensorFolderKind& kind, const std::string& folder);

// The JSON comes last: without it the folder holds nothing.
MaybeError WriteTensorFolder(const TensorFolderKind& kind, const std::string& folder,
                             const TensorFolder& content);

// kinds: the names there are, for messages; is_kind: whether a name is one of them. Errors: no such
// folder, another kind, a newer format, weights that are not those of the JSON (by their hash).
Result<TensorFolder> ReadTensorFolder(const TensorFolderKind& kind, const std::string& folder,
                                      const std::string& kinds,
                                      bool (*is_kind)(const std::string& name));

// Numbers in NumPy's .npy format (version 1.0, little-endian float32, one dimension), so that any
// language can read weights: numpy.load("weights.npy"). Writes atomically.
MaybeError WriteNpy(const std::string& path, const std::vector<float>& values);

// Errors: no .npy file, another type, order or number of dimensions, cut off.
Result<std::vector<float>> ReadNpy(const std::string& path);

inline constexpr int kRestorationFormat = 1;
// In RestorationFile::settings: a name of RestorationView (of kWindow and kCvae), of
// CvaeCoordinates, whether the body has two networks, and a name of CvaeTraining (of kCvae). Files
// of before have none of them.
inline constexpr char kViewKey[] = "sees";
inline constexpr char kCvaeCoordinatesKey[] = "coordinates";
inline constexpr char kCvaeHalvesKey[] = "halves";
inline constexpr char kCvaeTrainingKey[] = "training";

// In RestorationFile::training: the most people of one recording that it learned from.
inline constexpr char kMostPeopleKey[] = "most_people";

struct RestorationFile {
  RestorationKind kind = RestorationKind::kWindow;
  KeptJson settings{};  // of the kind
  KeptJson training{};  // provenance
  TensorList tensors;
};

std::string RestorationJsonFile(const std::string& folder);

// The JSON comes last: without it the folder is no restoration.
MaybeError WriteRestorationFile(const std::string& folder, const RestorationFile& file);

// Errors: no such folder, a newer format, weights that are not those of the JSON (by their hash).
Result<RestorationFile> ReadRestorationFile(const std::string& folder);

// The restoration a file describes. Errors: a kind that is no restoration, missing or misshapen
// tensors by name.
Result<std::unique_ptr<Restoration>> MakeRestoration(const RestorationFile& file,
                                                     const std::string& folder);

// Whether it learned from people alone; such bodies stay on tiptoe when others push them on. false
// where the file does not say.
Result<bool> LearnedAlone(const std::string& folder);

// Both. "rigid" needs no folder: the name is enough.
Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder);

// How z of a `cvae` is chosen (models/restoration/cvae_restoration.h).
struct LatentChoice {
  CvaeLatent latent = CvaeLatent::kMean;
  uint64_t seed = 1;  // of kDraw
};
// Errors: kDraw of another kind, or without samplers.
MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration);

// What makes and trains each kind of restoration, one row each; RestorationKindRow has what
// else there is to a kind. A new kind adds a maker and a trainer here, and defines both in files of
// its own.
//
// The tables are two, because nothing but the programs that train needs LibTorch: a program links
// everything in the tables it reads.

struct RestorationSample;           // ident/training/restoration_training.h
struct RestorationTrainingOptions;  // ident/training/restoration_training.h
struct RestorationTraining;         // ident/training/restoration_training.h

// What the tensors of a file become; path: of the file, for messages.
struct KindMaker {
  RestorationKind kind;
  Result<std::unique_ptr<Restoration>> (*make)(const RestorationFile& file, const std::string& path,
                                               TensorReader* reader);
};

Result<std::unique_ptr<Restoration>> MakeWindow(const RestorationFile& file,
                                                const std::string& path, TensorReader* reader);
Result<std::unique_ptr<Restoration>> MakeCvae(const RestorationFile& file, const std::string& path,
                                              TensorReader* reader);
inline constexpr KindMaker kRestorationMakers[] = {
    {RestorationKind::kWindow, MakeWindow},
    {RestorationKind::kCvae, MakeCvae},
};

// training, held: samples to learn from and to stop early by. Errors: nothing to learn from.
using RestorationTrainer = Result<RestorationTraining>(
    const std::vector<RestorationSample>& training, const std::vector<RestorationSample>& held,
    const RestorationTrainingOptions& options);
struct KindTrainer {
  RestorationKind kind;
  RestorationTrainer* train;
};
RestorationTrainer TrainWindow, TrainCvae;
inline constexpr KindTrainer kRestorationTrainers[] = {
    {RestorationKind::kWindow, TrainWindow},
    {RestorationKind::kCvae, TrainCvae},
};

template <typename Row, size_t kCount>
constexpr bool HasRow(const Row (&rows)[kCount], RestorationKind kind) {
  for (const Row& row : rows) {
    if (row.kind == kind) return true;
  }
  return false;
}
constexpr bool EveryTrainedKindIsMadeAndTrained() {
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (HasRow(kRestorationTrainers, row.value) != row.trained ||
        HasRow(kRestorationMakers, row.value) != row.trained) {
      return false;
    }
  }
  return true;
}
static_assert(EveryTrainedKindIsMadeAndTrained(), "a kind has no maker or no trainer");

}  // namespace pushid
