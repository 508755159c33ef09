// ident: draws, and words.
#include "ident/prediction/futures.h"

#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/figures/text_table.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/statistics.h"
#include "models/rollout.h"

namespace pushid {
namespace {

bool StepsAreSpread(const IdentifiedModel& model) {
  return model.options.stance == Stance::kSteps && model.step_probability &&
         model.step_probability->coefficients[1] > 0.0;
}

// A person steps if the support is smaller than f b, which has the probability At(margin).
void DrawSupport(const StepProbability& p, Random* random, ParameterSet<double>* own) {
  const double u = random->Unit();
  const double margin = (std::log(u / (1.0 - u)) - p.coefficients[0]) / p.coefficients[1];
  const double factor = FactorAtMargin((*own)[kSupportFront], margin);
  for (Parameter id : {kSupportFront, kSupportBack, kSupportSide}) (*own)[id] *= factor;
}

// By the drawn parameters until a foot leaves the ground, then by the person's own: what is drawn
// is whether there is a first step, and who went on with a support of millimetres would march.
RolloutStatus RollDrawn(const Scene& scene, const ModelOptions& options,
                        std::vector<ParameterSet<double>> now,
                        const std::vector<ParameterSet<double>>& own,
                        const FrameTable<Vector4<double>>* noise, RolloutPath<double>* path) {
  ModelStep<double> forces(scene, options, now);
  StartPath(scene, InitialVelocities(scene), path);
  for (int t = 0; t + 1 < path->num_frames(); ++t) {
    const RolloutStatus status = StepOn<double>(scene, &forces, t, path, nullptr, noise);
    if (!status.ok) return status;
    for (int n = 0; n < scene.num_people(); ++n) {
      if (path->At(t + 1, n).feet.swings != 0) now[n] = own[n];
    }
  }
  return {};
}

}  // namespace

uint64_t SeedOfRecording(uint64_t seed, int recording) {
  return seed * 1000003u + static_cast<uint64_t>(recording);
}

MaybeError CheckDrawsFrom(const IdentifiedModel& model) {
  if (model.options.process_noise != ProcessNoise::kNone || StepsAreSpread(model))
    return std::nullopt;
  return Error{(model.source.empty() ? "the model" : model.source) +
               " has no process noise to draw futures from; fit it with "
               "--likelihood=innovation, or, where it is known who "
               "steps, with --stance=steps"};
}

Result<Futures> DrawFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                            int draws, uint64_t seed, int num_frames) {
  if (MaybeError error = CheckDrawsFrom(model)) return *error;
  const int frames = num_frames > 0 ? num_frames : recording.num_frames();
  const Scene& scene = recording.scene;
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  Futures futures;
  futures.id = recording.id;
  Random random(seed);
  const bool noisy = model.options.process_noise != ProcessNoise::kNone,
             spread = StepsAreSpread(model);
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<ParameterSet<double>> drawn = parameters;
    for (size_t n = 0; spread && n < drawn.size(); ++n) {
      DrawSupport(*model.step_probability, &random, &drawn[n]);
    }
    FrameTable<Vector4<double>> noise(frames, scene.num_people());
    for (int t = 0; noisy && t < frames; ++t) {
      for (int n = 0; n < scene.num_people(); ++n) {
        for (double& w : noise.At(t, n)) w = random.Normal();
      }
    }
    RolloutPath<double> path(frames, scene.num_people());
    const auto roll = [&](const Scene& turned) {
      return RollDrawn(turned, model.options, drawn, parameters, noisy ? &noise : nullptr, &path);
    };
    if (!RollInOwnAxes(recording, model.options, roll, frames, &path).ok) {
      ++futures.failed;
      continue;
    }
    std::vector<std::vector<BandPoint>> people(scene.num_people());
    if (spread) futures.steps.emplace_back();
    for (int n = 0; n < scene.num_people(); ++n) {
      for (int t = 0; t < frames; ++t) {
        const PendulumState<double>& state = path.At(t, n);
        BandPoint point;
        point << HipPosition(scene.people[n].body, state.q), state.q.tail<2>();
        people[n].push_back(point);
      }
      if (spread) {
        futures.steps.back().push_back(static_cast<int>(PredictedSteps(path, n).size()));
      }
    }
    futures.paths.push_back(std::move(people));
  }
  return futures;
}

namespace {

// "0: 0.05, 1: 0.62, 2: 0.33"
std::string StepShares(const Futures& futures, size_t person) {
  std::map<int, int> counts;
  for (const std::vector<int>& draw : futures.steps) ++counts[draw[person]];
  std::string text;
  for (const auto& [steps, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(steps) + ": " +
            Rounded(count / static_cast<double>(futures.steps.size()), 2);
  }
  return text;
}

}  // namespace

std::string LastFrameText(const Futures& futures) {
  std::vector<std::string> titles = {">person", ">x m", ">5 %", ">95 %", ">y m", ">5 %", ">95 %"};
  if (!futures.steps.empty()) titles.push_back("steps: share");
  TextTable table(titles);
  if (futures.paths.empty()) return "";
  for (size_t n = 0; n < futures.paths[0].size(); ++n) {
    std::vector<std::string> row = {std::to_string(n)};
    for (int axis : {0, 1}) {
      const std::vector<double> values =
          ValuesAt(futures.paths, static_cast<int>(n), futures.paths[0][n].size() - 1, axis);
      for (double share : {0.5, 0.05, 0.95}) row.push_back(Rounded(Quantile(values, share), 3));
    }
    if (!futures.steps.empty()) row.push_back(StepShares(futures, n));
    table.Add(row);
  }
  return table.ToString();
}

}  // namespace pushid
