// A force law that pushid does not have, in another project: fitted to synthetic recordings of
// people who obey it, it must come back. Feet that brake with one force, whatever the speed:
//   F_x, F_y = -M b tanh(v / 0.2 m/s), and b (m/s^2) is to be found beside the tail preset's seven.
#include <cmath>
#include <cstdio>

#include "ident/fit.h"

using namespace pushid;

struct Brake {  // the formula, for any scalar
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    using std::tanh;
    const T brake = -person.body.mass * own[0];
    return {brake * tanh(s.qd[0] / 0.2), brake * tanh(s.qd[1] / 0.2), T(0.0), T(0.0)};
  }
};

int main() {
  SyntheticOptions study;
  FitOptions options = MakePreset("tail").value();
  options.model = study.model;  // in the axes of the files
  options.settling_weight = 0.0;
  // Its row: name, symbol, unit, start, bounds, typical size.
  const auto law = MakeForceLaw("brake", {{"brake", "b", "m/s^2", 0.1, 0.0, 5.0, 0.1}}, Brake{});
  if (const MaybeError error = AddForceLaw(law, &options.model, &options.table)) {
    std::fprintf(stderr, "%s\n", error->ToString().c_str());
    return 1;
  }
  const Parameter brake = options.table.Find("brake")->id;

  // People who brake with 0.35 m/s^2, noise-free; then the fit, without priors.
  study.model = options.model;
  study.parameters[brake] = 0.35;
  study.subjects = 2;
  const std::vector<PendulumRecording> recordings = MakePendulumRecordings(
      Recordings(MakeSyntheticRecordings(study).value()), SkeletonMapping::kExact);
  for (ParameterSpec& spec : options.table.specs) {
    spec.prior.reset();
    spec.tied_to.reset();
    if (!spec.free) spec.nominal = study.parameters[spec.id];
  }
  if (const MaybeError error = PrepareFit(recordings, &options)) return 1;
  const FitResult result = Fit(recordings, options);
  std::printf("brake %.9g, truth 0.35\n", result.parameters[brake]);
  return std::abs(result.parameters[brake] / 0.35 - 1.0) < 1e-6 ? 0 : 1;
}
