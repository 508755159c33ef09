// apps: expanding plans.
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/batch/batch.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/manifest/manifest.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {
namespace {

// A separator that no id holds, so that "ab","c" and "a","bc" differ.
void AddPiece(const std::string& text, ContentHash* hash) {
  hash->Add(text);
  hash->Add(std::string_view("\0", 1));
}

// Adds the contents of every file that a manifest's entry names. Every text that is a file's name
// counts, whatever its key.
void HashFiles(const nlohmann::ordered_json& json, const std::string& manifest, ContentHash* hash) {
  if (json.is_structured()) {
    for (const auto& part : json) HashFiles(part, manifest, hash);
  }
  if (!json.is_string()) return;
  const std::string path = ResolvePath(manifest, json.get<std::string>());
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) AddPiece(OrFail(HashFile(path)), hash);
}

// Hash of what a manifest says about all its recordings, or about one.
std::string HashOf(const nlohmann::ordered_json& json, const std::string& manifest) {
  ContentHash hash;
  AddPiece(json.dump(), &hash);
  HashFiles(json, manifest, &hash);
  return hash.Hex();
}

std::string FlagsHash(const BatchVariant& variant) {
  ContentHash hash;
  for (const std::string& flag : variant.flags) AddPiece(flag, &hash);
  if (variant.restoration) AddPiece("restoration", &hash);
  for (const std::string& flag : variant.restoration.value_or(std::vector<std::string>{})) {
    AddPiece(flag, &hash);
  }
  return hash.Hex();
}

std::string GroupOf(const std::string& by, const ManifestRecording& entry) {
  if (by == "none") return "all";
  if (by == "recording") return entry.id;
  if (by == "subject") return entry.subjects[entry.pushed_person].id;
  return entry.labels.Of(by);
}

// A recording with all that MakeFolds looks at.
PendulumRecording AsKnown(const ManifestRecording& entry) {
  PendulumRecording recording;
  recording.id = entry.id;
  recording.labels = entry.labels;
  recording.pushed_person = entry.pushed_person;
  for (const ManifestSubject& subject : entry.subjects) {
    recording.subject_ids.push_back(subject.id);
  }
  return recording;
}

struct Part {
  std::string group, name;
  std::vector<int> train, held_out;  // indices into the manifest
};

std::vector<Part> PartsOf(const BatchPlan& plan, const Manifest& manifest, const std::string& group,
                          const std::vector<int>& members) {
  if (plan.folds == 0) return {{group, group, members, {}}};
  std::vector<PendulumRecording> known;
  for (int i : members) known.push_back(AsKnown(manifest.recordings[i]));
  const auto folds = MakeFolds(known, FoldScheme::kStratified, plan.folds, 1, plan.seed);
  if (!folds.ok()) {
    throw plan.ErrorAt("folds", Error{"group '" + group + "' in " + std::to_string(plan.folds) +
                                      " folds: " + folds.error().message});
  }
  std::vector<Part> parts;
  for (size_t f = 0; f < folds.value().size(); ++f) {
    Part part{group,
              group + " fold " + std::to_string(f + 1) + " of " + std::to_string(plan.folds),
              {},
              {}};
    const std::vector<int>& out = folds.value()[f].held_out;
    for (int k = 0; k < static_cast<int>(members.size()); ++k) {
      const bool held = std::find(out.begin(), out.end(), k) != out.end();
      (held ? part.held_out : part.train).push_back(members[k]);
    }
    parts.push_back(part);
  }
  return parts;
}

std::vector<std::string> Those(const std::vector<std::string>& flags,
                               const std::vector<const char*>& names) {
  std::vector<std::string> those;
  for (const std::string& flag : flags) {
    for (const char* name : names) {
      if (flag.rfind("--" + std::string(name) + "=", 0) == 0) those.push_back(flag);
    }
  }
  return those;
}

using Command = std::vector<std::string>;

void Append(const Command& more, Command* command) {
  command->insert(command->end(), more.begin(), more.end());
}

// The flags of every program after the fit: recordings are read as the fitted ones were.
Command AfterFit(const std::string& program, const BatchJob& job, const BatchPlan& plan,
                 const std::vector<std::string>& ids, const std::string& model) {
  Command command = {program, "--model=" + model, "--recordings=" + plan.manifest,
                     "--ids=" + Joined(ids, ","), "--quiet"};
  Append(Those(job.fit_flags, {std::begin(kLoadFlags), std::end(kLoadFlags)}), &command);
  return command;
}

class Expander {
 public:
  Expander(const BatchPlan& plan, const Manifest& manifest) : plan_(plan), manifest_(manifest) {}

  std::vector<BatchJob> Expand() {
    const std::vector<int> chosen = Chosen();
    common_hash_ = HashOf(*manifest_.json, manifest_.path);
    hashes_.resize(manifest_.recordings.size());
    std::vector<std::pair<std::string, std::vector<int>>> groups;
    for (int i : chosen) {
      const ManifestRecording& entry = manifest_.recordings[i];
      hashes_[i] = HashOf(*entry.json, entry.manifest);
      const std::string name = GroupOf(plan_.group_by, entry);
      if (name.empty()) {
        throw plan_.ErrorAt("group_by",
                            Error{"must be none, recording, subject or a label; recording " +
                                  Quoted(entry.id) + " has no label " + Quoted(plan_.group_by)});
      }
      ValueOf(name, &groups).push_back(i);
    }
    for (const BatchVariant& variant : plan_.variants) {
      const std::string flags = FlagsHash(variant);
      for (const auto& [name, members] : groups) {
        for (const Part& part : PartsOf(plan_, manifest_, name, members)) {
          AddPart(variant, flags, part);
        }
      }
    }
    return jobs_;
  }

 private:
  // Keys are checked one by one, so that the wrong one can be named.
  std::vector<int> Chosen() const {
    const auto by = [this](const char* key, const std::vector<std::string>& ids,
                           const std::vector<std::string>& leave_out) {
      const auto selected = SelectRecordings(manifest_, plan_.setting, ids, leave_out);
      if (!selected.ok()) throw plan_.ErrorAt(key, selected.error());
      return selected.value();
    };
    by("setting", {}, {});
    by("ids", plan_.ids, {});
    return by("leave_out", plan_.ids, plan_.leave_out);
  }

  void AddPart(const BatchVariant& variant, const std::string& flags_hash, const Part& part) {
    for (int replica = 0; replica <= plan_.bootstrap; ++replica) {
      BatchJob job;
      job.variant = variant.name;
      job.group = part.name;
      if (!part.held_out.empty()) job.folded = part.group;
      job.replica = replica;
      for (int i : part.train) job.recordings.push_back(manifest_.recordings[i].id);
      for (int i : part.held_out) job.held_out.push_back(manifest_.recordings[i].id);
      job.fit_flags = variant.flags;
      job.fit_flags.push_back("--seed=" + std::to_string(plan_.seed));
      if (replica > 0) job.fit_flags.push_back("--replica=" + std::to_string(replica));
      job.restoration_flags = variant.restoration;
      if (job.restoration_flags) {
        job.restoration_flags->push_back("--seed=" + std::to_string(plan_.seed));
      }
      ContentHash hash;
      AddPiece(Version(), &hash);
      AddPiece(flags_hash, &hash);
      AddPiece(common_hash_, &hash);
      AddPiece(std::to_string(plan_.seed) + "/" + std::to_string(replica), &hash);
      for (int i : part.train) AddPiece(hashes_[i], &hash);
      AddPiece("held out", &hash);
      for (int i : part.held_out) AddPiece(hashes_[i], &hash);
      job.id = hash.Hex();
      jobs_.push_back(std::move(job));
    }
  }

  const BatchPlan& plan_;
  const Manifest& manifest_;
  std::string common_hash_;
  std::vector<std::string> hashes_;
  std::vector<BatchJob> jobs_;
};

}  // namespace

