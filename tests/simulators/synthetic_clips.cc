// A stick figure that walks.
#include "tests/simulators/synthetic_clips.h"

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/loading/generator_data.h"
#include "datasets/manifest/manifest.h"
#include "datasets/synthetic/synthetic_recordings.h"

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
  return Caught([&] {
    const std::filesystem::path root(folder);
    OrThrow(MakeFolder(folder));
    OrThrow(WriteFileAtomically((root / "skeleton.json").string(), kStickFigure));
    Random random(options.seed);
    for (const StickAction& action : kActions) {
      for (int i = 1; i <= options.clips + 1; ++i) {
        const std::string name = StrCat(std::string(action.name), "_", i, ".txt");
        const std::string file =
            (root / (i > options.clips ? "test" : "train") / action.name / name).string();
        OrThrow(MakeFolderOf(file));
        OrThrow(WriteFileAtomically(file, Clip(action, options.frames, &random)));
      }
    }
  });
}

namespace {

constexpr int kTalkers = 3;
constexpr int kNobody = -1;
constexpr int kSpine = 1, kTalkingNeck = 4, kTalkersRightArm = 7, kTalkersRightElbow = 8,
              kTalkersLeftArm = 11,
              kTalkersLeftElbow = 12;  // joints of the synthetic skeleton
constexpr LengthUnit kTurnsUnit = LengthUnit::kMillimetre;
constexpr double kDegrees = 180.0 / M_PI;
constexpr double kTurnsHz = 60.0, kTurnSeconds = 2.0, kPauseSeconds = 1.0;
constexpr double kPauseShare = 0.4;                            // of turns that end in a pause
constexpr double kTurnEnds = 1.0 / (kTurnSeconds * kTurnsHz);  // a frame
constexpr double kPauseEnds = 1.0 / (kPauseSeconds * kTurnsHz);

// The speaker at each frame.
std::vector<int> Speakers(int frames, Random* random) {
  constexpr double kPausing = kTurnEnds * kPauseShare / (kTurnEnds * kPauseShare + kPauseEnds);
  const auto any = [random](int count) { return static_cast<int>(random->Unit() * count); };
  int speaker = random->Unit() < kPausing ? kNobody : any(kTalkers);
  std::vector<int> speakers;
  for (int t = 0; t < frames; ++t) {
    speakers.push_back(speaker);
    if (speaker == kNobody) {
      if (random->Unit() < kPauseEnds) speaker = any(kTalkers);
    } else if (random->Unit() < kTurnEnds) {
      const bool pauses = random->Unit() < kPauseShare;
      speaker = pauses ? kNobody : (speaker + 1 + any(kTalkers - 1)) % kTalkers;
    }
  }
  return speakers;
}

struct Talker {
  std::string id;
  double mass_kg;
  SyntheticSkeleton skeleton;
  Eigen::Vector2d place;  // between the ankles, m
  double heading;         // rad
  double liveliness;      // of gestures
};

std::vector<Talker> DrawTalkers(int recording, Random* random) {
  const double turned = random->Uniform(0.0, 2.0 * M_PI), radius = random->Uniform(0.6, 0.9);
  std::vector<Talker> talkers;
  for (int n = 0; n < kTalkers; ++n) {
    const double angle = turned + 2.0 * M_PI * n / kTalkers + random->Normal(0.0, 0.1);
    const double mass = std::round(10.0 * random->Uniform(55.0, 95.0)) / 10.0;
    const SyntheticSkeleton skeleton(random->Uniform(0.82, 1.02));
    const Eigen::Vector2d place(radius * std::cos(angle), radius * std::sin(angle));
    talkers.push_back({StrCat("T", kTalkers * recording + n + 1), mass, skeleton, place,
                       angle + M_PI + random->Normal(0.0, 0.05),
                       std::exp(random->Normal(0.0, 0.15))});
  }
  return talkers;
}

// The motion of one person, frame by frame.
class TalkingBody {
 public:
  TalkingBody(const Talker& who, Random* random)
      : who_(who), phase_(random->Uniform(0.0, 2.0 * M_PI)) {
    for (int i = 0; i < kNoises; ++i) noise_.emplace_back(random, kStepSeconds);
  }

