// ident: generators written and read.
#include "ident/generators/generator_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "datasets/manifest/recording.h"
#include "ident/bodies/restoration_files.h"
#include "ident/model/model_rollout.h"
#include "ident/parameters/json_archive.h"
#include "ident/prediction/online_predictor.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr TensorFolderKind kGeneratorFolder = {"generator", "--model",
                                               "pushid-train-generator --out", 1};
constexpr int kMostParticles = 1000;

void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

bool IsKind(const std::string& name) { return FromName<GeneratorKind>(name).has_value(); }

void CheckLayout(const ParticleLayout& layout) {
  const int count = layout.num_particles();
  Demand(count > 0 && count <= kMostParticles, "there must be 1 to 1000 particles");
  Demand(layout.joints > 0 && layout.mirrored_axis >= 0 && layout.mirrored_axis < 3 &&
             layout.up_axis >= 0 && layout.up_axis < 3 && layout.up_axis != layout.mirrored_axis,
         "joints must be positive, up_axis and mirrored_axis two of 0, 1 and 2");
  for (int i = 0; i < count; ++i) {
    Demand(layout.mirrored[i] >= 0 && layout.mirrored[i] < count && layout.parents[i] >= kNoBone &&
               layout.parents[i] < i,
           "particle " + std::to_string(i) + " names particles that do not exist");
  }
}

// The networks of each kind.

// How many a file has.
int ReadMembers(const Json& json) {
  constexpr int kMostMembers = 100;
  const int members = json.at("members");
  Demand(members >= 1 && members <= kMostMembers, "members must be 1 to 100");
  return members;
}

// What their tensors are called.
constexpr char kMember[] = "member";
std::string MemberName(size_t member, const std::string& name = kMember) {
  return name + std::to_string(member);
}
template <typename Network>
void AddMembers(const std::string& name, const std::vector<Network>& members, TensorList* tensors) {
  for (size_t m = 0; m < members.size(); ++m) AddTensors(MemberName(m, name), members[m], tensors);
}
template <typename Network>
TensorList TensorsOf(const std::vector<Network>& members) {
  TensorList tensors;
  AddMembers(kMember, members, &tensors);
  return tensors;
}

constexpr int kMostCorrected = 100000, kMostBlocks = 1000;
constexpr char kSimlpePartner[] = "simlpe";  // of its tensors, beside particles

Json SimlpeSettings(const std::vector<SimlpeNetwork>& members) {
  return {{"members", members.size()},
          {"blocks", members.empty() ? 0 : members.front().blocks.size()}};
}

std::vector<SimlpeNetwork> ReadSimlpeMembers(const std::string& name, const Json& json,
                                             const GeneratorSettings& settings,
                                             TensorReader* reader) {
  const int count = ReadMembers(json), blocks = json.at("blocks");
  Demand(blocks >= 1 && blocks <= kMostBlocks, "blocks must be 1 to 1000");
  std::vector<SimlpeNetwork> members;
  for (int m = 0; m < count; ++m) {
    members.push_back(TakeSimlpe(MemberName(m, name), settings.observed,
                                 settings.layout.num_coordinates(), blocks, reader));
  }
  return members;
}

double ReadShare(const Json& json, const char* key) {
  const double share = json.value(key, 0.0);  // older files know no siMLPe
  Demand(share >= 0.0 && share <= 1.0, std::string(key) + " must lie between 0 and 1");
  return share;
}

Json SettingsJson(const TrainedNetworks& trained) {
  Json json = JsonOf(trained.settings);
  for (const PushKind kind : trained.settings.push_kinds) {
    json["push_kinds"].push_back(NameOf(kind));
  }
  json.update(trained.of_kind->Settings());
  return json;
}

TrainedNetworks Read(const TensorFolder& folder, TensorReader* reader) {
  const Json& json = *folder.settings;
  TrainedNetworks trained;
  GeneratorSettings& settings = trained.settings;
  ReadJson(json, &settings);
  CheckLayout(settings.layout);
  for (const Json& name : json.value("push_kinds", Json::array())) {
    const std::optional<PushKind> kind = FromName<PushKind>(name.get<std::string>());
    Demand(kind.has_value(), "push_kinds has " + name.dump() + ", which is not a kind of push");
    settings.push_kinds.push_back(*kind);
  }
  settings.training = folder.training;
  GeneratorKind kind{};
  ParseName("kind", folder.kind, &kind);  // ReadTensorFolder has checked it
  trained.of_kind = RowOf(kind).read(json, settings, reader);
  return trained;
}

}  // namespace

