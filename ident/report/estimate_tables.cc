// ident: tables and sentences of the fitted numbers and their errors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/option_names.h"
#include "ident/parameters/presets.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/clusters.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

// What stands where errors about these people are told apart (uncertainty/covariance.h).
const std::vector<std::string> kTheseColumns = {"these people", "their 95 %"};

// Its errors hold what is taken as known as well (model_verdict.h).
constexpr char kTotalColumn[] = "total 95 %";

std::string TheirError(const std::optional<Interval>& these) {
  return !these ? "" : these->standard_error > 0.0 ? Rounded(these->standard_error, 3) : "-";
}

std::string TheirInterval(double value, const std::optional<Interval>& these) {
  if (!these) return "";
  return these->standard_error > 0.0 ? IntervalText(value, these->lower, these->upper) : "-";
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
  TextTable table({"parameter", "value", "std error", "95 % interval", kTotalColumn,
                   kTheseColumns[0], kTheseColumns[1], "unit", "status", "data/prior/settling, %",
                   "prior shift, std errors", "prior"},
                  {true, false, false, true, true, false, true, true, true, true, false, true});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed) {
      table.Add({e.name, Rounded(e.value, 4), "-", "-", "", "", "", e.unit, "fixed", "-", "-", ""});
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
    table.Add(
        {e.name, Rounded(e.value, 4), unknown ? "infinite" : error,
         unknown || no_error ? "-" : IntervalText(e.value, e.lower95, e.upper95),
         e.total && !no_shares ? IntervalText(e.value, e.total->lower95, e.total->upper95) : "",
         TheirError(e.these), TheirInterval(e.value, e.these), e.unit, NameOf(e.status),
         no_shares ? "-" : SharesText(e.shares), no_shares ? "-" : PullText(e), prior});
  }
  table.DropIfEmpty({kTotalColumn});
  table.DropIfEmpty(kTheseColumns);
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
  const bool told_apart = std::any_of(result.estimates.begin(), result.estimates.end(),
                                      [](const Estimate& e) { return e.these.has_value(); });
  return "errors and status are about people like these " + std::to_string(u.num_people) +
         ": people are the units" +
         (told_apart
              ? "; the columns of these people are about their mean: recordings are the units"
              : "") +
         "\n" +
         (u.num_people < kFewestPeople
              ? "fewer than " + std::to_string(kFewestPeople) +
                    " people: nothing is identified about people like them\n"
              : "");
}

namespace {

std::string Freedom(double least, double most) {
  const std::string from = Rounded(least, 2), to = Rounded(most, 2);
  return (from == to ? from : from + " to " + to) +
         (to == "1" ? " degree of freedom" : " degrees of freedom");
}

}  // namespace

std::string HowSure(const FitResult& result) {
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
  TextTable table({"derived", "value", "std error", "95 % interval", kTheseColumns[0],
                   kTheseColumns[1], "unit"},
                  {true, false, false, true, false, true, true});
  for (const Combination& c : result.derived) {
    const bool fixed = c.standard_error == 0.0;
    table.Add({c.name, Rounded(c.value, 4), fixed ? "-" : Rounded(c.standard_error, 3),
               fixed ? "-" : IntervalText(c.value, c.lower95, c.upper95), TheirError(c.these),
               TheirInterval(c.value, c.these), c.unit});
  }
  table.DropIfEmpty(kTheseColumns);
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
  const std::string quoted =
      "Gains are for a person of 85 kg with a rod of 0.95 m (gain scaling: " +
      NameOf(result.options.model.gain_scaling) + ").\n" + PerFrameText(result) + TiedText(result);
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

}  // namespace pushid