std::vector<BatchJob> ExpandPlan(const BatchPlan& plan, const Manifest& manifest) {
  return Expander(plan, manifest).Expand();
}

std::vector<std::vector<std::string>> JobCommands(const BatchJob& job, const BatchPlan& plan,
                                                  const std::string& folder,
                                                  const std::string& bin) {
  const std::string model = folder + "/model.json", restoration = folder + "/restoration";
  Command fit = {bin + "/pushid-fit", "--recordings=" + plan.manifest,
                 "--ids=" + Joined(job.recordings, ","), "--model_out=" + model, "--quiet"};
  Append(job.fit_flags, &fit);
  std::vector<Command> commands = {fit};
  if (job.restoration_flags) {
    Command train = AfterFit(bin + "/pushid-train-restoration", job, plan, job.recordings, model);
    train.push_back("--out=" + restoration);
    Append(*job.restoration_flags, &train);
    commands.push_back(train);
  }
  if (job.held_out.empty()) return commands;
  Command evaluate = AfterFit(bin + "/pushid-evaluate", job, plan, job.held_out, model);
  evaluate.push_back("--json_out=" + folder + "/scores.json");
  if (job.restoration_flags) {
    evaluate.push_back("--restoration=" + restoration);
    Append(Those(*job.restoration_flags, {"postprocess"}), &evaluate);
  }
  commands.push_back(evaluate);
  return commands;
}

std::vector<BatchJob> Shard(const std::vector<BatchJob>& jobs, int i, int n) {
  std::vector<BatchJob> part;
  std::map<std::string, size_t> order;  // of first appearance
  for (const BatchJob& job : jobs) {
    const size_t k = order.emplace(job.id, order.size()).first->second;
    if (k % static_cast<size_t>(n) + 1 == static_cast<size_t>(i)) part.push_back(job);
  }
  return part;
}

}  // namespace pushid