void Fields(JsonArchive& a, ParticleStructure& s) {
  PUSHID_FIELDS(a, s, skip, particles);
  if (a.Has("poses")) a("poses", s.poses);  // this and those below: older files have none
  s.summed = a.reads() ? s.particles : s.summed;
  if (a.Has("summed")) a("summed", s.summed);
  if (a.Has("lstm")) a("lstm", s.lstm);
  if (a.Has("noisy_input")) a("noisy_input", s.noisy_input);
  if (a.Has("corrected_frames")) a("corrected_frames", s.corrected_frames);
  a.Check(s.particles || s.poses, "particles or poses must be true");
  a.Check(!s.noisy_input || s.particles != s.poses, "noisy_input needs one of particles and poses");
  a.Check(s.corrected_frames >= 0 && s.corrected_frames <= kMostCorrected,
          "corrected_frames must be 0 to 100000");
}

void Fields(JsonArchive& a, DiffusionStructure& s) {
  a("pooling", s.pooling);
  a("pooling_at", s.join);
  a("frame", s.frame);
}

Json TrainedParticles::Settings() const {
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  json.update(Json{{"jitter", jitter},
                   {"ridge_share", ridge_share},
                   {"simlpe_share", simlpe_share},
                   {"simlpe", SimlpeSettings(partners.simlpe)}});
  return json;
}

TensorList TrainedParticles::Tensors() const {
  TensorList tensors = TensorsOf(members);
  const RidgeForecast& ridge = partners.ridge;
  if (ridge_share > 0.0) AddTensors("ridge", DenseLayer{ridge.weights, ridge.bias}, &tensors);
  AddMembers(kSimlpePartner, partners.simlpe, &tensors);
  return tensors;
}

SharedNetworks ReadParticles(const Json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  const auto networks = std::make_shared<TrainedParticles>();
  TrainedParticles& trained = *networks;
  const auto structure = FromJson<ParticleStructure>(json);
  trained.jitter = json.at("jitter");
  trained.ridge_share = ReadShare(json, "ridge_share");
  trained.simlpe_share = ReadShare(json, "simlpe_share");
  Demand(trained.jitter >= 0.0, "jitter must not be negative");
  const int members = ReadMembers(json), size = settings.layout.num_coordinates();
  for (int m = 0; m < members; ++m) {
    trained.members.push_back(TakeParticles(MemberName(m), structure, size, reader));
  }
  if (trained.simlpe_share > 0.0) {
    trained.partners.simlpe =
        ReadSimlpeMembers(kSimlpePartner, json.at("simlpe"), settings, reader);
  }
  if (trained.ridge_share <= 0.0) return networks;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  DenseLayer ridge;
  TensorFields(reader).Layer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted,
                             &ridge);
  trained.partners.ridge = {ridge.weights, ridge.bias};
  return networks;
}

std::unique_ptr<MotionGenerator> TrainedParticles::Make(const GeneratorSettings& settings,
                                                        const GeneratorChanges& changes) const {
  ParticleGeneratorOptions options = changes.particles;
  options.jitter = jitter;
  options.ridge_share = changes.ridge ? ridge_share : 0.0;
  options.simlpe_share = changes.simlpe ? simlpe_share : 0.0;
  return std::make_unique<ParticleGenerator>(settings.layout, members, partners, options);
}

TensorList TrainedDiffusion::Tensors() const { return TensorsOf(members); }

Json TrainedDiffusion::Settings() const {
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  return json;
}

SharedNetworks ReadDiffusion(const nlohmann::ordered_json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  const auto trained = std::make_shared<TrainedDiffusion>();
  const auto structure = FromJson<DiffusionStructure>(json);
  const int members = ReadMembers(json);
  for (int m = 0; m < members; ++m) {
    trained->members.push_back(TakeDiffusion(MemberName(m), structure, reader));
  }
  return trained;
}

