#include "ident/formations/formation_run.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/propagation.h"
#include "ident/problem/statistics.h"
#include "models/formation.h"
#include "models/self_terms.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

Outcome Judge(const FormationRun& run, int person, int onset_frame) {
  const RolloutPath<double>& path = run.prediction.path;
  for (int t = 0; t < run.num_frames(); ++t) {
    if (path.At(t, person).q.tail<2>().cwiseAbs().maxCoeff() > kFallAngle) return Outcome::kFell;
  }
  if (onset_frame < 0) return Outcome::kUnmoved;
  const Scene& scene = run.recording.scene;
  // Time counts from a person's own onset, so that it does not hold what a wave takes to reach them
  // (kWaitSecondsInRows).
  const int judged = std::max(scene.LastPushEnd(), onset_frame) +
                     static_cast<int>(std::lround(kWaitSeconds / scene.dt));
  if (judged >= run.num_frames()) return Outcome::kNotJudged;
  const PendulumState<double>& end = path.At(judged, person);
  const Vector4<double>& rest = scene.people[person].start.q;
  const bool settled = end.qd.head<2>().norm() < kSettledSpeed &&
                       (end.q - rest).tail<2>().cwiseAbs().maxCoeff() < kSettledLean;
  return settled ? Outcome::kSettled : Outcome::kSlow;
}

constexpr int kDraws = 60;
constexpr double kLower = 0.05, kUpper = 0.95;

// Onset frames of all people in each draw; none where its rollout left the model's domain.
std::vector<std::vector<int>> DrawnOnsets(const FittedModel& model, const std::string& set,
                                          const FormationRun& run) {
  const bool replicas = model.bootstrap && !model.bootstrap->values.empty();
  if (!replicas && model.fit.uncertainty.covariance.size() == 0) return {};
  BandOptions options;
  options.samples = kDraws;
  if (replicas) options.bootstrap = &*model.bootstrap;
  IdentifiedModel fitted = ModelOf(model.fit);
  fitted.by_unit.clear();  // no person of a formation is one of the fit
  std::vector<std::vector<int>> onsets;
  for (const ParameterSet<double>& draw : SampleParameters(model.fit, options)) {
    IdentifiedModel drawn = WithShared(fitted, draw);
    if (SetValues(set, &drawn)) return {};
    const Prediction prediction = Predict(drawn, run.recording, run.num_frames());
    onsets.emplace_back();
    if (!prediction.status.ok) continue;
    for (const auto& hip : prediction.hip) onsets.back().push_back(OnsetFrame(hip));
  }
  return onsets;
}

constexpr int kSpeedFrames = 6;

// Horizontal, m, from the first that was seen; frames without the person are left out.
struct Track {
  std::vector<int> frames;
  HipPath places;
};

Track TrackOf(const std::vector<Eigen::Vector3d>& positions, double metres) {
  Track track;
  for (size_t frame = 0; frame < positions.size(); ++frame) {
    if (!positions[frame].head<2>().allFinite()) continue;
    track.frames.push_back(static_cast<int>(frame));
    track.places.emplace_back(metres * positions[frame].x(), metres * positions[frame].y(), 0.0);
  }
  return track;
}

double PeakSpeedOf(const Track& track, const Eigen::Vector3d& way, double rate) {
  double peak = 0.0;
  for (size_t i = kSpeedFrames; i < track.places.size(); ++i) {
    const double seconds = (track.frames[i] - track.frames[i - kSpeedFrames]) / rate;
    peak = std::max(peak, way.dot(track.places[i] - track.places[i - kSpeedFrames]) / seconds);
  }
  return peak;
}

