// ident: generators written and read.
#include "ident/generators/generator_files.h"

#include <nlohmann/json.hpp>

#include "datasets/manifest/recording.h"
#include "ident/bodies/tensor_folder.h"
#include "ident/parameters/json_archive.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
// flag: what names the folder.
TensorFolderKind GeneratorFolder(const char* flag) {
  return {"generator", flag, "pushid-train-generator --out", 1};
}
constexpr int kMostParticles = 1000;

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

}  // namespace

template <class Archive>
void Fields(Archive& a, ParticleLayout& layout) {
  PUSHID_FIELDS(a, layout, joints, up_axis, mirrored_axis);
  a.Rows("particles", std::tie(layout.names, layout.mirrored, layout.parents, layout.weights),
         [&layout](auto& row, size_t i) {
           if (Archive::kReads && i == 0) layout.fixed.setZero(3, layout.num_particles());
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

template <class Archive>
void Fields(Archive& a, ForecastChoice& choice) {
  PUSHID_FIELDS(a, choice, by, blend);
  a.Check(choice.blend >= 0.0 && choice.blend <= 1.0, "blend must lie between 0 and 1");
}

template <class Archive>
void Fields(Archive& a, GeneratorSettings& settings) {
  PUSHID_FIELDS(a, settings, data, observed, predicted);
  a("rate_hz", settings.rate);
  a("layout", settings.layout);
  a.Optional("choice", settings.choice);
  a.Check(settings.observed >= 1 && settings.predicted >= 1 && settings.rate > 0.0,
          "observed, predicted and rate_hz must be positive");
}

namespace {

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
  Demand(!json.value("pendulum", false),
         "it corrects physics (--pendulum_input), which is gone: blend it with them, and train it "
         "again");
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

int ReadMembers(const Json& json) {
  constexpr int kMostMembers = 100;
  const int members = json.at("members");
  Demand(members >= 1 && members <= kMostMembers, "members must be 1 to 100");
  return members;
}

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained) {
  return WriteTensorFolder(GeneratorFolder("--out"), folder,
                           {NameOf(trained.kind()), SettingsJson(trained),
                            trained.settings.training, trained.of_kind->Tensors()});
}

std::unique_ptr<MotionGenerator> MakeGenerator(const TrainedNetworks& trained,
                                               const GeneratorChanges& changes) {
  return trained.of_kind->Make(trained.settings, changes);
}

Result<LoadedGenerator> LoadGenerator(const std::string& folder, const GeneratorChanges& changes,
                                      const char* flag) {
  const Result<TensorFolder> read = ReadTensorFolder(
      GeneratorFolder(flag), folder, Listed(AllNames<GeneratorKind>(), ","), IsKind);
  if (!read.ok()) return read.error();
  const std::string path = JsonFileOf(GeneratorFolder(flag), folder);
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
  if (const MaybeError error = trained.of_kind->Check(changes)) return Error{error->message, path};
  return LoadedGenerator{trained.kind(), trained.settings, MakeGenerator(trained, changes),
                         nullptr};
}

}  // namespace pushid
