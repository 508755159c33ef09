// datasets: names of a file's parts, as messages list them.
#include "datasets/files/list_of_names.h"

#include <algorithm>

namespace pushid {

std::string ListOfNames(const std::vector<std::string>& names) {
  constexpr std::size_t kListed = 60;
  std::string text;
  for (std::size_t i = 0; i < std::min(kListed, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  return text + (names.size() > kListed ? ", ... (" + std::to_string(names.size()) + ")" : "");
}

}  // namespace pushid
