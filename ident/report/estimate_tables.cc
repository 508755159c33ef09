#include "ident/report/estimate_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/linear_loop.h"
#include "ident/problem/statistics.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

constexpr char kUndetermined[] = "undetermined";
constexpr double kOpenFactor = 100.0;  // to either side
constexpr double kOpenSize = 1e6;      // of intervals that contain zero, in units of the value

// Words for a derived gain; rates are told as their time constant.
struct GainWords {
  const char *derived, *name, *unit;
  bool inverse;
};
constexpr GainWords kGainWords[] = {
    {"Kp_theta/(m g l)", "ankle stiffness",
     " times m g l (1 is just enough to hold a pendulum upright)", false},
    {"Kp_theta/(M g l)", "ankle stiffness",
     " times M g l (1.06 is just enough to hold a body upright)", false},
    {"Kp_phi/(M g l)", "to the side", " times M g l", false},
    {"Kd_theta/(M l^2)", "damping of the lean with a time constant of", " s", true},
    {"Kp_phi/(m g l)", "to the side", " times m g l", false},
    {"Kd_theta/(m l^2)", "damping of the lean with a time constant of", " s", true},
    {"c_x/M", "friction of the feet with a time constant of", " s", true},
};

std::string GainText(const GainWords& words, const Combination& gain) {
  const bool held = gain.standard_error == 0.0;
  const bool known = held || IntervalText(gain.value, gain.lower95, gain.upper95) != kUndetermined;
  const std::string value = Rounded(words.inverse ? 1.0 / gain.value : gain.value, 2);
  return words.name + std::string(" ") + value + words.unit +
         (held    ? " (held)"
          : known ? ""
                  : " (undetermined)");
}

// "97/3/0"
std::string SharesText(const Shares& s) {
  const auto percent = [](double share) { return Rounded(std::round(100.0 * share), 3); };
  return percent(s.data) + "/" + percent(s.prior) + "/" + percent(s.settling);
}

// The shift by priors and settling together, in standard errors of the value.
std::string PullText(const Estimate& e) {
  if (e.standard_error <= 0.0) return "-";
  const double pull = (e.shares.prior_pull + e.shares.settling_pull) / e.standard_error;
  return (pull > 0.0 ? "+" : "") + Rounded(pull, 2);
}

}  // namespace

double ShownEnd(double value, double end, double other_end) {
  const double open = end < value ? -INFINITY : INFINITY;
  if (!std::isfinite(end)) return end;
  const double factor = end / value;
  if (value * end <= 0.0 || value * other_end <= 0.0) {
    return std::abs(end) > kOpenSize * std::max(1.0, std::abs(value)) ? open : end;
  }
  if (factor > kOpenFactor) return open;
  const bool wide = std::abs(std::log(end / other_end)) > 2.0 * std::log(kOpenFactor);
  return wide && factor < 1.0 / kOpenFactor ? open : end;
}

std::string IntervalText(double value, double lower, double upper, int digits) {
  const double from = ShownEnd(value, lower, upper), to = ShownEnd(value, upper, lower);
  if (!std::isfinite(from) && !std::isfinite(to)) return kUndetermined;
  const auto side = [digits](double end) {
    return std::isfinite(end) ? Rounded(end, digits) : std::string("open");
  };
  return "[" + side(from) + ", " + side(to) + "]";
}

std::string GainsText(const FitResult& result) {
  std::string text;
  for (const GainWords& words : kGainWords) {
    for (const Combination& gain : result.derived) {
      if (gain.name != words.derived || !(gain.value > 0.0)) continue;
      text += (text.empty() ? "" : ", ") + GainText(words, gain);
    }
  }
  return text.empty() ? "" : Capitalized(text) + ".";
}

std::string BalanceText(const FitResult& result) {
  const Verdict verdict = VerdictOf(result.behaviour);
  if (verdict == Verdict::kSettles) return "";
  return Capitalized(VerdictSentence(verdict, result.behaviour, result.options.model)) +
         (result.behaviour.self_propelling ? ": do not use the gains." : ".");
}

