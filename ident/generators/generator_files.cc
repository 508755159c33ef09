// ident: generators: their files, and forecasts of recordings.
#include "ident/generators/generator_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "datasets/files/names.h"
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
constexpr TensorFolderKind kGeneratorFolder = {
    "generator", "--model", "pushid-train-generator --out", 1, AllNames<GeneratorKind>};
constexpr int kMostParticles = 1000;

void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

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

// Prefixes of tensors' names, which continue with the network's index.
constexpr char kMember[] = "member";
constexpr char kSimlpePartner[] = "simlpe";  // beside particles

template <typename Network>
void AddMembers(const std::string& name, const std::vector<Network>& members, TensorList* tensors) {
  for (size_t m = 0; m < members.size(); ++m) {
    AddTensors(name + std::to_string(m) + ".", members[m], tensors);
  }
}

template <typename Network>
std::vector<Network> TakeMembers(const std::string& name, const Json& json, const Network& shape,
                                 TensorFields* reader) {
  const int count = json.at("members");
  Demand(count >= 1 && count <= 100, "members must be 1 to 100");
  std::vector<Network> members;
  for (int m = 0; m < count; ++m) {
    members.push_back(TakeTensors(name + std::to_string(m) + ".", shape, reader));
  }
  return members;
}

double ReadShare(const Json& json, const char* key) {
  const double share = json.value(key, 0.0);
  Demand(share >= 0.0 && share <= 1.0, std::string(key) + " must lie between 0 and 1");
  return share;
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
  a.Check(s.corrected_frames >= 0 && s.corrected_frames <= 100000,
          "corrected_frames must be 0 to 100000");
}

void Fields(JsonArchive& a, DiffusionStructure& s) {
  a("pooling", s.pooling);
  a("pooling_at", s.join);
  a("frame", s.frame);
}

Json TrainedParticles::Settings() const {
  const std::vector<SimlpeNetwork>& simlpe = partners.simlpe;
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  json.update(Json{{"jitter", jitter},
                   {"ridge_share", ridge_share},
                   {"simlpe_share", simlpe_share},
                   {"simlpe",
                    {{"members", simlpe.size()},
                     {"blocks", simlpe.empty() ? 0 : simlpe.front().blocks.size()}}}});
  return json;
}

TensorList TrainedParticles::Tensors() const {
  TensorList tensors;
  AddMembers(kMember, members, &tensors);
  if (ridge_share > 0.0) {
    DenseLayer ridge = {partners.ridge.weights, partners.ridge.bias};
    TensorFields(&tensors).Layer("ridge", 0, 0, &ridge);
  }
  AddMembers(kSimlpePartner, partners.simlpe, &tensors);
  return tensors;
}

SharedNetworks ReadParticles(const Json& json, const GeneratorSettings& settings,
                             TensorFields* reader) {
  const auto networks = std::make_shared<TrainedParticles>();
  TrainedParticles& trained = *networks;
  const int size = settings.layout.num_coordinates();
  ParticleNetwork shape;
  ReadJson(json, &shape.structure);
  shape.pose_mean.resize(size);
  trained.jitter = json.at("jitter");
  trained.ridge_share = ReadShare(json, "ridge_share");
  trained.simlpe_share = ReadShare(json, "simlpe_share");
  Demand(trained.jitter >= 0.0, "jitter must not be negative");
  trained.members = TakeMembers(kMember, json, shape, reader);
  if (trained.simlpe_share > 0.0) {
    const int blocks = json.at("simlpe").at("blocks");
    Demand(blocks >= 1 && blocks <= 1000, "blocks must be 1 to 1000");
    SimlpeNetwork simlpe;
    simlpe.pose_mean.resize(size);
    simlpe.blocks.resize(static_cast<size_t>(blocks));
    simlpe.blocks.front().mix.bias.resize(settings.observed);
    trained.partners.simlpe = TakeMembers(kSimlpePartner, json.at("simlpe"), simlpe, reader);
  }
  if (trained.ridge_share <= 0.0) return networks;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  DenseLayer ridge;
  reader->Layer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted, &ridge);
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

TensorList TrainedDiffusion::Tensors() const {
  TensorList tensors;
  AddMembers(kMember, members, &tensors);
  return tensors;
}

Json TrainedDiffusion::Settings() const {
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  return json;
}

SharedNetworks ReadDiffusion(const Json& json, const GeneratorSettings& settings,
                             TensorFields* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  DiffusionNetwork shape;
  ReadJson(json, &shape.structure);
  const auto trained = std::make_shared<TrainedDiffusion>();
  trained->members = TakeMembers(kMember, json, shape, reader);
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
  std::vector<std::string> kinds;
  for (const PushKind kind : settings.push_kinds) kinds.push_back(NameOf(kind));
  if (a.Has("push_kinds", !kinds.empty())) a("push_kinds", kinds);
  for (size_t i = 0; a.reads() && i < kinds.size(); ++i) {
    const std::optional<PushKind> kind = FromName<PushKind>(kinds[i]);
    Demand(kind.has_value(), "push_kinds has '" + kinds[i] + "', which is not a kind of push");
    settings.push_kinds.push_back(*kind);
  }
  a.Check(settings.observed >= 1 && settings.predicted >= 1 && settings.rate > 0.0,
          "observed, predicted and rate_hz must be positive");
  if (a.reads()) CheckLayout(settings.layout);
}

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained) {
  Json json = JsonOf(trained.settings);
  json.update(trained.of_kind->Settings());
  return WriteTensorFolder(
      kGeneratorFolder, folder,
      {NameOf(trained.kind()), json, trained.settings.training, trained.of_kind->Tensors()});
}

