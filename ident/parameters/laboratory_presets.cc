// ident: starts and priors of what a laboratory's model frees.
#include "ident/parameters/laboratory_presets.h"

namespace pushid {

void FreeFrom(const WeakStart& start, ParameterTable* table) {
  ParameterSpec& spec = (*table)[start.id];
  spec.free = true;
  spec.nominal = start.value;
  spec.prior = Prior{start.value, start.sigma};
}

void SetBody(BodyModel body, FitOptions* options) {
  options->model.body = body;
  if (body != BodyModel::kTable) return;
  options->start = FitStart::kNominal;  // the equation errors' Jacobian knows no masses
  ParameterSpec& com = options->table[kComHeight];
  com.nominal = 1.0;
  com.free = false;
  com.prior.reset();
}

void SetDelay(Delay delay, FitOptions* options) {
  options->model.delay = delay;
  if (delay == Delay::kNone) return;
  // A hinge on the free modes knows none of it; settling simulations do.
  options->mode_weight = 0.0;
  options->start = FitStart::kNominal;
  // Weak priors: published delays are 0.10 to 0.16 s (median 0.134), passive shares 0 to 0.9.
  for (const WeakStart& start :
       {WeakStart{kReactionDelay, 0.13, 0.1}, WeakStart{kStepDelay, 0.2, 0.15},
        WeakStart{kPassiveStiffness, 0.2, 0.2}, WeakStart{kPassiveDamping, 0.2, 0.2}}) {
    FreeFrom(start, &options->table);
  }
}

void TiePassive(FitOptions* o) {
  ParameterSpec& damping = o->table[kPassiveDamping];
  if (o->model.delay == Delay::kNone || damping.named) return;
  damping.tied_to = kPassiveStiffness;
  damping.free = damping.pooled = false;
}

}  // namespace pushid
