// ident: trainings run, with checkpoints: key, curve and state, each with its length in front.
#include "ident/training/training_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

void Append(const std::string& part, std::string* bytes) {
  const uint64_t size = part.size();
  bytes->append(reinterpret_cast<const char*>(&size), sizeof size);
  *bytes += part;
}

bool Take(const std::string& bytes, size_t* at, std::string* part) {
  uint64_t size = 0;
  if (bytes.size() < *at + sizeof size) return false;
  std::memcpy(&size, bytes.data() + *at, sizeof size);
  *at += sizeof size;
  if (bytes.size() - *at < size) return false;
  *part = bytes.substr(*at, size);
  *at += size;
  return true;
}

// The state and the curve so far; false where there is no checkpoint with this key.
bool Load(const std::string& path, const std::string& wanted_key, std::string* state,
          std::vector<TrainingPoint>* curve) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored)) return false;
  const Result<std::string> bytes = ReadWholeFile(path);
  if (!bytes.ok()) return false;
  size_t at = 0;
  std::string key, points;
  if (!Take(bytes.value(), &at, &key) || key != wanted_key) return false;
  if (!Take(bytes.value(), &at, &points) || !Take(bytes.value(), &at, state)) return false;
  const auto json = nlohmann::json::parse(points, nullptr, false);
  if (!json.is_array()) return false;
  for (const auto& p : json) {
    if (!p.is_array() || p.size() != 4) return false;
    curve->push_back(
        {p[0].get<int>(), p[1].get<double>(), p[2].get<double>(), p[3].get<std::string>()});
  }
  return true;
}

MaybeError Save(const std::string& path, const std::string& key, const std::string& state,
                const std::vector<TrainingPoint>& curve) {
  nlohmann::json points = nlohmann::json::array();
  for (const TrainingPoint& p : curve) {
    points.push_back({p.epoch, p.training_loss, p.validation_loss, p.stage});
  }
  std::string bytes;
  Append(key, &bytes);
  Append(points.dump(), &bytes);
  Append(state, &bytes);
  return WriteFileAtomically(path, bytes);
}

}  // namespace

MaybeError RunToEnd(Trainer* trainer, const std::string& key, const CheckpointOptions& options,
                    const std::function<void(TrainingPoint* point)>& told, TrainingCourse* course) {
  double last = Now();
  std::string state;
  std::vector<TrainingPoint> curve;
  if (Load(options.checkpoint, key, &state, &curve) && trainer->Resume(state)) {
    course->resumed = true;
  } else {
    curve.clear();
  }
  while (!trainer->Done()) {
    curve.push_back(trainer->RunRound());
    told(&curve.back());
    const bool due =
        trainer->Done() ? options.keep_finished : Now() - last >= options.checkpoint_seconds;
    if (options.checkpoint.empty() || !due) continue;
    last = Now();
    if (MaybeError error = Save(options.checkpoint, key, trainer->State(), curve)) return error;
  }
  course->curve.insert(course->curve.end(), curve.begin(), curve.end());
  return std::nullopt;
}

void RemoveCheckpoint(const std::string& file) {
  std::error_code ignored;
  if (!file.empty()) std::filesystem::remove(file, ignored);
}

namespace {

constexpr double kWidth = 640, kPanel = 220, kLeft = 60, kRight = 580, kTop = 44, kBottom = 34;
constexpr char kTraining[] = "stroke:#2a788e;stroke-width:2";
constexpr char kHeldOut[] = "stroke:#d1495b;stroke-width:2";

// One stage in a panel of its own: their losses mean different things. Stages have names where the
// training loss and the held-out one (m) have different units: then the latter has an axis of its
// own on the right.
void DrawStage(const std::vector<TrainingPoint>& points, double top, SvgPicture* svg) {
  const bool two_axes = !points.front().stage.empty();
  double most = 0.0, most_held = 0.0;
  for (const TrainingPoint& p : points) {
    most = std::max(most, p.training_loss);
    most_held = std::max(most_held, p.validation_loss);
  }
  if (!two_axes) most = most_held = std::max(most, most_held);
  const auto axis = [top](double highest) {
    return SvgScale(0.0, highest > 0.0 ? 1.05 * highest : 1.0, top + kPanel - kBottom, top + kTop);
  };
  const SvgScale x(points.front().epoch, points.back().epoch, kLeft, kRight);
  const SvgScale y = axis(most), y_held = axis(most_held);
  for (double tick : y.Ticks(4)) {
    svg->Line(kLeft, y(tick), kRight, y(tick), "grid");
    svg->Text(kLeft - 6, y(tick) + 4, Rounded(tick, 2), "axis end small");
  }
  if (two_axes) {
    for (double tick : y_held.Ticks(4)) {
      svg->Text(kRight + 6, y_held(tick) + 4, Rounded(tick, 2) + " m",
                "fill:#d1495b;font-size:10px");
    }
  }
  for (double tick : x.Ticks(8)) {
    if (tick != std::floor(tick)) continue;
    svg->Text(x(tick), top + kPanel - kBottom + 16, Rounded(tick, 4), "axis middle small");
  }
  std::vector<std::pair<double, double>> training, held;
  for (const TrainingPoint& p : points) {
    training.push_back({x(p.epoch), y(p.training_loss)});
    held.push_back({x(p.epoch), y_held(p.validation_loss)});
  }
  svg->Polyline(training, kTraining);
  svg->Polyline(held, kHeldOut);
  const auto best = std::min_element(
      points.begin(), points.end(),
      [](const auto& a, const auto& b) { return a.validation_loss < b.validation_loss; });
  svg->Circle(x(best->epoch), y_held(best->validation_loss), 4, "fill:#d1495b");
  svg->Text(kLeft, top + 34, points.front().stage, "ink bold small");
  svg->Text(kRight, top + 34,
            "best " + Rounded(best->validation_loss, 3) + " at " + std::to_string(best->epoch),
            "ink end small");
}

}  // namespace

std::string TrainingCurveSvg(const std::vector<TrainingPoint>& curve, const std::string& title) {
  std::vector<std::vector<TrainingPoint>> stages;
  for (const TrainingPoint& p : curve) {
    if (stages.empty() || stages.back().front().stage != p.stage) stages.emplace_back();
    stages.back().push_back(p);
  }
  SvgPicture svg(kWidth, 24 + kPanel * static_cast<double>(stages.size()), title);
  svg.Text(10, 18, title, "ink bold");
  svg.Text(kRight - 130, 18, "training", "fill:#2a788e;text-anchor:end");
  svg.Text(kRight, 18, "held-out recordings", "fill:#d1495b;text-anchor:end");
  for (size_t i = 0; i < stages.size(); ++i) {
    DrawStage(stages[i], 10 + kPanel * static_cast<double>(i), &svg);
  }
  return svg.ToString();
}

}  // namespace pushid