Result<TrainedNetworks> ReadGenerator(const std::string& folder) {
  const Result<TensorFolder> read = ReadTensorFolder(kGeneratorFolder, folder);
  if (!read.ok()) return read.error();
  const TensorFolder& content = read.value();
  return FromTensors(
      content, JsonFileOf(kGeneratorFolder, folder), "settings: ", [&](TensorFields* reader) {
        TrainedNetworks trained;
        ReadJson(*content.settings, &trained.settings);
        trained.settings.training = content.training;
        const GeneratorKind kind = *FromName<GeneratorKind>(content.kind);
        trained.of_kind = RowOf(kind).read(*content.settings, trained.settings, reader);
        return trained;
      });
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

ObservedMotion ParticlesOf(const BodyRecording& recording, int person) {
  const BodyMotion& body = recording.bodies[person];
  const int frames = static_cast<int>(body.size());
  const Eigen::Vector3d origin(body.front()(0, kBodyHip), body.front()(1, kBodyHip), 0.0);
  const Scene& scene = recording.pendulum.scene;
  const double mass = scene.people[person].body.mass;
  ObservedMotion motion;
  motion.frames.resize(3 * kBodyJoints, frames);
  for (int t = 0; t < frames; ++t) {
    const Pose pose = body[t].colwise() - origin;
    motion.frames.col(t) = pose.reshaped().cast<float>();
  }
  motion.controls = Eigen::MatrixXf::Zero(kPushControls, frames);
  motion.place = origin.head<2>().cast<float>();
  motion.mass = static_cast<float>(mass);
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    for (int t = push.start_frame; t < std::min(frames, push.EndFrame()); ++t) {
      motion.controls.col(t) += (push.force[t - push.start_frame] / mass).cast<float>();
    }
  }
  return motion;
}

Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames) {
  const int shown = settings.observed > 1 ? settings.observed : 0;  // one everybody has
  Result<Prediction> predicted = PredictFrom(physics, recording.pendulum, shown, frames);
  if (!predicted.ok() || predicted.value().status.ok) return predicted;
  return Error{"recording " + recording.pendulum.id + ": physics " +
                   OutsideText(predicted.value().status) + "; leave out --physics",
               physics.source};
}

std::vector<ObservedMotion> GroupOf(const BodyRecording& recording) {
  std::vector<ObservedMotion> group;
  for (int n = 0; n < recording.num_people(); ++n) group.push_back(ParticlesOf(recording, n));
  return group;
}

std::vector<PushKind> PushKindsOf(const Scene& scene) {
  std::set<PushKind> kinds;
  for (const ScenePush& push : scene.pushes) kinds.insert(push.kind);
  return {kinds.begin(), kinds.end()};
}

std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene) {
  const auto& learned = settings.push_kinds;
  std::vector<std::string> known, other;
  for (const PushKind kind : learned) known.push_back(NameOf(kind));
  for (const PushKind kind : PushKindsOf(scene)) {
    if (std::count(learned.begin(), learned.end(), kind) == 0) other.push_back(NameOf(kind));
  }
  if (known.empty() || other.empty()) return "";
  return "the generator was trained on pushes of kind " + Joined(known) +
         " and is applied to pushes of kind " + Joined(other) +
         ": predicted displacements may be too large or too small (an external push is complete, "
         "the others continue after their frames)";
}

BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector2f& place) {
  const Eigen::Vector3d origin(place.x(), place.y(), 0.0);
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
                                               const IdentifiedModel* physics, int frames) {
  const double dt = recording.pendulum.scene.dt;
  if (std::abs(1.0 / dt - settings.rate) > 0.01 * settings.rate) {
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
  std::vector<ObservedMotion> people = GroupOf(recording);
  for (ObservedMotion& person : people) {
    person.frames.conservativeResize(Eigen::NoChange, observed);
  }
  if (physics != nullptr) {
    const Result<Prediction> predicted = PredictBeside(settings, *physics, recording, frames);
    if (!predicted.ok()) return predicted.error();
    const auto pendulums = PredictedPeople(recording, predicted.value());
    for (size_t n = 0; n < people.size(); ++n) {
      const Eigen::Vector3d origin(pendulums[n].first_pose(0, kBodyHip),
                                   pendulums[n].first_pose(1, kBodyHip), 0.0);
      people[n].pendulum.resize(3, static_cast<Eigen::Index>(pendulums[n].q.size()));
      for (int t = 0; t < people[n].pendulum.cols(); ++t) {
        people[n].pendulum.col(t) = (TipAt(pendulums[n], t) - origin).cast<float>();
      }
    }
  }
  const std::vector<Trajectories> forecasts = generator.Forecast(people, frames - observed);
  std::vector<BodyMotion> bodies;
  for (size_t n = 0; n < people.size(); ++n) {
    Trajectories whole(people[n].frames.rows(), frames);
    whole << people[n].frames, forecasts[n];
    bodies.push_back(BodyFromParticles(whole, people[n].place));
  }
  return bodies;
}

}  // namespace pushid
