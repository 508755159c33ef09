// ident: the presets, and the parameters that a model's terms free.
#include "ident/parameters/presets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "models/self_terms.h"

namespace pushid {
namespace {

// A start, and the sigma of a weak prior about it.
struct Start {
  Parameter id;
  double value, sigma;
};

void FreeFrom(std::initializer_list<Start> starts, ParameterTable* table) {
  for (const auto& [id, value, sigma] : starts) {
    ParameterSpec& spec = (*table)[id];
    spec.free = true;
    spec.nominal = value;
    spec.prior = Prior{value, sigma};
  }
}

FitOptions TailPreset() {
  FitOptions o;
  o.table = BaseTable();
  // Round numbers, not fitted ones. Each is the centre of a weak prior as wide as itself: stiffness
  // and cross term slide along a ridge that fits no better and predicts unseen pushes worse (hipADE
  // 0.112 against 0.096 m in cross-validation); the prior's exact centre hardly matters.
  FreeFrom({Start{kMu, 40, 40}, Start{kKpTheta, 1400, 1400}, Start{kKdTheta, 140, 140},
            Start{kAx, -10, 10}, Start{kTailGain, 1, 1}, Start{kTailTorque, 0.5, 0.5},
            Start{kTailTime, 0.2, 0.2}, Start{kTailBase, 0.0, 0.5}},
           &o.table);
  // The tail's time does not grow with the push's duration (tail_exponent): in the published
  // recordings that stands for the condition, and it sends people away who are pushed weakly for
  // long.
  o.model.directions = Directions::kIsotropic;
  // Conditions differ in how much of the momentum is common to all pushes (5 x 4 folds: hipADE
  // 0.085 against 0.093 m with the tail's time pooled).
  o.pool = "tail_base";
  o.pool_by = kConditionLabel;
  // Two conditions do not tell how far conditions lie apart.
  o.pooling_sigma = 0.5;
  o.settling_weight = 30.0;
  return o;
}

FitOptions GroupPreset() {
  FitOptions o = TailPreset();
  o.model.interaction.spring = o.model.interaction.damping = true;
  o.self_force = SelfForceKind::kLinear;
  o.table[kKdTheta] = BaseTable()[kKdTheta];
  // A free tail base predicts no better (hipADE 0.1000 against 0.1009 m, mean of three sets of
  // folds).
  o.table[kTailBase] = BaseTable()[kTailBase];
  // A smaller weight leaves somebody in a line a little too fast.
  o.settling_weight = 80.0;
  o.pool = "all,-mu";  // the same floor: by setting, mu predicts no better and turns negative
  // Most spreads would be estimated as nil, and the fit would be slow to settle.
  o.pooling_sigma = 0.3;
  // An exponent held at 0 predicts unseen recordings worse (hipADE 0.103 against 0.098 m in 5
  // folds): in groups the duration stands for no condition. Longer pushes than there were are
  // bounded (models/push.h).
  FreeFrom({Start{kTailExponent, 1.5, 1.5}}, &o.table);
  // Going on to 1e-7 takes half as long again and moves no parameter by more than a tenth of its
  // standard error.
  o.function_tolerance = 1e-5;
  return o;
}

// Data tell everything about feet that hold, so priors are as wide as their centres, but for
// where the body's mass is: men and women, and where the hip's marker is, differ by some 5 %.
void SetFixed(FitOptions* options) {
  options->model.push = PushUse::kAsRecorded;
  options->model.push_tail = PushTail::kNone;
  options->model.directions = Directions::kBody;
  options->settling_weight = 0.0;
  FreeFrom({Start{kKpTheta, 1250, 1250}, Start{kKpPhi, 1250, 1250}, Start{kKdTheta, 300, 300},
            Start{kKdPhi, 300, 300}, Start{kComHeight, 1.09, 0.055}},
           &options->table);
}

FitOptions RobotPreset() {
  FitOptions o;
  o.table = BaseTable();
  SetFixed(&o);
  o.model.stance = Stance::kFixed;
  o.model.body = BodyModel::kAnthropometric;  // as the manifest states it
  o.model.gain_scaling = GainScaling::kNone;
  o.model.directions = Directions::kIsotropic;
  o.table[kComHeight].free = false;
  o.preset_priors = false;
  return o;
}

constexpr char kLdpPublished[] = "ldp_published", kLdpPublishedGroups[] = "ldp_published_groups";
constexpr double kCartGainPerFrame = 4.0, kAngleGainPerFrame = 200.0;  // Kd

// Plain PD balance and one friction, from upright (Yue et al., CVPR 2024). Kd is 200 N m per frame
// of 1/60 s in the paper and in its code, hence 200 / 60 N m s/rad; to read it as SI, use
// --fix=Kd_theta=200,Kd_phi=200.
FitOptions LdpPreset() {
  FitOptions o;
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

// LDP as published: one force law at all times, to which the push is added; all networks in their
// sizes, trained together with mu by LDP's loss; gains, potential and torques as they are given.
// The carts' Kd of 4 per frame acts on backward differences, as in LDP's code. Every frame counts
// as one.
FitOptions LdpPublishedPreset() {
  FitOptions o = LdpPreset();
  for (Parameter id : {kKpTheta, kKpPhi, kKdTheta, kKdPhi}) o.table[id].free = false;
  o.table[kKdX].nominal = o.table[kKdY].nominal = kCartGainPerFrame / kLdpRate;
  o.model.cart_derivative = CartDerivative::kBackward;
  o.model.push = PushUse::kAdded;
  o.model.learned =
      InitialNetwork({NetworkKind::kLdp, 256, 32}, o.seed, {RodKind::kLdp, {128, 128}});
  o.sigmas = kLdpSigmas;
  o.estimate_weights = false;
  o.effective_weight = 1.0;
  o.network_prior = 0.0;
  return o;
}

FitOptions LdpPublishedGroupsPreset() {
  FitOptions o = LdpPublishedPreset();
  o.model.interaction.ldp_published = true;
  o.model.interaction.learned = o.model.interaction.learned_in_range = true;
  const LearnedTerms& alone = *o.model.learned;
  o.model.learned = InitialNetwork(alone.shape, o.seed, alone.rod, PairShape{{512, 512}, true});
  return o;
}

// Settings differ in where people stand and how they are pushed, not in bodies: settings with gains
// of their own do not settle, and are predicted worse.
constexpr char kPooledWhereFeetStep[] =
    "contact_stiffness,contact_distance,contact_kappa,contact_damping,tail_gain,tail_time,"
    "tail_exponent";

struct NamedPreset {
  const char* name;
  FitOptions (*make)();
  std::optional<Stance> of_movers = std::nullopt;
  const char* pooled_where_feet_step = nullptr;  // null: what the preset pools
};
constexpr NamedPreset kPresets[] = {{"tail", TailPreset, Stance::kSlide},
                                    {"robot", RobotPreset},
                                    {"ldp", LdpPreset},
                                    {kLdpPublished, LdpPublishedPreset},
                                    {kLdpPublishedGroups, LdpPublishedGroupsPreset},
                                    {"group", GroupPreset, Stance::kSteps, kPooledWhereFeetStep}};

const NamedPreset* FindPreset(const std::string& name) {
  const auto known = std::find_if(std::begin(kPresets), std::end(kPresets),
                                  [&](const NamedPreset& preset) { return name == preset.name; });
  return known == std::end(kPresets) ? nullptr : known;
}

void FreeSelfForce(SelfForceKind kind, ParameterTable* table) {
  if (kind == SelfForceKind::kNone) return;
  for (int id = kFirstLinear; id <= kLastLinear; ++id) {
    ParameterSpec& spec = table->specs[id];
    spec.free = true;
    // Priors as weak as the preset's own: without them these terms drive the person instead.
    if (!spec.prior) spec.prior = Prior{spec.nominal, spec.scale};
  }
}

// Frees parameters with weak priors as wide as their centres. The contact's height stays fixed:
// heights from the ankles to the chest fit the group recordings alike. So do the parameters of
// LDP's discrete form: it has no derivatives.
void FreeByTerm(const ModelOptions& model, ParameterTable* table) {
  for (ParameterSpec& spec : table->specs) {
    if (!FreedByItsTerm(spec.id, model)) continue;
    spec.free = true;
    spec.prior = Prior{spec.nominal, std::abs(spec.nominal)};
  }
}

// Ties sideways parameters to the forward ones, but for those that a flag names.
void TieSideways(FitOptions* o) {
  for (const SidewaysParameter& pair : kSidewaysParameters) {
    ParameterSpec& spec = o->table[pair.sideways];
    spec.tied_to.reset();
    if (o->model.directions != Directions::kIsotropic || spec.named) continue;
    spec.tied_to = pair.forward;
    spec.free = spec.pooled = false;
  }
}

// Frees sideways parameters where the forward ones are free, from the same start.
void FreeSideways(FitOptions* o) {
  if (o->model.directions != Directions::kBody) return;
  for (const SidewaysParameter& pair : kSidewaysParameters) {
    const ParameterSpec& forward = o->table[pair.forward];
    ParameterSpec& sideways = o->table[pair.sideways];
    if (!forward.free || sideways.free || sideways.named) continue;
    sideways.free = true;
    sideways.nominal = forward.nominal;
    sideways.prior = forward.prior;
  }
}

// Stiffness and damping have one passive share, because the data hardly tell two apart, unless the
// damping's is named.
void TiePassive(FitOptions* o) {
  ParameterSpec& damping = o->table[kPassiveDamping];
  if (o->model.delay == Delay::kNone || damping.named) return;
  damping.tied_to = kPassiveStiffness;
  damping.free = damping.pooled = false;
}

// The noise that a likelihood of single steps tells of, without priors: it is seen thousands of
// times.
void FreeNoise(FitOptions* o) {
  if (o->likelihood == Likelihood::kTrajectory) return;
  for (int id = kFirstNoiseParameter; id <= kLastNoiseParameter; ++id) {
    const bool of_measurement = IsMeasurementError(static_cast<Parameter>(id));
    if (of_measurement && o->likelihood != Likelihood::kInnovation) continue;
    o->table.specs[id].free = Acts(static_cast<Parameter>(id), o->model);
  }
}

// Share of the pushes beyond which everybody moves. In the published recordings of single people 30
// of 32 step, in those of groups 48 of the 49 who are pushed.
constexpr double kEverybody = 0.75;

std::string OfAll(const PushedFeet& feet) {
  return std::to_string(feet.moved) + " of " + std::to_string(feet.seen) + " pushes";
}

// Whether both feet go at once, over at least half of the longer step's time: they slide, as
// nobody's who steps do.
bool Glide(const FootStep& a, const FootStep& b) {
  const int both = std::min(a.landing, b.landing) - std::max(a.lift_off, b.lift_off);
  return a.foot != b.foot && 2 * both > std::max(a.landing - a.lift_off, b.landing - b.lift_off);
}

bool LiftsAFoot(const PersonSteps& person) {
  const std::vector<FootStep>& steps = person.steps;
  return std::any_of(steps.begin(), steps.end(), [&steps](const FootStep& one) {
    return std::none_of(steps.begin(), steps.end(),
                        [&one](const FootStep& other) { return Glide(one, other); });
  });
}

}  // namespace

void SetStance(Stance stance, FitOptions* options) {
  options->model.stance = stance;
  if (stance == Stance::kSlide) return;
  ParameterTable& table = options->table;
  if (stance == Stance::kFixed) return SetFixed(options);
  options->model.push = PushUse::kAsRecorded;
  options->model.directions = Directions::kAxes;  // the feet's support has a front
  options->self_force = SelfForceKind::kNone;     // those act on feet that slide
  const NamedPreset* preset = FindPreset(options->preset);
  if (preset != nullptr && preset->pooled_where_feet_step != nullptr) {
    options->pool = preset->pooled_where_feet_step;
  }
  // People who stand turn about the ankles: contact is at the hip, or above. At 1.15
  // and 1.25 groups are predicted better, and rows no longer settle in time (models/README.md).
  table[kContactHeight].nominal = 0.95;
  table[kSupportBack].nominal = 0.08;
  table[kSupportSide].nominal = 0.03;
  // Few of those who were recorded stand, and none of them for long: that they can, and half of
  // them step at 0.34 m/s, comes from these priors. Twice as wide they predict people left out
  // alike (hipADE 0.0843 m against 0.0848), who step earlier.
  FreeFrom(
      {Start{kKpTheta, 900, 50}, Start{kKpPhi, 950, 100}, Start{kKdTheta, 200, 20},
       Start{kKdPhi, 320, 60}, Start{kSupportFront, 0.12, 0.015}, Start{kFootFront, 0.2, 0.01},
       Start{kStepGain, 0.85, 0.05}, Start{kStepOnset, 0.5, 0.08}, Start{kStepSwing, 0.31, 0.03},
       Start{kTailGain, 0.3, 0.15}, Start{kTailTime, 0.35, 0.1}},
      &table);
}

std::string MemoryOf(const ModelOptions& model) {
  if (model.delay != Delay::kNone) return "--delay=" + NameOf(model.delay);
  if (model.stance != Stance::kSlide) return "--stance=" + NameOf(model.stance);
  if (model.learned != nullptr) return "a network";
  if (model.cart_derivative != CartDerivative::kNone) return "the cart's derivative";
  return "";
}

void SetLikelihood(Likelihood likelihood, FitOptions* options) {
  options->likelihood = likelihood;
  if (likelihood == Likelihood::kTrajectory) return;
  options->model.process_noise = ProcessNoise::kDiagonal;
  options->settling_weight = 0.0;
}

std::optional<Stance> StanceOfMovers(const std::string& preset) {
  const NamedPreset* known = FindPreset(preset);
  return known == nullptr ? std::nullopt : known->of_movers;
}

std::string PresetFor(const std::string& name, const std::vector<PendulumRecording>& recordings) {
  const bool groups =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const PendulumRecording& recording) { return recording.num_people() > 1; });
  if (name == kLdpPublished && groups) return kLdpPublishedGroups;
  if (name != kAutoPreset) return name;
  return groups ? "group" : "tail";
}

