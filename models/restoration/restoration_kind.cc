// models: the kinds of restoration.
#include "models/restoration/restoration_kind.h"

#include <vector>

namespace pushid {
namespace {

constexpr bool RowsAreInOrder() {
  int value = 0;
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (static_cast<int>(row.kind) != value++) return false;
  }
  return true;
}
static_assert(RowsAreInOrder(), "RowOf finds a row by its kind's value");

}  // namespace

const RestorationKindRow& RowOf(RestorationKind kind) {
  return kRestorationKinds[static_cast<int>(kind)];
}

std::optional<RestorationKind> RestorationKindFromName(std::string_view name) {
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (name == row.name) return row.kind;
  }
  return std::nullopt;
}

std::string TrainedRestorationKinds() {
  std::vector<std::string> names;
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (row.trained) names.push_back(row.name);
  }
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  }
  return list;
}

}  // namespace pushid
