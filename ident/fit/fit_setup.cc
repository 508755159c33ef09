// ident: named options put together.
#include "ident/fit/fit_setup.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "datasets/files/names.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/presets.h"
#include "ident/parameters/pushed_feet.h"

namespace pushid {
namespace {

// The value of an option, or null.
const std::string* Find(const GivenOptions& given, const std::string& name) {
  for (const auto& [known, value] : given) {
    if (known == name) return &value;
  }
  return nullptr;
}

MaybeError ApplyStage(OptionStage stage, const GivenOptions& given, FitOptions* options) {
  for (const FitOptionRow& row : FitOptionRows()) {
    const std::string* value = row.stage == stage ? Find(given, row.name) : nullptr;
    if (value == nullptr) continue;
    if (MaybeError error = row.apply(*value, options)) return error;
  }
  return std::nullopt;
}

// Options that were given but act on nothing: an error that says what is missing.
MaybeError CheckGivenAct(const GivenOptions& given, const FitOptions& options) {
  const auto& network = options.model.learned;
  if (network == nullptr && Find(given, "network_prior") != nullptr) {
    return Error{
        "--network_prior acts on networks, but there is none; add one, as in --self_force=mlp:4"};
  }
  for (const char* name : {"marker_noise", "loss", "settling_weight"}) {
    if (options.likelihood == Likelihood::kTrajectory || Find(given, name) == nullptr) continue;
    return Error{std::string("--") + name + " acts on fits of whole rollouts; --likelihood=" +
                 NameOf(options.likelihood) + " fits single steps and does not use it"};
  }
  if (options.model.friction == FrictionKind::kAnisotropic && Find(given, "friction") != nullptr &&
      options.preset.rfind("ldp", 0) != 0) {
    return Error{"--friction=anisotropic is for --preset=ldp; take isotropic or coulomb"};
  }
  for (const char* name : {"fix", "free", "prior"}) {
    const std::string* named = Find(given, name);
    if (named == nullptr) continue;
    const MaybeError error =
        CheckTouching(*named, std::string("--") + name, options.table, options.model);
    if (error) return error;
  }
  if (!AnyPooled(options.table) && Find(given, "pool_by") != nullptr) {
    return Error{"--pool_by applies to pooled parameters, but the preset " + options.preset +
                 " pools none; add --pool=all, or name some, as in --pool=Kp_theta"};
  }
  return std::nullopt;
}

// What the preset pools by name may have been fixed since, or not act any more.
void PoolOnlyFree(FitOptions* options) {
  if (PoolsAllOrNone(options->pool)) return;
  std::string free;
  for (const std::string& name : SplitList(options->pool)) {
    if (options->table.Find(name)->free) free += (free.empty() ? "" : ",") + name;
  }
  options->pool = free.empty() ? "none" : free;
}

Result<FitOptions> OverPreset(const std::string& preset, const GivenOptions& given,
                              const GivenOptions& must_act) {
  Result<FitOptions> made = StartPreset(preset);
  if (!made.ok()) return made.error();
  FitOptions o = std::move(made.value());
  if (MaybeError error = ApplyStage(OptionStage::kModel, given, &o)) return *error;
  FreeTerms(&o);
  if (MaybeError error = ApplyStage(OptionStage::kTable, given, &o)) return *error;
  // Its shape is known now, and so is the seed.
  if (const auto network = o.model.learned) {
    o.model.learned = InitialNetwork(network->shape, o.seed, network->rod, network->pair);
  }
  if (Find(given, "pool") == nullptr) PoolOnlyFree(&o);
  if (MaybeError error = PoolParameters(&o)) return *error;
  std::string invalid;
  if (!o.IsValid(&invalid)) return Error{invalid};
  if (MaybeError error = CheckGivenAct(must_act, o)) return *error;
  return o;
}

std::string PresetIn(const GivenOptions& given) {
  const std::string* named = Find(given, "preset");
  return named != nullptr ? *named : kAutoPreset;
}

// Whether a stance that was not asked for goes together with what was.
bool GoesTogether(const FitOptions& o, const std::vector<PendulumRecording>& recordings) {
  const bool states_alone = o.likelihood == Likelihood::kTrajectory && o.model.learned == nullptr;
  const bool all_act =
      std::all_of(o.table.specs.begin(), o.table.specs.end(),
                  [&o](const ParameterSpec& spec) { return !spec.free || Acts(spec.id, o.model); });
  return states_alone && all_act &&
         (o.model.stance != Stance::kSteps ||
          std::all_of(recordings.begin(), recordings.end(), [](const PendulumRecording& r) {
            return r.scene.dt * kLeastSteppingRate <= 1.0;
          }));
}

// The stance that the recorded feet show; none for presets with a stance of their own.
std::optional<Stance> StanceFromFeet(const std::vector<PendulumRecording>& recordings,
                                     const std::string& preset) {
  const std::optional<Stance> of_movers = StanceOfMovers(preset);
  if (!of_movers) return std::nullopt;
  return StanceOf(FeetOf(recordings), *of_movers);
}

// Over the preset, with the stance that the feet tell where nothing says another.
Result<FitOptions> OverPresetOf(const std::vector<PendulumRecording>& recordings,
                                const std::string& preset, const GivenOptions& given,
                                const GivenOptions& must_act) {
  const std::string* asked = Find(given, "stance");
  const std::optional<Stance> told = StanceFromFeet(recordings, preset);
  const bool open = asked == nullptr || *asked == kAutoStance;
  if (open && told && *told != Stance::kSlide) {
    Result<FitOptions> made =
        OverPreset(preset, Merged(given, {{"stance", NameOf(*told)}}), must_act);
    if (made.ok() && GoesTogether(made.value(), recordings)) return made;
  }
  return OverPreset(preset, given, must_act);
}

}  // namespace

GivenOptions Merged(GivenOptions given, const GivenOptions& more) {
  for (const auto& option : more) {
    const auto same = std::find_if(given.begin(), given.end(),
                                   [&](const auto& one) { return one.first == option.first; });
    if (same == given.end()) {
      given.push_back(option);
    } else {
      same->second = option.second;
    }
  }
  return given;
}

Result<GivenOptions> ParseOptionWords(const std::string& words) {
  GivenOptions given;
  std::stringstream list(words);
  for (std::string word; list >> word;) {
    const size_t equals = word.find('=');
    if (word.rfind("--", 0) != 0 || equals == std::string::npos ||
        FindFitOption(word.substr(2, equals - 2)) == nullptr) {
      return Error{"'" + word + "' is not --flag=value of a fit; see pushid-fit --help"};
    }
    given.emplace_back(word.substr(2, equals - 2), word.substr(equals + 1));
  }
  return given;
}

Result<FitOptions> MakeFitOptions(const GivenOptions& given,
                                  const std::vector<PendulumRecording>* recordings,
                                  const GivenOptions& must_act) {
  const std::string preset = PresetIn(given);
  if (recordings != nullptr) {
    return OverPresetOf(*recordings, PresetFor(preset, *recordings), given, must_act);
  }
  if (preset != kAutoPreset) return OverPreset(preset, given, must_act);
  const Result<FitOptions> single = OverPreset("tail", given, must_act);
  if (single.ok()) return single;
  const Result<FitOptions> group = OverPreset("group", given, must_act);
  return group.ok() ? group : single;
}

Result<FitSetup> FitSetup::Make(GivenOptions given, GivenOptions must_act) {
  Result<FitOptions> roughly = MakeFitOptions(given, nullptr, must_act);
  if (!roughly.ok()) return roughly.error();
  return FitSetup(std::move(given), std::move(must_act), std::move(roughly.value()));
}

Result<FitOptions> FitSetup::For(const std::vector<PendulumRecording>& recordings) const {
  const std::string preset = PresetFor(PresetIn(given_), recordings);
  const std::optional<Stance> told = StanceFromFeet(recordings, preset);
  if (preset == roughly_.preset && (!told || *told == roughly_.model.stance)) return roughly_;
  return MakeFitOptions(given_, &recordings, must_act_);
}

std::vector<FitOptions> FitSetup::OtherStances(const std::vector<PendulumRecording>& recordings,
                                               const FitOptions& taken) const {
  const std::string* asked = Find(given_, "stance");
  std::vector<FitOptions> others;
  if ((asked != nullptr && *asked != kAutoStance) || !StanceOfMovers(taken.preset)) return others;
  for (const auto& [name, stance] : Names(Stance{})) {
    if (stance == taken.model.stance) continue;
    const Result<FitOptions> made =
        MakeFitOptions(Merged(given_, {{"preset", taken.preset}, {"stance", std::string(name)}}),
                       &recordings, must_act_);
    if (made.ok() && GoesTogether(made.value(), recordings)) others.push_back(made.value());
  }
  return others;
}

std::vector<std::string> OptionWarnings(const GivenOptions& given, const FitOptions& options) {
  std::vector<std::string> warnings;
  const std::string* fixed = Find(given, "fix");
  for (const std::string& item : SplitList(fixed != nullptr ? *fixed : "")) {
    const ParameterSpec* spec = options.table.Find(item.substr(0, item.find('=')));
    if (spec == nullptr || Acts(spec->id, options.model)) continue;
    warnings.push_back("--fix=" + item + " does nothing: " + spec->name +
                       " does not act under this model");
  }
  const std::string* pool_by = Find(given, "pool_by");
  if (pool_by != nullptr && Find(given, "pool") == nullptr && !PoolsAllOrNone(options.pool)) {
    warnings.push_back("--pool_by=" + *pool_by + " without --pool lets only " + options.pool +
                       " differ by " + *pool_by + ", which the preset " + options.preset +
                       " pools; --pool=all lets all free parameters differ");
  }
  const InteractionTerms& terms = options.model.interaction;
  if ((terms.ldp_published || terms.learned_in_range) && !NeedsGradientTraining(options)) {
    warnings.push_back("--interaction=" + InteractionText(options.model) +
                       " acts from one distance or lean on; derivatives do not see these switches, "
                       "so the fit may end before its optimum");
  }
  return warnings;
}

}  // namespace pushid
