// ident: the rows of all options.
#include "ident/parameters/option_table.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "ident/parameters/json_archive.h"
#include "ident/parameters/presets.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
using Row = FitOptionRow;

// Rows by the kind of their value.

// The place of a row's value: the options of the fit, those of the model, or the sigmas.
template <typename T>
class OptionField {
 public:
  OptionField(T FitOptions::*of_fit) : of_fit_(of_fit) {}               // NOLINT: stands for it
  OptionField(T ModelOptions::*of_model) : of_model_(of_model) {}       // NOLINT
  OptionField(T ResidualSigmas::*of_sigmas) : of_sigmas_(of_sigmas) {}  // NOLINT
  T& operator()(FitOptions& o) const {
    return of_fit_ ? o.*of_fit_ : of_model_ ? o.model.*of_model_ : o.sigmas.*of_sigmas_;
  }

 private:
  T FitOptions::*of_fit_ = nullptr;
  T ModelOptions::*of_model_ = nullptr;
  T ResidualSigmas::*of_sigmas_ = nullptr;
};

template <typename T>
const T& OptionValue(OptionField<T> field, const FitOptions& options) {
  return field(const_cast<FitOptions&>(options));  // only read
}

struct OptionRange {
  double lower, upper;
  bool open = false;  // without its lower end
  const char* words;  // "must be positive"
};
constexpr double kAnyNumber = std::numeric_limits<double>::max();
constexpr OptionRange kPositive = {0.0, kAnyNumber, true, "must be positive"};
constexpr OptionRange kNotNegative = {0.0, kAnyNumber, false, "must be a number of at least 0"};

// Written so that NaN and infinity lie outside.
std::string RangeViolation(const OptionRange& range, double value) {
  const bool inside =
      (range.open ? value > range.lower : value >= range.lower) && value <= range.upper;
  return inside ? "" : range.words;
}

// "--marker_noise is 'abc'; it must be positive".
Error BadOption(const std::string& name, const std::string& value, const std::string& must) {
  return Error{"--" + name + " is '" + value + "'; it " + must};
}

// A row that stands in no model, with a way to apply its words.
Row WordsRow(const char* name, OptionStage stage, const char* help,
             std::function<MaybeError(const std::string&, FitOptions*)> apply) {
  Row row;
  row.name = name;
  row.help = help;
  row.stage = stage;
  row.apply = std::move(apply);
  return row;
}

// A value in words, as flags give it, and back.
template <typename T>
std::string TextOf(const T& value) {
  if constexpr (std::is_same_v<T, double>) return DoubleText(value);
  const Json json = JsonOf(value);
  return json.is_string() ? json.get<std::string>() : json.dump();
}

template <typename T>
bool ParseText(const std::string& text, T* value) {
  if constexpr (std::is_same_v<T, double>) {
    return ParseDouble(text, value);
  } else if constexpr (std::is_same_v<T, bool>) {
    *value = text == "true" || text == "1" || text == "yes";
    return *value || text == "false" || text == "0" || text == "no";
  } else if constexpr (std::is_integral_v<T>) {
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, *value);
    return read.ec == std::errc() && read.ptr == end;
  } else if constexpr (std::is_same_v<T, std::string>) {
    *value = text;
    return true;
  }
  return false;  // a list stands in files alone
}

// The row of a field, whose flag and JSON follow from its type. must: what words have to be.
template <typename T>
Row FieldRow(const char* name, const char* json, OptionField<T> field, const char* help,
             const char* must = "") {
  Row row = WordsRow(name, OptionStage::kModel, help,
                     [=](const std::string& text, FitOptions* o) -> MaybeError {
                       if constexpr (std::is_enum_v<T>) {
                         return ParseName("--" + std::string(name), text, &field(*o));
                       } else {
                         if (ParseText(text, &field(*o))) return std::nullopt;
                         return BadOption(name, text, must);
                       }
                     });
  row.json = json;
  row.text = [field](const FitOptions& o) { return TextOf(OptionValue(field, o)); };
  row.write = [field](const FitOptions& o) { return Json(JsonOf(OptionValue(field, o))); };
  row.read = [=](const Json& value, FitOptions* o) { ReadJson(value, &field(*o), name); };
  return row;
}

