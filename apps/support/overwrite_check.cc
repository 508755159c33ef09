// apps: outputs against inputs.
#include "apps/support/overwrite_check.h"

#include <gflags/gflags.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "datasets/files/text_ends.h"
#include "datasets/manifest/merged_manifest.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInputs[] = {
    "recordings", "model",    "physics",  "truth",   "self_from", "interaction_network",
    "poses_from", "sensor",   "masses",   "sensors", "mapping",   "generator",
    "plan",       "flagfile", "formation"};

struct NamedPath {
  std::string name, path;
  std::string help;  // of the flag
};

std::vector<NamedPath> Outputs() {
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  std::vector<NamedPath> outputs;
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (!IsOutputFlag(flag.name) || flag.current_value.empty()) continue;
    outputs.push_back({"--" + flag.name, flag.current_value, flag.description});
  }
  return outputs;
}

// Through symbolic and hard links too; a file need not exist.
bool Same(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed) && !failed) return true;
  const auto whole = [](const std::string& path) {
    std::error_code ignored;
    std::string text = fs::weakly_canonical(fs::absolute(path), ignored).string();
    if (text.size() > 1 && text.back() == '/') text.pop_back();
    return text;
  };
  return whole(a) == whole(b);
}

Error BothName(const std::string& a, const std::string& b, const std::string& path) {
  return Error{a + " and " + b + " both name " + path + "; give each a file of its own"};
}

// What a flag writes is told by its name or, of pages and pictures, by its help in brackets.
struct OutputKind {
  const char *flag, *help, *ending;
};
constexpr OutputKind kKinds[] = {{"svg_out", "(SVG", ".svg"},
                                 {"html_out", "(HTML", ".html"},
                                 {"csv_out", nullptr, ".csv"},
                                 {"json_out", nullptr, ".json"}};

bool Writes(const NamedPath& output, const OutputKind& kind) {
  return EndsWith(output.name, kind.flag) ||
         (kind.help != nullptr && output.help.find(kind.help) != std::string::npos);
}

// A page under the name of a picture, say.
MaybeError CheckKind(const NamedPath& output) {
  for (const OutputKind& kind : kKinds) {
    if (!Writes(output, kind) || EndsWith(output.path, kind.ending)) continue;
    for (const OutputKind& other : kKinds) {
      if (!EndsWith(output.path, other.ending) || Writes(output, other)) continue;
      return Error{output.name + " writes " + kind.ending + ", but " + output.path + " ends in " +
                   other.ending};
    }
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckOutputs() {
  const std::vector<NamedPath> outputs = Outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (!Same(outputs[i].path, outputs[k].path)) continue;
      return BothName(outputs[k].name, outputs[i].name, outputs[i].path);
    }
  }
  for (const char* input : kInputs) {
    gflags::CommandLineFlagInfo flag;
    const bool known = gflags::GetCommandLineFlagInfo(input, &flag);
    if (!known || flag.is_default || flag.current_value.empty()) continue;
    // A formation may be a word as well as a file.
    if (flag.name == "formation" && !fs::is_regular_file(flag.current_value)) continue;
    for (const std::string& path : ManifestPaths(flag.current_value)) {
      if (MaybeError error = CheckNoOutput("--" + flag.name, path)) return error;
    }
  }
  for (const NamedPath& output : outputs) {
    if (MaybeError error = CheckKind(output)) return error;
  }
  return std::nullopt;
}

MaybeError CheckNoOutput(const std::string& reader, const std::string& path) {
  for (const NamedPath& output : Outputs()) {
    if (Same(output.path, path)) return BothName(reader, output.name, path);
  }
  return std::nullopt;
}

}  // namespace pushid
