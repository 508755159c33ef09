// Synthetic recordings of people on moving ground and on force platforms, in memory and as files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "models/ground.h"
#include "models/rollout.h"

namespace pushid {

// Motion of the ground, along x.
enum class GroundKind {
  kNone,
  kStep,        // a shift within 0.4 s, from 0.3 s on
  kSine,        // of 0.5 Hz, from rest within a second
  kSumOfSines,  // of 0.15, 0.35, 0.65, 1.05 and 1.55 Hz, from rest within a second
};

struct PlatformOptions : SyntheticOptions {
  GroundKind kind = GroundKind::kNone;
  double size_m = 0.03;                               // of the step, or of each sine
  double plate_noise_m = 0.002, plate_noise_n = 2.0;  // of the centre of pressure, and of forces
};

// A rise from 0 to 1 with velocity and acceleration zero at both ends (minimum jerk).
inline double MinimumJerk(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * v * (10.0 - 15.0 * v + 6.0 * v * v);
}

// Poses of the ground; size: m, of the step or of each sine.
inline std::vector<GroundPose> SyntheticGround(GroundKind kind, double size, int frames,
                                               double dt) {
  constexpr double kStepStart = 0.3, kStepSeconds = 0.4;       // s
  constexpr double kSine = 0.5;                                // Hz
  constexpr double kSines[] = {0.15, 0.35, 0.65, 1.05, 1.55};  // Hz
  std::vector<GroundPose> poses(frames, GroundPose::Zero());
  for (int t = 0; t < frames; ++t) {
    const double s = t * dt;
    double shift = 0.0;
    if (kind == GroundKind::kStep) shift = MinimumJerk((s - kStepStart) / kStepSeconds);
    if (kind == GroundKind::kSine) shift = MinimumJerk(s) * std::sin(2.0 * M_PI * kSine * s);
    if (kind == GroundKind::kSumOfSines) {
      for (double f : kSines) shift += MinimumJerk(s) * std::sin(2.0 * M_PI * f * s);
    }
    poses[t].x() = size * shift;
  }
  return poses;
}

// Measurements of platforms under the person, which move with the ground.
inline std::vector<PlateSample> ObservePlates(const PlatformOptions& options,
                                              const SyntheticRecording& made, int n,
                                              Random* noise) {
  std::vector<PlateSample> plates;
  const Scene& scene = made.scene;
  const BodyOf<double> body = DynamicBody(options.model, scene.people[n].body, made.parameters[n],
                                          options.model.stance == Stance::kFixed);
  for (int t = 0; t < options.frames; ++t) {
    const int at = std::min(t, options.frames - 2);  // the last frame has no step
    const PendulumState<double>& state = made.path.At(at, n);
    const GroundStep& ground = scene.ground.StepAt(at);
    const Vector4<double> felt =
        (made.path.At(at + 1, n).qd - state.qd) / scene.dt + ground.acceleration;
    const ReactionForce<double> force(body, Angles<double>(state.q), state.qd, felt, ground.gravity,
                                      PushForceAt(scene, n, at));
    const GroundReactionOf<double> reaction = ReactionOn(force, body.cart_height, state.q);
    const auto err = [&](double sigma) { return sigma * noise->Normal(); };
    PlateSample sample;
    sample.force = {reaction[0] + err(options.plate_noise_n),
                    reaction[1] + err(options.plate_noise_n),
                    force.vertical + err(options.plate_noise_n)};
    sample.centre = {reaction[2] + err(options.plate_noise_m),
                     reaction[3] + err(options.plate_noise_m), 0.0};
    sample.weight = 1.0;
    plates.push_back(sample);
  }
  return plates;
}

// MakeSyntheticRecordings of people who stand on platforms.
inline Result<std::vector<SyntheticRecording>> MakeOnPlatforms(PlatformOptions options) {
  if (options.kind != GroundKind::kNone) {
    options.ground =
        SyntheticGround(options.kind, options.size_m, options.frames, 1.0 / options.fps);
  }
  auto made = MakeSyntheticRecordings(options);
  if (!made.ok()) return made;
  Random noise(options.seed + 1);
  for (SyntheticRecording& one : made.value()) {
    for (size_t n = 0; n < one.recording.people.size(); ++n) {
      one.recording.people[n].plates = ObservePlates(options, one, static_cast<int>(n), &noise);
    }
  }
  return made;
}

// Writes a table with a row for each frame: its time, then the numbers. Returns its name.
template <typename Row>
std::string WriteTimed(const std::string& folder, const std::string& file, const std::string& names,
                       const Recording& recording, const Row& row) {
  OrThrow(MakeFolderOf(folder + "/" + file));
  std::string text = "time," + names + "\n";
  for (int t = 0; t < recording.num_frames(); ++t) {
    text += DoubleText(t / recording.fps);
    for (double value : row(t)) text += "," + DoubleText(value);
    text += "\n";
  }
  OrThrow(WriteFileAtomically(folder + "/" + file, text));
  return file;
}

// WriteSyntheticRecordings, with the ground's and the platforms' files and their keys.
inline MaybeError WriteOnPlatforms(const std::string& folder, const SyntheticOptions& options,
                                   const std::vector<SyntheticRecording>& made) {
  return Caught([&] {
    OrThrow(WriteSyntheticRecordings(folder, options, made));
    nlohmann::ordered_json manifest = OrThrow(ReadJsonDocument(folder + "/manifest.json")).content;
    for (size_t i = 0; i < made.size(); ++i) {
      const Recording& recording = made[i].recording;
      nlohmann::ordered_json& entry = manifest["recordings"][i];
      if (!recording.ground.empty()) {
        entry["ground"]["csv"] =
            WriteTimed(folder, "ground/" + recording.id + ".csv", "x,y,theta,phi", recording,
                       [&](int t) { return recording.ground[t]; });
      }
      const size_t people = recording.people.size();
      for (size_t n = 0; n < people; ++n) {
        const std::vector<PlateSample>& samples = recording.people[n].plates;
        if (samples.empty()) continue;
        const std::string name = recording.id + (people > 1 ? StrCat("_", n) : "") + ".csv";
        nlohmann::ordered_json plates = {
            {"use", "measure"},
            {"file", WriteTimed(folder, "plates/" + name, "fx,fy,fz,px,py", recording, [&](int t) {
               const PlateSample& s = samples[t];
               return std::array{s.force[0], s.force[1], s.force[2], s.centre[0], s.centre[1]};
             })}};
        if (people > 1) plates["person"] = n;
        if (people > 1) {
          entry["force_plates"].push_back(plates);
        } else {
          entry["force_plates"] = plates;
        }
      }
    }
    OrThrow(WriteJson(folder + "/manifest.json", manifest, 1));
  });
}

}  // namespace pushid