Row NumberRow(const char* name, const char* json, OptionField<double> field, OptionRange range,
              const char* help) {
  Row row = FieldRow(name, json, field, help, range.words);
  row.violation = [=](const FitOptions& o) { return RangeViolation(range, OptionValue(field, o)); };
  return row;
}

// A whole number of at least 1.
Row CountRow(const char* name, const char* json, OptionField<int> field, const char* help) {
  Row row = FieldRow(name, json, field, help, "must be a whole number of at least 1");
  row.violation = [field](const FitOptions& o) {
    return OptionValue(field, o) >= 1 ? "" : "must be positive";
  };
  return row;
}

Row BoolRow(const char* name, const char* json, OptionField<bool> field, const char* help) {
  Row row = FieldRow(name, json, field, help, "must be true or false");
  row.is_bool = true;
  return row;
}

// A row with one of its properties set.
template <auto member, auto value>
Row With(Row row) {
  row.*member = value;
  return row;
}
constexpr auto Decided = With<&Row::preset_decides, true>;  // by the preset
constexpr auto Stored = With<&Row::is_flag, false>;  // in files: a preset or the fit decides it
constexpr auto AtTable = With<&Row::stage, OptionStage::kTable>;
constexpr auto RarelyChanged = With<&Row::heading, kRarelyChanged>;

// An enum that other options depend on, which `set` sets with it.
template <typename E>
Row FieldRowWith(void (*set)(E, FitOptions*), const char* name, const char* json,
                 OptionField<E> field, const char* help) {
  Row row = FieldRow<E>(name, json, field, help);
  row.apply = [=](const std::string& text, FitOptions* o) -> MaybeError {
    E value{};
    if (MaybeError error = ParseName("--" + std::string(name), text, &value)) return error;
    set(value, o);
    return std::nullopt;
  };
  return row;
}

// Rows of the model.

Row PresetRow() {
  Row row = FieldRow<std::string>(
      "preset", "/preset", &FitOptions::preset,
      "the model: auto (tail for recordings of one person, group where there are more), tail (push "
      "tail, posture-relative recovery), group (tail with contact, pooled by setting; with feet "
      "that slide, linear self forces too), robot (feet that hold, PD gains in SI without priors, "
      "the mass as the manifest states it), ldp (plain PD and friction from upright), or "
      "ldp_published (LDP with all its networks, of one person or of groups)");
  row.stage = OptionStage::kPreset;
  row.text = [](const FitOptions&) { return std::string(kAutoPreset); };
  row.apply = nullptr;
  return row;
}

// The learned terms so far.
LearnedTerms Learned(const FitOptions& o) {
  return o.model.learned != nullptr ? *o.model.learned : LearnedTerms{};
}

Row StanceRow() {
  Row row = FieldRowWith<Stance>(
      SetStance, "stance", "/stance", &ModelOptions::stance,
      "behaviour of the feet: slide (the cart moves under any force), steps (they hold until the "
      "capture point leaves their support, then one of them steps), fixed (they hold), or auto "
      "(fixed where no pushed person's feet moved; steps where some did, and of people who touch "
      "also where all did; slide where three in four people alone did, fewer than half of them "
      "lifted a foot or feet were not recorded; ldp presets: slide)");
  row.text = [](const FitOptions&) { return std::string(kAutoStance); };
  row.apply = [named = row.apply](const std::string& text, FitOptions* o) -> MaybeError {
    if (text == kAutoStance) return std::nullopt;
    MaybeError error = named(text, o);
    if (error) error->message += std::string(", or ") + kAutoStance;
    return error;
  };
  return row;
}

// A row of words that name what is learned too; take: what they choose.
template <typename Choice>
Row LearnedRow(const char* name, const char* json, const char* help,
               Result<Choice> (*parse)(const std::string&, const std::string&),
               void (*take)(const Choice&, FitOptions*, LearnedTerms*),
               std::string (*text)(const FitOptions&)) {
  const auto set = [=](const std::string& flag, const std::string& words, FitOptions* o) {
    const Result<Choice> choice = parse(flag, words);
    if (!choice.ok()) return MaybeError(choice.error());
    // The weights are drawn once all of it is known (fit_setup.h).
    LearnedTerms network = Learned(*o);
    take(choice.value(), o, &network);
    o->model.learned = network.any() ? std::make_shared<const LearnedTerms>(network) : nullptr;
    return MaybeError();
  };
  Row row = WordsRow(name, OptionStage::kModel, help, [=](const std::string& words, FitOptions* o) {
    return set("--" + std::string(name), words, o);
  });
  row.json = json;
  row.text = text;
  row.write = [text](const FitOptions& o) { return Json(text(o)); };
  row.read = [=](const Json& words, FitOptions* o) {
    if (MaybeError error = set(name, words.get<std::string>(), o)) {
      throw std::runtime_error(error->ToString());
    }
  };
  return row;
}

