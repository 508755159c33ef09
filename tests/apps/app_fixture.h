// A fixture: small synthetic recordings as a user has them (manifest, BVH, push CSV), and a model
// fitted to them.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "datasets/files/json_file.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "tests/apps/run_app.h"
#include "tests/test_support.h"

namespace pushid {

class AppTest : public TempDirTest {
 protected:
  // Two people, three strengths, two pushes of each; 2 mm of noise at the joints.
  void SetUp() override {
    TempDirTest::SetUp();
    SyntheticOptions options;
    options.subjects = 2;
    options.recordings_per_subject = 6;
    options.frames = 45;
    options.joint_noise_m = 0.002;
    const auto made = Unwrapped(MakeSyntheticRecordings(options));
    ASSERT_EQ(ProblemOf(WriteSyntheticRecordings(folder_.string(), options, made)), "no error");
    id_ = made[0].recording.id;
    manifest_ = Path("manifest.json");
  }

  std::string Recordings() const { return "--recordings=" + manifest_; }

  // pushid-fit on the recordings, with the model in `name`; returns the model's path.
  std::string FitModel(const std::string& name = "model.json",
                       const std::vector<std::string>& more = {}) {
    fit_ = Succeeded(
        RunApp("pushid-fit", With({Recordings(), "--model_out=" + Path(name), "--details"}, more)));
    return Path(name);
  }

  // A fitted model with checks added.
  std::string CheckedModel(const std::vector<std::string>& checks,
                           const std::string& name = "model.json") {
    const std::string model = FitModel(name);
    Succeeded(RunApp("pushid-check", With({"--model=" + model, Recordings()}, checks)));
    return model;
  }

  static nlohmann::ordered_json Json(const std::string& path) {
    return Unwrapped(ReadJsonDocument(path)).content;
  }

  // The manifest with something changed, under its own name; returns --recordings=... for it.
  template <typename Change>
  std::string ChangedManifest(Change change) {
    nlohmann::ordered_json json = Json(manifest_);
    change(json);
    return "--recordings=" + WriteText("changed.json", json.dump(1));
  }

  std::string manifest_;
  std::string id_;  // of the first recording
  AppRun fit_;      // the last FitModel
};

// Text without its line breaks: those of sentences, and those of commands.
inline std::string OneLine(const std::string& text) {
  return std::regex_replace(text, std::regex(R"((\s\\)?\s+)"), " ");
}

// The app refused: exit 1, one line on stderr that says all of `says`, nothing on stdout.
inline ::testing::AssertionResult Refused(const AppRun& run, const std::vector<std::string>& says) {
  const auto failure = [&run] {
    return ::testing::AssertionFailure()
           << "exit " << run.exit_code << (run.timed_out ? ", out of time" : "")
           << (run.signal != 0 ? ", signal " + std::to_string(run.signal) : "")
           << "\nstdout: " << run.out << "\nstderr: " << run.err << "\n";
  };
  if (run.exit_code != 1) return failure() << "exit code 1 is expected";
  if (!run.out.empty()) return failure() << "nothing is expected on stdout";
  if (run.err.empty() || run.err.find('\n') != run.err.size() - 1) {
    return failure() << "one line is expected on stderr";
  }
  for (const std::string& part : says) {
    if (run.err.find(part) == std::string::npos) return failure() << "'" << part << "' is missing";
  }
  return ::testing::AssertionSuccess();
}

}  // namespace pushid
