// The contact energy balance: a spring gives back what it took, damping does not, energy adds up.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/prediction/propagation.h"
#include "models/rollout.h"

namespace pushid {
namespace {

ScenePerson PersonAt(double x, double mass) {
  ScenePerson person;
  person.body = {mass, 0.95, 0.0};
  person.start.q[0] = x;
  return person;
}

ParameterSet<double> Contact(double damping) {
  ParameterSet<double> p{};
  p[kContactStiffness] = 2500.0;
  p[kContactDistance] = 0.4;
  p[kContactKappa] = 0.5;
  p[kContactDamping] = damping;
  p[kContactHeight] = 0.6;
  p[kTailTime] = 0.2;
  return p;
}

ModelOptions WithContact() {
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  options.posture = Posture::kUpright;
  return options;
}

// The first walks into the second, who stands 0.5 m away, leans, and goes back as he came.
struct Bounce {
  Bounce() : path(2 * kHalf + 1, 2) {
    scene.people = {PersonAt(0.0, 70.0), PersonAt(0.5, 90.0)};
    for (int t = 0; t <= 2 * kHalf; ++t) {
      const double s = 1.0 - std::abs(t - kHalf) / static_cast<double>(kHalf);
      path.At(t, 0).q = {0.25 * s, 0.02 * s, 0.05 * s, 0.01 * s};
      path.At(t, 1).q = scene.people[1].start.q;
      if (t == 0) continue;
      path.At(t, 0).qd = (path.At(t, 0).q - path.At(t - 1, 0).q) / scene.dt;
    }
  }
  ContactEnergyBalance Balance(double damping) const {
    const auto p = Contact(damping);
    const ModelOptions options = WithContact();
    const std::vector<ParameterSet<double>> parameters = {p};
    ModelStep<double> forces(scene, options, parameters);
    ForceTrace trace(path.num_frames(), 2);
    std::vector<int> scratch;
    for (int t = 0; t < path.num_frames(); ++t) {
      forces.Update(path.Frame(t));
      for (int n : {0, 1}) {
        forces.Prepare(n, &scratch);
        trace.At(t, n)[ForcePart::kInteraction] = forces.received(n);
      }
    }
    return BalanceContactEnergy(path, trace);
  }
  static constexpr int kHalf = 30;
  Scene scene;
  RolloutPath<double> path;
};

TEST(ContactWork, ASpringGivesBackWhatItTook) {
  const ContactEnergyBalance balance = Bounce().Balance(0.0);
  EXPECT_GT(balance.absorbed, 5.0);
  EXPECT_NEAR(balance.TotalWork(), 0.0, 1e-9);
}

TEST(ContactWork, DampingDissipates) {
  const ContactEnergyBalance soft = Bounce().Balance(50.0), hard = Bounce().Balance(250.0);
  EXPECT_LT(soft.TotalWork(), -1.0);
  EXPECT_LT(hard.TotalWork(), soft.TotalWork());
  EXPECT_LT(hard.returned / hard.absorbed, soft.returned / soft.absorbed);
}

double Energy(const Body& body, const PendulumState<double>& state) {
  return 0.5 * state.qd.dot(MassMatrix(body, state.q) * state.qd) +
         body.point_mass() * kGravity * body.rod_length * std::cos(state.q[2]) *
             std::cos(state.q[3]);
}

// With contact as the only force, what it does is the change of everybody's energy.
TEST(ContactWork, IsTheChangeOfEnergy) {
  Scene scene;
  scene.dt = 1e-5;
  scene.people = {PersonAt(0.0, 70.0), PersonAt(0.45, 90.0)};
  scene.people[0].start.qd = {1.2, 0.1, 0.0, 0.0};
  for (double damping : {0.0, 200.0}) {
    const auto p = Contact(damping);
    RolloutPath<double> path;
    ForceTrace forces;
    ASSERT_TRUE(
        Rollout<double>(scene, WithContact(), {p}, InitialVelocities(scene), 30001, &path, &forces)
            .ok);
    const ContactEnergyBalance balance = BalanceContactEnergy(path, forces);
    double change = 0.0;
    for (int n : {0, 1}) {
      change += Energy(scene.people[n].body, path.At(30000, n)) -
                Energy(scene.people[n].body, path.At(0, n));
    }
    ASSERT_GT(balance.absorbed, 5.0);
    EXPECT_NEAR(balance.TotalWork(), change, 0.005 * balance.absorbed) << damping;
  }
}

// A row of four, pushed at one end.
TEST(ContactFigures, ContactTakesEnergyAndGivesSomeBack) {
  PendulumRecording recording;
  for (int n = 0; n < 4; ++n) {
    recording.scene.people.push_back(PersonAt(0.45 * n, 80.0));
    recording.subject_ids.push_back("S");
  }
  Scene& scene = recording.scene;
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       HalfSinePush(scene.people[0].body, 100.0, 12, scene.dt)));
  IdentifiedModel model;
  model.options.interaction.spring = model.options.interaction.damping = true;
  model.parameters = Contact(150.0);
  model.parameters[kMu] = 30.0, model.parameters[kAx] = -12.0;
  model.parameters[kKpTheta] = 1800.0, model.parameters[kKpPhi] = 1500.0;
  model.parameters[kKdTheta] = model.parameters[kKdPhi] = 70.0;
  const Prediction prediction = Predict(model, recording, 120);
  ASSERT_TRUE(prediction.status.ok);
  recording.hip = prediction.hip;
  PropagationScore score = ScorePropagation(recording, prediction.hip);
  AddContactFigures(model, prediction, &score);

  EXPECT_LT(score.figures[kContactWork].sum, 0.0);
  EXPECT_GT(score.figures[kRestitution].sum, 0.0);
  EXPECT_LT(score.figures[kRestitution].sum, score.figures[kRestitution].weight);

  // Not where something else than mutual contact acts between people.
  model.options.interaction.ldp_published = true;
  PropagationScore mixed = ScorePropagation(recording, prediction.hip);
  AddContactFigures(model, prediction, &mixed);
  EXPECT_EQ(mixed.figures[kRestitution].weight, 0.0);
  EXPECT_LT(mixed.figures[kContactWork].sum, 0.0);
}

}  // namespace
}  // namespace pushid