Result<FitOptions> StartPreset(const std::string& name) {
  if (name == kAutoPreset) {
    return Error{"the preset auto looks at recordings: ask PresetFor what it stands for"};
  }
  if (const NamedPreset* preset = FindPreset(name)) {
    FitOptions options = preset->make();
    options.preset = name;
    return options;
  }
  std::string known = kAutoPreset;
  for (const NamedPreset& preset : kPresets) {
    known += (&preset == std::end(kPresets) - 1 ? " or " : ", ") + std::string(preset.name);
  }
  return Error{"--preset is '" + name + "'; it must be " + known};
}

Result<FitOptions> MakePreset(const std::string& name) {
  Result<FitOptions> options = StartPreset(name);
  if (!options.ok()) return options;
  FreeTerms(&options.value());
  if (MaybeError error = PoolParameters(&options.value())) return *error;
  return options;
}

void FreeTerms(FitOptions* o) {
  FreeSelfForce(o->self_force, &o->table);
  FreeByTerm(o->model, &o->table);
  FreeNoise(o);
  for (ParameterSpec& spec : o->table.specs) {
    if (!o->preset_priors) spec.prior.reset();
    if (!Acts(spec.id, o->model)) spec.free = spec.pooled = false;
  }
  FreeSideways(o);
  TieSideways(o);
  TiePassive(o);
  // These two cannot fail; names can.
  if (PoolsAllOrNone(o->pool)) (void)PoolParameters(o);
}

