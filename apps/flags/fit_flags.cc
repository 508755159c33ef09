// apps: fit flags and their defaults.
#include "apps/flags/fit_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "apps/flags/fit_flag_checks.h"
#include "apps/flags/network_flags.h"
#include "ident/parameters/network_json.h"
#include "ident/parameters/option_names.h"
#include "ident/parameters/self_network_io.h"
#include "ident/results/result_json.h"

DEFINE_string(
    preset, "tail",
    "the model: tail (push tail, posture-relative recovery), ldp (plain PD and friction from "
    "upright), or group (tail with linear self forces and contact, pooled by setting)");
DEFINE_string(posture, "",
              "balance error measured from: upright or initial (default: the preset's)");
DEFINE_string(gain_scaling, "",
              "gains of other bodies: none, mass, or body (mass and rod length) (default: the "
              "preset's)");
DEFINE_string(friction, "", "isotropic or anisotropic (default: the preset's)");
DEFINE_string(push, "", "as_recorded (honour push_kind) or added (default: the preset's)");
DEFINE_string(push_tail, "", "none or exponential (default: the preset's)");
DEFINE_string(cart_derivative, "none", "none or backward: lets Kd_x and Kd_y act");
DEFINE_string(interaction, "",
              "what people do to each other: none, or some of these, comma-separated: contact "
              "(smooth and mutual: spring,damping), spring, damping, ldp (smoothed: "
              "potential,lean), potential, lean, ldp_discrete (LDP's exact form, to evaluate), "
              "network (of --interaction_network), drive (who was pushed by others steps on) "
              "(default: the preset's)");
DEFINE_string(interaction_network, "",
              "JSON file of the network that --interaction=network evaluates "
              "(ident/parameters/network_json.h)");
DEFINE_string(self_from, "",
              "a model whose self parameters (all but those between people) are taken over and "
              "held, as of single people");
DEFINE_string(mapping, "exact", "skeleton to pendulum: exact, or ldp for comparison");

DEFINE_string(fix, "", "parameters held: name or name=value, comma-separated");
DEFINE_string(free, "", "parameters fitted: name or name=start, comma-separated");
DEFINE_string(prior, "", "priors: name:mean:sigma in the parameter's unit, comma-separated");
DEFINE_bool(preset_priors, true, "keep the preset's weak priors");
DEFINE_string(pool, "",
              "parameters that may differ by unit, comma-separated, or all, or none (default: the "
              "preset's)");
DEFINE_string(pool_by, "",
              "the unit they may differ by: subject or setting (default: the preset's)");
DEFINE_double(pooling_sigma, -1.0,
              "how far a unit may deviate from the shared value (standard deviation on the fitted "
              "scale; 0.2 is about 20 % for a positive parameter) (default: the preset's)");

DEFINE_double(sigma_hip, 0.1, "standard deviation of the hip's position, m");
DEFINE_double(sigma_velocity, 1.0, "standard deviation of the cart's velocity, m/s");
DEFINE_double(sigma_angle, 1.0, "standard deviation of the angles, rad");
DEFINE_double(sigma_rate, 3.0, "standard deviation of the angular rates, rad/s");
DEFINE_double(robust, 0.5, "pseudo-Huber scale of a frame in sigmas; 0: plain least squares");
DEFINE_string(recording_weight, "recording",
              "what counts the same: every recording, or every frame");
DEFINE_double(settling_weight, -1.0,
              "weight of the settling simulations, after which a pushed person must have settled; "
              "0: off (default: the "
              "preset's)");
DEFINE_double(
    mode_weight, -1.0,
    "weight of the hinge that makes a person's free modes at rest decay (it sees no network); 0: "
    "off (default: 30 with --self_force=linear, else 0)");
DEFINE_double(mode_margin, 0.2, "slowest decay the hinge allows, 1/s");
DEFINE_double(stability_weight, 0.0,
              "weight of the rollouts continued past the data, with the push and 1.4 times it");

DEFINE_string(horizons, "8,16,32,64", "frames of the stages before all frames, comma-separated");
DEFINE_string(start, "equation_error", "first start: equation_error or nominal");
DEFINE_int32(starts, 1, "how many starts; the best one is taken");
DEFINE_double(start_spread, 5.0, "random starts multiply every gain by up to this, either way");
DEFINE_uint64(seed, 1, "seed of everything random");
DEFINE_int32(num_threads, 1, "threads");
DEFINE_int32(max_iterations, 200, "iterations of each stage");
DEFINE_double(function_tolerance, -1.0,
              "relative change of the cost that ends a stage (default: the preset's)");