void AddSlowness(MeasuredWave* wave) {
  std::vector<double> distance, onset;
  for (const PersonInWave& person : wave->people) {
    if (!person.onset_s) continue;
    distance.push_back(person.distance);
    onset.push_back(*person.onset_s);
  }
  wave->slowness = Slowness(distance, onset);
  if (!wave->slowness) return;
  const double s_mean = MeanOf(distance).mean, t_mean = MeanOf(onset).mean;
  double squares = 0.0, left = 0.0;
  for (size_t i = 0; i < distance.size(); ++i) {
    const double s = distance[i] - s_mean;
    squares += s * s;
    left += std::pow(onset[i] - t_mean - *wave->slowness * s, 2);
  }
  const double freedom = static_cast<double>(distance.size()) - 2.0;
  wave->error = std::sqrt(left / freedom / squares);
  wave->quantile = StudentQuantile95(freedom);
}

// "0.75 m/s (95 %: 0.5 to 1.3, ...)"; or why the onsets give no speed.
std::string SpeedOf(double slowness, double half_width, const std::string& from) {
  const double slowest = slowness + half_width, fastest = slowness - half_width;
  if (!(slowest > 0.0)) return "none: people farther away start earlier";
  const std::string interval = fastest > 0.0
                                   ? Rounded(1.0 / slowest, 3) + " to " + Rounded(1.0 / fastest, 3)
                                   : "above " + Rounded(1.0 / slowest, 3);
  const std::string ending = "95 %: " + interval + ", from " + from;
  return slowness > 0.0 ? Rounded(1.0 / slowness, 3) + " m/s (" + ending + ")"
                        : "it cannot be determined (" + ending + ")";
}

}  // namespace

std::string OutcomeLegend() {
  return "outcome: judged " + Rounded(kWaitSeconds, 4) +
         " s after the last push, or after the onset where that is later; " + kSettledText +
         ": slower than " + Rounded(kSettledSpeed, 4) + " m/s\nand within " +
         Rounded(kSettledLean, 4) + " rad of the rest posture then; " + kSlowToSettleText +
         ": not yet. " + kFellText +
         ": at any time. displaced: at the end of the run, along the push\n";
}

std::vector<ForcePart> ActingParts(const FormationRun& run) {
  std::vector<ForcePart> acting;
  for (const auto& [name, part] : kForceParts) {
    bool acts = false;
    for (int t = 0; t < run.num_frames() && !acts; ++t) {
      for (int n = 0; n < run.num_people(); ++n) {
        acts = acts || !run.Force(n, t)[part].isZero(0.0);
      }
    }
    if (acts) acting.push_back(part);
  }
  std::stable_partition(acting.begin(), acting.end(), [](ForcePart part) {
    return part == ForcePart::kPush || part == ForcePart::kTail;
  });
  return acting;
}

FormationRun RunFormation(const IdentifiedModel& model, const Scene& scene, int num_frames,
                          const std::vector<std::string>& names) {
  FormationRun run;
  PendulumRecording& recording = run.recording;
  recording.id = "formation";
  recording.labels.Set(kSettingLabel, recording.id);
  recording.scene = scene;
  if (!scene.pushes.empty()) recording.pushed_person = scene.pushes.front().person;
  recording.subject_ids = names;
  const size_t width = std::to_string(std::max(10, scene.num_people() - 1)).size();
  for (int n = 0; n < scene.num_people() && names.empty(); ++n) {
    std::string number = std::to_string(n);  // names sort in the order of the people
    number.insert(0, width - number.size(), '0');
    recording.subject_ids.push_back("p" + number);
  }
  // People of a formation are no subjects of the fit.
  IdentifiedModel shared = model;
  shared.by_unit.clear();
  run.prediction = Predict(shared, recording, num_frames);
  if (!run.prediction.status.ok) return run;
  for (int n = 0; n < run.num_people(); ++n) {
    const HipPath& hip = run.prediction.hip[n];
    PersonSummary& summary = run.summaries.emplace_back();
    for (int t = 0; t < run.num_frames(); ++t) {
      summary.peak_speed = std::max(summary.peak_speed, std::abs(HipSpeed(run, n, t)));
    }
    summary.onset_frame = OnsetFrame(hip);
    summary.displacement = PushDirection(recording).dot((hip.back() - hip.front()).head<2>());
    summary.outcome = Judge(run, n, summary.onset_frame);
  }
  return run;
}

