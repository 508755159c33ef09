// models: what the filter of unknown forces takes people to be (input_filter.h).
#pragma once

namespace pushid {

struct InputNoise {
  double force_time = 0.1;      // s, in which an unknown force dies out
  double force = 4.0;           // its standard deviation over the mass, m/s^2
  double measured = 0.0012;     // standard deviation of measured places, m
  double measured_time = 0.13;  // s, in which an error of measurement dies out
};

}  // namespace pushid
