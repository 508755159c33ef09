// ident: restorations written and read.
#include "ident/bodies/restoration_files.h"

#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/bodies/tensor_folder.h"
#include "ident/parameters/option_names.h"
#include "models/restoration/body_tangent.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
namespace {

constexpr uint64_t kDrawsSeed = 1;  // of a chain without a pendulum

// Begun anew with every call.
std::function<NormalSource()> NormalsOf(uint64_t seed) {
  return [seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
}

constexpr TensorFolderKind kRestorationFolder = {
    "restoration", "--restoration", "pushid-train-restoration --out", kRestorationFormat};

}  // namespace

MaybeError WriteRestorationFile(const std::string& folder, const RestorationFile& file) {
  return WriteTensorFolder(kRestorationFolder, folder,
                           {NameOf(file.kind), file.settings, file.training, file.tensors});
}

Result<RestorationFile> ReadRestorationFile(const std::string& folder, const char* flag) {
  TensorFolderKind named = kRestorationFolder;
  named.flag = flag;
  Result<TensorFolder> read = ReadTensorFolder(
      named, folder, TrainedRestorationKinds(),
      [](const std::string& name) { return FromName<RestorationKind>(name).has_value(); });
  if (!read.ok()) return read.error();
  TensorFolder& content = read.value();
  return RestorationFile{*FromName<RestorationKind>(content.kind), std::move(content.settings),
                         std::move(content.training), std::move(content.tensors)};
}

namespace {

Result<RestorationView> ViewOf(const RestorationFile& file, const std::string& path) {
  RestorationView view = RestorationView::kPendulum;
  const std::string name = file.settings->value(kViewKey, NameOf(view));
  if (MaybeError error = ParseName(kViewKey, name, &view)) return Error{error->message, path};
  return view;
}

}  // namespace

Result<std::unique_ptr<Restoration>> MakeWindow(const RestorationFile& file,
                                                const std::string& path, TensorReader* reader) {
  const Result<RestorationView> view = ViewOf(file, path);
  if (!view.ok()) return view.error();
  const int inputs = WindowInputRows(view.value());
  WindowWeights weights;
  weights.view = view.value();
  TensorFields fields(reader);
  fields.Scales("inputs", inputs, &weights.inputs);
  fields.Network("network", 3, inputs, WindowOutputRows(view.value()), &weights.network);
  return std::unique_ptr<Restoration>(new WindowRestoration(std::move(weights)));
}

Result<std::unique_ptr<Restoration>> MakeCvae(const RestorationFile& file, const std::string& path,
                                              TensorReader* reader) {
  const std::string name = file.settings->value(kCvaeCoordinatesKey, NameOf(CvaeCoordinates::kTip));
  CvaeCoordinates coordinates;
  if (MaybeError error = ParseName(kCvaeCoordinatesKey, name, &coordinates)) {
    return Error{error->message, path};
  }
  const Result<RestorationView> view = ViewOf(file, path);
  if (!view.ok()) return view.error();
  const CvaeLayout layout = {coordinates, view.value() == RestorationView::kPendulum,
                             file.settings->value(kCvaeHalvesKey, true),
                             file.settings->value(kCvaeSigmaKey, false)};
  return std::unique_ptr<Restoration>(
      new CvaeRestoration(TakeCvae(layout, reader), NormalsOf(kDrawsSeed)));
}

MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration) {
  if (choice.latent == CvaeLatent::kMean) return std::nullopt;
  auto* cvae = dynamic_cast<CvaeRestoration*>(restoration);
  if (cvae == nullptr || !cvae->weights().layout.pendulum) {
    return Error{
        "--latent=draw needs a restoration of --kind=cvae and --sees=pendulum: others "
        "have no sampler to draw from"};
  }
  if (!cvae->CanDraw()) {
    return Error{
        "--latent=draw needs the sigma of the samplers, which an earlier version did not "
        "keep; train again with this version, or give --latent=mean"};
  }
  cvae->DrawLatent(NormalsOf(choice.seed));
  return std::nullopt;
}

std::string RestorationJsonFile(const std::string& folder) {
  return JsonFileOf(kRestorationFolder, folder);
}

Result<std::unique_ptr<Restoration>> MakeRestoration(const RestorationFile& file,
                                                     const std::string& folder) {
  return MakeByKind(kRestorationMakers, file, RestorationJsonFile(folder),
                    "a peer is named by --peer");
}

Result<bool> LearnedAlone(const std::string& folder) {
  if (folder == NameOf(RestorationKind::kRigid)) return false;
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return file.value().training->value(kMostPeopleKey, 0) == 1;
}

Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder, const char* flag) {
  if (folder == NameOf(RestorationKind::kRigid)) {
    return std::unique_ptr<Restoration>(new RigidRestoration());
  }
  const Result<RestorationFile> file = ReadRestorationFile(folder, flag);
  if (!file.ok()) return file.error();
  return MakeRestoration(file.value(), folder);
}

namespace {

// Null where derivatives are not known.
std::shared_ptr<const BodyTangent> TangentOf(const Restoration& restoration) {
  const auto* window = dynamic_cast<const WindowRestoration*>(&restoration);
  if (window != nullptr && window->weights().view == RestorationView::kPendulum) {
    return std::make_shared<WindowTangent>(window->weights());
  }
  const auto* cvae = dynamic_cast<const CvaeRestoration*>(&restoration);
  if (cvae != nullptr && cvae->weights().layout.pendulum) {
    return std::make_shared<CvaeTangent>(cvae->weights());
  }
  return nullptr;
}

}  // namespace

Result<std::shared_ptr<const BodyData>> MakeBodyData(const Restoration& restoration,
                                                     const std::vector<BodyRecording>& recordings) {
  auto data = std::make_shared<BodyData>();
  data->restoration = TangentOf(restoration);
  if (data->restoration == nullptr) {
    return Error{
        "--body_weight needs a restoration of --kind=window or cvae and --sees=pendulum: the "
        "derivatives of others are not known"};
  }
  for (const BodyRecording& recording : recordings) {
    data->motions[recording.pendulum.id] = recording.bodies;
  }
  return std::shared_ptr<const BodyData>(std::move(data));
}

Result<std::shared_ptr<const BodyData>> LoadBodyData(const std::string& folder, const char* flag,
                                                     const std::vector<Recording>& recordings,
                                                     SkeletonMapping mapping) {
  const auto restoration = LoadRestoration(folder, flag);
  if (!restoration.ok()) return restoration.error();
  const auto bodies = MakeBodyRecordings(recordings, mapping);
  if (!bodies.ok()) return bodies.error();
  return MakeBodyData(*restoration.value(), bodies.value());
}

}  // namespace pushid
