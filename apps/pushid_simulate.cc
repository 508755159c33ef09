// apps: pushid-simulate: synthetic recordings of people with known parameters; with --formation, a
// model on people who stand together.
#include <cstdio>
#include <filesystem>

#include "apps/flags/command_line.h"
#include "apps/flags/formation_flags.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/simulate_flags.h"
#include "apps/simulate_formation.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/fit/fit_setup.h"
#include "ident/fit/push_range.h"
#include "ident/parameters/option_names.h"

namespace {

using namespace pushid;

// The model of --model, else the tail preset with the feet of --truth_stance and the process noise
// of --truth_noise: what it fits has values near those identified from the published recordings,
// what it holds keeps its value, so that a fit can find the truth exactly. Either with --set.
Result<IdentifiedModel> Truth(Stance stance, const ProcessNoiseTerms& noise) {
  const ModelFlags flags = ModelFlagsFromCommandLine();
  if (!flags.file.empty()) {
    for (const char* flag : {"truth_stance", "truth_noise"}) {
      if (!Given(flag)) continue;
      return Error{std::string("--model sets the parameters of the people; leave --") + flag +
                   " out"};
    }
    return LoadFlaggedModel();
  }
  const Result<FitOptions> made = MakeFitOptions(
      {{"preset", "tail"}, {"stance", NameOf(stance)}, {"process_noise", NameOf(noise)}});
  if (!made.ok()) return made.error();
  const FitOptions& preset = made.value();
  const ParameterSet<double> published =
      stance == Stance::kSlide ? PublishedTailParameters() : PublishedStanceParameters();
  IdentifiedModel model;
  model.options = preset.model;
  model.table = preset.table;
  model.parameters = preset.table.Values();
  for (Parameter id : preset.table.Free()) model.parameters[id] = published[id];
  if (MaybeError error = SetValues(flags.set, &model)) return *error;
  return model;
}

void PrintTruth(const IdentifiedModel& truth, const SyntheticOptions& options) {
  TextTable table({"parameter", "truth", "unit"}, {true, false, true});
  for (const ParameterSpec& spec : truth.table.specs) {
    const double value = truth.parameters[spec.id];
    const bool noise =
        IsNoiseParameter(spec.id) && !IsMeasurementError(spec.id) && Acts(spec.id, truth.options);
    if (spec.free || noise || value != spec.nominal)
      table.Add({spec.name, Rounded(value, 4), spec.unit});
  }
  std::printf("%s", table.ToString().c_str());
  if (options.recording_spread > 0.0 || options.subject_spread > 0.0) {
    std::printf(
        "(the centre: every parameter varies about it by %s between recordings, %s "
        "between people)\n",
        Rounded(options.recording_spread, 3).c_str(), Rounded(options.subject_spread, 3).c_str());
  }
}

int Run() {
  if (FormationGiven()) return SimulateFormation();
  const Result<SimulateFlags> flags = SimulateFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  const ModelOptions& asked = flags.value().recordings.model;
  const Result<IdentifiedModel> truth = Truth(asked.stance, asked.process_noise);
  if (!truth.ok()) return Fail(truth.error());
  const std::string& out = flags.value().out;
  SyntheticOptions options = flags.value().recordings;
  options.model = truth.value().options;
  options.parameters = truth.value().parameters;
  const Result<std::vector<SyntheticRecording>> made = MakeSyntheticRecordings(options);
  if (!made.ok()) return Fail(made.error());
  for (const std::string& warning : ExtrapolationWarnings(
           truth.value(),
           MakePendulumRecordings(Recordings(made.value()), truth.value().mapping))) {
    Warn(warning);
  }
  if (MaybeError error = WriteSyntheticRecordings(out, options, made.value())) return Fail(*error);
  PrintTruth(truth.value(), options);
  std::printf("%zu recordings of %d people, joint noise %s mm: %s lists the BVH and push files\n",
              made.value().size(), options.subjects,
              Rounded(1000.0 * options.joint_noise_m, 3).c_str(),
              (std::filesystem::path(out) / "manifest.json").c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-simulate generates recordings of synthetic people with known parameters,\n"
      "or rolls an identified model out on a formation.\n\n"
      "  pushid-simulate --out=synthetic --people=4 --seed=1\n"
      "  pushid-simulate --model=model.json --formation=line --people=10 --push=80 "
      "--svg_out=wave.svg",
      Run);
}
