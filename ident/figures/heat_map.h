// ident: a table of signed numbers as colours.
#pragma once

#include <string>
#include <vector>

namespace pushid {

struct HeatMap {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> values;  // [row][column]; 0 is paper
  double full = 1.0;                        // the value of the strongest colour
};

// Blue below zero, orange above.
std::string DrawHeatMap(const HeatMap& map);

}  // namespace pushid
