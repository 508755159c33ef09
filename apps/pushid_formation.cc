// apps: pushid-formation: an identified model on people who stand together, from flags to a run,
// from a run to files and a table.
#include <cmath>
#include <memory>
#include <set>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/overwrite_flag.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/trajectories.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_recording.h"
#include "ident/figures/text_table.h"
#include "ident/formations/formation_files.h"
#include "ident/formations/formation_run.h"
#include "ident/prediction/predicted_steps.h"
#include "models/formation.h"
#include "models/restoration/body.h"

DEFINE_string(csv_out, "", "trajectories and forces, one row per frame and person (CSV)");
DEFINE_string(out, "", "trajectories of the hips (.txt)");
DEFINE_string(bvh_out, "", "folder for the pendulums as BVH, with manifest.json and the pushes");
DEFINE_string(svg_out, "", "picture of the wave (SVG): time across, person down, colour speed");
DEFINE_string(html_out, "", "page of the moving people (HTML)");
DEFINE_string(poses_out, "", "with bodies: joint positions (CSV)");
DEFINE_string(bodies_out, "",
              "with bodies: the bodies (BVH, one file per person, named after this one)");

DEFINE_string(
    formation, "",
    "line, diamond or grid of --people, or a trajectory file (.txt, .csv), whose people at "
    "--formation_frame are taken; the table judges everybody 2 s after the last push (or after "
    "the onset, if later)");
DEFINE_int32(people, 4, "number of people in a line, diamond or grid");
DEFINE_double(fps, 60.0, "frames per second");
DEFINE_int32(
    formation_frame, 0,
    "of a trajectory file: frame of the file that gives the positions (default: its first)");
DEFINE_double(spacing, 0.45, "distance between neighbours, cart to cart, m");
DEFINE_string(pushed, "0",
              "who is pushed, comma-separated numbers; people are counted from 0, from "
              "back to front, and in a row from right to left");
DEFINE_string(push, "",
              "pushes, comma-separated, N s or N s@start in s, as in 80@0,80@1,112@2; every push "
              "acts on all of --pushed as the fit's pushes did: of their kind and at their height "
              "(default: one of their usual impulse)");
DEFINE_double(push_duration, 0.0,
              "duration of each push (a half-sine), s; 0: that of the fit's pushes");
DEFINE_double(direction, 0.0, "direction of all pushes, degrees from +x to the left");
DEFINE_double(
    mass, 0.0,
    "mass of each person, kg, of 0.95 m from ankles to hip and upright; 0: the fit's people "
    "as they stood");
DEFINE_string(recordings, "",
              "manifest.json of recordings whose people stand in the formation, each once and in "
              "their order, then from the first again, instead of the fit's people; bodies get "
              "their skeletons");
DEFINE_double(duration, 0.0, "duration, s; 0: until 6 s after the last push");
DEFINE_string(setting, "",
              "use the parameters of this setting, for models with parameters by "
              "setting (default: the shared ones)");