constexpr const char* kSelfForceHelp =
    "additional self force: none, linear (cross terms, quadratic), a network by kind and hidden "
    "size (mlp:4, or LDP's ldp:256:32 with its embedding), or linear and a network, "
    "comma-separated";

std::vector<Row> ModelRows() {
  using O = FitOptions;
  return {
      PresetRow(),
      StanceRow(),
      Decided(LearnedRow<SelfForceChoice>(
          "self_force", "/self_force", kSelfForceHelp, ParseSelfForce,
          [](const SelfForceChoice& choice, O* o, LearnedTerms* network) {
            o->self_force = choice.kind;
            network->shape = choice.network;
          },
          [](const FitOptions& o) { return SelfForceText(o.self_force, o.model.learned.get()); })),
      LearnedRow<RodShape>(
          "rod", "",
          "the rod's length: constant, or a state that LDP's learned law changes, ldp:128-128 "
          "(hidden sizes)",
          ParseRod, [](const RodShape& rod, O*, LearnedTerms* network) { network->rod = rod; },
          [](const FitOptions& o) { return RodName(Learned(o).rod); }),
      Decided(FieldRow<Posture>("posture", "/posture", &ModelOptions::posture,
                                "balance error measured from: upright or initial")),
      Decided(FieldRow<Directions>(
          "directions", "/directions", &ModelOptions::directions,
          "isotropic (people answer alike in all directions; fitted along each push), body (along "
          "what people face, sideways parameters free where forward ones are) or axes (those of "
          "the file; sideways parameters as the preset has them)")),
      Decided(FieldRow<GainScaling>(
          "gain_scaling", "/gain_scaling", &ModelOptions::gain_scaling,
          "gains of other bodies: none, mass, or body (mass and rod length)")),
      Decided(FieldRow<FrictionKind>("friction", "/friction", &ModelOptions::friction,
                                     AnyName<FrictionKind>().c_str())),
      Stored(FieldRow<PushUse>("push", "/push", &ModelOptions::push, "")),
      Decided(FieldRow<PushTail>("push_tail", "/push_tail", &ModelOptions::push_tail,
                                 "none or exponential")),
      FieldRowWith<Delay>(
          SetDelay, "delay", "/delay", &ModelOptions::delay,
          "reaction delay of active feedback: none, one (of all of it) or ankle_and_step (the "
          "feet's own); reaction_delay and the passive shares of stiffness and damping are then "
          "fitted"),
      FieldRowWith<BodyModel>(
          SetBody, "body", "/body", &ModelOptions::body,
          "where a body's mass is: ldp (nine tenths at the hip; of who stands, an average body's), "
          "anthropometric (by the recorded segments, de Leva 1996), or table (cart_share, "
          "com_height, gyration_radius and push_gain, of robots and rigs: fixed or fitted)"),
      Stored(FieldRow<CartDerivative>("cart_derivative", "/cart_derivative",
                                      &ModelOptions::cart_derivative, "")),
      Decided(LearnedRow<InteractionChoice>(
          "interaction", "/interaction",
          "interaction between people: none, or some of these, comma-separated: contact (smooth "
          "and mutual: spring,damping), ldp_published (LDP's equations 10 and 11 and its table of "
          "signs), network:4 (learned beside contact, by hidden sizes), ldp_network:512-512 "
          "(LDP's, learned of every neighbour in range)",
          ParseInteraction,
          [](const InteractionChoice& choice, O* o, LearnedTerms* network) {
            o->model.interaction = choice.terms;
            network->pair = choice.pair;
          },
          [](const FitOptions& o) { return InteractionText(o.model); })),
      Stored(FieldRow<ProcessNoise>("process_noise", "/process_noise", &ModelOptions::process_noise,
                                    "")),
      FieldRowWith<Likelihood>(
          SetLikelihood, "likelihood", "/likelihood", &O::likelihood,
          "what a fit maximizes: trajectory (whole rollouts), or, under process noise, transition "
          "(each measured state given the one before) or innovation (each measurement given all "
          "before it, with errors of measurement)"),
      FieldRow<DerivativesBy>(
          "derivatives", "", &O::derivatives,
          "of rollouts: auto (the quickest there are), or autodiff (of the model's own formulas)"),
      BoolRow("preset_priors", "", &O::preset_priors, "keep the preset's weak priors"),
  };
}

