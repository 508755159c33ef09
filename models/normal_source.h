// models: where random numbers come from; models hold no random generator of their own.
#pragma once

#include <functional>

namespace pushid {

// Standard normal draws.
using NormalSource = std::function<double()>;

}  // namespace pushid
