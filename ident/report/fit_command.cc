// ident: flags of a result as a command line.
#include "ident/report/fit_command.h"

#include <algorithm>
#include <cstring>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Stands for the recordings where the provenance does not know their place.
constexpr char kSomeManifest[] = "M/manifest.json";
// Stands for the model's file in every command: the same fit in another file has the same advice.
constexpr char kModelFlag[] = "--model=FILE";

std::string ManifestOf(const Provenance& provenance) {
  return provenance.manifest.empty() ? kSomeManifest : provenance.manifest;
}

// gflags writes 0.2 as 0.20000000000000001.
std::string Shortest(const std::string& value) {
  double number = 0.0;
  const bool fraction = value.find_first_of(".e") != std::string::npos;
  if (!fraction || !ParseDouble(value, &number)) return value;
  const std::string shortest = DoubleText(number);
  return shortest.size() < value.size() ? shortest : value;
}

std::string ShellQuoted(const std::string& value) {
  constexpr char kPlain[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%[]";
  if (value.find_first_not_of(kPlain) == std::string::npos) return value;
  std::string quoted = "'";
  for (const char c : value) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

const std::vector<std::string>& CheckFlagNames() {
  static const std::vector<std::string> names = {"profile", "bootstrap",  "horizon_check",
                                                 "design",  "learn_forecasts"};
  return names;
}

FitCommand FitCommand::Check(const Provenance& provenance) {
  FitCommand command(std::string("pushid-check ") + kModelFlag);
  return command.Set("recordings", ManifestOf(provenance));
}

FitCommand::FitCommand(std::string program, const Provenance& provenance)
    : program_(std::move(program)) {
  Set("recordings", ManifestOf(provenance));
  // The recordings and the model first, the rest by name.
  std::vector<std::string> names = {"setting", "ids", "leave_out", "preset"};
  for (const std::string& name : provenance.changed_flags) {
    const bool leads = std::find(names.begin(), names.begin() + 4, name) != names.begin() + 4;
    const std::vector<std::string>& checks = CheckFlagNames();
    const bool checked = std::find(checks.begin(), checks.end(), name) != checks.end();
    if (!leads && !checked) names.push_back(name);
  }
  for (const std::string& name : names) {
    const auto& changed = provenance.changed_flags;
    const auto at = provenance.configuration.find(name);
    if (at == provenance.configuration.end()) continue;
    if (std::find(changed.begin(), changed.end(), name) == changed.end()) continue;
    Set(name, Shortest(at->second));
  }
}

std::string* FitCommand::Find(const std::string& flag) {
  for (auto& [name, value] : flags_) {
    if (name == flag) return &value;
  }
  return nullptr;
}

FitCommand& FitCommand::Set(const std::string& flag, const std::string& value) {
  if (std::string* known = Find(flag)) {
    *known = value;
  } else {
    flags_.emplace_back(flag, value);
  }
  return *this;
}

std::string FitCommand::Appended(const std::string& flag, const std::string& item) const {
  for (const auto& [name, value] : flags_) {
    if (name == flag && !value.empty()) return value + "," + item;
  }
  return item;
}

void FitCommand::TakeOut(const std::string& flag, const std::string& name, const char* without) {
  std::string* const list = Find(flag);
  if (list == nullptr) return;
  std::string kept;
  bool found = false;
  for (const std::string& item : SplitList(*list)) {
    const bool it = item.substr(0, item.find('=')) == name;
    found = found || it;
    if (!it) kept += (kept.empty() ? "" : ",") + item;
  }
  if (found) *list = kept.empty() ? without : kept;
}

FitCommand& FitCommand::Append(const std::string& flag, const std::string& item) {
  if (flag == "fix") {
    const std::string name = item.substr(0, item.find('='));
    TakeOut("free", name, "");
    TakeOut("pool", name, "none");
  }
  return Set(flag, Appended(flag, item));
}

std::string FitCommand::ToString() const {
  std::string text = program_;
  for (const auto& [flag, value] : flags_) text += " --" + flag + "=" + ShellQuoted(value);
  return text;
}

bool NamesModel(const std::string& command) {
  return command.find(kModelFlag) != std::string::npos;
}

std::string CommandFor(const Provenance& provenance, std::string command) {
  const size_t at = command.find(kModelFlag);
  if (at == std::string::npos || provenance.model_file.empty()) return command;
  return command.replace(at, std::strlen(kModelFlag),
                         "--model=" + ShellQuoted(provenance.model_file));
}

}  // namespace pushid
