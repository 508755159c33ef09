// datasets: warnings about many recordings, said once.
#pragma once

#include <string>
#include <vector>

namespace pushid {

// Warnings that differ only in the recording, "recording 'a': a.bvh has ...", become one: "in 32
// recordings (a, b, c, ...): the file has ...". Equal ones become one with how often. In the order
// of their first.
std::vector<std::string> GroupedWarnings(const std::vector<std::string>& warnings);

}  // namespace pushid
