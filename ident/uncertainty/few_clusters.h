// ident: when standard errors are themselves in doubt.
#pragma once

namespace pushid {

// Of fewer clusters the standard errors are uncertain themselves.
inline constexpr int kFewClusters = 10;

}  // namespace pushid
