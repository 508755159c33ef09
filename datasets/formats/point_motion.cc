// datasets: trajectories of named points.
#include "datasets/formats/point_motion.h"

#include "datasets/files/meant_name.h"
#include "datasets/files/number_text.h"

namespace pushid {

Error UnknownPointError(const std::string& path, const std::vector<std::string>& names,
                        const std::string& name) {
  constexpr std::size_t kListed = 8;
  std::string message = "there is no point " + Quoted(name) + "; it has ";
  for (std::size_t i = 0; i < names.size() && i < kListed; ++i) {
    message += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kListed) message += ", ... (" + std::to_string(names.size()) + " points)";
  return {message + MeantText(name, names), path};
}

}  // namespace pushid
