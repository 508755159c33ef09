// One model of a person for all directions.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/fit/fit.h"
#include "ident/prediction/prediction.h"
#include "models/turn.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticOptions People() {
  SyntheticOptions study;
  study.subjects = 4;
  study.recordings_per_subject = 2;
  study.frames = 60;
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.003;
  study.subject_spread = 0.1;
  study.seed = 7;
  return study;
}

std::vector<Recording> MakeRecordings(const SyntheticOptions& study) {
  return Recordings(Unwrapped(MakeSyntheticRecordings(study)));
}

Vector3<double> TurnedBy(double angle, const Vector3<double>& p) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

// The markers as another camera system has them; forces at the recorded poses.
std::vector<Recording> TurnedBy(double angle, std::vector<Recording> recordings) {
  for (Recording& r : recordings) {
    const PendulumRecording before = MakePendulumRecording(r);
    for (RecordedPerson& person : r.people) {
      for (auto* points : {&person.hip, &person.left_ankle, &person.right_ankle}) {
        for (Vector3<double>& p : *points) p = TurnedBy(angle, p);
      }
    }
    for (Push& push : r.pushes) {
      for (size_t i = 0; i < push.force.size(); ++i) {
        const auto& q = before.states[push.person][push.start_frame + i].q;
        push.force[i] = TurnedAxes(-angle).Force(q, push.force[i]);
      }
    }
  }
  return recordings;
}

FitResult FitOf(const std::vector<Recording>& recordings, const std::string& free = "") {
  const std::vector<PendulumRecording> pendulums = AsPendulums(recordings);
  FitOptions options = MakePreset("tail").value();
  options.function_tolerance = 1e-14;
  TableEdits edits;
  edits.free = free;
  EXPECT_FALSE(EditTable(edits, &options.table));
  EXPECT_FALSE(PrepareFit(pendulums, &options));
  const FitResult result = Fit(pendulums, options);
  EXPECT_TRUE(result.ok()) << result.message;
  return result;
}

TEST(Directions, ATurnChangesNoEstimate) {
  const std::vector<Recording> recordings = MakeRecordings(People());
  const FitResult straight = FitOf(recordings);
  for (double angle : {0.3, 1.2, 2.7}) {
    const FitResult turned = FitOf(TurnedBy(angle, recordings));
    ASSERT_EQ(turned.estimates.size(), straight.estimates.size());
    for (size_t i = 0; i < straight.estimates.size(); ++i) {
      const Estimate &a = straight.estimates[i], &b = turned.estimates[i];
      EXPECT_NEAR(b.value, a.value, 1e-6 * std::abs(a.value)) << a.name << " at " << angle;
      EXPECT_EQ(NameOf(b.status), NameOf(a.status)) << a.name << " at " << angle;
    }
  }
}

TEST(Directions, SidewaysIsAsForwards) {
  const FitResult result = FitOf(MakeRecordings(People()));
  EXPECT_EQ(result.parameters[kKpPhi], result.parameters[kKpTheta]);
  EXPECT_EQ(result.parameters[kAy], result.parameters[kAx]);
  for (const Estimate& e : result.estimates) EXPECT_NE(e.name, "Kp_phi");
}

// A prediction turns with the recording, whatever axes it sees it in.
TEST(Directions, PredictionsTurnWithTheRecording) {
  SyntheticOptions study = People();
  study.joint_noise_m = 0.0;
  const std::vector<Recording> recordings = MakeRecordings(study);
  for (Directions directions : {Directions::kIsotropic, Directions::kBody}) {
    IdentifiedModel model = TruthOf(study);
    model.options.directions = directions;
    model.parameters[kKpPhi] = 2.0 * model.parameters[kKpTheta];
    for (double angle : {0.3, 2.7}) {
      const Prediction straight = Predict(model, AsPendulums({recordings[0]})[0]);
      const Prediction turned = Predict(model, AsPendulums(TurnedBy(angle, {recordings[0]}))[0]);
      ASSERT_TRUE(straight.status.ok && turned.status.ok);
      for (size_t t = 0; t < straight.hip[0].size(); ++t) {
        const Vector3<double> there = TurnedBy(angle, straight.hip[0][t]);
        EXPECT_LT((turned.hip[0][t] - there).norm(), 1e-9) << t;
        EXPECT_NEAR(turned.forces.At(t, 0).Total().head<2>().norm(),
                    straight.forces.At(t, 0).Total().head<2>().norm(), 1e-6)
            << t;
      }
    }
  }
}

// People who face along y and are pushed from behind and from the side.
TEST(Directions, ABodyTellsForwardsFromSideways) {
  SyntheticOptions study = People();
  study.joint_noise_m = 0.0;
  study.direction_sigma_rad = 1.0;
  study.subject_spread = 0.0;
  study.parameters[kKpPhi] = 1.4 * study.parameters[kKpTheta];
  const std::vector<PendulumRecording> pendulums =
      AsPendulums(TurnedBy(0.5 * M_PI, MakeRecordings(study)));
  EXPECT_NEAR(pendulums[0].facing, 0.5 * M_PI, 1e-9);
  FitOptions options = ExactFit(study);
  options.model.directions = Directions::kBody;
  options.table[kKpPhi].free = true;
  options.table[kKpPhi].nominal = 1500.0;
  const FitResult fit = Fit(pendulums, options);
  ASSERT_TRUE(fit.ok()) << fit.message;
  for (Parameter id : {kKpTheta, kKpPhi}) {
    EXPECT_NEAR(fit.parameters[id], study.parameters[id], 1e-3 * study.parameters[id]);
  }
}

TEST(Directions, AParameterThatIsNamedIsItsOwn) {
  const FitResult result = FitOf(MakeRecordings(People()), "a_y");
  EXPECT_NE(result.parameters[kAy], result.parameters[kAx]);
  EXPECT_EQ(result.parameters[kKpPhi], result.parameters[kKpTheta]);
}

TEST(Directions, LdpKeepsTheAxesOfTheFile) {
  const FitOptions ldp = MakePreset("ldp").value();
  EXPECT_EQ(ldp.model.directions, Directions::kAxes);
  EXPECT_FALSE(ldp.table[kKpPhi].tied_to.has_value());
}

}  // namespace
}  // namespace pushid
