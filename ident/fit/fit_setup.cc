// ident: named options put together.
#include "ident/fit/fit_setup.h"

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/diagnostics/diagnostics.h"
#include "ident/fit/covariates.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

// The value of an option, or null.
const std::string* Find(const GivenOptions& given, const std::string& name) {
  for (const auto& [known, value] : given) {
    if (known == name) return &value;
  }
  return nullptr;
}

std::string PresetIn(const GivenOptions& given) {
  const std::string* named = Find(given, "preset");
  return named != nullptr ? *named : kAutoPreset;
}

MaybeError ApplyStage(OptionStage stage, const GivenOptions& given, FitOptions* options) {
  for (const FitOptionRow& row : FitOptionRows()) {
    const std::string* value = row.stage == stage ? Find(given, row.name) : nullptr;
    if (value == nullptr) continue;
    if (MaybeError error = row.apply(*value, options)) return error;
  }
  return std::nullopt;
}

// The parts of a list that is given: "mu=3,Kp_theta" of --fix.
std::vector<std::string> ItemsOf(const GivenOptions& given, const std::string& option) {
  const std::string* list = Find(given, option);
  return list != nullptr ? SplitList(*list) : std::vector<std::string>();
}

std::string NameIn(const std::string& item) { return item.substr(0, item.find('=')); }

bool IsListed(const GivenOptions& given, const std::string& option, const std::string& name) {
  const std::vector<std::string> items = ItemsOf(given, option);
  return std::any_of(items.begin(), items.end(),
                     [&name](const std::string& item) { return NameIn(item) == name; });
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

Result<FitOptions> OverPreset(const std::string& preset, const GivenOptions& given,
                              const GivenOptions& must_act) {
  for (const std::string& item : ItemsOf(given, "free")) {
    if (!IsListed(given, "fix", NameIn(item))) continue;
    return Error{NameIn(item) + " is both fixed (--fix) and free (--free); leave one of them out"};
  }
  Result<FitOptions> made = StartPreset(preset);
  if (!made.ok()) return made.error();
  FitOptions o = std::move(made.value());
  if (MaybeError error = ApplyStage(OptionStage::kModel, given, &o)) return *error;
  FreeTerms(&o);
  if (MaybeError error = ApplyStage(OptionStage::kTable, given, &o)) return *error;
  // The network's shape and seed are known now.
  if (const auto network = o.model.learned) {
    o.model.learned = InitialNetwork(network->shape, o.seed, network->rod, network->pair);
  }
  // Parameters that the preset pools by name may have been fixed since, or not act any more.
  if (Find(given, "pool") == nullptr && !PoolsAllOrNone(o.pool)) {
    std::vector<std::string> free;
    for (const std::string& name : SplitList(o.pool)) {
      if (o.table.Find(name)->free) free.push_back(name);
    }
    o.pool = free.empty() ? "none" : Joined(free, ",");
  }
  if (MaybeError error = PoolParameters(&o)) return *error;
  std::string invalid;
  if (!o.IsValid(&invalid)) return Error{invalid};
  if (MaybeError error = CheckGivenAct(must_act, o)) return *error;
  return o;
}

// Whether a stance that was not asked for goes together with what was.
bool GoesTogether(const FitOptions& o, const std::vector<PendulumRecording>& recordings) {
  if (o.likelihood != Likelihood::kTrajectory || o.model.learned != nullptr) return false;
  for (Parameter id : o.table.Free()) {
    if (!Acts(id, o.model)) return false;
  }
  return o.model.stance != Stance::kSteps ||
         std::all_of(recordings.begin(), recordings.end(), [](const PendulumRecording& r) {
           return r.scene.dt * kLeastSteppingRate <= 1.0;
         });
}

}  // namespace

