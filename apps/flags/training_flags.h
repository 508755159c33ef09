// apps: flags and functions of the programs that train networks.
#pragma once

#include <functional>

#include "apps/flags/command_line.h"
#include "datasets/files/json_file.h"
#include "ident/training/restoration_training.h"
#include "ident/validation/scores_report.h"

DEFINE_string(out, "", "folder to write: the network (JSON) and weights.npy");
DEFINE_int32(crossvalidate, 0,
             "number of folds: instead of writing a network, train (and refit the pendulum) in "
             "every fold and score the held-out recordings; 0: off");
DEFINE_string(scheme, pushid::NameOf(pushid::FoldScheme::kStratified),
              "--crossvalidate: stratified (folds by setting, strength and subject) or interleaved "
              "(recordings of a setting assigned to folds in turn)");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_uint64(seed, pushid::TrainerOptions{}.seed, "seed of weights, batches, noise and folds");
DEFINE_int32(num_threads, pushid::TrainerOptions{}.num_threads,
             "threads of the training; only a single thread is bit-reproducible");

namespace pushid {

// "kind of restoration: window (fast, default), cvae (LDP's chain)"
template <typename Rows, typename Keep>
std::string KindHelp(const std::string& noun, const Rows& rows, Keep keep) {
  std::vector<std::string> kinds;
  for (const auto& row : rows) {
    if (keep(row)) kinds.push_back(std::string(row.name) + " (" + row.what + ")");
  }
  return "kind of " + noun + ": " + Joined(kinds);
}

// Throws where flags contradict each other.
inline FoldChoice FoldsFromCommandLine() {
  FoldChoice choice = {FoldScheme::kStratified, FLAGS_crossvalidate, FLAGS_seed};
  OrFail(ParseName("--scheme", FLAGS_scheme, &choice.scheme));
  if (FLAGS_crossvalidate == 0) {
    Require("out", FLAGS_out, "name the folder to write");
    if (Given("scheme")) throw Error{"--scheme needs --crossvalidate"};
  } else if (FLAGS_crossvalidate < 2) {
    throw Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  return choice;
}

// Prints and writes the scores of a cross-validation.
inline int ScoreFolds(const std::function<Result<BodyValidation>(const RunProgress&)>& validate) {
  TrainingLine line;
  const BodyValidation validation =
      OrFail(validate([&](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  std::printf("%s", BodyText(validation.evaluation).c_str());
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.evaluation, &json);
  json["run"] = {{"training_seconds", validation.training_seconds}};
  WriteIfNamed(FLAGS_json_out, json);
  return kDone;
}

inline std::string InOut(const char* name) {
  return (std::filesystem::path(FLAGS_out) / name).string();
}

// Makes the folder --out and checks that weights can be written there.
inline void MakeOut() {
  OrFail(MakeFolder(FLAGS_out));
  OrFail(CheckWritable(InOut("weights.npy")));
}

// The training as a network's file describes it, with `data` as `key`.
inline nlohmann::ordered_json TrainingJson(const char* key, const nlohmann::ordered_json& data) {
  nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  json[key] = data;
  return json;
}

inline nlohmann::ordered_json JsonOfData(const std::vector<BodyRecording>& recordings) {
  nlohmann::ordered_json data = nlohmann::ordered_json::array();
  for (const BodyRecording& recording : recordings) {
    data.push_back(
        {{"id", recording.pendulum.id}, {"content_hash", recording.pendulum.content_hash}});
  }
  return data;
}

}  // namespace pushid
