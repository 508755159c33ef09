// ident: how files and tables call a metric of a prediction.
#pragma once

#include <string>

#include "datasets/files/number_text.h"

namespace pushid {

struct Metric {
  const char* name;  // "hipADE"
  const char* unit;  // "m"

  // In files: "hipADE_m".
  std::string Key() const { return std::string(name) + "_" + unit; }
  std::string ErrorKey() const { return std::string(name) + "_standard_error_" + unit; }
  // At the head of a column: "hipADE m".
  std::string Title() const {
    std::string title = std::string(name) + " " + unit;
    for (char& c : title) c = c == '_' ? ' ' : c;
    return title;
  }
  // In a sentence: "hipADE 0.1 m".
  std::string Text(double value, int digits) const {
    std::string text = Title();
    const std::size_t unit_at = text.rfind(' ');
    return text.insert(unit_at, " " + Rounded(value, digits));
  }
};

}  // namespace pushid