GivenOptions Merged(GivenOptions given, const GivenOptions& more) {
  for (auto& [option, list] : given) {
    if (option != "fix" && option != "free") continue;
    std::vector<std::string> kept;
    for (const std::string& item : SplitList(list)) {
      if (!IsListed(more, option == "fix" ? "free" : "fix", NameIn(item))) kept.push_back(item);
    }
    list = Joined(kept, ",");
  }
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
  if (recordings == nullptr) {
    if (preset != kAutoPreset) return OverPreset(preset, given, must_act);
    const Result<FitOptions> single = OverPreset("tail", given, must_act);
    if (single.ok()) return single;
    const Result<FitOptions> group = OverPreset("group", given, must_act);
    return group.ok() ? group : single;
  }
  // The stance is that of the recorded feet where nothing says another.
  const std::string chosen = PresetFor(preset, *recordings);
  const std::string* asked = Find(given, "stance");
  const std::optional<Stance> of_movers = StanceOfMovers(chosen);  // none: the preset has its own
  const bool open = of_movers && (asked == nullptr || *asked == kAutoStance);
  const Stance told = open ? StanceOf(FeetOf(*recordings), *of_movers) : Stance::kSlide;
  if (told != Stance::kSlide) {
    Result<FitOptions> made =
        OverPreset(chosen, Merged(given, {{"stance", NameOf(told)}}), must_act);
    if (made.ok() && GoesTogether(made.value(), *recordings)) return made;
  }
  return OverPreset(chosen, given, must_act);
}

Result<FitSetup> FitSetup::Make(GivenOptions given, GivenOptions must_act) {
  Result<FitOptions> roughly = MakeFitOptions(given, nullptr, must_act);
  if (!roughly.ok()) return roughly.error();
  return FitSetup(std::move(given), std::move(must_act), std::move(roughly.value()));
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
  for (const std::string& item : ItemsOf(given, "fix")) {
    const ParameterSpec* spec = options.table.Find(NameIn(item));
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

namespace {

// What each of two options answers, for messages where they exclude each other.
constexpr char kQuestions[] =
    "rollouts (--likelihood=trajectory, with --delay and platforms) answer how stiff, damped and "
    "late people balance, likelihoods of single steps how much of their motion is noise";

bool AnyGroup(const std::vector<PendulumRecording>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [](const PendulumRecording& recording) { return recording.num_people() > 1; });
}

Warnings WarningsBefore(const std::vector<PendulumRecording>& recordings,
                        const FitOptions& options) {
  Warnings warnings = FindingWarnings(FindingsOf(recordings));
  if (AnyGroup(recordings) && !options.model.interaction.Any()) {
    warnings.emplace_back(
        "recordings contain several people, but the model has no interaction between them "
        "(--preset=group or --interaction=contact adds one)");
  }
  if (options.model.body != BodyModel::kAnthropometric) return warnings;
  for (const PendulumRecording& recording : recordings) {
    if (std::none_of(recording.masses.begin(), recording.masses.end(), IsAverage)) continue;
    const std::string what =
        "neither segments nor shoulders were read, so that --body=anthropometric takes the body of "
        "an average person; name them in the manifest (\"joints\"), state com_over_rod and "
        "gyration_over_rod of the subject, or enter com_height with --body=ldp";
    warnings.emplace_back("recording " + recording.id + ": " + what, recording.id, what);
  }
  return warnings;
}

// Pooling is taken out where all recordings share one unit, whose deviation and the shared value
// would be one number. The user is warned only if pooling was asked for.
void UnpoolOneUnit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                   Warnings* warnings) {
  if (!AnyPooled(options->table)) return;
  std::set<std::string> units;
  for (const PendulumRecording& recording : recordings) {
    for (const std::string& unit : PoolingUnits(recording, options->pool_by)) units.insert(unit);
  }
  if (units.size() > 1) return;
  for (ParameterSpec& spec : options->table.specs) spec.pooled = false;
  Result<FitOptions> preset = StartPreset(options->preset);
  if (!preset.ok()) return;
  SetStance(options->model.stance, &preset.value());  // which pools by itself
  const bool named = preset.value().pool != options->pool;
  if (!named && preset.value().pool_by == options->pool_by) return;  // not asked for
  warnings->push_back((named ? "--pool=" + options->pool : "--pool_by=" + options->pool_by) +
                      " does nothing: all recordings share one " + options->pool_by + ", '" +
                      *units.begin() + "'");
}

// A likelihood of single steps knows the state [q, qd] of everybody and nothing else.
MaybeError CheckLikelihood(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options) {
  const ModelOptions& model = options.model;
  if (options.likelihood == Likelihood::kTrajectory) return std::nullopt;
  if (const std::string what = MemoryOf(model); !what.empty()) {
    return Error{
        "the likelihoods of single steps require a model whose state is position and velocity; " +
        what +
        (model.learned != nullptr ? " has weights, which they cannot fit"
                                  : " has internal memory") +
        ": leave one of them out; " + kQuestions};
  }
  for (const PendulumRecording& r : recordings) {
    if (r.num_frames() < 3) {
      return Error{"recording " + r.id + " has too few frames for a likelihood of single steps"};
    }
    if (r.initial_velocity != InitialVelocity::kFree) continue;
    return Error{"recording " + r.id +
                 " has free initial velocities, which likelihoods of single steps cannot fit; "
                 "set initial_velocity to zero or estimated in the manifest"};
  }
  return std::nullopt;
}

}  // namespace

MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      Warnings* warnings) {
  if (recordings.empty()) return Error{"there are no recordings to fit"};
  if (options->model.interaction.learned && !AnyGroup(recordings)) {
    return Error{
        "--interaction names a network between people, but every recording is of one person; leave "
        "it out, or fit recordings of groups"};
  }
  // A label that no recording has pools by nothing; that of the presets may be absent.
  const std::string& key = options->pool_by;
  if (key != kSubjectUnit && key != kSettingLabel && key != kConditionLabel) {
    if (MaybeError error = CheckLabel(recordings, "pool_by", key, kSubjectUnit)) return error;
  }
  for (const PendulumRecording& recording : recordings) {
    const double rate = 1.0 / recording.scene.dt;
    if (options->model.stance != Stance::kSteps || rate >= kLeastSteppingRate) continue;
    return Error{"recording " + recording.id + " has " + Rounded(rate, 3) +
                 " frames per second, too few for --stance=steps; resample it "
                 "(--resample_fps=60), or let feet slide"};
  }
  if (MaybeError error = CheckLaboratory(recordings, *options)) return error;
  if (MaybeError error = CheckLikelihood(recordings, *options)) return error;
  Warnings told;
  UnpoolOneUnit(recordings, options, &told);
  std::string invalid;
  if (!options->IsValid(&invalid)) return Error{invalid};
  HoldUnusedTail(recordings, options);
  if (MaybeError error = AddCovariates(recordings, options, &told)) return error;
  if (options->table.Free().empty()) {
    return Error{"every parameter that acts on these recordings is fixed: nothing is left to fit"};
  }
  if (warnings != nullptr) {
    *warnings = WarningsBefore(recordings, *options);
    warnings->insert(warnings->end(), told.begin(), told.end());
  }
  // A large network has no force yet and no Jacobian at all: the physical model is what is checked.
  const FitOptions checked = NeedsGradientTraining(*options) ? PhysicsAlone(*options) : *options;
  return CheckEffects(FitProblem(recordings, checked));
}

