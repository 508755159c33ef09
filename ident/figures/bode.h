// ident: Bode plots: gain, phase and coherence over frequency, measured points over a model's
// curve.
#pragma once

#include <string>
#include <vector>

#include "ident/figures/chart.h"

namespace pushid {

struct BodePoint {
  double hz = 0.0;
  double gain = 0.0, gain_lower = 0.0, gain_upper = 0.0;  // above 0
  double phase = 0.0, phase_error = 0.0;                  // degrees
  double coherence = 0.0;                                 // in [0, 1]
};

struct BodePlot {
  std::string gain_unit;                // "rad/m"
  std::vector<BodePoint> measured;      // by frequency
  std::vector<double> hz, gain, phase;  // of the model, above 0, above 0 and degrees; may be empty
};

// Phases in sequence without jumps of 360 degrees: of the model from its lowest frequency on, of
// each point as near to the model as may be, or to the point before where there is no model.
void Unwrap(BodePlot* plot);

// Three panels over a logarithmic frequency.
Figure BodeFigure(const BodePlot& plot);

}  // namespace pushid
