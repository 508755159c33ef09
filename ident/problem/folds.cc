// ident: folds drawn and named.
#include "ident/problem/folds.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/json_file.h"
#include "datasets/files/random.h"
#include "datasets/inspection/findings.h"

namespace pushid {
namespace {

std::string PushedSubject(const PendulumRecording& recording) {
  return recording.subject_ids[recording.pushed_person];
}

std::vector<Fold> StratifiedFolds(const std::vector<PendulumRecording>& recordings, int num_folds,
                                  int repeats, uint64_t seed) {
  std::map<std::array<std::string, 3>, std::vector<int>> strata;
  for (int i = 0; i < static_cast<int>(recordings.size()); ++i) {
    const PendulumRecording& r = recordings[i];
    strata[{r.labels.setting(), r.labels.magnitude(), PushedSubject(r)}].push_back(i);
  }
  std::vector<Fold> folds;
  Random random(seed);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::vector<Fold> round(num_folds);
    int next = 0;  // carried over from stratum to stratum: folds stay equally large
    for (const auto& [key, members] : strata) {
      std::vector<int> shuffled = members;
      random.Shuffle(&shuffled);
      for (int index : shuffled) round[next++ % num_folds].held_out.push_back(index);
    }
    for (int f = 0; f < num_folds; ++f) {
      round[f].name = "repeat " + std::to_string(repeat + 1) + " fold " + std::to_string(f + 1);
      std::sort(round[f].held_out.begin(), round[f].held_out.end());
      folds.push_back(round[f]);
    }
  }
  return folds;
}

// Position within the setting, modulo the number of folds.
Result<std::vector<Fold>> InterleavedFolds(const std::vector<PendulumRecording>& recordings,
                                           int num_folds) {
  std::vector<Fold> folds(num_folds);
  std::map<std::string, int> position;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const int fold = position[recordings[i].labels.setting()]++ % num_folds;
    folds[fold].held_out.push_back(static_cast<int>(i));
  }
  if (folds[1].held_out.empty()) {
    return Error{
        "--scheme=interleaved assigns the recordings of a setting to folds in turn, but no setting "
        "has two; --scheme=stratified makes folds of any recordings"};
  }
  while (folds.back().held_out.empty()) folds.pop_back();
  for (size_t f = 0; f < folds.size(); ++f) folds[f].name = "fold " + std::to_string(f + 1);
  return folds;
}

Result<std::vector<Fold>> DrawFolds(const std::vector<PendulumRecording>& recordings,
                                    FoldScheme scheme, int num_folds, int repeats, uint64_t seed) {
  const int total = static_cast<int>(recordings.size());
  if (scheme == FoldScheme::kStratified || scheme == FoldScheme::kInterleaved) {
    if (num_folds < 2 || num_folds > total) {
      return Error{"--folds is " + std::to_string(num_folds) + "; it must lie between 2 and the " +
                   std::to_string(total) + " recordings"};
    }
    if (scheme == FoldScheme::kInterleaved) return InterleavedFolds(recordings, num_folds);
    if (repeats < 1) return Error{"--repeats must be at least 1"};
    if (num_folds == total) repeats = 1;  // each repeat would leave out the same ones
    return StratifiedFolds(recordings, num_folds, repeats, seed);
  }
  // One fold per subject or setting; one fold of all strong pushes.
  std::map<std::string, Fold> by_name;
  for (int i = 0; i < total; ++i) {
    const PendulumRecording& recording = recordings[i];
    std::string key = PushedSubject(recording);
    if (scheme == FoldScheme::kSetting) key = recording.labels.setting();
    if (scheme == FoldScheme::kStrong) key = "strong";
    if (scheme == FoldScheme::kStrong && recording.labels.magnitude() != "strong") continue;
    by_name[key].name = "without " + key;
    by_name[key].held_out.push_back(i);
  }
  std::vector<Fold> folds;
  for (auto& [name, fold] : by_name) {
    if (static_cast<int>(fold.held_out.size()) < total) folds.push_back(fold);
  }
  if (folds.empty()) {
    return Error{"--scheme=" + NameOf(scheme) +
                 " leaves nothing to fit: it needs recordings of at least two pushed subjects "
                 "(subject), of two settings (setting), or recordings of magnitude 'strong' and "
                 "others (strong)"};
  }
  return folds;
}