TextTable ShortTable(const FitResult& result) {
  constexpr size_t kMost = 10;  // in the model's order
  std::vector<const Estimate*> free;
  for (const Estimate& e : result.estimates) {
    if (e.status != EstimateStatus::kFixed) free.push_back(&e);
  }
  if (free.size() > kMost) {
    std::stable_partition(free.begin(), free.end(), [](const Estimate* e) {
      return e->status != EstimateStatus::kPriorHeld;
    });
    std::stable_partition(free.begin(), free.end(), [](const Estimate* e) {
      return e->status == EstimateStatus::kIdentified;
    });
  }
  TextTable table({"parameter", ">value", "95 % interval", "unit", "status"});
  for (const Estimate* e : free) {
    const Interval shown = e->interval();
    const bool known = e->status != EstimateStatus::kUnidentifiable && shown.standard_error > 0.0;
    table.Add({e->name, Rounded(e->value, 3),
               known ? IntervalText(e->value, shown.lower, shown.upper, 3) : "-", e->unit,
               NameOf(e->status)});
  }
  return table;
}

TextTable EstimateTable(const FitResult& result) {
  TextTable table({"parameter", ">value", ">std error", "95 % interval", "unit", "status",
                   "data/prior/settling, %", ">prior shift, std errors", "prior"});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed) {
      table.Add({e.name, Rounded(e.value, 4), "-", "-", e.unit, "fixed", "-", "-", ""});
      continue;
    }
    const std::string prior =
        spec != nullptr && spec->prior
            ? Rounded(spec->prior->mean, 3) + " +- " + Rounded(spec->prior->sigma, 3)
            : "";
    const bool unknown = e.status == EstimateStatus::kUnidentifiable;
    const bool no_shares = unknown || e.status == EstimateStatus::kAtBound;
    const bool no_error = no_shares && e.standard_error <= 0.0;
    const Interval shown = e.interval();
    table.Add({e.name, Rounded(e.value, 4),
               unknown    ? "infinite"
               : no_error ? "-"
                          : Rounded(shown.standard_error, 3),
               unknown || no_error ? "-" : IntervalText(e.value, shown.lower, shown.upper), e.unit,
               NameOf(e.status), no_shares ? "-" : SharesText(e.shares),
               no_shares ? "-" : PullText(e), prior});
  }
  return table;
}

namespace {

size_t ColumnOf(const FitResult& result, const std::string& name) {
  const std::vector<Estimate>& fitted = result.uncertainty.estimates;
  const auto at = std::find_if(fitted.begin(), fitted.end(),
                               [&name](const Estimate& e) { return e.name == name; });
  return static_cast<size_t>(at - fitted.begin());
}

// The assumption that makes up most of a squared total error; null: none does.
const AssumptionTest* WidensMost(const ModelVerdict& verdict, size_t column, bool measured) {
  const AssumptionTest* most = nullptr;
  double widest = 0.0;
  for (const AssumptionTest& test : verdict.assumptions) {
    if (measured && StatedErrorKey(test).empty()) continue;
    const double widens = test.Widens(column, test.stated);
    if (widens > widest) most = &test, widest = widens;
  }
  return most;
}

// "height of the pushes (63 %)"
std::string WidenedBy(const FitResult& result, const std::string& name, double error) {
  const size_t column = ColumnOf(result, name);
  const AssumptionTest* const most = WidensMost(result.verdict, column, false);
  if (most == nullptr) return "-";
  const double share = std::min(1.0, most->Widens(column, most->stated) / (error * error));
  return most->name + " (" + Rounded(100.0 * share, 2) + " %)";
}

// The largest of a half, a fifth and a tenth of what is stated by which a weak estimate would be
// identified; 0: none.
double SharpEnough(const ParameterSpec& spec, const Estimate& e, const AssumptionTest& test,
                   size_t column) {
  const Interval total = e.interval();
  const double variance = total.standard_error * total.standard_error;
  const double fitted = ToFitted(spec.transform, e.value);
  const double width = spec.prior ? spec.prior->sigma : spec.scale;
  for (double share : {0.5, 0.2, 0.1}) {
    const double stated = share * test.stated;
    const double left = variance - test.Widens(column, test.stated) + test.Widens(column, stated);
    const auto end = [&](double natural) {
      const double half = ToFitted(spec.transform, natural) - fitted;
      return ToNatural(spec.transform, fitted + std::sqrt(std::max(0.0, left / variance)) * half);
    };
    if (IsNarrow(spec.transform, width, end(total.lower), end(total.upper))) return stated;
  }
  return 0.0;
}

// Whether an estimate is weak only because of what is taken as known: by the data alone it would
// be identified.
bool WeakInTotal(const FitResult& result, const Estimate& e, const ParameterSpec& spec) {
  const Uncertainty& u = result.uncertainty;
  const bool few = u.about_people_like_them && u.num_people < kFewestPeople;
  const double width = spec.prior ? spec.prior->sigma : spec.scale;
  return e.status == EstimateStatus::kWeak && !few && Leads(e) &&
         IsNarrow(spec.transform, width, e.lower95, e.upper95);
}

}  // namespace

