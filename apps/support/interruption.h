// apps: what Ctrl-C does: says what is kept and how to go on, and ends with exit code 130.
#pragma once

#include <string>

namespace pushid {

inline constexpr int kInterrupted = 130;  // as shells count SIGINT

// From now on SIGINT ends the process so: "pushid-fit: interrupted; WHAT". what: what is kept, and
// what starts it again. Called again, it replaces what is said.
void SayWhenInterrupted(const std::string& what);

}  // namespace pushid
