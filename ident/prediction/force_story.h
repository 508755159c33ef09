// ident: what happens to one person of a prediction, in words: when the net force changes its main
// part.
//
// Along the push, the net force has three causes: a push itself, what others do, and the person's
// own answer (friction, balance and all that is fitted or learned of one person). The largest of
// them tells a frame, where it is above 10 N; what others do is from behind where it goes along the
// push and from in front where it goes against it, and named after the nearest person on that side.
// A cause that lasts less than 0.1 s belongs to the one before, unless it is a push; where several
// such follow each other for longer, the loudest of them tells all.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ident/prediction/prediction.h"

namespace pushid {

enum class Cause { kNothing, kPush, kFromBehind, kFromInFront, kOwn };

struct StoryMoment {
  int from = 0, to = 0;  // frames, `to` is the next one's `from`
  Cause cause = Cause::kNothing;
  double peak = 0.0;     // N, of the cause
  double impulse = 0.0;  // N s along the push
  std::string text;      // "pushed from behind by X-18, up to 230 N (31 N s)"
};

struct ForceStory {
  int person = -1;
  std::vector<StoryMoment> moments;
  // [frame]: push, others, own answer, net, N along the push.
  std::vector<std::array<double, 4>> forces;
};

// The prediction must have stayed within its domain.
ForceStory StoryOf(const PendulumRecording& recording, const Prediction& prediction, int person);

// The story of the bystander with most to tell: first still, then pushed by the one behind, then by
// the one in front, is more than being pushed alone. Person -1 where there is no bystander.
ForceStory RichestStory(const PendulumRecording& recording, const Prediction& prediction);

// "X-11: 0 s still; 0.42 s pushed from behind by X-18, up to 230 N (31 N s); ..."
std::string StoryText(const PendulumRecording& recording, const ForceStory& story);

// The contact energy balance along a rollout: work and impulse on each person.
//
// Work on a person between two frames: (Q_t + Q_t+1) / 2 . (q_t+1 - q_t), the trapezoid of the
// generalized force along the path, so that a spring alone gives back what it took, whatever the
// step. Of each step's total over people the negative part is absorbed by contact (stored or lost),
// the positive part returned; contact still loaded at the last frame has not returned its share.

struct ContactEnergyBalance {
  std::vector<double> work;               // J, on each person
  std::vector<Vector4<double>> impulse;   // integral of the generalized force
  double absorbed = 0.0, returned = 0.0;  // J

  double TotalWork() const { return returned - absorbed; }
};

// forces: those that drove the path (Rollout's trace); its last frame must hold them too.
ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path, const ForceTrace& forces,
                                          double dt);

// The integral of all pushes on a person, tails included, over the path's steps.
Vector4<double> PushImpulse(const ForceTrace& forces, int person, double dt);

}  // namespace pushid
