// ident: a network in a folder: a JSON file that says what it is, and weights.npy with its numbers.
//
//   {"schema": "pushid-network/1", "format": 1, "kind": "window", "settings": {...}, "weights":
//   "weights.npy",
//    "weights_hash": "...",
//    "tensors": [{"name": "network.0.weights", "rows": 256, "columns": 107}, ...],
//    "training": {...}}
//
// The tensors stand in weights.npy one after the other, each column by column. Restorations and
// generators are such folders.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/kept_json.h"
#include "models/restoration/dense_network.h"

namespace pushid {

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

}  // namespace pushid