// Rows of the weights of recordings, priors and the demands on the person.

void SetLoss(FrameLoss loss, FitOptions* o) {
  if (loss != o->sigmas.loss) o->sigmas = loss == FrameLoss::kLdp ? kLdpSigmas : ResidualSigmas();
}

Row PoolByRow() {
  Row row = FieldRow<std::string>(
      "pool_by", "/pool_by", &FitOptions::pool_by,
      "what pooled parameters may differ by: subject, setting, condition or any other label of the "
      "manifest; a recording without the label takes its setting");
  row.apply = [](const std::string& given, FitOptions* o) -> MaybeError {
    if (given.empty()) return BadOption("pool_by", given, "must be subject or a label");
    o->pool_by = given;
    return std::nullopt;
  };
  return row;
}

constexpr char kEstimate[] = "estimate";

// A standard deviation, or estimate.
Row PoolingSigmaRow() {
  Row row;
  row.name = "pooling_sigma";
  row.json = "/pooling_sigma";
  row.write = [](const FitOptions& o) {
    return o.pooling_sigma ? Json(*o.pooling_sigma) : Json(kEstimate);
  };
  row.read = [](const Json& json, FitOptions* o) {
    o->pooling_sigma.reset();
    if (json != kEstimate) o->pooling_sigma = json.get<double>();
  };
  return Stored(row);
}

std::vector<Row> WeightRows() {
  using O = FitOptions;
  return {
      FieldRowWith<FrameLoss>(
          SetLoss, "loss", "/sigmas/loss", &ResidualSigmas::loss,
          "what is minimized: hip (positions of the hip, velocities, angles and rates, robust by "
          "frame), or ldp (LDP's Eq. 6: absolute errors of all states and velocities, but for the "
          "rate of phi, which is itself held small)"),
      Stored(NumberRow("sigma_hip", "/sigmas/hip_m", &ResidualSigmas::hip, kPositive, "")),
      Stored(NumberRow("sigma_velocity", "/sigmas/velocity_m_s", &ResidualSigmas::velocity,
                       kPositive, "")),
      Stored(NumberRow("sigma_angle", "/sigmas/angle_rad", &ResidualSigmas::angle, kPositive, "")),
      Stored(NumberRow("sigma_rate", "/sigmas/rate_rad_s", &ResidualSigmas::rate, kPositive, "")),
      RarelyChanged(NumberRow(
          "marker_noise", "/sigmas/marker_noise_m", &O::marker_noise, kPositive,
          "standard deviation of a marker's position, m: lower limit of estimated sigmas")),
      Stored(NumberRow("robust", "/sigmas/robust", &ResidualSigmas::robust, kNotNegative, "")),
      Stored(BoolRow("estimate_weights", "/estimate_weights", &O::estimate_weights, "")),
      Stored(NumberRow("effective_weight", "/effective_weight", &O::effective_weight,
                       {0.0, 1e6, false, "must be a number from 0 to 1e6"}, "")),
      Decided(
          NumberRow("settling_weight", "/settling_weight", &O::settling_weight, kNotNegative,
                    "weight of the settling constraint (pushed people must settle in the settling "
                    "simulations); 0: off")),
      Decided(PoolByRow()),
      PoolingSigmaRow(),
      NumberRow("network_prior", "/network_prior", &O::network_prior, kNotNegative,
                "standard deviation of the prior that ties a network's weights to zero; 0: none"),
  };
}

// Rows of the solver.

