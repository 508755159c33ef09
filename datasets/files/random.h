// datasets: random draws that are the same on every standard library.
//
// std::mt19937_64 is specified bit by bit, std::normal_distribution and its kin are not; a seed
// printed in a report must give the same recordings everywhere, hence our own transformations.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace pushid {

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  // Uniform in [0, 1), 53 random bits.
  double Unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double Uniform(double lower, double upper) { return lower + (upper - lower) * Unit(); }

  // Standard normal, by Box and Muller's method; the pair's second value is kept for the next call.
  double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Unit()));  // 1 - Unit() is never zero
    const double angle = 2.0 * M_PI * Unit();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }
  double Normal(double mean, double sigma) { return mean + sigma * Normal(); }

  // Fisher and Yates's shuffle.
  template <typename Value>
  void Shuffle(std::vector<Value>* items) {
    for (size_t i = items->size(); i > 1; --i) {
      std::swap((*items)[i - 1], (*items)[Fork() % i]);
    }
  }

  // Seed for an independent stream, e.g. one per recording.
  uint64_t Fork() { return engine_(); }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace pushid
