// tests: people, pushes and recordings for the residual tests and the benchmarks, seeded.
//
// Recordings are rolled out from known parameters, so that their residual at the truth is zero.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "datasets/files/random.h"
#include "datasets/loading/pendulum_recording.h"
#include "models/rollout.h"
#include "residuals/parameter_map.h"
#include "tests/jacobian_check.h"

namespace pushid {

// Parameters under which a pushed person recovers, every term of the model taking part.
inline ParameterSet<double> RecoveringParameters() {
  ParameterSet<double> p{};
  p[kMu] = 25.0, p[kMuY] = 35.0, p[kKpX] = 6.0, p[kKpY] = 4.0;
  p[kKpTheta] = 1650.0, p[kKpPhi] = 1750.0, p[kKdTheta] = 85.0, p[kKdPhi] = 75.0;
  p[kKdX] = 1.2, p[kKdY] = 0.8;  // beyond the cart's own mass the backward difference diverges
  p[kAx] = -9.0, p[kAy] = -7.0, p[kBx] = 0.3, p[kBy] = 0.2, p[kTx] = -0.2, p[kTy] = -0.1;
  p[kCq] = 0.05, p[kDq] = 0.1;
  p[kTailGain] = 1.1, p[kTailTorque] = 0.35, p[kTailTime] = 0.19, p[kTailExponent] = 1.5;
  p[kContactStiffness] = 2000.0, p[kContactDistance] = 0.9, p[kContactKappa] = 0.6;
  p[kContactDamping] = 100.0, p[kContactHeight] = 0.5;
  p[kPotentialStrength] = 120.0, p[kPotentialLength] = 0.4, p[kNeighbourRange] = 0.9;
  p[kLeanTheta] = 30.0, p[kLeanPhi] = 20.0;
  p[kSupportFront] = 0.1, p[kSupportBack] = 0.07, p[kSupportSide] = 0.04, p[kFootFront] = 0.18;
  p[kStepGain] = 1.0, p[kStepOnset] = 0.25, p[kStepSwing] = 0.3;
  p[kComHeight] = 1.07;
  p[kCoulombFriction] = 0.02, p[kReactionDelay] = 0.043, p[kStepDelay] = 0.071;
  p[kPassiveStiffness] = 0.3, p[kPassiveDamping] = 0.4;
  p[kCartMassShare] = 0.2, p[kGyrationRadius] = 0.25, p[kPushGain] = 1.1;
  return p;
}

inline bool IsOfLaboratory(int id) {
  return id == kCoulombFriction || (id >= kReactionDelay && id <= kPushGain);
}

// Each of them times a random factor within [1 - spread, 1 + spread]; a rollout feels no noise.
inline ParameterSet<double> RandomRecoveringParameters(Random* random, double spread) {
  ParameterSet<double> p = RecoveringParameters();
  for (int id = 0; id < kFirstOwnParameter; ++id) {
    if (!IsNoiseParameter(static_cast<Parameter>(id)) && !IsOfLaboratory(id) && id != kTailBase)
      p[id] *= random->Uniform(1.0 - spread, 1.0 + spread);
  }
  // Six more, as many as own parameters there once were: what is drawn behind them stays.
  Random late(random->Fork());
  for (int i = 0; i < 5; ++i) random->Unit();
  for (int id = 0; id < kFirstOwnParameter; ++id) {
    if (IsOfLaboratory(id)) p[id] *= late.Uniform(1.0 - spread, 1.0 + spread);
  }
  return p;
}

// Fits every parameter: logs where the sign is physics, one logit, the rest as they are.
// pooled: parameters that also vary by subject.
inline ParameterMap EveryParameterMap(const std::vector<Parameter>& pooled) {
  ParameterMap map;
  for (int i = 0; i < kNumParameters; ++i) {
    FittedParameter fitted{static_cast<Parameter>(i), Transform::kIdentity, -1};
    switch (fitted.parameter) {
      case kMu:
      case kMuY:
      case kKpTheta:
      case kKpPhi:
      case kKdTheta:
      case kKdPhi:
      case kTailTime:
        fitted.transform = Transform::kLog;
        break;
      case kTailTorque:
        fitted.transform = Transform::kLogit;
        break;
      default:
        break;
    }
    for (Parameter p : pooled) {
      if (p == fitted.parameter) fitted.deviation = map.num_deviations++;
    }
    map.fitted.push_back(fitted);
  }
  return map;
}

// The shared block that gives these values.
inline std::vector<double> SharedBlock(const ParameterMap& map, const ParameterSet<double>& p) {
  std::vector<double> block;
  for (const FittedParameter& f : map.fitted)
    block.push_back(ToFitted(f.transform, p[f.parameter]));
  return block;
}

// The blocks of a recording: shared values, random deviations, random initial velocities.
inline ParameterBlocks RandomBlocks(const ParameterMap& map, const BlockLayout& layout,
                                    const ParameterSet<double>& p, double deviation,
                                    double velocity, Random* random) {
  ParameterBlocks blocks = {SharedBlock(map, p)};
  const std::vector<int> sizes = layout.BlockSizes();
  for (size_t b = 1; b < sizes.size(); ++b) {
    const bool last = b + 1 == sizes.size();
    const double size = layout.free_initial_velocity && last ? velocity : deviation;
    blocks.emplace_back();
    for (int i = 0; i < sizes[b]; ++i) blocks.back().push_back(random->Uniform(-size, size));
  }
  return blocks;
}

inline constexpr int kPairStates = 16;  // numbers of the states of two people

// Its numbers vary by the columns from `first` on.
template <typename Jet>
PendulumState<Jet> JetState(const PendulumState<double>& state, int first) {
  PendulumState<Jet> jets;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = Jet(state.q[i], first + i);
    jets.qd[i] = Jet(state.qd[i], first + 4 + i);
  }
  return jets;
}