std::string PersonText(const FitResult& fit, const IdentifiedModel& model,
                       const std::vector<PendulumRecording>& recordings) {
  const auto external = [](const PendulumRecording& recording) {
    const std::vector<ScenePush>& pushes = recording.scene.pushes;
    return std::any_of(pushes.begin(), pushes.end(), [](const ScenePush& push) {
      return push.kind == PushKind::kExternal && !push.force.empty();
    });
  };
  if (!model.push_range || model.push_range->net_s.empty() ||
      !model.push_range->external_s.empty() ||
      std::none_of(recordings.begin(), recordings.end(), external)) {
    return "";
  }
  std::string text = "person: of " +
                     CountText(model.push_range->people.size(), "person", "people") + " in " +
                     CountText(fit.recordings.size(), "recording") +
                     " of net pushes (--stance=" + NameOf(model.options.stance) + ")";
  // The weakest pushes, where those who stand end, and the hardest, where those who step end.
  for (const auto& [speed, duration, measured] :
       {std::array{0.20, 0.60, 0.02}, std::array{0.62, 0.86, 0.68}}) {
    text += "; given " + Rounded(speed, 2) + " m/s in " + Rounded(duration, 2) + " s";
    for (const double height : {1.0, 1.25}) {  // of the rod
      Scene scene = FormationScene({{0.0, 0.0}}, {75.0, kReferenceRod, 0.0}, 1.0 / 60.0);
      AddHipPush(0, {75.0 * speed, 0.0, duration, 0.0, height}, &scene);
      const FormationRun run = RunFormation(model, scene, 480);  // 8 s
      text += height > 1.0 ? " and at the trunk " : " at the hip it ends ";
      text += run.summaries.empty() ? "on the ground"
                                    : Rounded(run.summaries[0].displacement, 2) + " m away";
    }
    text += " (ten measured people: " + Rounded(measured, 2) + " m)";
  }
  return text;
}

double HipSpeed(const FormationRun& run, int person, int frame) {
  if (frame == 0) return 0.0;
  const HipPath& hip = run.prediction.hip[person];
  const Vector3<double> step = hip[frame] - hip[frame - 1];
  const double speed = step.norm() / run.recording.scene.dt;
  return -step.x() > std::abs(step.y()) ? -speed : speed;
}

Pose SyntheticPose(double rod_length) {
  const SyntheticSkeleton skeleton(rod_length);
  const Eigen::Vector3d cart(0.0, 0.0, skeleton.cart_height());
  SkeletonPose upright;
  upright.hip = cart + Eigen::Vector3d(0.0, 0.0, rod_length);
  upright.left_ankle = cart + skeleton.HalfStance();
  upright.right_ankle = cart - skeleton.HalfStance();
  std::vector<double> row;
  skeleton.AppendFrame(upright, LengthUnit::kMetre, &row);
  std::vector<int> joints(kBodyJoints);
  for (int j = 0; j < kBodyJoints; ++j) joints[j] = j;
  BvhKinematics kinematics(skeleton.Bvh(LengthUnit::kMetre), 1.0, joints);
  std::vector<Eigen::Vector3d> positions(kBodyJoints);
  kinematics.Positions(row.data(), positions.data());
  Pose pose;
  for (int j = 0; j < kBodyJoints; ++j) pose.col(j) = positions[j];
  return pose;
}

void PlaceFittedPeople(const std::vector<FittedPerson>& people, Scene* scene) {
  for (int n = 0; n < scene->num_people(); ++n) {
    const FittedPerson& fitted = people[n % people.size()];
    ScenePerson& person = scene->people[n];
    person.body.mass = fitted.mass;
    person.body.rod_length = fitted.rod;
    person.body.cart_height = fitted.cart_height;
    person.start.q.tail<2>() << fitted.theta, fitted.phi;
    person.start.feet.apart = fitted.apart;
  }
}

