// ident: recordings that are held out together.
//
// Stratified by setting, strength and subject, so that every fold holds out its share of each,
// repeated with new shuffles; the recordings of a setting dealt out in the manifest's order,
// which other programs can repeat; leave-one-subject-out and leave-one-setting-out; the strong
// pushes held out together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "models/enum_names.h"

namespace pushid {

enum class FoldScheme { kStratified, kInterleaved, kSubject, kStrong, kSetting };
constexpr EnumNames<FoldScheme, 5> Names(FoldScheme) {
  return {{{"stratified", FoldScheme::kStratified},
           {"interleaved", FoldScheme::kInterleaved},
           {"subject", FoldScheme::kSubject},
           {"strong", FoldScheme::kStrong},
           {"setting", FoldScheme::kSetting}}};
}

struct Fold {
  std::string name;  // "repeat 2 fold 3", "without X-05", "strong"
  std::vector<int> held_out;
};

// For kStratified: num_folds folds, `repeats` times; for kInterleaved num_folds folds. For the
// others the arguments are not used. Copies of a recording are held out together.
// Errors: fewer recordings or subjects than the scheme needs, no strong push.
Result<std::vector<Fold>> MakeFolds(const std::vector<PendulumRecording>& recordings,
                                    FoldScheme scheme, int num_folds, int repeats, uint64_t seed);

// The indices below `total` that are not held out, ascending.
std::vector<int> Others(const std::vector<int>& held_out, int total);

// The values at these positions; none where there is nothing to pick from.
template <typename Value>
std::vector<Value> Picked(const std::vector<Value>& from, const std::vector<int>& positions) {
  std::vector<Value> picked;
  if (from.empty()) return picked;
  for (int k : positions) picked.push_back(from[k]);
  return picked;
}

template <typename Value>
std::vector<Value> Without(const std::vector<Value>& all, const std::vector<int>& held_out) {
  return Picked(all, Others(held_out, static_cast<int>(all.size())));
}

// Folds that a file gives, such as a published split or quarters of the recordings:
//   {"folds": [{"name": "1", "held_out": ["single_X05_00", ...]}, ...]}
// A recording may be held out by several folds, or by none. Errors: those of ReadJsonDocument; at
// its place (file:line) what is no fold, a name given twice, a recording that is not there, and a
// fold that holds out nothing or everything.
Result<std::vector<Fold>> ReadFolds(const std::string& path,
                                    const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