// People in a row, leaning a little when `lean` (rad) is not zero.
inline Scene SceneOfPeople(int num_people, double lean, Random* random) {
  Scene scene;
  for (int n = 0; n < num_people; ++n) {
    ScenePerson person;
    person.body = {random->Uniform(55, 105), random->Uniform(0.8, 1.05), random->Uniform(0, 0.12)};
    person.start.q = {0.7 * n, random->Uniform(-0.2, 0.2), random->Uniform(-lean, lean),
                      random->Uniform(-lean, lean)};
    scene.people.push_back(person);
  }
  return scene;
}

// Rows of roughly `magnitude` N on the cart and as many N m on the angles.
inline ScenePush RandomPush(int person, int start_frame, int rows, PushKind kind, double magnitude,
                            Random* random) {
  std::vector<Vector4<double>> force;
  for (int i = 0; i < rows; ++i) {
    force.push_back({magnitude * random->Uniform(0.5, 1.5), magnitude * random->Uniform(-0.5, 0.5),
                     magnitude * random->Uniform(0.2, 1.0),
                     magnitude * random->Uniform(-0.5, 0.5)});
  }
  return MakeScenePush(person, start_frame, kind, std::move(force));
}

// What a motion capture of the rollout would hold; velocities are the rollout's own.
inline PendulumRecording RecordRollout(const Scene& scene, const ModelOptions& options,
                                       const std::vector<ParameterSet<double>>& truth,
                                       int num_frames) {
  PendulumRecording recording;
  recording.id = "rolled_out";
  recording.scene = scene;
  RolloutPath<double> path;
  const RolloutStatus status =
      Rollout(scene, options, truth, InitialVelocities(scene), num_frames, &path);
  EXPECT_TRUE(status.ok) << status.quantity << " of person " << status.person << " at frame "
                         << status.frame;
  for (int n = 0; n < scene.num_people(); ++n) {
    const Body& body = scene.people[n].body;
    recording.subject_ids.push_back("S" + std::to_string(n));
    recording.states.emplace_back();
    recording.hip.emplace_back();
    recording.rod_length.emplace_back();
    for (int t = 0; t < num_frames; ++t) {
      const PendulumState<double>& state = path.At(t, n);
      const Body now = BodyNow(body, state.rod);
      recording.states[n].push_back(state);
      recording.hip[n].push_back(HipPosition(now, state.q));
      recording.rod_length[n].push_back(now.rod_length);
    }
  }
  return recording;
}

