// ident: trainings run, with checkpoints: key, curve and state, each with its length in front.
#include "ident/training/training_run.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

constexpr double kCheckpointSeconds = 20.0;  // between two

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
  double last = Now() - kCheckpointSeconds;  // the first is due at once
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
    const bool due = trainer->Done() ? options.keep_finished : Now() - last >= kCheckpointSeconds;
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

constexpr double kCurveWidth = 700;  // pixels
constexpr char kTraining[] = "stroke:#2a788e", kHeldOut[] = "stroke:#d1495b";

ChartLine LossLine(const std::vector<TrainingPoint>& stage, double TrainingPoint::*loss,
                   const char* look) {
  ChartLine line;
  line.look = std::string("fill:none;stroke-width:2;") + look;
  for (const TrainingPoint& p : stage) line.points.emplace_back(p.epoch, p.*loss);
  return line;
}

// Stages have names where the training loss and the held-out one (m) have different units, and a
// panel each.
void AddPanels(const std::vector<TrainingPoint>& stage, std::vector<Chart>* panels) {
  const ChartLine training = LossLine(stage, &TrainingPoint::training_loss, kTraining);
  const auto best = std::min_element(stage.begin(), stage.end(), [](const auto& a, const auto& b) {
    return a.validation_loss < b.validation_loss;
  });
  Chart chart{stage.front().stage, "epoch"};
  chart.y_from = 0.0;
  if (!chart.title.empty()) {
    panels->push_back(chart);
    panels->back().lines = {training};
    chart.y_label = "m";
  } else {
    chart.lines = {training};
  }
  chart.x_label +=
      ", best " + Rounded(best->validation_loss, 3) + " at " + std::to_string(best->epoch);
  chart.lines.push_back(LossLine(stage, &TrainingPoint::validation_loss, kHeldOut));
  chart.marks = {static_cast<double>(best->epoch)};
  panels->push_back(chart);
}

}  // namespace

std::string TrainingCurveSvg(const std::vector<TrainingPoint>& curve, const std::string& title) {
  Figure figure{{{"training", kTraining}, {"held-out recordings", kHeldOut}}, {}, title};
  for (size_t from = 0, to = 0; from < curve.size(); from = to) {
    while (to < curve.size() && curve[to].stage == curve[from].stage) ++to;
    AddPanels({curve.begin() + static_cast<std::ptrdiff_t>(from),
               curve.begin() + static_cast<std::ptrdiff_t>(to)},
              &figure.panels);
  }
  return DrawFigure(figure, kCurveWidth, title).ToString();
}

}  // namespace pushid
