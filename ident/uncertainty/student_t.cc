// ident: Student's t, from the regularized incomplete beta function that Eigen brings.
#include <cmath>
#include <unsupported/Eigen/SpecialFunctions>

#include "ident/uncertainty/uncertainty.h"

namespace pushid {

double StudentQuantile95(double v) {
  // P(|T| > t) = I_{v / (v + t^2)}(v / 2, 1 / 2), falling in t.
  double low = 0.0, high = 1000.0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    const double outside = Eigen::numext::betainc(0.5 * v, 0.5, v / (v + t * t));
    (outside > 0.05 ? low : high) = t;
  }
  return 0.5 * (low + high);
}

}  // namespace pushid
