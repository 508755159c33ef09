// One model of a person for all directions.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/fit/fit.h"
#include "models/turn.h"
#include "tests/ident/fit_samples.h"

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
  const auto made = MakeSyntheticRecordings(study);
  EXPECT_TRUE(made.ok()) << made.error().ToString();
  return Recordings(made.value());
}

Vector3<double> TurnedBy(double angle, const Vector3<double>& p) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

// The markers as another camera system has them; forces at the recorded poses.
std::vector<Recording> TurnedBy(double angle, std::vector<Recording> recordings) {
  for (Recording& r : recordings) {
    const PendulumRecording before = MakePendulumRecording(r, SkeletonMapping::kExact);
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
