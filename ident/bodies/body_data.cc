// ident: restoration and recorded bodies, for a fit.
#include "ident/bodies/body_data.h"

#include "ident/bodies/restoration_files.h"
#include "models/restoration/window_restoration.h"

namespace pushid {

Result<std::shared_ptr<const BodyData>> MakeBodyData(const Restoration& restoration,
                                                     const std::vector<BodyRecording>& recordings) {
  const auto* window = dynamic_cast<const WindowRestoration*>(&restoration);
  if (window == nullptr || window->weights().view != RestorationView::kPendulum) {
    return Error{
        "--body_weight needs a restoration of --kind=window and --sees=pendulum: the derivatives "
        "of others are not known"};
  }
  auto data = std::make_shared<BodyData>();
  data->restoration = std::make_shared<WindowTangent>(window->weights());
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