MaybeError PoolParameters(FitOptions* o) {
  for (ParameterSpec& spec : o->table.specs) {
    spec.pooled = false;
    spec.pooling_sigma = o->pooling_sigma.value_or(kFirstPoolingSigma);
  }
  TableEdits edits;
  edits.pool = o->pool;
  edits.pool_by = o->pool_by;
  return EditTable(edits, &o->table);
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
  // Weak priors: published delays are 0.10 to 0.16 s (median 0.134), passive shares 0 to 0.9.
  FreeFrom({Start{kReactionDelay, 0.13, 0.1}, Start{kStepDelay, 0.2, 0.15},
            Start{kPassiveStiffness, 0.2, 0.2}, Start{kPassiveDamping, 0.2, 0.2}},
           &options->table);
}

PushedFeet FeetOf(const std::vector<PendulumRecording>& recordings) {
  PushedFeet feet;
  for (const PendulumRecording& recording : recordings) {
    if (!recording.StepsKnown()) continue;
    std::set<int> pushed;
    for (const ScenePush& push : recording.scene.pushes) pushed.insert(push.person);
    // Ground that moves pushes everybody; who sways in quiet does so on feet that hold.
    if (pushed.empty() || recording.scene.ground.moves()) {
      for (int n = 0; n < recording.num_people(); ++n) pushed.insert(n);
    }
    for (int person : pushed) {
      const PersonSteps& steps = recording.steps[person];
      ++feet.seen;
      feet.moved += steps.Moved();
      feet.stepped += LiftsAFoot(steps);
    }
  }
  return feet;
}