std::string SharperText(const FitResult& result) {
  const ModelVerdict& verdict = result.verdict;
  if (verdict.fails() || !verdict.none_identified.empty()) return "";
  std::string text;
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* const spec = result.options.table.Find(e.name);
    const size_t column = ColumnOf(result, e.name);
    const AssumptionTest* const most = WidensMost(verdict, column, true);
    if (spec == nullptr || most == nullptr || !WeakInTotal(result, e, *spec)) continue;
    const double stated = SharpEnough(*spec, e, *most, column);
    if (stated <= 0.0) continue;
    text += (text.empty() ? "" : "; ") + e.name + " becomes identified where the " + most->name +
            " is known to " + Rounded(stated, 2) + (most->unit.empty() ? "" : " " + most->unit) +
            " (stated_errors: " + StatedErrorKey(*most) + ")";
  }
  return text.empty() ? "" : "Measure better and state it in the manifest: " + text + ".";
}

TextTable PartsTable(const FitResult& result) {
  TextTable table({"parameter", ">by the data alone", "95 %", ">of these people alone", "95 %",
                   "unit", "widened most by"});
  const auto add = [&](const auto& row) {
    if (!row.total && !row.these) return;
    const auto cells =
        [&row](const std::optional<Interval>& i) -> std::pair<std::string, std::string> {
      if (!i || !(i->standard_error > 0.0)) return {"-", "-"};
      return {Rounded(i->standard_error, 3), IntervalText(row.value, i->lower, i->upper)};
    };
    const auto own = cells(Interval{row.standard_error, row.lower95, row.upper95});
    const auto these = cells(row.these);
    table.Add({row.name, own.first, own.second, these.first, these.second, row.unit,
               WidenedBy(result, row.name, row.interval().standard_error)});
  };
  for (const Estimate& e : result.estimates) {
    if (e.status != EstimateStatus::kFixed) add(e);
  }
  for (const Combination& c : result.derived) add(c);
  return table;
}

std::string SharesNote() {
  return "Shares: fractions of a value's variance due to the data, its prior and the settling "
         "constraint. Prior shift: how far prior and constraint together move the value, in "
         "standard errors of the data alone. Prior-held: the data account for less than half.";
}

namespace {

// Says whether errors and status are about these people, or about people like them.
std::string TargetText(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  if (u.num_people == 0) return "";  // a model of an older version
  if (!u.about_people_like_them) {
    return u.num_people == 1
               ? "errors and status are about this person: of other people one person says "
                 "nothing\n"
               : "errors and status are about these " + std::to_string(u.num_people) +
                     " people, not about people like them: recordings are the units\n";
  }
  return "errors and status are about people like these " + std::to_string(u.num_people) +
         ": people are the units\n";
}

std::string Freedom(double least, double most) {
  const std::string from = Rounded(least, 2), to = Rounded(most, 2);
  return (from == to ? from : from + " to " + to) +
         (to == "1" ? " degree of freedom" : " degrees of freedom");
}

}  // namespace

