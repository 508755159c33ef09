// apps: pushid-crossvalidate: how well configurations predict recordings they have not seen.
#include <gflags/gflags.h>

#include <cstdio>
#include <memory>
#include <set>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/fit_flag_checks.h"
#include "apps/flags/fit_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "ident/parameters/option_names.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/validation/frontier_svg.h"
#include "ident/validation/predictors.h"
#include "ident/validation/scores_json.h"
#include "ident/validation/scores_text.h"

DECLARE_uint64(seed);

DEFINE_string(scheme, "stratified",
              "what is held out: stratified (folds by setting, strength and subject), "
              "subject or setting (one at a time), strong (all strong pushes)");
DEFINE_int32(folds, 4, "folds of the stratified scheme");
DEFINE_int32(repeats, 5, "repeats of the stratified scheme, each with new folds");
DEFINE_string(
    compare, "",
    "candidate configurations, semicolon-separated: name: --flag=value ... added to the flags "
    "given, as in 'pd: --preset=ldp; linear: --self_force=linear'");
DEFINE_bool(yardsticks, true, "also static, constant velocity and ridge regression");
DEFINE_string(frontier_out, "",
              "draw accuracy against settling, a point for each configuration, here (SVG)");
DEFINE_bool(bands, false,
            "also how often predictive 50 and 90 % bands hold the recordings that were not fitted");
DEFINE_string(json_out, "", "write the scores here (JSON)");

namespace {

using namespace pushid;
using Predictors = std::vector<std::unique_ptr<Predictor>>;

std::string Trim(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

MaybeError AddCandidates(Predictors* predictors) {
  std::stringstream list(FLAGS_compare);
  for (std::string item; std::getline(list, item, ';');) {
    if (Trim(item).empty()) continue;
    const size_t colon = item.find(':');
    if (colon == std::string::npos || Trim(item.substr(0, colon)).empty()) {
      return Error{"--compare: '" + Trim(item) + "' is not 'name: --flag=value ...'"};
    }
    const std::string name = Trim(item.substr(0, colon));
    const Result<FitOptions> options = FitOptionsWith(item.substr(colon + 1));
    if (!options.ok()) return Error{"--compare, '" + name + "': " + options.error().message};
    predictors->push_back(std::make_unique<ModelPredictor>(name, options.value()));
  }
  return std::nullopt;
}

// Two of one name could not be told apart in the tables.
MaybeError CheckNames(const Predictors& predictors) {
  std::set<std::string> names;
  for (const auto& predictor : predictors) {
    if (names.insert(predictor->name).second) continue;
    return Error{"--compare: there is more than one '" + predictor->name +
                 "'; name the configurations differently"};
  }
  return std::nullopt;
}

int Run() {
  const Result<FitOptions> options = FitOptionsFromFlags();
  if (!options.ok()) return Fail(options.error());
  FoldScheme scheme{};
  if (MaybeError error = ParseName("--scheme", FLAGS_scheme, &scheme)) return Fail(*error);
  Predictors predictors;
  predictors.push_back(std::make_unique<ModelPredictor>(options.value().preset, options.value()));
  if (MaybeError error = AddCandidates(&predictors)) return Fail(*error);
  if (FLAGS_yardsticks) {
    predictors.push_back(std::make_unique<RidgePredictor>("ridge"));
    predictors.push_back(std::make_unique<BaselinePredictor>("static", StaticBaseline));
    predictors.push_back(
        std::make_unique<BaselinePredictor>("constant velocity", ConstantVelocityBaseline));
  }
  if (MaybeError error = CheckNames(predictors)) return Fail(*error);
  for (const std::string& warning : FlagWarnings(options.value())) Warn(warning);
  for (const std::string& file : {FLAGS_json_out, FLAGS_frontier_out}) {
    if (file.empty()) continue;
    if (MaybeError error = CheckWritable(file)) return Fail(*error);
  }
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings();
  if (!recordings.ok()) return Fail(recordings.error());
  if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  const std::vector<PendulumRecording> pendulums =
      MapRecordings(recordings.value(), options.value().mapping);
  const Result<std::vector<Fold>> folds =
      MakeFolds(pendulums, scheme, FLAGS_folds, FLAGS_repeats, FLAGS_seed);
  if (!folds.ok()) return Fail(folds.error());

  std::vector<CrossValidation> validations;
  ProgressLine line;
  for (const auto& predictor : predictors) {
    validations.push_back(
        CrossValidate(pendulums, folds.value(), *predictor, NumThreads(), [&](int done, int total) {
          line.Show(predictor->name + ": fold " + std::to_string(done) + " of " +
                    std::to_string(total));
        }));
  }
  std::vector<BandCoverage> bands;
  if (FLAGS_bands) {
    BandOptions asked;
    asked.seed = FLAGS_seed;
    bands = CrossValidateBands(
        pendulums, folds.value(), options.value(), asked, NumThreads(),
        [&line](int done, int total) {
          line.Show("bands: fold " + std::to_string(done) + " of " + std::to_string(total));
        });
  }
  line.Finish();
  std::printf("%s", CrossValidationText(validations).c_str());
  if (!FLAGS_frontier_out.empty()) {
    const std::string svg = FrontierSvg(validations);
    if (MaybeError error = WriteFileAtomically(FLAGS_frontier_out, svg)) return Fail(*error);
  }
  if (FLAGS_bands) std::printf("\n%s", BandCoverageText(bands).c_str());
  if (!FLAGS_json_out.empty()) {
    nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
    for (const CrossValidation& validation : validations) {
      json["predictors"].push_back(ToJson(validation));
      if (&validation != &validations[0]) {
        json["paired_differences"].push_back(ToJson(Compare(validations[0], validation)));
      }
    }
    if (MaybeError error = WriteJson(FLAGS_json_out, json)) return Fail(*error);
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-crossvalidate fits on some recordings and scores the predictions of "
      "the others.\n\n  pushid-crossvalidate --recordings=M/manifest.json "
      "--setting=single --compare='pd: --preset=ldp'",
      Run);
}
