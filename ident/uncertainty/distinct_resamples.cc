// ident: how many resamples there are; apart from the refits, so that a reader of models needs no
// solver.
#include "ident/uncertainty/bootstrap.h"

namespace pushid {

double DistinctResamples(int units) {
  double number = 1.0;
  for (int i = 1; i < units; ++i) number *= static_cast<double>(units + i) / i;
  return number;
}

}  // namespace pushid
