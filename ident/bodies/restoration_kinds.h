// ident: what makes and trains each kind of restoration, one row each; RestorationKindRow has what
// else there is to a kind. A new kind adds a maker and a trainer here, and defines both in files of
// its own.
//
// The tables are three, because nothing but the programs that train needs LibTorch, and nothing but
// those that compare with peers needs these: a program links everything in the tables it reads.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/bodies/restoration_files.h"

namespace pushid {

class Peer;                         // models/peers/peer.h
struct RestorationSample;           // ident/training/restoration_training.h
struct RestorationTrainingOptions;  // ident/training/restoration_training.h
struct RestorationTraining;         // ident/training/restoration_training.h

// What the tensors of a file become; path: of the file, for messages.
template <typename Made>
struct KindMaker {
  RestorationKind kind;
  Result<std::unique_ptr<Made>> (*make)(const RestorationFile& file, const std::string& path,
                                        TensorReader* reader);
};

Result<std::unique_ptr<Restoration>> MakeWindow(const RestorationFile& file,
                                                const std::string& path, TensorReader* reader);
Result<std::unique_ptr<Restoration>> MakeCvae(const RestorationFile& file, const std::string& path,
                                              TensorReader* reader);
inline constexpr KindMaker<Restoration> kRestorationMakers[] = {
    {RestorationKind::kWindow, MakeWindow},
    {RestorationKind::kCvae, MakeCvae},
};

Result<std::unique_ptr<Peer>> MakeMrt(const RestorationFile& file, const std::string& path,
                                      TensorReader* reader);
inline constexpr KindMaker<Peer> kPeerMakers[] = {
    {RestorationKind::kMrt, MakeMrt},
};

// training, held: samples to learn from and to stop early by. Errors: nothing to learn from.
using RestorationTrainer = Result<RestorationTraining>(
    const std::vector<RestorationSample>& training, const std::vector<RestorationSample>& held,
    const RestorationTrainingOptions& options);
struct KindTrainer {
  RestorationKind kind;
  RestorationTrainer* train;
};
RestorationTrainer TrainWindow, TrainCvae, TrainMrt;
inline constexpr KindTrainer kRestorationTrainers[] = {
    {RestorationKind::kWindow, TrainWindow},
    {RestorationKind::kCvae, TrainCvae},
    {RestorationKind::kMrt, TrainMrt},
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
        HasRow(kRestorationMakers, row.value) != (row.trained && row.follows_pendulum) ||
        HasRow(kPeerMakers, row.value) != (row.trained && !row.follows_pendulum)) {
      return false;
    }
  }
  return true;
}
static_assert(EveryTrainedKindIsMadeAndTrained(), "a kind has no maker or no trainer");

// hint: what to do about a kind that none of the makers makes. Errors: that, the maker's own,
// missing or misshapen tensors by name.
template <typename Made, size_t kCount>
Result<std::unique_ptr<Made>> MakeByKind(const KindMaker<Made> (&makers)[kCount],
                                         const RestorationFile& file, const std::string& path,
                                         const char* hint) {
  std::string known;
  for (const KindMaker<Made>& maker : makers) {
    known += (known.empty() ? "" : " and ") + NameOf(maker.kind);
    if (maker.kind != file.kind) continue;
    TensorReader reader(file.tensors);
    Result<std::unique_ptr<Made>> made = maker.make(file, path, &reader);
    if (made.ok() && !reader.problem().empty()) {
      return Error{reader.problem() + "; train again with this version", path};
    }
    return made;
  }
  return Error{
      "the kind is " + Quoted(NameOf(file.kind)) + "; it must be " + known + " (" + hint + ")",
      path};
}

}  // namespace pushid
