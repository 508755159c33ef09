// ident: Student's t, from the regularized incomplete beta function that Eigen brings.
#include "ident/uncertainty/statistics.h"

#include <cmath>
#include <unsupported/Eigen/SpecialFunctions>

namespace pushid {

// P(|T| > t) = I_{v / (v + t^2)}(v / 2, 1 / 2).
double StudentTail(double t, double v) {
  return Eigen::numext::betainc(0.5 * v, 0.5, v / (v + t * t));
}

double StudentQuantile95(double v) {
  double low = 0.0, high = 1000.0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (StudentTail(t, v) > 0.05 ? low : high) = t;
  }
  return 0.5 * (low + high);
}

}  // namespace pushid