Stance StanceOf(const PushedFeet& feet, Stance of_movers) {
  if (feet.seen > 0 && feet.moved == 0) return Stance::kFixed;
  // Feet that move and do not leave the ground slide, if little. Of people who slide noise shows
  // some as lifted: of 48 synthetic pushes 8, where all of 78 recorded ones step.
  if (2 * feet.stepped < feet.moved || feet.stepped == 0) return Stance::kSlide;
  return feet.moved >= kEverybody * feet.seen ? of_movers : Stance::kSteps;
}

std::string FeetText(const PushedFeet& feet, Stance stance) {
  if (feet.seen == 0) return "";
  const char* const feet_do = stance == Stance::kSlide   ? "feet move freely"
                              : stance == Stance::kFixed ? "feet hold"
                                                         : "feet hold, then step";
  return std::string(feet_do) + " (--stance=" + NameOf(stance) + "; they moved in " + OfAll(feet) +
         ")";
}

std::string FeetWarning(const PushedFeet& feet, Stance stance) {
  if (feet.seen == 0) return "";
  if (stance == Stance::kSlide && feet.moved == 0) {
    return "no pushed person's feet moved, but those of the model slide: drag and gains are not "
           "those of people who stand; fit with --stance=fixed";
  }
  if (stance == Stance::kFixed && feet.moved > 0) {
    return "feet moved in " + OfAll(feet) +
           ", but those of the model hold: leave these recordings out, or fit with "
           "--stance=steps";
  }
  return "";
}

}  // namespace pushid