std::vector<Pose> SyntheticPoses(Scene* scene) {
  std::vector<Pose> poses;
  for (ScenePerson& person : scene->people) {
    const Vector4<double>& q = person.start.q;
    const Eigen::Quaterniond lean = Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(q[2], Eigen::Vector3d::UnitY());
    Pose pose = SyntheticPose(person.body.rod_length);
    const Eigen::Vector3d origin(0.0, 0.0, pose(2, kLeftAnkle));
    if (person.body.cart_height == 0.0) person.body.cart_height = origin.z();
    const Eigen::Vector3d cart(q[0], q[1], person.body.cart_height);
    for (int j = 0; j < kBodyJoints; ++j) {
      const Eigen::Vector3d at = pose.col(j) - origin;
      pose.col(j) = cart + (at.z() > 0.0 ? lean * at : at);  // feet stay flat
    }
    const Eigen::Vector2d half = 0.5 * person.start.feet.apart;
    pose.col(kLeftAnkle) << cart.head<2>() + half, cart.z();
    pose.col(kRightAnkle) << cart.head<2>() - half, cart.z();
    poses.push_back(pose);
  }
  return poses;
}

std::vector<Pose> TakePoses(const std::vector<Pose>& poses, Scene* scene) {
  std::vector<Pose> placed;
  for (int n = 0; n < scene->num_people(); ++n) {
    ScenePerson& person = scene->people[n];
    Pose pose = poses[n % poses.size()];
    pose = (TurnAboutZ(-Heading(pose)) * pose).eval();
    const Eigen::Vector3d cart = 0.5 * (pose.col(kLeftAnkle) + pose.col(kRightAnkle));
    pose.colwise() +=
        Eigen::Vector3d(person.start.q[0] - cart.x(), person.start.q[1] - cart.y(), 0.0);
    const MappedPose mapped = MapSkeleton(pose.col(0), pose.col(kLeftAnkle), pose.col(kRightAnkle));
    person.body.rod_length = mapped.rod_length;
    person.body.cart_height = mapped.cart_height;
    person.start.q.tail<2>() = mapped.q.tail<2>();
    person.start.feet.apart = (pose.col(kLeftAnkle) - pose.col(kRightAnkle)).head<2>();
    placed.push_back(pose);
  }
  return placed;
}

std::vector<BodyMotion> FormationBodies(const FormationRun& run,
                                        const std::vector<Pose>& first_poses,
                                        const Restoration& restoration,
                                        const PostprocessOptions& options) {
  const Scene& scene = run.recording.scene;
  std::vector<RestorationInput> people = PeopleOf(scene, first_poses);
  FollowPrediction(run.prediction, &people);
  return RestoreBodies(restoration, options, people);
}

std::vector<Pose> PlacePeople(const std::vector<BodyRecording>& recordings, Scene* scene) {
  std::vector<Pose> poses;
  std::vector<double> masses;
  std::set<std::string> seen;
  for (const BodyRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      if (!seen.insert(recording.pendulum.subject_ids[n]).second) continue;
      poses.push_back(recording.bodies[n].front());
      masses.push_back(recording.pendulum.scene.people[n].body.mass);
    }
  }
  for (int n = 0; n < scene->num_people(); ++n) {
    scene->people[n].body.mass = masses[n % masses.size()];
  }
  return TakePoses(poses, scene);
}

std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets) {
  if (scene.pushes.size() != 1) return std::nullopt;
  int first = -1, foremost = -1;
  for (int n = 0; n < scene.num_people(); ++n) {
    if (onsets[n] < 0) continue;
    if (first < 0 || onsets[n] < onsets[first]) first = n;
    foremost = n;
  }
  if (first < 0) return std::nullopt;
  const WaveSpeed wave{first, foremost,
                       scene.people[foremost].start.q[0] - scene.people[first].start.q[0],
                       (onsets[foremost] - onsets[first]) * scene.dt};
  if (!(wave.metres > 0.0) || !(wave.seconds > 0.0)) return std::nullopt;
  return wave;
}

