// ident: feet that move, counted.
#include "ident/parameters/pushed_feet.h"

#include <algorithm>
#include <set>

namespace pushid {
namespace {

// Share of the pushes beyond which everybody moves. In the published recordings of single people 30
// of 32 step, in those of groups 48 of the 49 who are pushed.
constexpr double kEverybody = 0.75;

std::string OfAll(const PushedFeet& feet) {
  return std::to_string(feet.moved) + " of " + std::to_string(feet.seen) + " pushes";
}

// Whether both feet go at once, over at least half of the longer step's time: they slide, as
// nobody's who steps do.
bool Glide(const FootStep& a, const FootStep& b) {
  const int both = std::min(a.landing, b.landing) - std::max(a.lift_off, b.lift_off);
  return a.foot != b.foot && 2 * both > std::max(a.landing - a.lift_off, b.landing - b.lift_off);
}

bool LiftsAFoot(const PersonSteps& person) {
  const std::vector<FootStep>& steps = person.steps;
  return std::any_of(steps.begin(), steps.end(), [&steps](const FootStep& one) {
    return std::none_of(steps.begin(), steps.end(),
                        [&one](const FootStep& other) { return Glide(one, other); });
  });
}

}  // namespace

PushedFeet FeetOf(const std::vector<PendulumRecording>& recordings) {
  PushedFeet feet;
  for (const PendulumRecording& recording : recordings) {
    if (!recording.StepsKnown()) continue;
    std::set<int> pushed;
    for (const ScenePush& push : recording.scene.pushes) pushed.insert(push.person);
    // Ground that moves pushes everybody; who sways in quiet does so on feet that hold.
    if (pushed.empty() || recording.scene.ground.moves()) {
      for (int n = 0; n < recording.num_people(); ++n) pushed.insert(n);
    }
    for (int person : pushed) {
      const PersonSteps& steps = recording.steps[person];
      ++feet.seen;
      feet.moved += steps.Moved();
      feet.stepped += LiftsAFoot(steps);
    }
  }
  return feet;
}

Stance StanceOf(const PushedFeet& feet, Stance of_movers) {
  if (feet.seen > 0 && feet.moved == 0) return Stance::kFixed;
  // Feet that move and do not leave the ground slide, if little. Of people who slide noise shows
  // some as lifted: of 48 synthetic pushes 8, where all of 78 recorded ones step.
  if (2 * feet.stepped < feet.moved || feet.stepped == 0) return Stance::kSlide;
  return feet.moved >= kEverybody * feet.seen ? of_movers : Stance::kSteps;
}

std::string FeetText(const PushedFeet& feet, Stance stance) {
  if (feet.seen == 0) return "";
  const char* const feet_do = stance == Stance::kSlide   ? "feet move freely"
                              : stance == Stance::kFixed ? "feet hold"
                                                         : "feet hold, then step";
  return std::string(feet_do) + " (--stance=" + NameOf(stance) + "; they moved in " + OfAll(feet) +
         ")";
}

std::string FeetWarning(const PushedFeet& feet, Stance stance) {
  if (feet.seen == 0) return "";
  if (stance == Stance::kSlide && feet.moved == 0) {
    return "no pushed person's feet moved, but those of the model slide: drag and gains are not "
           "those of people who stand; fit with --stance=fixed";
  }
  if (stance == Stance::kFixed && feet.moved > 0) {
    return "feet moved in " + OfAll(feet) +
           ", but those of the model hold: leave these recordings out, or fit with "
           "--stance=steps";
  }
  return "";
}

}  // namespace pushid
