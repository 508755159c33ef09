// ident: what was done to recordings before the fit, as the report says it.
#pragma once

#include <map>
#include <string>

namespace pushid {

// "motion: low-pass at 6 Hz (zero-phase Butterworth), resampled to 60 frames per second" with a
// newline, from the flags that a result keeps; empty where the motion was taken as recorded. A
// replica of a bootstrap says so on a line of its own.
std::string PreparationText(const std::map<std::string, std::string>& configuration);

}  // namespace pushid
