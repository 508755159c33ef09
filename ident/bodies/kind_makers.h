// ident: what the tensors of a file become, by its kind: restorations and peers.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "datasets/files/number_text.h"
#include "ident/bodies/restoration_files.h"

namespace pushid {

template <typename Made>
struct KindMaker {
  RestorationKind kind;
  Result<std::unique_ptr<Made>> (*make)(const RestorationFile& file, const std::string& path,
                                        TensorReader* reader);
};

// path: of the file, for messages; hint: what to do about a kind that none of them makes. Errors:
// that, the maker's own, missing or misshapen tensors by name.
template <typename Made, size_t kCount>
Result<std::unique_ptr<Made>> MakeByKind(const KindMaker<Made> (&makers)[kCount],
                                         const RestorationFile& file, const std::string& path,
                                         const char* hint) {
  std::string known;
  for (const KindMaker<Made>& maker : makers) {
    known += (known.empty() ? "" : " and ") + std::string(Name(maker.kind));
    if (maker.kind != file.kind) continue;
    TensorReader reader(file.tensors);
    Result<std::unique_ptr<Made>> made = maker.make(file, path, &reader);
    if (made.ok() && !reader.problem().empty()) {
      return Error{reader.problem() + "; train again with this version", path};
    }
    return made;
  }
  return Error{
      "the kind is " + Quoted(Name(file.kind)) + "; known are " + known + " (" + hint + ")", path};
}

}  // namespace pushid
