// datasets: a stick figure that walks.
#include "datasets/synthetic/synthetic_clips.h"

#include <array>
#include <filesystem>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Root, right leg, left leg, waist, neck, head, right arm, left arm; y is up, z ahead.
constexpr char kStickFigure[] = R"({
  "joints": 16,
  "parents": [-1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 8, 10, 11, 8, 13, 14],
  "offsets_mm": [[0, 0, 0], [-100, 0, 0], [0, -420, 0], [0, -410, 0], [100, 0, 0], [0, -420, 0],
    [0, -410, 0], [0, 60, 0], [0, 440, 0], [0, 200, 0], [-180, 0, 0], [0, -290, 0], [0, -250, 0],
    [180, 0, 0], [0, -290, 0], [0, -250, 0]],
  "used": [2, 3, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15],
  "mirror": "x -> -x; joints 1-3 <-> 4-6, 10-12 <-> 13-15"
}
)";
enum Joint {
  kRightThigh = 1,
  kRightShin,
  kLeftThigh = 4,
  kLeftShin,
  kWaist = 7,
  kRightArm = 10,
  kRightForearm,
  kLeftArm = 13,
  kLeftForearm
};
constexpr int kJoints = 16;
constexpr double kStep = 1.0 / 50.0;  // s

struct StickAction {
  const char* name;
  double cadence, leg, knee, arm, elbow, sway;  // Hz, rad
};
constexpr StickAction kActions[] = {{"walking", 0.9, 0.45, 0.6, 0.35, 0.3, 0.04},
                                    {"running", 1.4, 0.75, 1.3, 0.70, 1.4, 0.06},
                                    {"strolling", 0.6, 0.25, 0.35, 0.15, 0.2, 0.05},
                                    {"waving", 0.5, 0.02, 0.05, 1.10, 1.2, 0.08}};

std::string Clip(const StickAction& action, int frames, Random* random) {
  constexpr double kAmplitude = 0.15, kCadence = 0.1, kTremor = 0.02;
  const auto own = [&](double size) { return size * std::exp(random->Normal(0.0, kAmplitude)); };
  const double leg = own(action.leg), knee = own(action.knee), arm = own(action.arm);
  const double elbow = own(action.elbow), sway = own(action.sway);
  double phase = random->Uniform(0.0, 2.0 * M_PI);
  SlowNoise cadence(random, kStep);
  std::vector<SlowNoise> tremor;
  while (tremor.size() < 3 * kJoints) tremor.emplace_back(random, kStep);
  std::string text;
  for (int t = 0; t < frames; ++t) {
    std::array<double, 3 * kJoints> maps{};
    for (size_t i = 3; i < maps.size(); ++i) maps[i] = kTremor * tremor[i].Next();
    const auto bend = [](double phi) { return 0.5 * (1.0 + std::sin(phi + M_PI / 2.0)); };
    for (const auto& [thigh, shin, upper, fore, phi] :
         {std::tuple(kRightThigh, kRightShin, kRightArm, kRightForearm, phase),
          std::tuple(kLeftThigh, kLeftShin, kLeftArm, kLeftForearm, phase + M_PI)}) {
      maps[3 * thigh] += leg * std::sin(phi);
      maps[3 * shin] -= knee * bend(phi);
      maps[3 * upper] -= arm * std::sin(phi);
      maps[3 * fore] += elbow * bend(phi);
    }
    maps[3 * kWaist + 2] += sway * std::sin(phase);
    phase += 2.0 * M_PI * action.cadence * std::exp(kCadence * cadence.Next()) * kStep;
    text += "0,0,0";  // of translation, which nobody uses
    for (const double value : maps) text += "," + Rounded(value, 7);
    text += "\n";
  }
  return text;
}

}  // namespace

MaybeError WriteSyntheticClips(const std::string& folder, const SyntheticClipOptions& options) {
  if (MaybeError error = MakeFolder(folder)) return error;
  const std::filesystem::path root(folder);
  if (MaybeError error = WriteFileAtomically((root / "skeleton.json").string(), kStickFigure)) {
    return error;
  }
  Random random(options.seed);
  for (const StickAction& action : kActions) {
    for (int i = 1; i <= options.clips + 1; ++i) {
      const std::filesystem::path place =
          root / (i > options.clips ? "test" : "train") / action.name;
      if (MaybeError error = MakeFolder(place.string())) return error;
      const std::string name = std::string(action.name) + "_" + std::to_string(i) + ".txt";
      const std::string clip = Clip(action, options.frames, &random);
      if (MaybeError error = WriteFileAtomically((place / name).string(), clip)) return error;
    }
  }
  return std::nullopt;
}

}  // namespace pushid
