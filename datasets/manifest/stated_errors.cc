// datasets: reading stated errors.
#include "datasets/manifest/stated_errors.h"

#include <cmath>

#include "datasets/files/json_fields.h"

namespace pushid {

StatedErrors ReadStatedErrors(const JsonDocument& document, JsonFields* fields,
                              StatedErrors stated) {
  constexpr const char* kKey = "stated_errors";
  if (!fields->Has(kKey)) return stated;
  if (!fields->At(kKey).is_object()) {
    fields->Fail(kKey, "must be an object { } of standard deviations");
    return stated;
  }
  JsonFields given(document, fields->At(kKey), fields->Pointer(kKey),
                   fields->label() + ", stated_errors");
  for (const StatedErrorRow& row : kStatedErrors) {
    double& value = stated.*row.value;
    value = given.OptionalNumber(row.key, "a standard deviation above 0", value);
    if (!given.failed() && !(value > 0.0 && std::isfinite(value))) {
      given.Fail(row.key, "must be a standard deviation above 0");
    }
    if (!given.failed() && row.share && value > 1.0) {
      given.Fail(row.key, "is a share: 0.05 means 5 %");
    }
  }
  given.OnlyAsked();
  fields->Fail(given.error());
  return stated;
}

}  // namespace pushid