DEFINE_double(gradient_tolerance, 1e-12, "gradient that ends a stage");
DEFINE_double(parameter_tolerance, 1e-9, "relative step that ends a stage");

namespace pushid {
namespace {

template <typename E>
MaybeError Override(const char* flag, const std::string& text, E* value) {
  if (text.empty()) return std::nullopt;
  return ParseName(std::string("--") + flag, text, value);
}

MaybeError ReadModel(FitOptions* o) {
  ModelOptions& m = o->model;
  for (MaybeError error :
       {Override("mapping", FLAGS_mapping, &o->mapping),
        Override("posture", FLAGS_posture, &m.posture),
        Override("gain_scaling", FLAGS_gain_scaling, &m.gain_scaling),
        Override("friction", FLAGS_friction, &m.friction), Override("push", FLAGS_push, &m.push),
        Override("push_tail", FLAGS_push_tail, &m.push_tail),
        Override("cart_derivative", FLAGS_cart_derivative, &m.cart_derivative),
        Override("interaction", FLAGS_interaction, &m.interaction),
        Override("recording_weight", FLAGS_recording_weight, &o->recording_weight),
        Override("pool_by", FLAGS_pool_by, &o->pool_by),
        Override("start", FLAGS_start, &o->start)}) {
    if (error) return error;
  }
  return std::nullopt;
}

// A linear self force can feed a mode that the settling simulations do not excite.
constexpr double kLinearModeWeight = 30.0;

constexpr long kLongestHorizon = 1000000;  // frames

MaybeError ReadHorizons(FitOptions* o) {
  o->horizons.clear();
  std::stringstream list(FLAGS_horizons);
  for (std::string part; std::getline(list, part, ',');) {
    char* end = nullptr;
    const long frames = std::strtol(part.c_str(), &end, 10);
    if (part.empty() || *end != '\0' || frames < 2 || frames > kLongestHorizon) {
      return Error{"--horizons: '" + part + "' is no number of frames of at least 2"};
    }
    o->horizons.push_back(static_cast<int>(frames));
  }
  o->horizons.push_back(0);
  return std::nullopt;
}

// Parameters of terms that the options switched off must not be fitted: they have no effect.
void FixWhatDoesNotAct(const ModelOptions& model, ParameterTable* table) {
  for (ParameterSpec& spec : table->specs) {
    if (!Acts(spec.id, model)) spec.free = false;
  }
}

MaybeError ReadInteraction(ModelOptions* model) {
  if (!model->interaction.network && FLAGS_interaction_network.empty()) return std::nullopt;
  if (!model->interaction.network) {
    return Error{"--interaction_network is given, but --interaction does not name network"};
  }
  if (FLAGS_interaction_network.empty()) {
    return Error{"--interaction names network: --interaction_network must name its JSON file"};
  }
  const auto network = ReadInteractionNetwork(FLAGS_interaction_network);
  if (!network.ok()) return network.error();
  model->interaction_network = network.value();
  return std::nullopt;
}

// Takes over what a person does alone; the terms between people stay as they are.
MaybeError TakeSelfFrom(const std::string& path, ParameterTable* table) {
  if (path.empty()) return std::nullopt;
  const Result<FitResult> source = ReadFitResult(path);
  if (!source.ok()) return source.error();
  if (const auto& network = source.value().options.model.self_network) {
    return Error{"has learned " + LearnedName(*network) +
                     ", which --self_from cannot take over; fit one without",
                 path};
  }
  for (ParameterSpec& spec : table->specs) {
    if (spec.id >= kFirstPairParameter) continue;
    spec.nominal = source.value().parameters[spec.id];
    spec.free = false;
  }
  return std::nullopt;
}

Result<FitOptions> OptionsOfFlags() {
  Result<Preset> preset = MakePreset(FLAGS_preset);
  if (!preset.ok()) return preset.error();
  FitOptions o;
  o.preset = FLAGS_preset;
  o.model = preset.value().model;
  o.table = preset.value().table;
  o.self_force = preset.value().self_force;
  o.pool_by = preset.value().pool_by;
  o.settling_weight =
      FLAGS_settling_weight >= 0.0 ? FLAGS_settling_weight : preset.value().settling_weight;
  o.stability_weight = FLAGS_stability_weight;
  if (MaybeError error = ReadModel(&o)) return *error;
  if (MaybeError error = ReadNetworkFlags(FLAGS_seed, &o)) return *error;
  if (MaybeError error = ReadHorizons(&o)) return *error;
  if (MaybeError error = CheckFitNumbers()) return *error;

  const double hinge = o.self_force == SelfForceKind::kLinear ? kLinearModeWeight : 0.0;
  o.mode_weight = FLAGS_mode_weight >= 0.0 ? FLAGS_mode_weight : hinge;
  o.mode_margin = FLAGS_mode_margin;
  FreeSelfForce(o.self_force, &o.table);
  FreeRod(o.model, &o.table);
  FreeInteraction(o.model.interaction, &o.table);
  if (!FLAGS_preset_priors) {
    for (ParameterSpec& spec : o.table.specs) spec.prior.reset();
  }
  if (MaybeError error = ReadInteraction(&o.model)) return *error;
  FixWhatDoesNotAct(o.model, &o.table);
  if (MaybeError error = TakeSelfFrom(FLAGS_self_from, &o.table)) return *error;
  TableEdits edits;
  edits.fix = FLAGS_fix;
  edits.free = FLAGS_free;
  edits.prior = FLAGS_prior;
  edits.pool = FLAGS_pool.empty() ? preset.value().pool : FLAGS_pool;
  edits.pool_by = o.pool_by;
  if (MaybeError error = EditTable(edits, &o.table)) return *error;
  if (MaybeError error = CheckNetworkFlags(o)) return *error;
  if (o.table.Free().empty()) return Error{"every parameter is fixed: nothing is left to fit"};

  o.sigmas = {FLAGS_sigma_hip, FLAGS_sigma_velocity, FLAGS_sigma_angle, FLAGS_sigma_rate,
              FLAGS_robust};
  o.pooling_sigma = FLAGS_pooling_sigma > 0.0 ? FLAGS_pooling_sigma : preset.value().pooling_sigma;
  o.num_starts = FLAGS_starts;
  o.start_spread = FLAGS_start_spread;
  o.seed = FLAGS_seed;
  o.num_threads = FLAGS_num_threads;
  o.max_iterations = FLAGS_max_iterations;
  o.function_tolerance = FLAGS_function_tolerance >= 0.0 ? FLAGS_function_tolerance
                                                         : preset.value().function_tolerance;
  o.gradient_tolerance = FLAGS_gradient_tolerance;
  o.parameter_tolerance = FLAGS_parameter_tolerance;
  return o;
}

}  // namespace

Result<FitOptions> FitOptionsFromFlags() {
  const Result<FitOptions> options = OptionsOfFlags();
  if (!options.ok() || AnyPooled(options.value().table)) return options;
  for (const char* flag : {"pool_by", "pooling_sigma"}) {
    if (gflags::GetCommandLineFlagInfoOrDie(flag).is_default) continue;
    return Error{std::string("--") + flag +
                 " says how parameters differ, but none does; name some with --pool"};
  }
  return options;
}

Result<FitOptions> FitOptionsWith(const std::string& extra_flags) {
  // Other flags than those of a fit would be taken and do nothing.
  const auto file = [](const char* flag) {
    return gflags::GetCommandLineFlagInfoOrDie(flag).filename;
  };
  const std::string these[] = {file("preset"), file("self_force")};
  const gflags::FlagSaver saver;
  std::stringstream list(extra_flags);
  for (std::string word; list >> word;) {
    const size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    gflags::CommandLineFlagInfo flag;
    if (name.rfind("--", 0) != 0 || equals == std::string::npos ||
        !gflags::GetCommandLineFlagInfo(name.c_str() + 2, &flag) ||
        std::find(std::begin(these), std::end(these), flag.filename) == std::end(these) ||
        gflags::SetCommandLineOption(name.c_str() + 2, word.c_str() + equals + 1).empty()) {
      return Error{"'" + word + "' is not --flag=value of a fit; see pushid-fit --help"};
    }
  }
  return OptionsOfFlags();
}

int NumThreads() { return FLAGS_num_threads; }

}  // namespace pushid
