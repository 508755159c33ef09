// apps: reading plans.
#include "apps/batch_plan.h"

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace pushid {
namespace {

// Set by the batch for every job.
const std::set<std::string> kOwnFlags = {"recordings", "setting",  "ids",   "leave_out",
                                         "model_out",  "resample", "quiet", "num_threads",
                                         "seed",       "flagfile"};

class PlanReader {
 public:
  PlanReader(const std::string& path, const toml::table& root) : path_(path), root_(root) {
    plan_.path = path;
  }

  Result<BatchPlan> Read() {
    Known(root_, "the plan", {"data", "jobs", "variant", "output"});
    Data();
    Jobs();
    Variants();
    Output();
    if (error_) return *error_;
    return plan_;
  }

 private:
  // The first error is the one that is told.
  void Fail(const toml::node& at, const std::string& message) {
    if (!error_) error_ = Error{message, path_, static_cast<int>(at.source().begin.line)};
  }

  void Known(const toml::table& table, const std::string& what,
             const std::vector<std::string>& keys) {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
      std::string list;
      for (const std::string& known : keys) list += (list.empty() ? "" : ", ") + known;
      Fail(value, what + " has no key '" + name + "'; it may have " + list);
    }
  }

  const toml::table* Table(const char* name, bool needed) {
    const toml::node* node = root_.get(name);
    if (node == nullptr) {
      if (needed) Fail(root_, "the plan has no [" + std::string(name) + "]");
      return nullptr;
    }
    if (!node->is_table()) Fail(*node, std::string(name) + " must be a table: [" + name + "]");
    return node->as_table();
  }

  // Leaves *value alone where the key is absent.
  template <typename T>
  void Get(const toml::table& table, const char* key, const char* kind, T* value) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    const auto found = node->value_exact<T>();
    if (!found) return Fail(*node, std::string(key) + " must be " + kind);
    *value = *found;
  }

  void GetStrings(const toml::table& table, const char* key, std::vector<std::string>* values) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    const std::string wrong = std::string(key) + " must be a list of texts: [\"...\"]";
    if (!node->is_array()) return Fail(*node, wrong);
    for (const toml::node& entry : *node->as_array()) {
      const auto text = entry.value_exact<std::string>();
      if (!text) return Fail(entry, wrong);
      values->push_back(*text);
    }
  }

  void GetCount(const toml::table& table, const char* key, int64_t most, int* value) {
    int64_t count = *value;
    Get(table, key, "a whole number", &count);
    if (count < 0 || count > most) {
      return Fail(*table.get(key), std::string(key) + " is " + std::to_string(count) +
                                       "; it must lie between 0 and " + std::to_string(most));
    }
    *value = static_cast<int>(count);
  }

  std::string Resolve(const std::string& file) const {
    return (std::filesystem::path(path_).parent_path() / file).string();
  }

  void Data() {
    const toml::table* data = Table("data", true);
    if (data == nullptr) return;
    Known(*data, "[data]", {"recordings", "setting", "ids"});
    std::string manifest;
    Get(*data, "recordings", "a text: the manifest's path", &manifest);
    if (manifest.empty()) Fail(*data, "[data] needs recordings = \"M/manifest.json\"");
    plan_.manifest = Resolve(manifest);
    Get(*data, "setting", "a text", &plan_.setting);
    GetStrings(*data, "ids", &plan_.ids);
  }

  void Jobs() {
    const toml::table* jobs = Table("jobs", false);
    if (jobs == nullptr) return;
    Known(*jobs, "[jobs]",
          {"group_by", "folds", "bootstrap", "seed", "time_limit_s", "memory_limit_mb"});
    std::string group_by = "none";
    Get(*jobs, "group_by", "a text", &group_by);
    const std::vector<std::pair<std::string, GroupBy>> names = {{"none", GroupBy::kNone},
                                                                {"recording", GroupBy::kRecording},
                                                                {"subject", GroupBy::kSubject},
                                                                {"setting", GroupBy::kSetting}};
    bool known = false;
    for (const auto& [name, value] : names) {
      if (name != group_by) continue;
      plan_.group_by = value;
      known = true;
    }
    if (!known) {
      Fail(*jobs->get("group_by"),
           "group_by is '" + group_by + "'; it must be none, recording, subject or setting");
    }
    GetCount(*jobs, "folds", 1000, &plan_.folds);
    if (plan_.folds == 1) Fail(*jobs->get("folds"), "folds is 1; it must be 0 or at least 2");
    GetCount(*jobs, "bootstrap", 1000000, &plan_.bootstrap);
    GetCount(*jobs, "memory_limit_mb", 1 << 24, &plan_.memory_limit_mb);
    int64_t seed = 1;
    Get(*jobs, "seed", "a whole number", &seed);
    if (seed < 0) Fail(*jobs->get("seed"), "seed must not be negative");
    plan_.seed = static_cast<uint64_t>(seed);
    TimeLimit(*jobs);
  }

  void TimeLimit(const toml::table& jobs) {
    const toml::node* limit = jobs.get("time_limit_s");
    if (limit == nullptr) return;
    const auto seconds = limit->value<double>();  // 60 is as good as 60.0
    if (!limit->is_number() || !seconds || !(*seconds >= 0.0)) {
      return Fail(*limit, "time_limit_s must be a number of seconds, 0 for none");
    }
    plan_.time_limit_s = *seconds;
  }

  void Variants() {
    const toml::node* node = root_.get("variant");
    if (node == nullptr || !node->is_array_of_tables()) {
      return Fail(node == nullptr ? root_ : *node,
                  "the plan needs at least one [[variant]] with a name and flags");
    }
    std::set<std::string> names;
    for (const toml::node& entry : *node->as_array()) {
      const toml::table& table = *entry.as_table();
      Known(table, "[[variant]]", {"name", "flags"});
      BatchVariant variant;
      Get(table, "name", "a text", &variant.name);
      if (variant.name.empty()) Fail(table, "a [[variant]] needs a name");
      if (!names.insert(variant.name).second) {
        Fail(table, "two variants are called '" + variant.name + "'");
      }
      GetStrings(table, "flags", &variant.flags);
      for (const std::string& flag : variant.flags) CheckFlag(table, flag);
      plan_.variants.push_back(variant);
    }
  }

  void CheckFlag(const toml::table& table, const std::string& flag) {
    if (flag.rfind("--", 0) != 0) {
      return Fail(table, "'" + flag + "' is no flag; write \"--name=value\"");
    }
    const std::string name = flag.substr(2, flag.find('=') - 2);
    if (kOwnFlags.count(name) == 1) {
      Fail(table, "--" + name + " is set by the batch itself for every job");
    }
  }

  void Output() {
    const toml::table* output = Table("output", true);
    if (output == nullptr) return;
    Known(*output, "[output]", {"dir"});
    std::string dir;
    Get(*output, "dir", "a text", &dir);
    if (dir.empty()) Fail(*output, "[output] needs dir = \"out\"");
    plan_.dir = Resolve(dir);
  }

  const std::string& path_;
  const toml::table& root_;
  BatchPlan plan_;
  MaybeError error_;
};

}  // namespace

Result<BatchPlan> ReadPlan(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Error{"cannot be read: no such file", path};
  }
  const toml::parse_result parsed = toml::parse_file(path);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    return Error{std::string(error.description()), path,
                 static_cast<int>(error.source().begin.line)};
  }
  return PlanReader(path, parsed.table()).Read();
}

}  // namespace pushid
