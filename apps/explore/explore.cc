// apps: a pushed person for the report page: the rollout of models/, compiled to WebAssembly
// (CMakeLists.txt; explore.js calls it).
#include "apps/explore/explore.h"

#include <type_traits>
#include <vector>

#include "models/rollout.h"

namespace pushid {
namespace {

constexpr int kMostFrames = 600;
constexpr double kBand = 0.9;

// Places in m, step 0 (stands) to 1 (steps), push in N, and the band of the hip's x.
struct Row {
  double cart, hip, height, step, push, lower, upper;
};

// Through which all numbers go, in this order.
struct Block {
  ExploredPush in;
  ParameterSet<double> now, estimate, draws[kMostDraws];  // drawn about the estimate
  Row path[kMostFrames];
} block;

ModelOptions Options(const ExploredPush& in) {
  ModelOptions options;
  ForEachChoice(options, in, [](auto& choice, double number) {
    choice = static_cast<std::remove_reference_t<decltype(choice)>>(number);
  });
  options.interaction.spring = in.others != 0.0;  // of any kind: nobody is there
  return options;
}

// The frames within the model's domain.
int Roll(const Scene& scene, const ParameterSet<double>& parameters, RolloutPath<double>* path) {
  const int frames = std::min(kMostFrames, static_cast<int>(block.in.frames));
  const RolloutStatus status = Rollout<double>(scene, Options(block.in), {parameters},
                                               InitialVelocities(scene), frames, path);
  return status.ok ? frames : status.frame;
}

// As far from `now` as the draw is from the estimate, on the scale of the fit.
ParameterSet<double> Moved(const ParameterSet<double>& draw) {
  ParameterSet<double> moved = block.now;
  for (int i = 0; i < kFirstOwnParameter; ++i) {
    if (draw[i] == block.estimate[i]) continue;
    const Transform transform = AllParameterFacts()[i].transform;
    const double by = ToFitted(transform, draw[i]) - ToFitted(transform, block.estimate[i]);
    moved[i] = Shifted(transform, moved[i], by);
  }
  return moved;
}

// Draws that have left the domain are in no band from there on.
void AddBand(const Scene& scene, int frames) {
  std::vector<std::vector<double>> hips(frames);
  for (int k = 0; k < static_cast<int>(block.in.draws); ++k) {
    RolloutPath<double> drawn;
    const int inside = std::min(frames, Roll(scene, Moved(block.draws[k]), &drawn));
    for (int t = 0; t < inside; ++t) {
      hips[t].push_back(HipPosition(scene.people[0].body, drawn.At(t, 0).q)[0]);
    }
  }
  for (int t = 0; t < frames; ++t) {
    if (hips[t].empty()) continue;
    std::sort(hips[t].begin(), hips[t].end());
    const double last = static_cast<double>(hips[t].size()) - 1.0;
    block.path[t].lower = hips[t][std::lround(0.5 * (1.0 - kBand) * last)];
    block.path[t].upper = hips[t][std::lround(0.5 * (1.0 + kBand) * last)];
  }
}

int PushPerson() {
  const Scene scene = SceneOf(block.in);
  const std::vector<Vector4<double>>& rows = scene.pushes[0].force;
  RolloutPath<double> path;
  const int inside = Roll(scene, block.now, &path);
  for (int t = 0; t < inside; ++t) {
    const PendulumState<double>& state = path.At(t, 0);
    const Vector3<double> hip = HipPosition(scene.people[0].body, state.q);
    const double push = t < static_cast<int>(rows.size()) ? rows[t][0] : 0.0;
    block.path[t] = {state.q[0], hip[0], hip[2], state.feet.swings != 0 ? 1.0 : 0.0,
                     push,       hip[0], hip[0]};
  }
  AddBand(scene, inside);
  return inside;
}

}  // namespace
}  // namespace pushid

#define PUSHID_EXPORT(name) extern "C" __attribute__((export_name(name)))

// The block; parameters in a set; draws in the block.
PUSHID_EXPORT("numbers") double* Numbers() { return reinterpret_cast<double*>(&pushid::block); }
PUSHID_EXPORT("parameters") int Parameters() { return pushid::kNumParameters; }
PUSHID_EXPORT("draws") int Draws() { return pushid::kMostDraws; }
// Writes the path; returns its frames until the person leaves the model's domain.
PUSHID_EXPORT("push") int Push() { return pushid::PushPerson(); }
