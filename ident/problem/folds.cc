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
    strata[{recordings[i].labels.setting(), recordings[i].labels.magnitude(),
            PushedSubject(recordings[i])}]
        .push_back(i);
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

// A fit to a copy of what is held out has seen it.
void HoldOutCopies(const std::vector<PendulumRecording>& recordings, std::vector<Fold>* folds) {
  std::vector<int> root = CopyOf(recordings);
  for (size_t i = 0; i < root.size(); ++i) root[i] = root[i] < 0 ? static_cast<int>(i) : root[i];
  for (Fold& fold : *folds) {
    std::set<int> roots;
    for (int i : fold.held_out) roots.insert(root[i]);
    std::vector<int> all;
    for (size_t i = 0; i < root.size(); ++i) {
      if (roots.count(root[i]) > 0) all.push_back(static_cast<int>(i));
    }
    if (all.size() < recordings.size()) fold.held_out = std::move(all);
  }
}

using Indices = std::map<std::string, int>;

std::string Text(const nlohmann::ordered_json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return "";
  return object[key].get<std::string>();
}

// at: the fold's place.
Result<Fold> ReadFold(const JsonDocument& document, const std::string& at, const Indices& indices) {
  const nlohmann::ordered_json::json_pointer place(at);
  const nlohmann::ordered_json& json = document.content[place];
  Fold fold;
  fold.name = Text(json, "name");
  if (fold.name.empty()) return document.ErrorAt(at, "a fold needs a name, as a text");
  const std::string list = at + "/held_out";
  if (!json.contains("held_out") || !json["held_out"].is_array()) {
    return document.ErrorAt(list, "a fold needs held_out, a list of ids of recordings");
  }
  for (std::size_t i = 0; i < json["held_out"].size(); ++i) {
    const nlohmann::ordered_json& id = json["held_out"][i];
    const auto found = id.is_string() ? indices.find(id.get<std::string>()) : indices.end();
    if (found == indices.end()) {
      return document.ErrorAt(list + "/" + std::to_string(i),
                              "no recording that was loaded has the id " + id.dump());
    }
    fold.held_out.push_back(found->second);
  }
  std::sort(fold.held_out.begin(), fold.held_out.end());
  fold.held_out.erase(std::unique(fold.held_out.begin(), fold.held_out.end()), fold.held_out.end());
  if (fold.held_out.empty() || fold.held_out.size() == indices.size()) {
    return document.ErrorAt(list, std::string("the fold '") + fold.name + "' holds out " +
                                      (fold.held_out.empty() ? "nothing" : "everything") +
                                      "; some recordings must be fitted and others scored");
  }
  return fold;
}

}  // namespace

Result<std::vector<Fold>> MakeFolds(const std::vector<PendulumRecording>& recordings,
                                    FoldScheme scheme, int num_folds, int repeats, uint64_t seed) {
  Result<std::vector<Fold>> folds = DrawFolds(recordings, scheme, num_folds, repeats, seed);
  if (folds.ok()) HoldOutCopies(recordings, &folds.value());
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
  Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  const nlohmann::ordered_json& content = document.value().content;
  if (!content.is_object() || !content.contains("folds") || !content["folds"].is_array() ||
      content["folds"].empty()) {
    return document.value().ErrorAt("/folds", "the file needs folds, a list of at least one");
  }
  Indices indices;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    indices[recordings[i].id] = static_cast<int>(i);
  }
  std::vector<Fold> folds;
  std::set<std::string> names;
  for (std::size_t i = 0; i < content["folds"].size(); ++i) {
    const std::string at = "/folds/" + std::to_string(i);
    Result<Fold> fold = ReadFold(document.value(), at, indices);
    if (!fold.ok()) return fold.error();
    if (!names.insert(fold.value().name).second) {
      return document.value().ErrorAt(at, "there is a fold '" + fold.value().name + "' before");
    }
    folds.push_back(std::move(fold.value()));
  }
  return folds;
}

}  // namespace pushid