namespace {

using namespace pushid;

PushRange FittedTo(const IdentifiedModel& model) { return model.push_range.value_or(PushRange{}); }

constexpr double kMostPersonFrames = 2e6;  // half a gigabyte of forces
constexpr double kWatchSeconds = 6.0;      // after the last push
constexpr int kMostPeople = 10000;

bool FromFile() {
  const std::optional<MotionFormat> format = MotionFormatInFile(FLAGS_formation);
  return format && HoldsCrowd(*format);
}

std::vector<CrowdPlace> PlacesOfFile() {
  RefuseGiven({"people", "spacing"},
              " is for line, diamond and grid; " + FLAGS_formation + " gives the positions");
  std::optional<std::int64_t> frame;
  if (Given("formation_frame")) frame = FLAGS_formation_frame;
  std::vector<CrowdPlace> places =
      OrFail(PlacesAt(OrFail(ReadTrajectoryText(FLAGS_formation)), frame));
  const std::string odd = OddSpacing(places);
  if (!odd.empty()) LOG(WARNING) << FLAGS_formation << ": " << odd;
  if (places.size() <= kMostPeople) return places;
  throw Error{std::to_string(places.size()) + " people are too many", FLAGS_formation};
}

// Only the people of a file have names.
std::vector<CrowdPlace> FormationPlaces() {
  if (FromFile()) return PlacesOfFile();
  if (Given("formation_frame"))
    throw Error{"--formation_frame needs a trajectory file (.txt, .csv)"};
  const auto shape = FromName<FormationShape>(FLAGS_formation);
  if (!shape) {
    throw Error{"--formation is '" + FLAGS_formation +
                "'; it must be line, diamond or grid, or a trajectory file (.txt, .csv)"};
  }
  std::vector<CrowdPlace> places;
  for (const Eigen::Vector2d& at : FormationPositions(*shape, FLAGS_people, FLAGS_spacing)) {
    places.push_back({"", at});
  }
  return places;
}

// People are counted from the back, whatever the file's ids.
std::vector<int> PushedPeople(const std::vector<CrowdPlace>& places) {
  std::vector<int> people;
  const int count = static_cast<int>(places.size());
  for (const std::string& spaced : SplitList(FLAGS_pushed)) {
    const std::string word(Trimmed(spaced));
    std::int64_t person = 0;
    if (!ParseInteger(word, &person)) {
      throw Error{"--pushed: " + Quoted(word) +
                  " is not a person's number; give numbers as in 0,1,3"};
    }
    if (person < 0 || person >= count) {
      for (int n = 0; n < count; ++n) {
        if (places[n].name != word) continue;
        throw Error{"--pushed counts people from the back, from 0; the file's id " + word +
                    " is person " + std::to_string(n)};
      }
      throw Error{"--pushed names person " + word + ", but " +
                  (FromFile() ? "the " + std::to_string(count) + " people of the file count"
                              : "--people=" + std::to_string(count) + " counts them") +
                  " from 0 to " + std::to_string(count - 1)};
    }
    if (std::count(people.begin(), people.end(), person) > 0) {
      throw Error{"--pushed names person " + word + " twice"};
    }
    people.push_back(static_cast<int>(person));
  }
  if (people.empty())
    throw Error{"--pushed is empty; give the numbers of the pushed people, as in 0,1,3"};
  return people;
}

HipPush ParsePush(const std::string& word, const UsualPush& usual) {
  HipPush push;
  push.kind = usual.kind;
  push.height = usual.height;
  push.duration = FLAGS_push_duration > 0.0 ? FLAGS_push_duration : usual.duration;
  push.direction = FLAGS_direction * M_PI / 180.0;
  const size_t at = word.find('@');
  const std::string start = at == std::string::npos ? "0" : word.substr(at + 1);
  if (!ParseDouble(word.substr(0, at), &push.impulse) || !ParseDouble(start, &push.start)) {
    throw Error{"--push: " + Quoted(word) +
                " is not a push; give N s, or N s@start in s, as in 80@0,80@1.5"};
  }
  if (push.impulse <= 0.0 || push.impulse > 2000.0) {
    throw Error{"--push: " + Quoted(word) +
                " has an impulse outside 0 to 2000 N s; --direction turns it"};
  }
  if (push.start < 0.0 || push.start > 3600.0) {
    throw Error{"--push: " + Quoted(word) + " starts at a time outside 0 to 3600 s"};
  }
  return push;
}

constexpr double kMassUnknown = 80.0;  // kg, of models that do not tell whom they were fitted to

// Recorded people, those of the fit, or upright ones who are all alike. First poses of recorded
// ones.
std::vector<Pose> PlaceFlaggedPeople(const IdentifiedModel& model, Scene* scene) {
  if (FLAGS_recordings.empty()) {
    const std::vector<FittedPerson> fitted = FittedTo(model).people;
    if (FLAGS_mass == 0.0 && !fitted.empty()) PlaceFittedPeople(fitted, scene);
    return std::vector<Pose>();
  }
  LoadOptions options;
  options.keep_all_joints = true;
  const std::vector<Recording> recordings = OrFail(LoadRecordings(FLAGS_recordings, options));
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  return PlacePeople(bodies, scene);
}

// "10 people in a line, 0.45 m apart".
std::string PeopleText(int people) {
  std::ostringstream text;
  text << people << (FLAGS_recordings.empty() ? "" : " recorded")
       << (people == 1 ? " person" : " people");
  if (FromFile()) {
    text << " of " << FLAGS_formation;
    if (Given("formation_frame")) text << ", frame " << FLAGS_formation_frame;
  } else if (people == 1) {
    text << ", alone";
  } else {
    text << " in a " << FLAGS_formation << ", " << FLAGS_spacing << " m apart";
  }
  return text.str();
}

std::string RunTitle(int people, const std::vector<HipPush>& pushes) {
  std::ostringstream text;
  text << PeopleText(people);
  const char* separator = "; ";
  for (const HipPush& push : pushes) {
    text << separator << push.impulse << " N s at " << push.start << " s";
    separator = ", ";
  }
  text << (FLAGS_pushed.find(',') == std::string::npos ? " on person " : " on people ")
       << FLAGS_pushed;
  if (FLAGS_direction != 0.0) {
    text << ", " << std::abs(FLAGS_direction) << " degrees to the "
         << (FLAGS_direction > 0.0 ? "left" : "right");
  }
  return text.str();
}

void CheckFrames(int frames, int people, const std::vector<HipPush>& pushes) {
  if (frames < 3) throw Error{"--duration is shorter than two frames"};
  for (const HipPush& push : pushes) {
    if (std::lround(push.start * FLAGS_fps) < frames - 1) continue;
    std::ostringstream text;
    text << "--duration ends at " << FLAGS_duration << " s, before the push of " << push.impulse
         << " N s at " << push.start << " s; lengthen it, or leave the push out";
    throw Error{text.str()};
  }
  if (static_cast<double>(frames) * people > kMostPersonFrames) {
    throw Error{std::to_string(people) + " people over " + std::to_string(frames) +
                " frames are too many; lower --people, --duration or --fps"};
  }
}

// The formation as the flags describe it.
struct FormationFlags {
  std::string title;               // "10 people in a line, 0.45 m apart; 80 N s on person 0 at 0 s"
  Scene scene;                     // people and pushes
  std::vector<std::string> names;  // of people who come from a file; otherwise empty
  int frames = 0;
  std::vector<Pose> first_poses;  // of the recorded people of --recordings; otherwise empty
};

FormationFlags FormationFlagsFromCommandLine(const IdentifiedModel& model) {
  Require("formation", FLAGS_formation, "give line, diamond or grid, or a trajectory file");
  const std::vector<CrowdPlace> places = FormationPlaces();
  const std::vector<int> pushed = PushedPeople(places);
  const UsualPush usual = FittedTo(model).usual.value_or(UsualPush{});
  std::vector<HipPush> pushes;
  for (const std::string& word : SplitList(FLAGS_push)) {
    pushes.push_back(ParsePush(std::string(Trimmed(word)), usual));
  }
  if (pushes.empty()) pushes.push_back(ParsePush(Rounded(usual.impulse, 2), usual));

  FormationFlags flags;
  std::vector<Eigen::Vector2d> positions;
  const bool named = FromFile();
  for (const CrowdPlace& place : places) {
    positions.push_back(place.position);
    if (named) flags.names.push_back(place.name);
  }
  const int people = static_cast<int>(places.size());
  flags.title = RunTitle(people, pushes);
  const double mass = FLAGS_mass > 0.0 ? FLAGS_mass : kMassUnknown;
  flags.scene = FormationScene(positions, {mass, kReferenceRod, 0.0}, 1.0 / FLAGS_fps);
  flags.first_poses = PlaceFlaggedPeople(model, &flags.scene);
  for (const HipPush& push : pushes) {
    for (int person : pushed) AddHipPush(person, push, &flags.scene);
  }
  double seconds = FLAGS_duration;
  if (seconds <= 0.0) seconds = flags.scene.LastPushEnd() * flags.scene.dt + kWatchSeconds;
  flags.frames = static_cast<int>(std::lround(seconds * FLAGS_fps)) + 1;
  CheckFrames(flags.frames, people, pushes);
  return flags;
}

// "people: the 9 of the fit in turn, as they stood, 57 to 120 kg; pushes as the fit's: external,
// 0.2 s, at 1.3 of the rod".
std::string WhoText(const IdentifiedModel& model, const FormationRun& run) {
  const Scene& scene = run.recording.scene;
  const PushRange fitted = FittedTo(model);
  const ScenePush& push = scene.pushes.front();
  ValueRange masses;
  for (const ScenePerson& person : scene.people) masses.Add(person.body.mass);
  std::string text = "people: the " + std::to_string(fitted.people.size()) + " of the fit in turn";
  if (FLAGS_mass > 0.0 || fitted.people.empty()) text = "people: upright";
  if (!FLAGS_recordings.empty()) text = "people: as recorded";
  text += ", " + Rounded(masses.lower, 3);
  if (masses.upper > masses.lower) text += " to " + Rounded(masses.upper, 3);
  text += std::string(" kg; pushes ") + (fitted.usual ? "as the fit's: " : "") + NameOf(push.kind) +
          ", " + Rounded(push.force.size() * scene.dt, 3) + " s, at " +
          Rounded(fitted.usual.value_or(UsualPush{}).height, 3) + " of the rod";
  if (push.kind == PushKind::kExternal) return text;
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  for (int t = 0; t < run.num_frames(); ++t) {
    const NetForce<double>& force = run.Force(push.person, t);
    impulse += scene.dt * (force[ForcePart::kPush] + force[ForcePart::kTail]).head<2>();
  }
  return text + "; with the model's tail person " + std::to_string(push.person) + " gets " +
         Rounded(impulse.norm(), 3) + " N s";
}

std::string Fixed(double value) {  // with two decimals
  char text[64];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

void PrintPeople(const FormationRun& run, bool named) {
  const bool steps = !run.prediction.steps.empty();
  std::vector<std::string> header = {">person",   ">x m",         ">y m",   ">onset s",
                                     ">peak m/s", ">displaced m", "outcome"};
  if (steps) header.push_back(">P(step)");
  if (named) header.push_back("id");
  TextTable table(header);
  for (int n = 0; n < run.num_people(); ++n) {
    const PersonSummary& person = run.summaries[n];
    const Vector4<double>& q = run.recording.scene.people[n].start.q;
    const std::string onset = person.onset_frame < 0 ? "-" : Fixed(run.Seconds(person.onset_frame));
    std::vector<std::string> row = {std::to_string(n),
                                    Fixed(q[0]),
                                    Fixed(q[1]),
                                    onset,
                                    Fixed(person.peak_speed),
                                    Fixed(person.displacement),
                                    NameOf(person.outcome)};
    if (steps) row.push_back(Fixed(run.prediction.steps[n].probability));
    if (named) row.push_back(run.recording.subject_ids[n]);
    table.Add(row);
  }
  std::printf("%s%s", table.ToString().c_str(), OutcomeLegend().c_str());
  if (run.prediction.feet_step) {
    std::printf("%s", PredictedStepsText(run.recording, run.prediction).c_str());
  }
}

// With more people, the draws for the intervals take too long.
constexpr int kMostPeopleForBands = 60;

std::string SpeedText(const WaveSpeed& wave, const WaveBands& bands) {
  const SpeedBand& band = bands.speed;
  std::string text = "; from person " + std::to_string(wave.from) + " to " +
                     std::to_string(wave.to) + " the onset propagated " + Rounded(wave.metres, 3) +
                     " m in " + Rounded(wave.seconds, 3) +
                     " s: " + Rounded(wave.MetresPerSecond(), 3) + " m/s";
  if (band.known()) {
    // Onsets are whole frames.
    const std::string width = band.from == band.to
                                  ? "less than a frame of the onsets"
                                  : Rounded(band.from, 3) + " to " + Rounded(band.to, 3);
    text += " (90 % interval from the uncertainty of the parameters: " + width +
            ", from the waves of " + std::to_string(band.moved) + " of " +
            std::to_string(band.draws) + " draws)";
  } else if (band.draws > 0) {
    text += " (no interval: the push propagates in only " + std::to_string(band.moved) + " of " +
            std::to_string(band.draws) + " draws of the parameters)";
  }
  if (bands.failed > 0) {
    text += "; " + std::to_string(bands.failed) + " of " + std::to_string(band.draws) +
            " draws leave the model's domain";
  }
  return text;
}

// held: parameters that no draw changes.
void PrintWave(const FormationRun& run, const WaveBands& bands, const std::string& held,
               bool setting) {
  const auto moved =
      std::count_if(run.summaries.begin(), run.summaries.end(),
                    [](const PersonSummary& person) { return person.onset_frame >= 0; });
  std::string text = std::to_string(moved) + " of " + std::to_string(run.num_people()) +
                     " people moved by 2 cm or more";
  std::set<int> pushed;
  for (const ScenePush& push : run.recording.scene.pushes) pushed.insert(push.person);
  if (moved > 1 && pushed.size() > 1) {
    text += "; no speed: several people are pushed";
  } else if (moved > 1 && run.recording.scene.pushes.size() > 1) {
    text += "; no speed: there are several pushes";
  }
  if (const std::optional<WaveSpeed> wave = SpeedOfWave(run)) text += SpeedText(*wave, bands);
  std::printf("%s\n", text.c_str());
  if (bands.speed.draws > 0 && !held.empty()) {
    std::printf("held by hand or by the preset, and so not in these intervals: %s\n", held.c_str());
  }
  if (setting) {
    std::printf("no intervals: a model has no covariance of the values of one setting\n");
  }
}

// Steps much longer than those of the recordings make stiff contact unstable.
constexpr double kUsualFps = 60.0;

int LeftDomain(const RolloutStatus& status) {
  const char* const advice =
      FLAGS_fps < kUsualFps - 0.5
          ? "the time step is long: try --fps=60, and if that does not help a weaker --push"
          : "the person falls: try a weaker or longer push (--push, --push_duration), or a "
            "higher --fps if the push is no harder than those the model was fitted to";
  return Fail(OutsideText(status) + "; " + advice + "; nothing is written", kFitFailed);
}

// Takes the parameters of the named setting, or condition, for every person.
void ActAsIn(const std::string& setting, IdentifiedModel* model) {
  if (setting.empty()) return;
  std::vector<std::string> known;
  for (const auto& [name, values] : model->by_unit) {
    if (!HoldsForRecording(model->pool_by)) break;
    if (name == setting) {
      model->parameters = values;
      return;
    }
    known.push_back(name);
  }
  throw Error{"--setting names '" + setting + "'; " + model->source + " has " +
              (known.empty() ? "no settings (--pool_by=setting fits them)" : Joined(known))};
}

void CheckOutputFlags(int people, bool bodies) {
  if (!FLAGS_svg_out.empty() && people > kMostPeopleInWave) {
    throw Error{"--svg_out shows at most " + std::to_string(kMostPeopleInWave) +
                " people; leave it out or lower --people"};
  }
  if (!FLAGS_out.empty() && !EndsWith(FLAGS_out, ".txt")) {
    throw Error{"--out names " + FLAGS_out + "; trajectories end in .txt"};
  }
  for (const char* flag : {"poses_out", "bodies_out"}) {
    if (!bodies && Given(flag)) throw NeedsRestoration(flag);
  }
  OrFail(CheckOutputFiles({FLAGS_csv_out, FLAGS_out, FLAGS_svg_out, FLAGS_html_out, FLAGS_poses_out,
                           FLAGS_bodies_out}));
  if (!FLAGS_bvh_out.empty()) OrFail(CheckOutputFolder("bvh_out", FLAGS_bvh_out));
}

// Writes outputs up to the first that fails. bodies: none where pages show pendulums.
void WriteOutputs(const FormationRun& run, const std::vector<OnsetBand>& onsets,
                  std::vector<BodyMotion> bodies, const std::string& title) {
  const auto write = [](const std::string& file, auto writer) {
    if (!file.empty()) OrFail(writer(file));
  };
  write(FLAGS_bvh_out, [&](auto& file) { return WriteFormationRecording(file, run); });
  write(FLAGS_csv_out,
        [&](auto& file) { return WriteTrajectoryCsv(file, run.recording, run.prediction); });
  write(FLAGS_out, [&](auto& file) { return WriteFormationTrajectories(file, run); });
  write(FLAGS_svg_out,
        [&](auto& file) { return WriteFileAtomically(file, WaveSvg(run, title, onsets)); });
  BodyScene scene;
  scene.id = run.recording.id;
  scene.dt = run.recording.scene.dt;
  scene.subject_ids = run.recording.subject_ids;
  scene.bodies = std::move(bodies);
  write(FLAGS_html_out, [&](auto& file) {
    Animation animation;
    animation.title = title;
    animation.dt = scene.dt;
    AddPrediction(run.recording, run.prediction, scene.bodies, &animation);
    AddPushes(run.recording, &animation);
    return WriteFileAtomically(file, AnimationHtml({animation}));
  });
  write(FLAGS_poses_out, [&](auto& file) { return WriteJointsCsv(file, scene); });
  write(FLAGS_bodies_out, [&](auto& file) { return WriteBodyBvh(file, scene); });
}

int Run() {
  RequireModel();
  CheckRange("people", FLAGS_people, 1, kMostPeople);
  CheckRange("fps", FLAGS_fps, 10, 10000);
  CheckRange("spacing", FLAGS_spacing, 0.05, 100);
  if (FLAGS_push_duration != 0.0) CheckRange("push_duration", FLAGS_push_duration, 0.001, 60);
  CheckRange("direction", FLAGS_direction, -360, 360);
  if (FLAGS_mass != 0.0) CheckRange("mass", FLAGS_mass, 1, 400);
  CheckRange("duration", FLAGS_duration, 0, 3600);
  if (!FLAGS_recordings.empty()) {
    RefuseGiven({"mass"},
                "--recordings gives the recorded people's mass and rod length; leave out --{}");
  }
  IdentifiedModel model = LoadFlaggedModel();
  FormationFlags flags = FormationFlagsFromCommandLine(model);
  Scene& scene = flags.scene;
  const std::string& title = flags.title;
  const RestorationFlags body_flags = RestorationFlagsFromCommandLine();
  CheckOutputFlags(scene.num_people(), body_flags.given());

  std::unique_ptr<Restoration> restoration;
  if (body_flags.given()) {
    restoration = LoadFlaggedRestoration(body_flags, scene.num_people());
    if (flags.first_poses.empty()) flags.first_poses = SyntheticPoses(&scene);
  }
  ActAsIn(FLAGS_setting, &model);
  const FormationRun run = RunFormation(model, scene, flags.frames, flags.names);
  WarnGrouped(InputWarnings(model, {run.recording}));
  if (!run.prediction.status.ok) return LeftDomain(run.prediction.status);
  const FittedModel fitted = OrFail(ReadFittedModel(ModelFile()));
  // A model does not hold the uncertainty of a setting's own parameters, so there are no bands
  // then.
  const bool setting = !FLAGS_setting.empty();
  const bool banded =
      !setting && (!FLAGS_svg_out.empty() || scene.num_people() <= kMostPeopleForBands);
  const WaveBands bands = banded ? BandsOfWave(fitted, FLAGS_set, run) : WaveBands();
  std::vector<BodyMotion> bodies;
  if (restoration) {
    bodies = FormationBodies(run, flags.first_poses, *restoration, body_flags.postprocess);
  }
  WriteOutputs(run, bands.onsets, std::move(bodies), title);
  std::printf("%s; %s s\n%s\n", title.c_str(),
              Rounded(run.Seconds(run.num_frames() - 1), 3).c_str(), WhoText(model, run).c_str());
  PrintPeople(run, !flags.names.empty());
  PrintWave(run, bands, HeldInDraws(fitted, FLAGS_set), setting);
  // Warnings of the fit hold for the people that are simulated with it.
  for (const std::string& warning : GroupedWarnings(fitted.fit.warnings)) {
    std::printf("warning of the fit: %s\n", warning.c_str());
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-formation pushes people who stand together: who moves, when, and "
                        "how far the push travels.\n"
                        "  pushid-formation --model=model.json --formation=line --people=10 "
                        "--push=80 --svg_out=wave.svg",
                        Run);
}
