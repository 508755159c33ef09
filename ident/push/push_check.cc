// ident: one refit for each variant of the pushes.
#include "ident/push/push_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "datasets/files/random.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/push/push_estimation.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

RefitRow FitVariant(const PushVariant& variant, const FitOptions& options,
                    const FitPoint& estimate) {
  RefitRow row{variant.source, variant.name, {}, {}, "", 0};
  const FitProblem problem(variant.recordings, options);
  SolveStart fit = Refit(problem, estimate);
  // Far off, it is fitted like any other study.
  if (!fit.usable || !fit.converged) {
    fit = SolveFrom(problem, problem.NominalPoint(), "nominal", "", nullptr);
  }
  Take(problem, fit, &row);
  return row;
}

}  // namespace

MaybeError AddPushCheck(const std::vector<PendulumRecording>& recordings,
                        const PushVariantOptions& options, int num_threads,
                        const JobProgress& progress, FittedModel* model) {
  const Result<std::vector<PushVariant>> variants = PushVariants(recordings, options);
  if (!variants.ok()) return variants.error();
  const FitPoint& estimate = model->fit.starts[model->fit.best_start].to;
  FitOptions one = model->fit.options;
  one.num_threads = 1;
  RefitTable check = RefitTableOf(FitProblem(recordings, one), estimate, model->fit.uncertainty);
  check.rows.resize(variants.value().size());
  ParallelFor(
      static_cast<int>(check.rows.size()), num_threads,
      [&](int i) { check.rows[i] = FitVariant(variants.value()[i], one, estimate); }, progress);
  model->push_check = std::move(check);
  return std::nullopt;
}

std::vector<PushError> PushErrors(const RefitTable& check) {
  std::vector<PushError> errors;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    struct Source {
      double squares = 0.0;
      int refits = 0;
    };
    std::map<std::string, Source> sources;
    for (const RefitRow& row : check.rows) {
      if (row.value.empty()) continue;
      Source& source = sources[row.source];
      source.squares += std::pow(row.value[i] - check.value[i], 2);
      ++source.refits;
    }
    double square = 0.0;
    for (const auto& [name, source] : sources) square += source.squares / source.refits;
    errors.push_back({std::sqrt(square), std::hypot(check.standard_error[i], std::sqrt(square))});
  }
  return errors;
}

namespace {

constexpr int kLonger[] = {-2, 0, 2, 4};    // frames
constexpr int kShifts[] = {-1, 1};          // frames
constexpr double kHeights[] = {-0.1, 0.1};  // m

bool IsMeasured(const ScenePush& push) { return push.kind == PushKind::kExternal; }

// The push by inverse dynamics over a window `longer` frames longer.
MaybeError Reestimate(const PendulumRecording& recording, int longer, int smoothing,
                      ScenePush* push) {
  PushEstimationOptions options;
  options.person = push->person;
  options.smoothing_frames = smoothing;
  if (push->kind == PushKind::kNetWithoutFriction) options.friction_taken_out = kPublishedFriction;
  PushWindow window;
  window.start = push->start_frame;
  window.end = std::clamp(push->EndFrame() + longer, window.start + 1,
                          std::max(window.start + 1, recording.num_frames() - 1));
  const Result<EstimatedPush> made = EstimatePush(recording, window, options);
  if (!made.ok()) return made.error();
  *push = MakeScenePush(push->person, window.start, push->kind, made.value().push.force);
  return std::nullopt;
}

void AddNoise(double share, Random* random, ScenePush* push) {
  Vector4<double> peak = Vector4<double>::Zero();
  for (const Vector4<double>& row : push->force) peak = peak.cwiseMax(row.cwiseAbs());
  std::vector<Vector4<double>> rows = push->force;
  for (Vector4<double>& row : rows) {
    for (int i = 0; i < 4; ++i) row[i] += share * peak[i] * random->Normal();
  }
  *push = MakeScenePush(push->person, push->start_frame, push->kind, rows);
}

void Shift(int frames, ScenePush* push) {
  std::vector<Vector4<double>> rows = push->force;
  const int start = push->start_frame + frames;
  // Before the recording nothing can push.
  if (start < 0)
    rows.erase(rows.begin(), rows.begin() + std::min<long>(-start, static_cast<long>(rows.size())));
  *push = MakeScenePush(push->person, std::max(0, start), push->kind, rows);
}

// The force as it is, higher or lower on the person.
void Raise(const PendulumRecording& recording, double metres, ScenePush* push) {
  const Body& body = recording.scene.people[push->person].body;
  std::vector<Vector4<double>> rows = push->force;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Vector4<double>& q = recording.states[push->person][push->start_frame + i].q;
    const Vector4<double> more =
        GeneralizedForce<double>(body, q, {rows[i][0], rows[i][1], 0.0}, metres / body.rod_length);
    rows[i].tail<2>() += more.tail<2>();
  }
  *push = MakeScenePush(push->person, push->start_frame, push->kind, rows);
}

