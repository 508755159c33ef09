// ident: stepping phases from step states.
#include "ident/prediction/predicted_steps.h"

#include <algorithm>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// At 0.85 the ground holds with a fortieth of its strength: before, feet hardly move.
constexpr double kSteps = 0.85, kStandsAgain = 0.75;

std::string PhaseText(const SteppingPhase& phase, double dt) {
  const std::string from = "from " + Rounded(phase.lift_off * dt, 3) + " s ";
  return from + (phase.finished ? "to " + Rounded(phase.landing * dt, 3) + " s" : "on") + ", " +
         TravelText(phase.travel) + (phase.finished ? "" : " by the end");
}

std::string PhasesText(const std::vector<SteppingPhase>& phases, double dt) {
  if (phases.empty()) return "stands";
  std::string text = "steps ";
  for (size_t i = 0; i < phases.size(); ++i) {
    text += (i > 0 ? "; " : "") + PhaseText(phases[i], dt);
  }
  return text;
}

}  // namespace

std::vector<SteppingPhase> SteppingPhases(const RolloutPath<double>& path, int person) {
  std::vector<SteppingPhase> phases;
  const auto cart = [&](int t) { return path.At(t, person).q.head<2>(); };
  bool steps = false;
  for (int t = 0; t < path.num_frames(); ++t) {
    const bool did = steps;
    steps = path.At(t, person).step > (did ? kStandsAgain : kSteps);
    if (steps && !did) phases.push_back({t, t, false});
    if (!did && !steps) continue;
    SteppingPhase& phase = phases.back();
    phase.finished = !steps;
    phase.landing = steps ? t + 1 : t;
    phase.travel = cart(t) - cart(phase.lift_off);
  }
  return phases;
}

std::vector<bool> StandingFrames(const Prediction& prediction, int person) {
  if (!prediction.feet_step) return {};
  std::vector<bool> stands(prediction.path.num_frames(), true);
  for (const SteppingPhase& phase : SteppingPhases(prediction.path, person)) {
    std::fill(stands.begin() + phase.lift_off, stands.begin() + phase.landing, false);
  }
  return stands;
}

std::string PredictedStepsText(const PendulumRecording& recording, const Prediction& prediction) {
  std::string text;
  for (int n = 0; n < prediction.path.num_people(); ++n) {
    std::vector<std::string> parts;
    if (!prediction.steps.empty()) {
      parts.push_back("P(step) " + Rounded(prediction.steps[n].probability, 2));
    }
    if (prediction.feet_step) {
      parts.push_back(PhasesText(SteppingPhases(prediction.path, n), recording.scene.dt));
    }
    if (parts.empty()) continue;
    text += recording.subject_ids[n] + ": ";
    for (size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? ", " : "") + parts[i];
    text += "\n";
  }
  return text;
}

}  // namespace pushid