using Json = nlohmann::ordered_json;

// The member of an object; null where it has none.
const Json& Member(const Json& object, const char* key) {
  static const Json none;
  return object.is_object() && object.contains(key) ? object[key] : none;
}

}  // namespace

Result<std::vector<Fold>> MakeFolds(const std::vector<PendulumRecording>& recordings,
                                    FoldScheme scheme, int num_folds, int repeats, uint64_t seed) {
  Result<std::vector<Fold>> folds = DrawFolds(recordings, scheme, num_folds, repeats, seed);
  if (!folds.ok()) return folds;
  // A fit to a copy of what is held out has seen it.
  std::vector<int> root = CopyOf(recordings);
  for (size_t i = 0; i < root.size(); ++i) root[i] = root[i] < 0 ? static_cast<int>(i) : root[i];
  for (Fold& fold : folds.value()) {
    std::set<int> roots;
    for (int i : fold.held_out) roots.insert(root[i]);
    std::vector<int> all;
    for (size_t i = 0; i < root.size(); ++i) {
      if (roots.count(root[i]) > 0) all.push_back(static_cast<int>(i));
    }
    if (all.size() < recordings.size()) fold.held_out = std::move(all);
  }
  return folds;
}

std::vector<int> Others(const std::vector<int>& held_out, int total) {
  std::vector<int> others;
  for (int i = 0; i < total; ++i) {
    if (!std::binary_search(held_out.begin(), held_out.end(), i)) others.push_back(i);
  }
  return others;
}

Result<std::vector<Fold>> ReadFolds(const std::string& path,
                                    const std::vector<PendulumRecording>& recordings) {
  const Result<JsonDocument> read = ReadJsonDocument(path);
  if (!read.ok()) return read.error();
  const JsonDocument& document = read.value();
  const Json& list = Member(document.content, "folds");
  if (!list.is_array() || list.empty()) {
    return document.ErrorAt("/folds", "the file needs folds, a list of at least one");
  }
  std::map<Json, int> indices;  // by id
  for (size_t i = 0; i < recordings.size(); ++i) indices[recordings[i].id] = static_cast<int>(i);
  std::vector<Fold> folds;
  std::set<std::string> names;
  for (size_t f = 0; f < list.size(); ++f) {
    const std::string at = "/folds/" + std::to_string(f), of_ids = at + "/held_out";
    const Json& name = Member(list[f], "name");
    const Json& ids = Member(list[f], "held_out");
    if (!name.is_string() || name == "") {
      return document.ErrorAt(at, "a fold needs a name, as a text");
    }
    if (!ids.is_array()) {
      return document.ErrorAt(of_ids, "a fold needs held_out, a list of ids of recordings");
    }
    std::set<int> held_out;
    for (size_t i = 0; i < ids.size(); ++i) {
      const auto found = indices.find(ids[i]);
      if (found == indices.end()) {
        return document.ErrorAt(of_ids + "/" + std::to_string(i),
                                "no recording that was loaded has the id " + ids[i].dump());
      }
      held_out.insert(found->second);
    }
    if (held_out.empty() || held_out.size() == indices.size()) {
      return document.ErrorAt(of_ids, "the fold '" + std::string(name) + "' holds out " +
                                          (held_out.empty() ? "nothing" : "everything") +
                                          "; some recordings must be fitted and others scored");
    }
    if (!names.insert(name).second) {
      return document.ErrorAt(at, "there is a fold '" + std::string(name) + "' before");
    }
    folds.push_back({name, {held_out.begin(), held_out.end()}});
  }
  return folds;
}

}  // namespace pushid