std::unique_ptr<MotionGenerator> TrainedDiffusion::Make(const GeneratorSettings& settings,
                                                        const GeneratorChanges& changes) const {
  const auto noise = [seed = changes.seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
  DiffusionGeneratorOptions options = changes.diffusion;
  options.learnt_frames = settings.observed + settings.predicted;
  return std::make_unique<DiffusionGenerator>(settings.layout, members, 1.0 / settings.rate,
                                              options, noise);
}

void Fields(JsonArchive& a, ParticleLayout& layout) {
  PUSHID_FIELDS(a, layout, joints, up_axis, mirrored_axis);
  a.Rows("particles", std::tie(layout.names, layout.mirrored, layout.parents, layout.weights),
         [&layout](auto& row, size_t i) {
           if (row.reads() && i == 0) layout.fixed.setZero(3, layout.num_particles());
           row("name", layout.names[i]);
           row("mirrored", layout.mirrored[i]);
           row("parent", layout.parents[i]);
           row("weight", layout.weights[i]);
           if (layout.parents[i] != kFixedPoint) return;
           Eigen::Vector3f place = layout.fixed.col(i);
           row("fixed_m", place);
           layout.fixed.col(i) = place;
         });
}

void Fields(JsonArchive& a, GeneratorSettings& settings) {
  PUSHID_FIELDS(a, settings, observed, predicted);
  a("rate_hz", settings.rate);
  a("layout", settings.layout);
  a.Check(settings.observed >= 1 && settings.predicted >= 1 && settings.rate > 0.0,
          "observed, predicted and rate_hz must be positive");
}

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained) {
  return WriteTensorFolder(kGeneratorFolder, folder,
                           {NameOf(trained.kind()), SettingsJson(trained),
                            trained.settings.training, trained.of_kind->Tensors()});
}

Result<TrainedNetworks> ReadGenerator(const std::string& folder) {
  const Result<TensorFolder> read =
      ReadTensorFolder(kGeneratorFolder, folder, Listed(AllNames<GeneratorKind>(), ","), IsKind);
  if (!read.ok()) return read.error();
  const std::string path = JsonFileOf(kGeneratorFolder, folder);
  TensorReader reader(read.value().tensors);
  TrainedNetworks trained;
  try {
    trained = Read(read.value(), &reader);
  } catch (const std::exception& problem) {
    return Error{std::string("settings: ") + problem.what() + "; train again with this version",
                 path};
  }
  if (!reader.problem().empty()) {
    return Error{reader.problem() + "; train again with this version", path};
  }
  return trained;
}

ParticleLayout PushLayout(const std::vector<std::string>& joint_names) {
  ParticleLayout layout;
  layout.names = joint_names;
  layout.mirrored_axis = 1;
  layout.joints = kBodyJoints;
  layout.weights.assign(kBodyJoints, 1.0f);
  layout.fixed = Eigen::Matrix3Xf::Zero(3, kBodyJoints);
  for (int j = 0; j < kBodyJoints; ++j) {
    layout.mirrored.push_back(MirroredJoint(j));
    layout.parents.push_back(j == kBodyHip ? kNoBone : kBodyParents[j]);
  }
  return layout;
}

PushedParticles ParticlesOf(const BodyRecording& recording, int person) {
  const BodyMotion& body = recording.bodies[person];
  const int frames = static_cast<int>(body.size());
  PushedParticles particles;
  particles.origin << body.front()(0, kBodyHip), body.front()(1, kBodyHip), 0.0;
  Trajectories& motion = particles.motion.frames;
  motion.resize(3 * kBodyJoints, frames);
  for (int t = 0; t < frames; ++t) {
    const Pose pose = body[t].colwise() - particles.origin;
    motion.col(t) = pose.reshaped().cast<float>();
  }
  particles.motion.controls = Eigen::MatrixXf::Zero(kPushControls, frames);
  const Scene& scene = recording.pendulum.scene;
  particles.motion.place = particles.origin.head<2>().cast<float>();
  particles.motion.mass = static_cast<float>(scene.people[person].body.mass);
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    for (int t = push.start_frame; t < std::min(frames, push.EndFrame()); ++t) {
      particles.motion.controls.col(t) +=
          (push.force[t - push.start_frame] / scene.people[person].body.mass).cast<float>();
    }
  }
  return particles;
}