using Change = std::function<MaybeError(const PendulumRecording&, ScenePush*)>;

// The recordings with every measured (or every other) push changed.
Result<PushVariant> Changed(const std::vector<PendulumRecording>& recordings, bool measured,
                            const std::string& source, const std::string& name,
                            const Change& change) {
  PushVariant variant{source, name, recordings};
  for (PendulumRecording& recording : variant.recordings) {
    for (ScenePush& push : recording.scene.pushes) {
      if (IsMeasured(push) != measured || push.force.empty()) continue;
      if (MaybeError error = change(recording, &push)) return *error;
    }
  }
  return variant;
}

MaybeError AddWindows(const std::vector<PendulumRecording>& recordings,
                      std::vector<PushVariant>* variants) {
  for (int smoothing : {0, kSmoothingFrames}) {
    for (int longer : kLonger) {
      const std::string name =
          (longer == 0 ? kSameWindow
                       : (longer > 0 ? "+" : "") + std::to_string(longer) + " frames") +
          (smoothing > 0 ? ", smoothed over " + std::to_string(smoothing) : "");
      Result<PushVariant> made = Changed(recordings, false, "window", name,
                                         [&](const PendulumRecording& recording, ScenePush* push) {
                                           return Reestimate(recording, longer, smoothing, push);
                                         });
      if (!made.ok()) return made.error();
      variants->push_back(std::move(made.value()));
    }
  }
  return std::nullopt;
}

MaybeError AddSensors(const std::vector<PendulumRecording>& recordings,
                      const PushVariantOptions& options, std::vector<PushVariant>* variants) {
  const auto add = [&](const std::string& source, const std::string& name,
                       const std::function<void(const PendulumRecording&, ScenePush*)>& change) {
    variants->push_back(Changed(recordings, true, source, name,
                                [&](const PendulumRecording& recording, ScenePush* push) {
                                  change(recording, push);
                                  return MaybeError();
                                })
                            .value());
  };
  Random random(options.seed);
  for (int k = 0; k < options.draws; ++k) {
    add("sensor noise", "draw " + std::to_string(k + 1),
        [&](const PendulumRecording&, ScenePush* push) {
          AddNoise(options.sensor_noise, &random, push);
        });
  }
  for (int frames : kShifts) {
    add("clock", frames < 0 ? "a frame earlier" : "a frame later",
        [&](const PendulumRecording&, ScenePush* push) { Shift(frames, push); });
  }
  for (double metres : kHeights) {
    add("contact height", metres < 0.0 ? "0.1 m lower" : "0.1 m higher",
        [&](const PendulumRecording& recording, ScenePush* push) {
          Raise(recording, metres, push);
        });
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<PushVariant>> PushVariants(const std::vector<PendulumRecording>& recordings,
                                              const PushVariantOptions& options) {
  bool measured = false, estimated = false;
  for (const PendulumRecording& recording : recordings) {
    for (const ScenePush& push : recording.scene.pushes) {
      (IsMeasured(push) ? measured : estimated) = true;
    }
  }
  if (!measured && !estimated) return Error{"none of the recordings has a push"};
  std::vector<PushVariant> variants;
  if (estimated) {
    if (MaybeError error = AddWindows(recordings, &variants)) return *error;
  }
  if (measured) {
    if (MaybeError error = AddSensors(recordings, options, &variants)) return *error;
  }
  return variants;
}

}  // namespace pushid
