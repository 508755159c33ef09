// ident: reading folds.
#include "ident/problem/fold_file.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/json_file.h"

namespace pushid {
namespace {

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