// Adds what a measurement gets wrong, so that residuals are not zero.
inline void AddNoise(double magnitude, Random* random, PendulumRecording* recording) {
  for (int n = 0; n < recording->num_people(); ++n) {
    for (int t = 0; t < recording->num_frames(); ++t) {
      for (int i = 0; i < 3; ++i) recording->hip[n][t][i] += random->Normal(0.0, magnitude);
      for (int i = 0; i < 4; ++i) {
        recording->states[n][t].q[i] += random->Normal(0.0, magnitude);
        recording->states[n][t].qd[i] += random->Normal(0.0, magnitude);
      }
    }
  }
}

// A model with a network of random weights, each up to `size`.
inline ModelOptions WithNetwork(const NetworkShape& shape, double size, Random* random,
                                const RodShape& rod = {}, const PairShape& pair = {}) {
  auto network = std::make_shared<LearnedTerms>(LearnedTerms{shape, {}, rod, pair});
  for (int i = 0; i < network->num_weights(); ++i) {
    network->weights.push_back(random->Uniform(-size, size));
  }
  ModelOptions options;
  options.learned = network;
  options.interaction.learned = pair.any();
  options.interaction.learned_in_range = pair.ldp;
  return options;
}

// None, the parts of contact alone and together, and LDP's terms.
inline std::vector<InteractionTerms> SomeInteractions() {
  std::vector<InteractionTerms> some(5);
  some[1].spring = some[1].damping = true;
  some[2].spring = true;
  some[3].damping = true;
  some[4].ldp_published = true;
  return some;
}

// Every combination of options that changes a rollout of one person, with the interactions in turn:
// every three values of the options meet, those of an interaction among them.
inline std::vector<ModelOptions> EveryModelOptions() {
  std::vector<ModelOptions> all;
  const std::vector<InteractionTerms> interactions = SomeInteractions();
  for (Posture posture : {Posture::kUpright, Posture::kInitial})
    for (GainScaling scaling : {GainScaling::kNone, GainScaling::kMass, GainScaling::kBody})
      for (FrictionKind friction : {FrictionKind::kIsotropic, FrictionKind::kAnisotropic})
        for (PushUse use : {PushUse::kAsRecorded, PushUse::kAdded})
          for (PushTail tail : {PushTail::kNone, PushTail::kExponential})
            for (const auto& [stance, derivative] :
                 {std::pair(Stance::kSlide, CartDerivative::kNone),
                  std::pair(Stance::kSlide, CartDerivative::kBackward),
                  std::pair(Stance::kSteps, CartDerivative::kNone)})
              all.push_back({posture, scaling, Directions::kAxes, friction, use, tail, stance,
                             Delay::kNone, BodyModel::kLdp, derivative,
                             interactions[all.size() % interactions.size()], nullptr});
  return all;
}

inline std::string DescribeTerms(const InteractionTerms& t) {
  std::string text;
  for (bool on : {t.spring, t.damping, t.ldp_published}) {
    text += on ? "1" : "0";
  }
  return text;
}

inline std::string Describe(const ModelOptions& options) {
  const auto number = [](auto value) { return std::to_string(static_cast<int>(value)); };
  return "posture " + number(options.posture) + ", scaling " + number(options.gain_scaling) +
         ", friction " + number(options.friction) + ", push use " + number(options.push) +
         ", tail " + number(options.push_tail) + ", cart derivative " +
         number(options.cart_derivative) + ", stance " + number(options.stance) + ", interaction " +
         DescribeTerms(options.interaction);
}

}  // namespace pushid
