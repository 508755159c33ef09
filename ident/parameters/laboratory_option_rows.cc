// ident: rows of the options that a laboratory's model has.
#include <nlohmann/json.hpp>

#include "ident/parameters/option_row_makers.h"
#include "ident/parameters/presets.h"

namespace pushid {

using Row = FitOptionRow;

Row DelayRow() {
  Row row = NameRow<Delay>(
      "delay", "/delay", [](FitOptions & o) -> auto& { return o.model.delay; },
      "reaction delay of active feedback: none, one (of all of it) or ankle_and_step (the feet's "
      "own); reaction_delay and the passive shares of stiffness and damping are then fitted");
  row.apply = [](const std::string& text, FitOptions* o) -> MaybeError {
    Delay delay;
    if (MaybeError error = ParseName("--delay", text, &delay)) return error;
    SetDelay(delay, o);
    return std::nullopt;
  };
  return MayBeAbsent(row);
}

Row BodyRow() {
  Row row = NameRow<BodyModel>(
      "body", "/body", [](FitOptions & o) -> auto& { return o.model.body; },
      "where a body's mass is: ldp (nine tenths at the hip; of who stands, an average body's), "
      "anthropometric (by the recorded segments, de Leva 1996), or table (cart_share, com_height, "
      "gyration_radius and push_gain, of robots and rigs: fixed or fitted)");
  row.apply = [](const std::string& text, FitOptions* o) -> MaybeError {
    BodyModel body;
    if (MaybeError error = ParseName("--body", text, &body)) return error;
    SetBody(body, o);
    return std::nullopt;
  };
  return MayBeAbsent(row);
}

}  // namespace pushid
