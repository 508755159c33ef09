// ident: restorations written and read.
#include "ident/bodies/restoration_files.h"

#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/bodies/tensor_folder.h"
#include "ident/parameters/option_names.h"
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

Result<RestorationFile> ReadRestorationFile(const std::string& folder) {
  Result<TensorFolder> read = ReadTensorFolder(
      kRestorationFolder, folder, TrainedRestorationKinds(),
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
                             file.settings->value(kCvaeHalvesKey, true)};
  return std::unique_ptr<Restoration>(
      new CvaeRestoration(TakeCvae(layout, reader), NormalsOf(kDrawsSeed)));
}

MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration) {
  if (choice.latent == CvaeLatent::kMean) return std::nullopt;
  auto* cvae = dynamic_cast<CvaeRestoration*>(restoration);
  if (cvae == nullptr || !cvae->CanDraw()) {
    return Error{
        "--latent=draw needs a restoration of --kind=cvae and --sees=pendulum: others "
        "have no sampler to draw from"};
  }
  cvae->DrawLatent(NormalsOf(choice.seed));
  return std::nullopt;
}

std::string RestorationJsonFile(const std::string& folder) {
  return JsonFileOf(kRestorationFolder, folder);
}

Result<std::unique_ptr<Restoration>> MakeRestoration(const RestorationFile& file,
                                                     const std::string& folder) {
  const std::string path = RestorationJsonFile(folder);
  for (const KindMaker& maker : kRestorationMakers) {
    if (maker.kind != file.kind) continue;
    TensorReader reader(file.tensors);
    Result<std::unique_ptr<Restoration>> made = maker.make(file, path, &reader);
    if (made.ok() && !reader.problem().empty()) {
      return Error{reader.problem() + "; train again with this version", path};
    }
    return made;
  }
  return Error{
      "the kind is " + Quoted(NameOf(file.kind)) + "; it must be " + TrainedRestorationKinds(),
      path};
}

Result<bool> LearnedAlone(const std::string& folder) {
  if (folder == NameOf(RestorationKind::kRigid)) return false;
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return file.value().training->value(kMostPeopleKey, 0) == 1;
}

Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder) {
  if (folder == NameOf(RestorationKind::kRigid)) {
    return std::unique_ptr<Restoration>(new RigidRestoration());
  }
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return MakeRestoration(file.value(), folder);
}

}  // namespace pushid
