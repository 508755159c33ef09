// apps: pushid-crossvalidate: how well configurations predict recordings they have not seen.
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/fit_option_flags.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/json_file.h"
#include "ident/parameters/presets.h"
#include "ident/problem/folds.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/scores_report.h"

DEFINE_string(scheme, pushid::NameOf(pushid::FoldScheme::kStratified),
              "what is held out: stratified (folds by setting, strength and subject), interleaved "
              "(recordings of a setting assigned to folds in turn), subject or setting (one at a "
              "time), strong (all strong pushes)");
DEFINE_int32(folds, 4, "folds of the stratified and the interleaved scheme");
DEFINE_string(folds_file, "",
              "file with the folds, instead of --scheme: JSON, {\"folds\": [{\"name\": \"1\", "
              "\"held_out\": [ids]}]}; all other recordings are fitted");
DEFINE_int32(repeats, 5, "repeats of the stratified scheme, each with new folds");
DEFINE_string(compare, "",
              "further candidates, semicolon-separated: name: --flag=value ... added to the flags "
              "given, as in 'pd: --preset=ldp; linear: --self_force=linear'");
DEFINE_bool(yardsticks, true,
            "also score the baselines: static, constant velocity, ridge regression and the mean "
            "displacement by condition; with --observed those that start from the last frame");
DEFINE_bool(bands, false,
            "also score how often predictive 50 and 90 % bands contain the held-out recordings");
DEFINE_string(group_by, pushid::LabelKeysText(pushid::UsualGroups()),
              "labels that scores are grouped by: subject, or any label of the manifest");
DEFINE_bool(details, false, "print all tables, of folds and groups too, instead of one screen");
DEFINE_string(json_out, "", "write the scores here (JSON)");

namespace {

using namespace pushid;
using Setups = std::vector<std::pair<std::string, FitSetup>>;
using Candidates = std::vector<std::pair<std::string, FitOptions>>;

// The flags' own model, whose name is its preset's, and those of --compare.
Setups SetupsFromFlags() {
  const FitSetup own = FitSetupFromFlags();
  Setups setups = {{"", own}};
  for (const std::string& item : SplitList(FLAGS_compare, ';')) {
    const std::string text(Trimmed(item));
    if (text.empty()) continue;
    const size_t colon = text.find(':');
    const std::string name(Trimmed(text.substr(0, colon)));
    if (colon == std::string::npos || name.empty()) {
      throw Error{"--compare: '" + text + "' is not 'name: --flag=value ...'"};
    }
    const auto of_candidate = [&name](auto result) {
      if (!result.ok()) throw Error{"--compare, '" + name + "': " + result.error().message};
      return result.value();
    };
    const GivenOptions more = of_candidate(ParseOptionWords(text.substr(colon + 1)));
    setups.emplace_back(name, of_candidate(FitSetup::Make(Merged(GivenFitFlags(), more), more)));
  }
  return setups;
}

// Their options: what is known without recordings, or with them.
Candidates CandidatesOf(const Setups& setups,
                        const std::vector<PendulumRecording>* recordings = nullptr) {
  Candidates candidates;
  for (const auto& [name, setup] : setups) {
    const Result<FitOptions> options =
        recordings == nullptr ? Result<FitOptions>(setup.roughly()) : setup.For(*recordings);
    if (!options.ok()) {
      throw name.empty() ? options.error()
                         : Error{"--compare, '" + name + "': " + options.error().message};
    }
    candidates.emplace_back(name.empty() ? options.value().preset : name, options.value());
  }
  return candidates;
}

using Predictors = std::vector<Predictor>;

// Ridge regression and template are left out with observed frames, which they cannot use.
void AddBaselines(Predictors* predictors) {
  const int observed = ObservedFrames();
  if (observed == 0) {
    predictors->push_back(RidgePredictor());
    predictors->push_back(TemplatePredictor());
  }
  for (const Baseline& baseline : Baselines(observed)) {
    predictors->push_back(BaselinePredictor(baseline, observed));
  }
}

Predictors MakePredictors(const Candidates& candidates) {
  Predictors predictors;
  const int observed = ObservedFrames();
  for (const auto& [name, candidate] : candidates) {
    predictors.push_back(ModelPredictor(name, candidate, observed, ForecastUseFlag()));
  }
  if (FLAGS_bands) {
    BandOptions asked;
    asked.seed = Seed();
    predictors.push_back(
        BandPredictor(candidates[0].first + ", bands", candidates[0].second, asked));
  }
  if (FLAGS_yardsticks) AddBaselines(&predictors);
  return predictors;
}

nlohmann::ordered_json ScoresJson(const std::vector<CrossValidation>& validations) {
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  for (const CrossValidation& validation : validations) {
    json["predictors"].push_back(ToJson(validation));
    if (&validation != &validations[0]) {
      json["paired_differences"].push_back(ToJson(Compare(validations[0], validation)));
    }
  }
  return json;
}

int Run() {
  FoldScheme scheme;
  if (!FLAGS_folds_file.empty()) {
    RefuseGiven({"scheme", "folds", "repeats"},
                "--folds_file already gives the folds; leave --{} out");
  }
  OrFail(ParseName("--scheme", FLAGS_scheme, &scheme));
  const Setups setups = SetupsFromFlags();
  MakePredictors(CandidatesOf(setups));  // refuses wrong flags before any recording is read
  CheckObservedFlag();
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  const bool joints = std::any_of(setups.begin(), setups.end(), [](const auto& setup) {
    return NeedsJoints(setup.second.roughly().model);
  });
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, joints);
  CheckPushed(recordings);
  const std::vector<PendulumRecording> pendulums = MakePendulumRecordings(recordings);
  CheckObservedFlag(pendulums);
  OrFail(CheckGroups(pendulums, ParseLabelKeys(FLAGS_group_by)));
  const Candidates candidates = CandidatesOf(setups, &pendulums);
  const FitOptions& options = candidates[0].second;
  for (const std::string& warning : OptionWarnings(GivenFitFlags(), options))
    LOG(WARNING) << warning;
  const Predictors predictors = MakePredictors(candidates);
  std::set<std::string> names;  // equal ones could not be distinguished in the tables
  for (const Predictor& predictor : predictors) {
    if (names.insert(predictor.name).second) continue;
    throw Error{"--compare has more than one '" + predictor.name +
                "'; give each configuration its own name"};
  }
  const std::vector<Fold> folds = OrFail(
      FLAGS_folds_file.empty() ? MakeFolds(pendulums, scheme, FLAGS_folds, FLAGS_repeats, Seed())
                               : ReadFolds(FLAGS_folds_file, pendulums));

  std::vector<CrossValidation> validations;
  ProgressLine line;
  for (const Predictor& predictor : predictors) {
    validations.push_back(CrossValidate(pendulums, folds, predictor, NumThreads(),
                                        line.OfJobs(predictor.name + ": fold"),
                                        ParseLabelKeys(FLAGS_group_by)));
  }
  line.Finish();
  std::printf("%s", (FLAGS_details ? CrossValidationText(validations)
                                   : CrossValidationScreen(validations).ToString())
                        .c_str());
  WriteIfNamed(FLAGS_json_out, ScoresJson(validations));
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::JoinRepeated("compare", ';', argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-crossvalidate fits on some recordings and scores the predictions of the others.\n"
      "  pushid-crossvalidate --recordings=recordings/manifest.json --compare='pd: --preset=ldp'",
      Run);
}