namespace {

// The first fault that holds.
MaybeError FirstOf(const std::vector<std::pair<bool, std::string>>& faults) {
  for (const auto& [holds, text] : faults) {
    if (holds) return Error{text};
  }
  return std::nullopt;
}

// A delay is seen in how an answer follows a push: a recording should last some times as long.
constexpr double kDelaysInRecording = 2.0;

MaybeError CheckDelay(const std::vector<PendulumRecording>& recordings, const FitOptions& options) {
  if (options.model.delay == Delay::kNone) return std::nullopt;
  if (options.model.cart_derivative != CartDerivative::kNone) {
    return Error{
        "--delay and the derivative of the cart's velocity (--preset=ldp_published) do not go "
        "together: a late difference of velocities has no meaning in short steps"};
  }
  for (Parameter id : {kReactionDelay, kStepDelay}) {
    if (!Acts(id, options.model)) continue;
    const ParameterSpec& spec = options.table[id];
    for (const PendulumRecording& r : recordings) {
      const double seconds = (r.num_frames() - 1) * r.scene.dt;
      if (seconds >= kDelaysInRecording * spec.nominal) continue;
      return Error{"recording " + r.id + " lasts " + Rounded(seconds, 3) + " s, too short for a " +
                   spec.name + " of " + Rounded(spec.nominal, 3) +
                   " s: nothing in it comes after the delay; leave the recording out, set a "
                   "shorter delay (--free=" +
                   spec.name + "=0.1), or fit with --delay=none"};
    }
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckLaboratory(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options) {
  const ModelOptions& model = options.model;
  const bool large = NeedsGradientTraining(options), table = model.body == BodyModel::kTable;
  const bool rod = RodMoves(model);
  const ParameterSpec& gyration = options.table[kGyrationRadius];
  if (MaybeError error = CheckDelay(recordings, options)) return error;
  MaybeError error = FirstOf(
      {{table && model.stance != Stance::kSlide,
        "--body=table is for a pendulum on a cart that moves, but --stance is " +
            NameOf(model.stance) +
            "; add --stance=slide, or take the masses from the segments (--body=anthropometric)"},
       {table && gyration.free && gyration.nominal == 0.0,
        "gyration_radius is free and starts at 0, where nothing depends on it at first order; give "
        "a start, as in --free=gyration_radius=0.3"},
       {table && rod, "--body=table and --rod do not go together; leave one out"},
       {large && (model.delay != Delay::kNone || table),
        "networks of this size are trained by their gradient, which knows neither --delay nor "
        "--body=table; leave them out, or take a smaller network"}});
  for (size_t i = 0; !error && i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    const std::vector<GroundPose>& poses = r.scene.ground.poses;
    const bool moves = r.scene.ground.moves(), plates = r.HasPlates(), unseen = !r.IsSeen();
    const bool touch = model.interaction.Any() && r.num_people() > 1;
    const bool tilts = std::any_of(poses.begin(), poses.end(),
                                   [](const GroundPose& pose) { return !pose.tail<2>().isZero(); });
    const std::string name = "recording " + r.id;
    const std::string measured = name + " has force_plates to be measured against";
    // Without recorded motion, only what the platforms measure is compared.
    const std::string alone = name + " was measured by force plates alone (\"motion\": \"none\")";
    error = FirstOf(
        {{moves && rod, name +
                            " is on moving ground, whose inertia no law of --rod has; leave --rod "
                            "out, or the recording"},
         {moves && tilts && touch,
          name + " has several people who touch on ground that tilts, about where each of them "
                 "stands; fit with --interaction=none, or leave the recording out"},
         {plates && rod, measured +
                             ", which know nothing of a rod that moves; leave --rod out, or set "
                             "\"use\": \"none\" there"},
         {plates && options.likelihood != Likelihood::kTrajectory,
          measured + ", which --likelihood=" + NameOf(options.likelihood) +
              " does not have: it knows positions alone; set \"use\": \"none\" there, or fit with "
              "--likelihood=trajectory; " +
              kQuestions},
         {plates && touch,
          name +
              " has force_plates and several people who touch: platforms cannot tell what they do "
              "to each other from what the ground does; set \"use\": \"none\" there, or fit with "
              "--interaction=none"},
         {unseen && model.stance != Stance::kFixed,
          alone + ", which tell nothing of feet that slide or step; add --stance=fixed"},
         {unseen && (model.body != BodyModel::kLdp || rod || large),
          alone + ", from which neither bodies, rods nor large networks are learnt; leave --body, "
                  "--rod and the network out"},
         {large && (moves || plates),
          name + " has moving ground or force_plates, and the network is of a size that is trained "
                 "by its gradient, which knows neither; take a smaller network, or leave the "
                 "recording out"}});
  }
  return error;
}

Result<IdentifiedModel> SyntheticTruth(const SyntheticOptions& study, const std::string& set) {
  const Stance stance = study.model.stance;
  const bool groups = study.people_in_row > 1, slide = stance == Stance::kSlide;
  const Result<FitOptions> made = MakeFitOptions({{"preset", groups ? "group" : "tail"},
                                                  {"stance", NameOf(study.model.stance)},
                                                  {"delay", NameOf(study.model.delay)}});
  if (!made.ok()) return made.error();
  const FitOptions& preset = made.value();
  const ParameterSet<double> published =
      !slide ? PublishedStanceParameters()
             : (groups ? PublishedGroupParameters() : PublishedTailParameters());
  IdentifiedModel model;
  model.options = preset.model;
  model.options.process_noise = study.model.process_noise;  // which no fit by rollouts has
  model.table = preset.table;
  model.parameters = preset.table.Values();
  for (Parameter id : preset.table.Free()) {
    // People who stand, and delays, are as the preset has them.
    const bool of_delay = id >= kReactionDelay && id <= kPassiveDamping;
    if (stance == Stance::kFixed || of_delay) continue;
    if (!IsPairParameter(id) || slide) model.parameters[id] = published[id];
  }
  model.table.SetTied(&model.parameters);
  if (MaybeError error = SetValues(set, &model)) return *error;
  return model;
}

}  // namespace pushid