  // looks: direction of whom they look at, rad; appends the channels of a frame.
  void Append(double looks, bool speaks, bool listens, std::vector<double>* values) {
    const double wanted = std::remainder(looks - who_.heading, 2.0 * M_PI);
    for (int i = 0; i < kNoises; ++i) Follow(noise_[i].Next(), 0.3, &slow_[i]);
    if (first_) head_ = wanted, shoulders_ = kShare * wanted, gesture_ = speaks ? 1.0 : 0.0;
    first_ = false;
    Follow(wanted, 0.15, &head_);
    Follow(kShare * wanted, 0.35, &shoulders_);
    Follow(speaks ? 1.0 : 0.0, 0.2, &gesture_);
    Follow(listens ? 1.0 : 0.0, 0.3, &nod_);
    phase_ += 2.0 * M_PI * 1.1 * std::exp(0.2 * slow_[0]) * kStepSeconds;

    const double theta = 0.006 * slow_[1], phi = 0.006 * slow_[2];
    const double rod = who_.skeleton.rod_length(), height = who_.skeleton.cart_height();
    const Eigen::Vector3d foot(0.0, 0.0, height), half = who_.skeleton.HalfStance();
    const Eigen::Vector3d hip(rod * std::sin(theta), -rod * std::cos(theta) * std::sin(phi),
                              height + rod * std::cos(theta) * std::cos(phi));
    const size_t begin = values->size();
    who_.skeleton.AppendFrame({theta, phi, hip, foot + half, foot - half}, kTurnsUnit, values);
    const Eigen::Rotation2D<double> turn(who_.heading);
    const Eigen::Vector2d there = who_.place + turn * Eigen::Vector2d(hip.head<2>());
    double* const frame = values->data() + begin;
    frame[0] = kMillimetres * there.x();
    frame[1] = kMillimetres * there.y();
    // Channels are the hip's place, then three angles of each joint, about z, y and x.
    const auto turn_joint = [frame](int joint, int axis, double angle) {
      frame[3 + 3 * joint + axis] = kDegrees * angle;
    };
    const double shoulders = shoulders_ + 0.04 * slow_[3];
    const double head = head_ + 0.05 * slow_[4];
    turn_joint(kHipJoint, 0, who_.heading);
    for (int j = kSpine; j < kTalkingNeck; ++j) turn_joint(j, 0, shoulders / 3.0);
    turn_joint(kTalkingNeck, 0, head - shoulders);
    turn_joint(kTalkingNeck, 1, 0.08 * nod_ * std::sin(0.9 * phase_));
    const double lively = who_.liveliness * gesture_;
    for (const bool left : {false, true}) {
      const double beat = phase_ + (left ? 1.0 : 0.0);
      const double raise = lively * (0.45 + 0.2 * std::sin(beat)) + 0.03 * slow_[5 + left];
      const double bend = lively * (1.1 + 0.4 * std::sin(1.3 * beat)) + 0.15;
      turn_joint(left ? kTalkersLeftArm : kTalkersRightArm, 1, -raise);
      turn_joint(left ? kTalkersLeftElbow : kTalkersRightElbow, 1, -bend);
    }
  }

 private:
  static constexpr int kNoises = 7;
  static constexpr double kShare = 0.7, kStepSeconds = 1.0 / kTurnsHz;

  void Follow(double wanted, double seconds, double* value) const {
    *value += (1.0 - std::exp(-kStepSeconds / seconds)) * (wanted - *value);
  }