GroupHips PendulumHips(const BodyRecording& recording, const Prediction& prediction) {
  GroupHips hips;
  for (const RestorationInput& person : PredictedPeople(recording, prediction)) {
    const Pose& first = person.first_pose;
    const Eigen::Vector3d origin(first(0, kBodyHip), first(1, kBodyHip), 0.0);
    Eigen::Matrix3Xf hip(3, person.q.size());
    for (size_t t = 0; t < person.q.size(); ++t) {
      const int frame = static_cast<int>(t);
      hip.col(frame) = (TipAt(person, frame) - origin).cast<float>();
    }
    hips.push_back(std::move(hip));
  }
  return hips;
}

Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames) {
  Result<Prediction> predicted =
      PredictFrom(physics, recording.pendulum, ShownToPhysics(settings), frames);
  if (!predicted.ok() || predicted.value().status.ok) return predicted;
  return Error{"recording " + recording.pendulum.id + ": physics " +
                   OutsideText(predicted.value().status) + "; leave out --physics",
               physics.source};
}

std::vector<ObservedMotion> GroupOf(const BodyRecording& recording, const GroupHips& hips) {
  std::vector<ObservedMotion> group;
  for (int n = 0; n < recording.num_people(); ++n) {
    group.push_back(ParticlesOf(recording, n).motion);
    if (!hips.empty()) group.back().pendulum = hips[n];
  }
  return group;
}

std::vector<PushKind> PushKindsOf(const Scene& scene) {
  std::set<PushKind> kinds;
  for (const ScenePush& push : scene.pushes) kinds.insert(push.kind);
  return {kinds.begin(), kinds.end()};
}

std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene) {
  if (settings.push_kinds.empty()) return "";
  const auto& learned = settings.push_kinds;
  std::string known, other;
  for (const PushKind kind : learned) known += (known.empty() ? "" : ", ") + NameOf(kind);
  for (const PushKind kind : PushKindsOf(scene)) {
    if (std::find(learned.begin(), learned.end(), kind) != learned.end()) continue;
    other += (other.empty() ? "" : ", ") + NameOf(kind);
  }
  if (other.empty()) return "";
  return "the generator was trained on pushes of kind " + known +
         " and is applied to pushes of kind " + other +
         ": predicted displacements may be too large or too small (an external push is complete, "
         "the others continue after their frames)";
}

bool AtRateOf(const GeneratorSettings& settings, double dt) {
  return std::abs(1.0 / dt - settings.rate) <= 0.01 * settings.rate;
}

BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector3d& origin) {
  BodyMotion body(motion.cols());
  for (size_t t = 0; t < body.size(); ++t) {
    const Eigen::VectorXd pose = motion.col(static_cast<Eigen::Index>(t)).cast<double>();
    body[t] = pose.reshaped(3, kBodyJoints).colwise() + origin;
  }
  return body;
}

Result<std::vector<BodyMotion>> GenerateBodies(const GeneratorSettings& settings,
                                               const MotionGenerator& generator,
                                               const BodyRecording& recording,
                                               const GroupHips& hips, int frames) {
  const double dt = recording.pendulum.scene.dt;
  if (!AtRateOf(settings, dt)) {
    return Error{"recording " + recording.pendulum.id + " has " + Rounded(1.0 / dt, 3) +
                 " frames per second; the generator was trained at " + Rounded(settings.rate, 3) +
                 ": resample the recording"};
  }
  const int observed = settings.observed, recorded = recording.num_frames();
  if (frames == 0) frames = recorded;
  if (std::min(frames, recorded) <= observed) {
    return Error{"of recording " + recording.pendulum.id + " there are " +
                 std::to_string(std::min(frames, recorded)) + " frames; the generator is given " +
                 std::to_string(observed) + " and has nothing to forecast"};
  }
  std::vector<ObservedMotion> people = GroupOf(recording, hips);
  for (ObservedMotion& person : people) {
    person.frames = Trajectories(person.frames.leftCols(observed));
  }
  const std::vector<Trajectories> forecasts = generator.Forecast(people, frames - observed);
  std::vector<BodyMotion> bodies;
  for (size_t n = 0; n < people.size(); ++n) {
    Trajectories whole(people[n].frames.rows(), frames);
    whole << people[n].frames, forecasts[n];
    const Eigen::Vector2d place = people[n].place.cast<double>();
    bodies.push_back(BodyFromParticles(whole, {place.x(), place.y(), 0.0}));
  }
  return bodies;
}

}  // namespace pushid