std::string ErrorsText(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  if (!u.clustered) {
    return "standard errors: of the posterior, priors included; a single recording says nothing of "
           "errors between people\n";
  }
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    if (!std::isfinite(e.freedom)) continue;
    least = std::min(least, e.freedom);
    most = std::max(most, e.freedom);
  }
  const bool people = u.clustered_by == ClusterBy::kSubject;
  return "standard errors: clustered by " +
         std::string(people ? (u.two_way ? "person and by who stood together" : "person")
                            : "recording") +
         " (" + std::to_string(u.num_clusters) + (people ? " people" : " recordings") +
         "; Student's t with " + Freedom(least, most) + ")" +
         (u.too_few_clusters ? "; correlations are those of independent frames" : "") + "\n" +
         TargetText(result);
}

std::string FeetOfFit(const FitResult& result) {
  const Stance stance = result.options.model.stance;
  return result.feet ? FeetText(*result.feet, stance) : "stance " + NameOf(stance);
}

TextTable DerivedTable(const FitResult& result) {
  TextTable table({"derived", ">value", ">std error", "95 % interval", "unit"});
  for (const Combination& c : result.derived) {
    const Interval shown = c.interval();
    const bool fixed = c.standard_error == 0.0;
    table.Add({c.name, Rounded(c.value, 4), fixed ? "-" : Rounded(shown.standard_error, 3),
               fixed ? "-" : IntervalText(c.value, shown.lower, shown.upper), c.unit});
  }
  return table;
}

namespace {

// "Sideways as forwards: Kp_phi = Kp_theta, a_y = a_x (--directions=isotropic).\n"
std::string TiedText(const FitResult& result) {
  const ParameterTable& specs = result.options.table;
  std::string tied, passive;
  for (const ParameterSpec& spec : specs.specs) {
    if (!spec.tied_to || !Acts(spec.id, result.options.model)) continue;
    if (result.parameters[spec.id] == 0.0) continue;
    if (spec.id == kPassiveDamping) {
      passive =
          "One passive share: passive_damping = passive_stiffness (--free=passive_damping: its "
          "own).\n";
      continue;
    }
    tied += (tied.empty() ? "" : ", ") + spec.name + " = " + specs[*spec.tied_to].name;
  }
  return (tied.empty() ? "" : "Sideways as forwards: " + tied + " (--directions=isotropic).\n") +
         passive;
}

// LDP's Kd multiply differences from frame to frame; empty for models that are not LDP's.
std::string PerFrameText(const FitResult& result) {
  if (result.options.preset.rfind("ldp", 0) != 0) return "";
  std::string text;
  for (Parameter id : {kKdX, kKdY, kKdTheta, kKdPhi}) {
    if (!Acts(id, result.options.model)) continue;
    text += (text.empty() ? "" : ", ") + result.options.table[id].name + " " +
            Rounded(kLdpRate * result.parameters[id], 4);
  }
  if (text.empty()) return "";
  return "In LDP's units, per frame of 1/60 s: " + text + ".\n";
}

}  // namespace

std::string ConventionText(const FitResult& result) {
  const ParameterTable& specs = result.options.table;
  const std::string whose = IsOneMachine(result.options.model)
                                ? "Gains are those of the recorded body"
                                : "Gains are for a person of 85 kg with a rod of 0.95 m";
  const std::string quoted = whose +
                             " (gain scaling: " + NameOf(result.options.model.gain_scaling) +
                             ").\n" + PerFrameText(result) + TiedText(result);
  if (!Acts(kMu, result.options.model)) return quoted;
  bool fitted = false;
  std::string held;
  for (const CartDamping& c : CartDampings(result.options.model.friction)) {
    fitted = fitted || specs[c.gain].free;
    held += (held.empty() ? "" : ", ") + specs[c.gain].name + " = " +
            Rounded(result.parameters[c.gain], 4);
  }
  return "mu and Kp act on the same velocity: only c = mu + Kp is identifiable. " +
         (fitted ? std::string("Here Kp is fitted too.")
                 : "Convention: " + held + " N s/m held, mu = c - Kp.") +
         "\n" + quoted;
}

