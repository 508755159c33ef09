// datasets: a stick figure that walks.
#include "datasets/synthetic/synthetic_clips.h"

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

namespace {

constexpr int kTalkers = 3;
constexpr int kNobody = -1;
constexpr int kSpine = 1, kTalkingNeck = 4, kTalkersRightArm = 7, kTalkersRightElbow = 8,
              kTalkersLeftArm = 11,
              kTalkersLeftElbow = 12;  // joints of the synthetic skeleton
constexpr LengthUnit kTurnsUnit = LengthUnit::kMillimetre;
constexpr double kDegrees = 180.0 / M_PI;

// The speaker at each frame.
std::vector<int> Speakers(const SyntheticTurnsOptions& o, Random* random) {
  const double end = 1.0 / (o.turn_s * o.fps), begin = 1.0 / (o.pause_s * o.fps);
  const double pausing = end * o.pause_share / (end * o.pause_share + begin);
  const auto any = [random](int count) { return static_cast<int>(random->Unit() * count); };
  int speaker = random->Unit() < pausing ? kNobody : any(kTalkers);
  std::vector<int> speakers;
  for (int t = 0; t < o.frames; ++t) {
    speakers.push_back(speaker);
    if (speaker == kNobody) {
      if (random->Unit() < begin) speaker = any(kTalkers);
    } else if (random->Unit() < end) {
      const bool pauses = random->Unit() < o.pause_share;
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
    talkers.push_back({"T" + std::to_string(kTalkers * recording + n + 1), mass, skeleton, place,
                       angle + M_PI + random->Normal(0.0, 0.05),
                       std::exp(random->Normal(0.0, 0.15))});
  }
  return talkers;
}

double Wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

// The motion of one person, frame by frame.
class TalkingBody {
 public:
  TalkingBody(const Talker& who, double dt, Random* random)
      : who_(who), dt_(dt), phase_(random->Uniform(0.0, 2.0 * M_PI)) {
    for (int i = 0; i < kNoises; ++i) noise_.emplace_back(random, dt);
  }

  // looks: direction of whom they look at, rad; appends the channels of a frame.
  void Append(double looks, bool speaks, bool listens, std::vector<double>* values) {
    const double wanted = Wrapped(looks - who_.heading);
    for (int i = 0; i < kNoises; ++i) Follow(noise_[i].Next(), 0.3, &slow_[i]);
    if (first_) head_ = wanted, shoulders_ = kShare * wanted, gesture_ = speaks ? 1.0 : 0.0;
    first_ = false;
    Follow(wanted, 0.15, &head_);
    Follow(kShare * wanted, 0.35, &shoulders_);
    Follow(speaks ? 1.0 : 0.0, 0.2, &gesture_);
    Follow(listens ? 1.0 : 0.0, 0.3, &nod_);
    phase_ += 2.0 * M_PI * 1.1 * std::exp(0.2 * slow_[0]) * dt_;

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
  static constexpr double kShare = 0.7;

  void Follow(double wanted, double seconds, double* value) const {
    *value += (1.0 - std::exp(-dt_ / seconds)) * (wanted - *value);
  }

  const Talker& who_;
  double dt_, phase_;
  bool first_ = true;
  double head_ = 0.0, shoulders_ = 0.0, gesture_ = 0.0, nod_ = 0.0;
  std::vector<SlowNoise> noise_;
  std::array<double, kNoises> slow_{};  // without jitter from frame to frame
};

double DirectionTo(const Talker& of, const Talker& other) {
  const Eigen::Vector2d way = other.place - of.place;
  return std::atan2(way.y(), way.x());
}

// The channels of everybody.
std::vector<std::vector<double>> Move(const std::vector<Talker>& talkers,
                                      const std::vector<int>& speakers, double fps,
                                      Random* random) {
  constexpr double kLookSeconds = 1.0;
  std::vector<TalkingBody> bodies;
  for (const Talker& talker : talkers) bodies.emplace_back(talker, 1.0 / fps, random);
  std::vector<std::vector<double>> values(talkers.size());
  std::array<int, kTalkers> looks_at = {1, 2, 0};
  for (const int speaker : speakers) {
    for (int n = 0; n < kTalkers; ++n) {
      if (speaker != kNobody && n != speaker) looks_at[n] = speaker;
      if (n == speaker && random->Unit() < 1.0 / (kLookSeconds * fps)) {
        looks_at[n] = kTalkers - n - looks_at[n];  // the third
      }
      bodies[n].Append(DirectionTo(talkers[n], talkers[looks_at[n]]), n == speaker,
                       speaker != kNobody && n != speaker, &values[n]);
    }
  }
  return values;
}

RecordedStates StatesOfTurns(const Recording& recording, const std::vector<int>& speakers) {
  RecordedStates states{recording.id, {}};
  for (int n = 0; n < kTalkers; ++n) {
    states.subjects.push_back(recording.people[n].subject_id);
    states.people.emplace_back();
    for (const int speaker : speakers) {
      states.people.back().push_back(NameOf(speaker == kNobody ? TurnState::kRest
                                            : speaker == n     ? TurnState::kSpeak
                                                               : TurnState::kListen));
    }
  }
  return states;
}

nlohmann::ordered_json TruthJson(const SyntheticTurnsOptions& o) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array(), names = rows;
  const Eigen::Matrix3d shares = TurnTransitions(o);
  for (int i = 0; i < shares.rows(); ++i) {
    rows.push_back({shares(i, 0), shares(i, 1), shares(i, 2)});
  }
  for (const auto& row : Names(TurnState{})) names.push_back(row.name);
  return {{"seed", o.seed},
          {"turns",
           {{"turn_s", o.turn_s},
            {"pause_s", o.pause_s},
            {"pause_share", o.pause_share},
            {"states", names},
            {"transitions", rows}}}};
}

}  // namespace

Eigen::Matrix3d TurnTransitions(const SyntheticTurnsOptions& o) {
  const double end = 1.0 / (o.turn_s * o.fps), begin = 1.0 / (o.pause_s * o.fps);
  const double to_pause = end * o.pause_share, to_other = end - to_pause;
  const double rest = to_pause / (to_pause + begin);
  const double speak = (1.0 - rest) / kTalkers, listen = 2.0 * speak;
  Eigen::Matrix3d shares;
  shares.row(0) << speak * (1.0 - end), speak * to_other, speak * to_pause;
  shares.row(1) << listen * 0.5 * to_other, listen * (1.0 - to_pause - 0.5 * to_other),
      listen * to_pause;
  shares.row(2) << rest * begin / kTalkers, rest * begin * 2.0 / kTalkers, rest * (1.0 - begin);
  return shares;
}

MaybeError WriteSyntheticTurns(const std::string& folder, const SyntheticTurnsOptions& options) {
  if (MaybeError failed = MakeFolder(folder + "/bvh")) return failed;
  Manifest manifest;
  manifest.length_unit = kTurnsUnit;
  manifest.json->update(nlohmann::ordered_json{{"synthetic", TruthJson(options)}});
  std::vector<RecordedStates> states;
  Random seeds(options.seed);
  for (int i = 0; i < options.recordings; ++i) {
    Random random(seeds.Fork());
    const std::vector<int> speakers = Speakers(options, &random);
    const std::vector<Talker> talkers = DrawTalkers(i, &random);
    const auto values = Move(talkers, speakers, options.fps, &random);
    Recording recording;
    recording.id = "turns_" + std::string(i < 9 ? "0" : "") + std::to_string(i + 1);
    recording.labels.Set(kSettingLabel, "turns");
    recording.fps = options.fps;
    std::vector<std::string> files;
    std::vector<ManifestSubject> subjects;
    for (int n = 0; n < kTalkers; ++n) {
      const BvhMotion motion{talkers[n].skeleton.Bvh(kTurnsUnit), 1.0 / options.fps, values[n]};
      files.push_back("bvh/" + recording.id + "_" + std::to_string(n) + ".bvh");
      if (MaybeError failed = WriteBvh(folder + "/" + files.back(), motion)) {
        return failed;
      }
      subjects.push_back({talkers[n].id, talkers[n].mass_kg});
      recording.people.emplace_back();
      recording.people.back().subject_id = talkers[n].id;
      recording.people.back().hip.resize(options.frames);
    }
    ManifestRecording entry = EntryOf(recording);
    entry.subjects = subjects;
    entry.motion = files;
    manifest.recordings.push_back(entry);
    states.push_back(StatesOfTurns(recording, speakers));
  }
  if (MaybeError failed = WriteStates(folder + "/states.csv", states)) return failed;
  return WriteManifest(folder + "/manifest.json", manifest);
}

}  // namespace pushid
