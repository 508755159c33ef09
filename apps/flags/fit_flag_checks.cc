// apps: fit flags out of range, and those that do nothing.
#include "apps/flags/fit_flag_checks.h"

#include <gflags/gflags.h>

#include <cmath>
#include <sstream>

DECLARE_double(early_stopping);
DECLARE_int32(ensemble);
DECLARE_string(fix);
DECLARE_double(function_tolerance);
DECLARE_double(gradient_tolerance);
DECLARE_int32(max_iterations);
DECLARE_double(mode_margin);
DECLARE_double(mode_weight);
DECLARE_double(network_prior);
DECLARE_int32(num_threads);
DECLARE_double(parameter_tolerance);
DECLARE_double(pooling_sigma);
DECLARE_double(robust);
DECLARE_double(settling_weight);
DECLARE_double(sigma_angle);
DECLARE_double(sigma_hip);
DECLARE_double(sigma_rate);
DECLARE_double(sigma_velocity);
DECLARE_double(stability_weight);
DECLARE_double(start_spread);
DECLARE_int32(starts);
DECLARE_double(takeover_weight);

namespace pushid {
namespace {

// Written so that NaN and infinity fail.
MaybeError CheckPositive(const char* flag, double value) {
  if (value > 0.0 && std::isfinite(value)) return std::nullopt;
  return Error{std::string("--") + flag + " must be positive"};
}

MaybeError CheckNotNegative(const char* flag, double value) {
  if (value >= 0.0 && std::isfinite(value)) return std::nullopt;
  return Error{std::string("--") + flag + " must be a number of at least 0"};
}

// The default, below zero, stands for the preset's value.
MaybeError CheckNotNegativeIfGiven(const char* flag, double value) {
  const bool given = !gflags::GetCommandLineFlagInfoOrDie(flag).is_default;
  return given ? CheckNotNegative(flag, value) : std::nullopt;
}

}  // namespace

MaybeError CheckFitNumbers() {
  for (MaybeError error :
       {CheckPositive("sigma_hip", FLAGS_sigma_hip),
        CheckPositive("sigma_velocity", FLAGS_sigma_velocity),
        CheckPositive("sigma_angle", FLAGS_sigma_angle),
        CheckPositive("sigma_rate", FLAGS_sigma_rate),
        CheckPositive("num_threads", FLAGS_num_threads),
        CheckPositive("max_iterations", FLAGS_max_iterations),
        CheckNotNegative("robust", FLAGS_robust),
        CheckNotNegative("stability_weight", FLAGS_stability_weight),
        CheckPositive("starts", FLAGS_starts), CheckPositive("ensemble", FLAGS_ensemble),
        CheckNotNegative("network_prior", FLAGS_network_prior),
        CheckNotNegative("takeover_weight", FLAGS_takeover_weight),
        CheckNotNegative("gradient_tolerance", FLAGS_gradient_tolerance),
        CheckNotNegative("parameter_tolerance", FLAGS_parameter_tolerance)}) {
    if (error) return error;
  }
  if (!(FLAGS_early_stopping >= 0.0 && FLAGS_early_stopping <= 0.5)) {
    return Error{"--early_stopping must lie between 0 and 0.5"};
  }
  // Below zero stands for the preset's value.
  if (!std::isfinite(FLAGS_pooling_sigma) || FLAGS_pooling_sigma == 0.0) {
    return Error{"--pooling_sigma must be positive"};
  }
  if (!std::isfinite(FLAGS_function_tolerance)) {
    return Error{"--function_tolerance must be a number of at least 0"};
  }
  if (MaybeError error = CheckNotNegativeIfGiven("mode_weight", FLAGS_mode_weight)) return error;
  if (!std::isfinite(FLAGS_mode_margin)) return Error{"--mode_margin must be a number"};
  if (MaybeError error = CheckNotNegativeIfGiven("settling_weight", FLAGS_settling_weight)) {
    return error;
  }
  if (!(FLAGS_start_spread >= 1.0 && FLAGS_start_spread <= 1000.0)) {
    return Error{"--start_spread must lie between 1 and 1000"};
  }
  return std::nullopt;
}

std::vector<std::string> FlagWarnings(const FitOptions& options) {
  std::vector<std::string> warnings;
  std::stringstream list(FLAGS_fix);
  for (std::string item; std::getline(list, item, ',');) {
    const ParameterSpec* spec = options.table.Find(item.substr(0, item.find('=')));
    if (spec == nullptr || Acts(spec->id, options.model)) continue;
    warnings.push_back("--fix=" + item + " does nothing: " + spec->name +
                       " does not act under this model");
  }
  if (options.model.interaction.ldp_discrete) {
    warnings.push_back(
        "--interaction=ldp_discrete has switches, which a fit cannot see: it is there to evaluate; "
        "fit ldp (potential,lean), its smooth form");
  }
  return warnings;
}

}  // namespace pushid