namespace {

// Settings in which a harder push does not move the line on farther.
std::string NoFartherText(const Behaviour& b) {
  if (b.harder_moves_farther) return "";
  std::string where;
  const SettlingSimulation* before = nullptr;
  for (const SettlingSimulation& d : b.simulations) {
    if (d.people == 1) continue;
    const std::string name = d.setting.empty() ? "shared values" : d.setting;
    const bool harder = before != nullptr && before->setting == d.setting;
    if (harder && d.advance <= before->advance && where.find(name) == std::string::npos) {
      where += (where.empty() ? ": " : ", ") + name;
    }
    before = &d;
  }
  return "a harder push does NOT move the line farther" + (SettingsDiffer(b) ? where : "") + "\n";
}

}  // namespace

std::string CorrelationText(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  std::string text;
  for (int i = 0; i < u.correlation.rows(); ++i) {
    for (int j = i + 1; j < u.correlation.cols(); ++j) {
      if (std::abs(u.correlation(i, j)) < 0.9) continue;
      if (u.estimates[j].name.find('[') != std::string::npos) continue;  // a unit's deviation
      text += "  " + u.estimates[i].name + " and " + u.estimates[j].name + ": " +
              Rounded(u.correlation(i, j), 2) + "\n";
    }
  }
  return text.empty() ? "" : "correlations beyond 0.9 (the data separate these poorly):\n" + text;
}

std::string BehaviourText(const FitResult& result) {
  const Behaviour& b = result.behaviour;
  return SettlingText(b, result.options.model) + NoFartherText(b) + FreeModeText(b);
}

namespace {

// Speeds of a motion that has died out are shown as 0.
std::string MotionText(double value) {
  constexpr double kNothing = 1e-6;
  return Rounded(std::abs(value) < kNothing ? 0.0 : value, 2);
}

}  // namespace

TextTable BehaviourTable(const FitResult& result) {
  TextTable table({"settling simulation", WaitText(result.options.model) + " after the push",
                   ">m/s", ">rad from rest", ">mean advance, m", ">advance of pushed person, m"});
  const bool differ = SettingsDiffer(result.behaviour);
  for (const SettlingSimulation& d : result.behaviour.simulations) {
    table.Add({SettlingSimulationName(d, differ),
               d.fell      ? kFellText
               : d.settled ? kSettledText
                           : "still moving",
               MotionText(d.speed), MotionText(d.lean), MotionText(d.advance),
               MotionText(d.pushed_advance)});
  }
  return table;
}

TextTable PooledTable(const FitResult& result) {
  const bool by_setting = !result.settings.empty();
  std::vector<std::string> header = {result.options.pool_by};
  if (!by_setting) header.push_back(">kg");
  header.insert(header.end(), {"parameter", ">value", ">std error", "95 % interval", "unit"});
  TextTable table(header);
  const auto add = [&table](const std::vector<std::string>& unit,
                            const std::map<std::string, Estimate>& pooled) {
    for (const auto& [name, e] : pooled) {
      std::vector<std::string> row = unit;
      row.insert(row.end(), {name, Rounded(e.value, 4), Rounded(e.standard_error, 3),
                             IntervalText(e.value, e.lower95, e.upper95), e.unit});
      table.Add(row);
    }
  };
  if (!by_setting) {
    for (const auto& [id, subject] : result.subjects) {
      add({id, Rounded(subject.mass_kg, 4)}, subject.pooled);
    }
  }
  for (const auto& [setting, pooled] : result.settings) add({setting}, pooled);
  return table;
}