std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run) {
  std::vector<int> onsets;
  for (const PersonSummary& person : run.summaries) onsets.push_back(person.onset_frame);
  return SpeedOfWave(run.recording.scene, onsets);
}

std::string HeldInDraws(const FittedModel& model, const std::string& set) {
  std::string held;
  const auto add = [&held](const std::string& text) { held += (held.empty() ? "" : ", ") + text; };
  const Result<std::vector<NamedValue>> values = ParseAssignments(set, "--set");
  const std::vector<NamedValue> replaced = values.ok() ? values.value() : std::vector<NamedValue>();
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    const bool again = std::any_of(replaced.begin(), replaced.end(),
                                   [&e](const NamedValue& one) { return one.name == e.name; });
    const bool convention = spec != nullptr && HeldByConvention(spec->id);
    if (e.status != EstimateStatus::kFixed || again || convention) continue;
    add(e.name + " = " + Rounded(e.value, 4));
  }
  for (const NamedValue& one : replaced) add(one.name + " = " + Rounded(one.value, 4) + " (--set)");
  return held;
}

WaveBands BandsOfWave(const FittedModel& model, const std::string& set, const FormationRun& run) {
  const std::vector<std::vector<int>> draws = DrawnOnsets(model, set, run);
  const Scene& scene = run.recording.scene;
  WaveBands bands;
  std::vector<double> speeds;
  for (const std::vector<int>& onsets : draws) {
    if (onsets.empty()) {
      ++bands.failed;
    } else if (const auto wave = SpeedOfWave(scene, onsets)) {
      speeds.push_back(wave->MetresPerSecond());
    }
  }
  SpeedBand& speed = bands.speed;
  speed.moved = static_cast<int>(speeds.size());
  speed.draws = static_cast<int>(draws.size());
  if (speed.known()) speed.from = Quantile(speeds, kLower), speed.to = Quantile(speeds, kUpper);
  for (int n = 0; n < run.num_people() && !draws.empty(); ++n) {
    std::vector<double> seconds;
    for (const std::vector<int>& onsets : draws) {
      if (!onsets.empty() && onsets[n] >= 0) seconds.push_back(onsets[n] * scene.dt);
    }
    OnsetBand& band = bands.onsets.emplace_back();
    if (seconds.empty()) continue;
    band = {Quantile(seconds, kLower), Quantile(seconds, kUpper),
            static_cast<double>(seconds.size()) / static_cast<double>(draws.size())};
  }
  return bands;
}

MeasuredWave MeasureWave(const std::string& name, const PointMotion& motion) {
  MeasuredWave wave;
  wave.name = name;
  const double metres = MetresPer(motion.unit.value_or(LengthUnit::kMetre));
  std::vector<Track> tracks;
  std::vector<int> onsets;
  int first = -1;
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    tracks.push_back(TrackOf(motion.positions[i], metres));
    const int onset = OnsetFrame(tracks.back().places);
    onsets.push_back(onset < 0 ? onset : tracks.back().frames[onset]);
    const bool moves = onsets.back() >= 0;
    if (moves && (first < 0 || onsets.back() < onsets[static_cast<size_t>(first)])) {
      first = static_cast<int>(i);
    }
  }
  if (first < 0) return wave;
  const Track& origin = tracks[static_cast<size_t>(first)];
  Eigen::Vector3d way = Eigen::Vector3d::Zero();  // from the first place to the farthest
  for (const Eigen::Vector3d& place : origin.places) {
    if ((place - origin.places[0]).norm() > way.norm()) way = place - origin.places[0];
  }
  way.normalize();
  for (size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    if (track.places.empty()) continue;
    PersonInWave person;
    person.name = motion.names[static_cast<size_t>(motion.chosen[i])];
    person.distance = (track.places[0] - origin.places[0]).norm();
    if (onsets[i] >= 0) person.onset_s = onsets[i] / motion.rate_hz;
    person.peak_speed = PeakSpeedOf(track, way, motion.rate_hz);
    person.displaced = way.dot(track.places.back() - track.places[0]);
    wave.people.push_back(person);
  }
  std::stable_sort(
      wave.people.begin(), wave.people.end(),
      [](const PersonInWave& a, const PersonInWave& b) { return a.distance < b.distance; });
  AddSlowness(&wave);
  return wave;
}

