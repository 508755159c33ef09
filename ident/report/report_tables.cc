// ident: tables and sentences of a result.
#include "ident/report/report_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/behaviour_text.h"
#include "ident/problem/pooling_spread.h"
#include "ident/report/value_text.h"
#include "models/self_terms.h"

namespace pushid {

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

std::string SharesText(const Shares& s) {
  const auto percent = [](double share) { return Rounded(std::round(100.0 * share), 3); };
  return percent(s.data) + "/" + percent(s.prior) + "/" + percent(s.settling);
}

std::string PullText(const Estimate& e) {
  if (e.standard_error <= 0.0) return "-";
  const double pull = (e.shares.prior_pull + e.shares.settling_pull) / e.standard_error;
  return (pull > 0.0 ? "+" : "") + Rounded(pull, 2);
}

TextTable EstimateTable(const FitResult& result) {
  TextTable table({"parameter", "value", "std error", "95 % interval", "unit", "status",
                   "data/prior/settling, %", "prior shift, std errors", "prior"},
                  {true, false, false, true, true, true, true, false, true});
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
    const std::string error = no_error ? "-" : Rounded(e.standard_error, 3);
    table.Add({e.name, Rounded(e.value, 4), unknown ? "infinite" : error,
               unknown || no_error ? "-" : IntervalText(e.value, e.lower95, e.upper95), e.unit,
               NameOf(e.status), no_shares ? "-" : SharesText(e.shares),
               no_shares ? "-" : PullText(e), prior});
  }
  return table;
}

std::string IdentifiedText(const FitResult& result) {
  int free = 0, identified = 0;
  std::string others;
  for (const EnumName<EstimateStatus>& status : Names(EstimateStatus())) {
    if (status.value == EstimateStatus::kFixed) continue;
    std::string names;
    for (const Estimate& e : result.estimates) {
      if (e.status != status.value) continue;
      ++free;
      names += (names.empty() ? "" : ", ") + e.name;
      identified += e.status == EstimateStatus::kIdentified;
    }
    if (status.value == EstimateStatus::kIdentified || names.empty()) continue;
    others += "; " + std::string(status.name) + ": " + names;
  }
  const std::string all = std::to_string(free);
  if (free > 0 && identified == free) {
    return free == 1 ? "The free parameter is identified by the data."
                     : "All " + all + " free parameters are identified by the data.";
  }
  return std::to_string(identified) + " of " + all + " free parameters " +
         (identified == 1 ? "is" : "are") + " identified" + others + ".";
}

std::string SharesNote() {
  return "Shares: fractions of a value's variance due to the data, its prior and the settling "
         "constraint. Prior shift: how far prior and constraint together move the value, in "
         "standard errors. Prior-held: the data account for less than half.";
}

std::string HowSure(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  if (!u.clustered)
    return "standard errors: naive (the scatter cannot be estimated from a single cluster)\n";
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    least = std::min(least, e.freedom);
    most = std::max(most, e.freedom);
  }
  const bool people = u.clustered_by == ClusterBy::kSubject;
  return "standard errors: clustered by " +
         std::string(people ? (u.two_way ? "person and by recording" : "person") : "recording") +
         " (" + std::to_string(u.num_clusters) + (people ? " people" : " recordings") +
         "; Student's t with " + Rounded(least, 2) + " to " + Rounded(most, 2) +
         " degrees of freedom)" +
         (u.too_few_clusters ? "; correlations are those of independent frames" : "") + "\n";
}

std::string FeetOfFit(const FitResult& result) {
  const Stance stance = result.options.model.stance;
  return result.feet ? FeetText(*result.feet, stance) : "stance " + NameOf(stance);
}

TextTable DerivedTable(const FitResult& result) {
  TextTable table({"derived", "value", "std error", "95 % interval", "unit"},
                  {true, false, false, true, true});
  for (const Combination& c : result.derived) {
    const bool fixed = c.standard_error == 0.0;
    table.Add({c.name, Rounded(c.value, 4), fixed ? "-" : Rounded(c.standard_error, 3),
               fixed ? "-" : IntervalText(c.value, c.lower95, c.upper95), c.unit});
  }
  return table;
}

std::string ConventionText(const FitResult& result) {
  const ParameterTable& specs = result.options.table;
  const std::string quoted =
      "Gains are for a person of 85 kg with a rod of 0.95 m (gain scaling: " +
      NameOf(result.options.model.gain_scaling) + ").\n";
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
  return SettlingText(b) + NoFartherText(b) + FreeModeText(b);
}

TextTable LinesTable(const FitResult& result) {
  TextTable table =
      TextTable::OfNumbers({"line pushed forwards, " + WaitText() + " later", "mean advance, m",
                            "advance of pushed person, m", "mean displacement, m"});
  const bool differ = SettingsDiffer(result.behaviour);
  for (const SettlingSimulation& d : result.behaviour.simulations) {
    if (d.people == 1) continue;
    table.Add({SettlingSimulationName(d, differ), Rounded(d.advance, 2),
               Rounded(d.pushed_advance, 2), Rounded(d.distance, 2)});
  }
  return table;
}

TextTable BehaviourTable(const FitResult& result) {
  TextTable table({"settling simulation", WaitText() + " after the push", "m/s", "rad from rest",
                   "mean advance, m", "advance of pushed person, m"},
                  {true, true, false, false, false, false});
  const bool differ = SettingsDiffer(result.behaviour);
  for (const SettlingSimulation& d : result.behaviour.simulations) {
    table.Add({SettlingSimulationName(d, differ),
               d.fell      ? kFellText
               : d.settled ? kSettledText
                           : "still moving",
               Rounded(d.speed, 2), Rounded(d.lean, 2), Rounded(d.advance, 2),
               Rounded(d.pushed_advance, 2)});
  }
  return table;
}

TextTable PooledTable(const FitResult& result) {
  const bool by_setting = !result.settings.empty();
  std::vector<std::string> header = {result.options.pool_by};
  std::vector<bool> left = {true};
  if (!by_setting) header.push_back("kg"), left.push_back(false);
  header.insert(header.end(), {"parameter", "value", "std error", "95 % interval", "unit"});
  left.insert(left.end(), {true, false, false, true, true});
  TextTable table(header, left);
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
      {"pooled", "shared", "std error", "unit", "spread between " + o.pool_by + "s (1 sigma)"},
      {true, false, false, true, true});
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

}  // namespace pushid