TextTable SpreadTable(const FitResult& result) {
  const FitOptions& o = result.options;
  TextTable table(
      {"pooled", ">shared", ">std error", "unit", "spread between " + o.pool_by + "s (1 sigma)"});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = o.table.Find(e.name);
    if (spec == nullptr || !spec->free || !spec->pooled) continue;
    const double sigma = PoolingSigma(*spec);
    const std::string spread = spec->transform == Transform::kLog
                                   ? "a factor of " + Rounded(std::exp(sigma), 3)
                               : spec->transform == Transform::kLogit
                                   ? Rounded(sigma * TransformSlope(spec->transform, e.value), 3)
                                   : Rounded(sigma, 3);
    const char* source = o.pooling_sigma                             ? ", given"
                         : spec->pooling_sigma <= kLeastPoolingSigma ? ", estimated: none found"
                                                                     : ", estimated";
    table.Add({e.name, Rounded(e.value, 4), Rounded(e.standard_error, 3), e.unit, spread + source});
  }
  return table;
}

namespace {

constexpr double kHolmLevel = 0.05;
constexpr double kLeastShown = 1e-4;

std::string ProbabilityText(double p) {
  return p < kLeastShown ? "<" + Rounded(kLeastShown) : Rounded(p, 2);
}

std::string NumberOfPeople(size_t number) { return CountText(number, "person", "people"); }

std::string ComparedText(const Contrast& c) {
  std::string text = c.label + ": " + c.second + " less " + c.first + "; ";
  if (c.both.empty()) {
    return text + NumberOfPeople(c.only_first.size()) + " with " + c.first + ", " +
           NumberOfPeople(c.only_second.size()) + " with " + c.second +
           ", nobody in both: not paired";
  }
  text += NumberOfPeople(c.both.size()) + " in both (" + ListOfNames(c.both, kNamesInErrors) +
          "), compared with themselves";
  if (!c.only_first.empty()) {
    text += "; only with " + c.first + ": " + ListOfNames(c.only_first, kNamesInErrors);
  }
  if (!c.only_second.empty()) {
    text += "; only with " + c.second + ": " + ListOfNames(c.only_second, kNamesInErrors);
  }
  return text;
}

std::string DifferText(const Contrast& c) {
  std::string found;
  for (const ContrastRow& row : c.rows) {
    if (row.p_holm < kHolmLevel) found += (found.empty() ? "" : ", ") + row.name;
  }
  const auto told = std::count_if(c.rows.begin(), c.rows.end(), [](const ContrastRow& row) {
    return row.status != EstimateStatus::kUnidentifiable;
  });
  const std::string of = CountText(static_cast<size_t>(told), "parameter");
  return found.empty()
             ? "after Holm's correction for " + of + " no difference is distinguishable from 0"
             : "after Holm's correction for " + of + " these differ: " + found;
}

std::string JudgedText(const Contrast& c) {
  const bool apart = std::any_of(c.rows.begin(), c.rows.end(),
                                 [](const ContrastRow& row) { return row.effect.has_value(); });
  return apart
             ? "judged by everybody's own fit; effects are in standard deviations between people\n"
             : "judged by the joint fit, by people as clusters\n";
}

// The spread between few people may come out near nothing, and an effect over it as anything.
constexpr double kLargestEffect = 5.0;

std::string EffectText(const ContrastRow& row) {
  if (!row.effect) return "-";
  if (std::abs(*row.effect) <= kLargestEffect) return Rounded(*row.effect, 2);
  return (*row.effect > 0.0 ? "above " : "below -") + Rounded(kLargestEffect, 2);
}

}  // namespace

TextTable ContrastTable(const Contrast& c) {
  TextTable table({"parameter", ">" + c.first, ">" + c.second, ">difference", "95 % interval",
                   "unit", ">effect, sd", ">p", ">Holm's p", "status"});
  for (const ContrastRow& row : c.rows) {
    table.Add({row.name, Rounded(row.first, 4), Rounded(row.second, 4), Rounded(row.difference, 3),
               IntervalText(row.difference, row.lower95, row.upper95), row.unit, EffectText(row),
               ProbabilityText(row.p), ProbabilityText(row.p_holm), NameOf(row.status)});
  }
  return table;
}

std::string ContrastText(const FitResult& result) {
  if (!result.contrast) return "";
  return ComparedText(*result.contrast) + "\n" + DifferText(*result.contrast) + "\n" +
         JudgedText(*result.contrast);
}

namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kAlike = 1e-6;  // relative