  const Talker& who_;
  double phase_;
  bool first_ = true;
  double head_ = 0.0, shoulders_ = 0.0, gesture_ = 0.0, nod_ = 0.0;
  std::vector<SlowNoise> noise_;
  std::array<double, kNoises> slow_{};  // without jitter from frame to frame
};

// The channels of everybody.
std::vector<std::vector<double>> Move(const std::vector<Talker>& talkers,
                                      const std::vector<int>& speakers, Random* random) {
  constexpr double kLookSeconds = 1.0;
  std::vector<TalkingBody> bodies;
  for (const Talker& talker : talkers) bodies.emplace_back(talker, random);
  std::vector<std::vector<double>> values(talkers.size());
  std::array<int, kTalkers> looks_at = {1, 2, 0};
  for (const int speaker : speakers) {
    for (int n = 0; n < kTalkers; ++n) {
      if (speaker != kNobody && n != speaker) looks_at[n] = speaker;
      if (n == speaker && random->Unit() < 1.0 / (kLookSeconds * kTurnsHz)) {
        looks_at[n] = kTalkers - n - looks_at[n];  // the third
      }
      const Eigen::Vector2d way = talkers[looks_at[n]].place - talkers[n].place;
      bodies[n].Append(std::atan2(way.y(), way.x()), n == speaker,
                       speaker != kNobody && n != speaker, &values[n]);
    }
  }
  return values;
}

nlohmann::ordered_json TruthJson(uint64_t seed) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array(), names = rows;
  const Eigen::Matrix3d shares = TurnTransitions();
  for (int i = 0; i < shares.rows(); ++i) {
    rows.push_back({shares(i, 0), shares(i, 1), shares(i, 2)});
  }
  for (const auto& row : Names(TurnState{})) names.push_back(row.name);
  return {{"seed", seed},
          {"turns",
           {{"turn_s", kTurnSeconds},
            {"pause_s", kPauseSeconds},
            {"pause_share", kPauseShare},
            {"states", names},
            {"transitions", rows}}}};
}

}  // namespace

Eigen::Matrix3d TurnTransitions() {
  const double to_pause = kTurnEnds * kPauseShare, to_other = kTurnEnds - to_pause;
  const double rest = to_pause / (to_pause + kPauseEnds);
  const double speak = (1.0 - rest) / kTalkers, listen = 2.0 * speak;
  Eigen::Matrix3d shares;
  shares << speak * (1.0 - kTurnEnds), speak * to_other, speak * to_pause,  //
      listen * 0.5 * to_other, listen * (1.0 - to_pause - 0.5 * to_other), listen * to_pause,
      rest * kPauseEnds / kTalkers, rest * kPauseEnds * 2.0 / kTalkers, rest * (1.0 - kPauseEnds);
  return shares;
}

MaybeError WriteSyntheticTurns(const std::string& folder, const SyntheticTurnsOptions& options) {
  return Caught([&] {
    OrThrow(MakeFolder(folder + "/bvh"));
    Manifest manifest;
    manifest.length.length_unit = kTurnsUnit;
    manifest.json->update(nlohmann::ordered_json{{"synthetic", TruthJson(options.seed)}});
    std::vector<RecordedStates> states;
    Random seeds(options.seed);
    for (int i = 0; i < options.recordings; ++i) {
      Random random(seeds.Fork());
      const std::vector<int> speakers = Speakers(options.frames, &random);
      const std::vector<Talker> talkers = DrawTalkers(i, &random);
      const auto values = Move(talkers, speakers, &random);
      ManifestRecording& entry = manifest.recordings.emplace_back();
      entry.id = StrCat("turns_", i < 9 ? "0" : "", i + 1);
      entry.labels.Set(kSettingLabel, "turns");
      entry.fps = kTurnsHz;
      entry.frames = options.frames;
      states.push_back({entry.id, {}});
      for (int n = 0; n < kTalkers; ++n) {
        entry.motion.push_back(StrCat("bvh/", entry.id, "_", n, ".bvh"));
        OrThrow(WriteBvh(folder + "/" + entry.motion.back(),
                         {talkers[n].skeleton.Bvh(kTurnsUnit), 1.0 / kTurnsHz, values[n]}));
        entry.subjects.push_back({talkers[n].id, talkers[n].mass_kg});
        states.back().subjects.push_back(talkers[n].id);
        std::vector<std::string>& symbols = states.back().people.emplace_back();
        for (const int speaker : speakers) {
          symbols.push_back(NameOf(speaker == kNobody ? TurnState::kRest
                                   : speaker == n     ? TurnState::kSpeak
                                                      : TurnState::kListen));
        }
      }
    }
    OrThrow(WriteStates(folder + "/states.csv", states));
    OrThrow(WriteManifest(folder + "/manifest.json", manifest));
  });
}

}  // namespace pushid
