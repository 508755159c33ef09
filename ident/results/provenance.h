// ident: where a fit came from.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace pushid {

struct Provenance {
  std::string version;                               // of pushid
  std::map<std::string, std::string> configuration;  // effective flags
  std::vector<std::string> changed_flags;            // those of them that are not at their defaults
  std::string manifest, manifest_hash;
  std::string setting;  // as --setting
};

}  // namespace pushid