Result<std::vector<MeasuredWave>> MeasureWaves(const std::string& path) {
  std::vector<MeasuredWave> waves;
  const std::string ending = path.substr(path.find_last_of('.') + 1);
  if (ending == "json") {
    LoadOptions options;
    options.setting = "all";
    const Result<std::vector<Recording>> recordings = LoadRecordings(path, options);
    if (!recordings.ok()) return recordings.error();
    for (const Recording& recording : recordings.value()) {
      if (recording.people.size() < 2) continue;
      PointMotion hips;  // m, under the subjects' names; frames that do not count are not seen
      hips.rate_hz = recording.fps;
      for (const RecordedPerson& person : recording.people) {
        hips.names.push_back(person.subject_id);
        hips.positions.push_back(person.hip);
        for (size_t frame = 0; frame < person.weight.size(); ++frame) {
          if (person.weight[frame] > 0.0) continue;
          hips.positions.back()[frame].setConstant(std::numeric_limits<double>::quiet_NaN());
        }
      }
      ChoosePoints({}, &hips);
      waves.push_back(MeasureWave(recording.id, hips));
    }
    if (waves.empty()) return Error{"no recording of several people", path};
    return waves;
  }
  const std::optional<MotionFormat> format = MotionFormatInFile(path);
  if (!format || !(HoldsCrowd(*format) || *format == MotionFormat::kCsv)) {
    return Error{
        "a wave is measured from one point a person: trajectories (.txt, or .csv with the header "
        "id,frame,x,y), a table with three columns for each person (.csv), or a manifest of groups",
        path};
  }
  const Result<PointMotion> motion = ReadPointMotion(path, *format);
  if (!motion.ok()) return motion.error();
  if (!(motion.value().rate_hz > 0.0)) return Error{"it does not give its frame rate", path};
  return std::vector<MeasuredWave>{MeasureWave(path, motion.value())};
}

std::string WaveText(const MeasuredWave& wave) {
  if (wave.people.empty()) return wave.name + ": nobody moves by 2 cm\n";
  const auto movers =
      std::count_if(wave.people.begin(), wave.people.end(),
                    [](const PersonInWave& person) { return person.onset_s.has_value(); });
  std::string text = wave.name + ": " + std::to_string(movers) + " of " +
                     std::to_string(wave.people.size()) + " people move by 2 cm or more, " +
                     wave.people[0].name + " first\n";
  TextTable table =
      TextTable::OfNumbers({"person", "distance m", "onset s", "peak m/s", "displaced m"});
  for (const PersonInWave& person : wave.people) {
    table.Add({person.name, Rounded(person.distance, 3),
               person.onset_s ? Rounded(*person.onset_s, 3) : "-", Rounded(person.peak_speed, 2),
               Rounded(person.displaced, 2)});
  }
  text += table.ToString() + "speed of the onset: ";
  if (!wave.slowness) return text + "none: fewer than three people move\n";
  return text +
         SpeedOf(*wave.slowness, wave.quantile * wave.error,
                 "the scatter of " + std::to_string(movers) + " onsets about a line") +
         "\n";
}

std::string WavesText(const std::vector<MeasuredWave>& waves) {
  std::vector<double> slowness;
  for (const MeasuredWave& wave : waves) {
    if (wave.slowness) slowness.push_back(*wave.slowness);
  }
  if (slowness.size() < 2) return "";
  const MeanAndError mean = MeanOf(slowness);
  const double quantile = StudentQuantile95(static_cast<double>(slowness.size()) - 1.0);
  return "speed of the onset, " + std::to_string(slowness.size()) +
         " recordings: " + SpeedOf(mean.mean, quantile * mean.error, "their scatter") + "\n";
}

}  // namespace pushid
