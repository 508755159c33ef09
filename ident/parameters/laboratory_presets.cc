// ident: starts and priors of what a laboratory's model frees.
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/presets.h"

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

namespace {

constexpr double kCartGainPerFrame = 4.0, kAngleGainPerFrame = 200.0;  // Kd

}  // namespace

FitOptions LdpPreset() {
  FitOptions o;
  o.preset = "ldp";
  o.table = BaseTable();
  o.table[kKpX].nominal = o.table[kKpY].nominal = 30;
  o.table[kKdTheta].nominal = o.table[kKdPhi].nominal = kAngleGainPerFrame / kLdpRate;
  for (Parameter id : {kMu, kKpTheta, kKpPhi, kKdTheta, kKdPhi}) o.table[id].free = true;
  o.model.posture = Posture::kUpright;
  o.model.gain_scaling = GainScaling::kNone;
  o.model.push = PushUse::kAsRecorded;
  o.model.push_tail = PushTail::kNone;
  return o;
}

FitOptions LdpPublishedPreset() {
  FitOptions o = LdpPreset();
  o.preset = kLdpPublished;
  for (Parameter id : {kKpTheta, kKpPhi, kKdTheta, kKdPhi}) o.table[id].free = false;
  o.table[kKdX].nominal = o.table[kKdY].nominal = kCartGainPerFrame / kLdpRate;
  o.model.cart_derivative = CartDerivative::kBackward;
  o.model.push = PushUse::kAdded;
  o.model.learned =
      InitialNetwork({NetworkKind::kLdp, 256, 32}, o.seed, {RodKind::kLdp, {256, 128, 256}});
  o.sigmas = kLdpSigmas;
  o.sigma_source = SigmaSource::kFixed;
  o.recording_weight = RecordingWeight::kFrame;
  o.network_training = NetworkTraining::kTogether;
  o.network_optimizer = NetworkOptimizer::kAdam;  // L-BFGS ends at the first hard switch
  o.network_prior = 0.0;
  return o;
}

FitOptions LdpPublishedGroupsPreset() {
  FitOptions o = LdpPublishedPreset();
  o.preset = kLdpPublishedGroups;
  o.model.interaction.ldp_published = true;
  o.model.interaction.learned = o.model.interaction.learned_in_range = true;
  const LearnedTerms& alone = *o.model.learned;
  o.model.learned = InitialNetwork(alone.shape, o.seed, alone.rod, PairShape{{512, 512}, true});
  return o;
}

}  // namespace pushid
