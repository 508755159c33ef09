// With an installed pushid: the paper in eight steps on synthetic recordings; then noise-free ones
// are fitted by its own laws, and by a force law that it does not have. The truth must come back.
//
//   own_law FOLDER   writes the study's recordings there
#include <cmath>
#include <cstdio>
#include <string>

#include "ident/pushid.h"

using namespace pushid;

// Feet that brake with one force, whatever the speed:
//   F_x, F_y = -M b tanh(v / 0.2 m/s), and b (m/s^2) is to be found beside the tail preset's seven.
struct Brake {  // the formula, for any scalar
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    using std::tanh;
    const T brake = -person.body.mass * own[0];
    return {brake * tanh(s.qd[0] / 0.2), brake * tanh(s.qd[1] / 0.2), T(0.0), T(0.0)};
  }
};

// Recordings of people who obey the study's laws; then the fit, without priors.
bool ComesBack(SyntheticOptions study, FitOptions options, Parameter parameter) {
  study.subjects = 2;
  study.recordings_per_subject = 3;
  const auto made = MakeSyntheticRecordings(study);
  if (!made.ok()) {
    std::fprintf(stderr, "%s\n", made.error().ToString().c_str());
    return false;
  }
  const std::vector<PendulumRecording> recordings =
      MakePendulumRecordings(Recordings(made.value()));
  options.settling_weight = 0.0;
  options.preset_priors = false;
  FreeTerms(&options);
  for (ParameterSpec& spec : options.table.specs) {
    if (!spec.free) spec.nominal = study.parameters[spec.id];
  }
  if (const MaybeError error = PrepareFit(recordings, &options)) {
    std::fprintf(stderr, "%s\n", error->ToString().c_str());
    return false;
  }
  const FitResult result = Fit(recordings, options);
  const double found = ModelOf(result).parameters[parameter], truth = study.parameters[parameter];
  std::printf("%.9g, truth %.9g\n", found, truth);
  return std::abs(found / truth - 1.0) < 1e-6;
}

// All eight steps, from files to bodies and a page.
bool StudyRuns(const std::string& folder) {
  SyntheticOptions people;
  people.joint_noise_m = 0.002;
  const auto made = MakeSyntheticRecordings(people);
  if (!made.ok() || WriteSyntheticRecordings(folder, people, made.value())) return false;
  StudyOptions options;
  options.recordings = options.held_out = folder + "/manifest.json";
  options.page = folder + "/report.html";
  const Result<Study> study = RunStudy(options);
  if (!study.ok()) {
    std::fprintf(stderr, "%s\n", study.error().ToString().c_str());
    return false;
  }
  const double error = study.value().evaluation.model.mean.value[kHipAde];
  std::printf("hipADE %.3g m\n", error);
  return error < 0.02 && study.value().bodies.size() == made.value().size();
}

int main(int argc, char** argv) {
  if (argc != 2 || !StudyRuns(argv[1])) return 1;
  SyntheticOptions study;
  FitOptions options = MakePreset("tail").value();
  options.model = study.model;  // in the axes of the files
  if (!ComesBack(study, options, kMu)) return 1;
  // Its row: name, symbol, unit, start, bounds, typical size.
  const auto law = MakeForceLaw("brake", {{"brake", "b", "m/s^2", 0.1, 0.0, 5.0, 0.1}}, Brake{});
  if (const MaybeError error = AddForceLaw(law, &options.model, &options.table)) {
    std::fprintf(stderr, "%s\n", error->ToString().c_str());
    return 1;
  }
  const Parameter brake = options.table.Find("brake")->id;
  study.model = options.model;
  study.parameters[brake] = 0.35;
  return ComesBack(study, options, brake) ? 0 : 1;
}
