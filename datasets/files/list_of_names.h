// datasets: names of a file's parts, as messages list them.
#pragma once

#include <string>
#include <vector>

namespace pushid {

// "a, b, c, ... (75)": the first sixty names, and how many there are.
std::string ListOfNames(const std::vector<std::string>& names);

}  // namespace pushid
