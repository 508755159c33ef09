// apps: a forecast shown.
#include "apps/show_forecast.h"

#include <cstdio>

#include "datasets/files/atomic_file.h"

namespace pushid {

MaybeError ShowForecast(const ForecastScene& scene, const GenerateFlags& flags) {
  if (!flags.poses_out.empty()) {
    const auto files = WritePoses(flags.poses_out, scene);
    if (!files.ok()) return files.error();
    for (const std::string& file : files.value()) std::printf("%s\n", file.c_str());
  }
  const auto write = [](const std::string& file, const std::string& content) -> MaybeError {
    if (MaybeError error = WriteFileAtomically(file, content)) return error;
    std::printf("%s\n", file.c_str());
    return std::nullopt;
  };
  if (!flags.strip_out.empty()) {
    if (MaybeError error = write(flags.strip_out, ForecastStripSvg(scene, flags.poses)))
      return error;
  }
  return flags.page_out.empty() ? std::nullopt : write(flags.page_out, ForecastPageHtml(scene));
}

}  // namespace pushid