Row HorizonsRow() {
  Row row = FieldRow<std::vector<int>>("horizons", "/horizons", &FitOptions::horizons, "");
  row.violation = [](const FitOptions& o) {
    const bool sound = std::all_of(o.horizons.begin(), o.horizons.end(),
                                   [](int frames) { return frames == 0 || frames >= 2; });
    return sound ? "" : "must be numbers of frames of at least 2";
  };
  return Stored(row);
}

std::vector<Row> SolverRows() {
  using O = FitOptions;
  return {
      HorizonsRow(),
      FieldRow<uint64_t>("seed", "/seed", &O::seed, "seed of all random numbers",
                         "must be a whole number of at least 0"),
      CountRow("num_threads", "", &O::num_threads, "threads"),
      CountRow("max_iterations", "/max_iterations", &O::max_iterations, "iterations of each stage"),
      Stored(NumberRow("function_tolerance", "/function_tolerance", &O::function_tolerance,
                       kNotNegative, "")),
      Stored(NumberRow("gradient_tolerance", "/gradient_tolerance", &O::gradient_tolerance,
                       kNotNegative, "")),
      Stored(NumberRow("parameter_tolerance", "/parameter_tolerance", &O::parameter_tolerance,
                       kNotNegative, "")),
  };
}

// Edits of the table of parameters.

Row CovariateRow() {
  Row row = FieldRow<std::string>(
      "covariate", "/covariate", &FitOptions::covariates,
      "numbers of people that parameters follow, as in 'Kp_theta ~ age + height; Kd_theta ~ age': "
      "keys of the manifest's subjects, mass (kg) or rod (m)");
  row.apply = [](const std::string& text, FitOptions* o) -> MaybeError {
    const Result<std::vector<CovariatesOfParameter>> chosen = ParseCovariates(text);
    if (!chosen.ok()) return chosen.error();
    o->covariates = text;
    return std::nullopt;
  };
  return row;
}

Row EditRow(const char* name, std::string TableEdits::*list, const char* help) {
  return WordsRow(name, OptionStage::kTable, help, [list](const std::string& text, FitOptions* o) {
    TableEdits edits;
    edits.*list = text;
    return EditTable(edits, &o->table);
  });
}

std::vector<Row> TableRows() {
  return {
      AtTable(FieldRow<std::string>(
          "contrast", "/contrast", &FitOptions::contrast,
          "a label with two values (patients and controls, eyes open and closed, before and "
          "after), of a recording or of a person in the manifest's subjects: the difference of "
          "every free parameter between them is fitted")),
      AtTable(CovariateRow()),
      EditRow("free", &TableEdits::free, "parameters fitted: name or name=start, comma-separated"),
      EditRow("fix", &TableEdits::fix,
              "parameters held fixed: name or name=value, comma-separated"),
      EditRow("prior", &TableEdits::prior,
              "priors: name:mean:sigma in the parameter's unit, comma-separated"),
      Decided(WordsRow("pool", OptionStage::kModel,
                       "parameters that may differ by unit, comma-separated, or all, or none; "
                       "all,-mu: all but mu",
                       [](const std::string& text, FitOptions* o) -> MaybeError {
                         o->pool = text;
                         return std::nullopt;
                       })),
  };
}

}  // namespace

const std::vector<FitOptionRow>& AllOptionRows() {
  static const std::vector<FitOptionRow> rows = [] {
    std::vector<FitOptionRow> all;
    const auto add = [&all](const std::string& heading, const std::vector<FitOptionRow>& part) {
      for (const FitOptionRow& row : part) {
        all.push_back(row);
        if (row.heading.empty()) all.back().heading = heading;
      }
    };
    add("model", ModelRows());
    add("fit", WeightRows());
    add(kRarelyChanged, SolverRows());
    add("model", TableRows());
    return all;
  }();
  return rows;
}

const std::vector<FitOptionRow>& FitOptionRows() {
  static const std::vector<FitOptionRow> flags = [] {
    std::vector<FitOptionRow> rows;
    std::copy_if(AllOptionRows().begin(), AllOptionRows().end(), std::back_inserter(rows),
                 [](const Row& row) { return row.is_flag; });
    return rows;
  }();
  return flags;
}

const FitOptionRow* FindFitOption(const std::string& name) {
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

}  // namespace pushid