struct NamedLoop {
  std::string name;
  LoopNumbers numbers;
  bool seen = true;  // otherwise its stiffness is the prior's, and so is whether it is stable
};

// Whether the recordings tell a gain.
bool Seen(const FitResult& result, Parameter id) {
  const std::string& name = result.options.table[id].name;
  const auto row = std::find_if(result.estimates.begin(), result.estimates.end(),
                                [&name](const Estimate& e) { return e.name == name; });
  return row == result.estimates.end() ||
         (row->status != EstimateStatus::kPriorHeld && row->status != EstimateStatus::kFixed &&
          row->status != EstimateStatus::kUnidentifiable);
}

bool Alike(const LoopNumbers& a, const LoopNumbers& b) {
  const auto same = [](double x, double y) {
    return std::abs(x - y) <= kAlike * (std::abs(x) + std::abs(y));
  };
  return same(a.stiffness_ratio, b.stiffness_ratio) &&
         same(a.damping_ratio.value_or(0.0), b.damping_ratio.value_or(0.0)) &&
         same(a.natural_hz.value_or(0.0), b.natural_hz.value_or(0.0)) &&
         same(a.delay_margin.value_or(0.0), b.delay_margin.value_or(0.0));
}

std::vector<NamedLoop> LoopsOf(const FitResult& result) {
  const ModelOptions& options = result.options.model;
  if (options.stance == Stance::kSlide || IsOneMachine(options) ||
      !WithoutLinearLoop(options).empty()) {
    return {};
  }
  const Body person;  // 85 kg, 0.95 m
  const LoopNumbers along = LinearLoop(options, person, result.parameters, 0).Numbers();
  const LoopNumbers across = LinearLoop(options, person, result.parameters, 1).Numbers();
  if (Alike(along, across)) return {{"both directions", along}};
  return {{"forwards (theta)", along, Seen(result, kKpTheta)},
          {"sideways (phi)", across, Seen(result, kKpPhi)}};
}

std::string OrDash(const std::optional<double>& value, int digits, double unit = 1.0) {
  return value ? Rounded(unit * *value, digits) : "-";
}

std::string GainRange(const LoopNumbers& numbers) {
  if (!numbers.gain_down && !numbers.gain_up) return "-";
  return (numbers.gain_down ? Rounded(*numbers.gain_down, 2) : "0") + " - " +
         (numbers.gain_up ? Rounded(*numbers.gain_up, 2) : "any");
}

}  // namespace

TextTable LoopTable(const FitResult& result) {
  TextTable table({"loop", ">stiffness/(m g l)", ">damping ratio", ">oscillates at, Hz",
                   ">phase margin, deg", ">delay margin, s", "gains stable at, times"});
  for (const NamedLoop& loop : LoopsOf(result)) {
    const LoopNumbers& n = loop.numbers;
    const auto if_stable = [&n](const std::string& text) { return n.stable ? text : "-"; };
    const char* const note = !loop.seen ? ": not seen" : n.stable ? "" : ": UNSTABLE";
    table.Add({loop.name + note, Rounded(n.stiffness_ratio, 3),
               if_stable(OrDash(n.damping_ratio, 2)), if_stable(OrDash(n.natural_hz, 2)),
               OrDash(n.phase_margin, 3, kDegrees), OrDash(n.delay_margin, 2), GainRange(n)});
  }
  return table;
}

std::string LagText(const FitResult& result) {
  constexpr double kLeastDelay = 0.01, kLevel = 0.05;  // s; of a one-sided test
  for (const AssumptionTest& test : result.verdict.assumptions) {
    if (test.name != kReactionDelayName || test.error <= 0.0) continue;
    // One-sided: nobody reacts before they are pushed.
    const double p = 0.5 * StudentTail(test.wanted / test.error, result.verdict.freedom);
    if (test.wanted < kLeastDelay || p > kLevel) continue;
    return "The response lags (the residuals ask for a reaction delay of " +
           Rounded(test.wanted, 2) + " +- " + Rounded(test.error, 1) +
           " s), and damping comes out too low without it; try --delay=one.";
  }
  return "";
}

}  // namespace pushid
