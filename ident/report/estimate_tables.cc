#include "ident/report/estimate_tables.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/linear_loop.h"
#include "ident/problem/statistics.h"
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

// Speeds of a motion that has died out are shown as 0.
std::string MotionText(double value) {
  constexpr double kNothing = 1e-6;
  return Rounded(std::abs(value) < kNothing ? 0.0 : value, 2);
}

constexpr double kHolmLevel = 0.05;
constexpr double kLeastShown = 1e-4;

std::string ProbabilityText(double p) {
  return p < kLeastShown ? "<" + Rounded(kLeastShown) : Rounded(p, 2);
}

constexpr double kLargestEffect = 5.0;

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kAlike = 1e-6;  // relative

struct NamedLoop {
  std::string name;
  LoopNumbers numbers;
  bool seen = true;  // otherwise its stiffness is the prior's, and so is whether it is stable
};

// True where the recordings determine a gain.
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
      const bool held = gain.standard_error == 0.0;
      const bool known = IntervalText(gain.value, gain.lower95, gain.upper95) != kUndetermined;
      text += (text.empty() ? "" : ", ") + std::string(words.name) + " " +
              Rounded(words.inverse ? 1.0 / gain.value : gain.value, 2) + words.unit +
              (held    ? " (held)"
               : known ? ""
                       : " (undetermined)");
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

std::string BehaviourText(const FitResult& result) {
  const Behaviour& b = result.behaviour;
  return SettlingText(b, result.options.model) + NoFartherText(b) + FreeModeText(b);
}

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

TextTable ContrastTable(const Contrast& c) {
  TextTable table({"parameter", ">" + c.first, ">" + c.second, ">difference", "95 % interval",
                   "unit", ">effect, sd", ">p", ">Holm's p", "status"});
  for (const ContrastRow& row : c.rows) {
    // The spread between few people may come out near nothing, and an effect over it as anything.
    const double effect = row.effect.value_or(0.0);
    const std::string in_sd =
        !row.effect ? "-"
        : std::abs(effect) <= kLargestEffect
            ? Rounded(effect, 2)
            : (effect > 0.0 ? "above " : "below -") + Rounded(kLargestEffect, 2);
    table.Add({row.name, Rounded(row.first, 4), Rounded(row.second, 4), Rounded(row.difference, 3),
               IntervalText(row.difference, row.lower95, row.upper95), row.unit, in_sd,
               ProbabilityText(row.p), ProbabilityText(row.p_holm), NameOf(row.status)});
  }
  return table;
}

std::string ContrastText(const FitResult& result) {
  if (!result.contrast) return "";
  const Contrast& c = *result.contrast;
  const auto people = [](size_t number) { return CountText(number, "person", "people"); };
  std::string text = c.label + ": " + c.second + " less " + c.first + "; ";
  if (c.both.empty()) {
    text += people(c.only_first.size()) + " with " + c.first + ", " + people(c.only_second.size()) +
            " with " + c.second + ", nobody in both: not paired";
  } else {
    text += people(c.both.size()) + " in both (" + ListOfNames(c.both, kNamesInErrors) +
            "), compared with themselves";
    for (const auto& [names, value] :
         {std::pair(&c.only_first, &c.first), {&c.only_second, &c.second}}) {
      if (names->empty()) continue;
      text += "; only with " + *value + ": " + ListOfNames(*names, kNamesInErrors);
    }
  }
  std::vector<std::string> differ;
  size_t told = 0;
  bool apart = false;
  for (const ContrastRow& row : c.rows) {
    if (row.p_holm < kHolmLevel) differ.push_back(row.name);
    told += row.status != EstimateStatus::kUnidentifiable ? 1 : 0;
    apart = apart || row.effect.has_value();
  }
  text += "\nafter Holm's correction for " + CountText(told, "parameter") +
          (differ.empty() ? " no difference is distinguishable from 0"
                          : " these differ: " + Joined(differ)) +
          "\n";
  return text +
         (apart
              ? "judged by everybody's own fit; effects are in standard deviations between people\n"
              : "judged by the joint fit, by people as clusters\n");
}

TextTable LoopTable(const FitResult& result) {
  TextTable table({"loop", ">stiffness/(m g l)", ">damping ratio", ">oscillates at, Hz",
                   ">phase margin, deg", ">delay margin, s", "gains stable at, times"});
  const ModelOptions& options = result.options.model;
  if (options.stance == Stance::kSlide || IsOneMachine(options) ||
      !WithoutLinearLoop(options).empty()) {
    return table;
  }
  const Body person;  // 85 kg, 0.95 m
  const LoopNumbers along = LinearLoop(options, person, result.parameters, 0).Numbers();
  const LoopNumbers across = LinearLoop(options, person, result.parameters, 1).Numbers();
  std::vector<NamedLoop> loops = {{"forwards (theta)", along, Seen(result, kKpTheta)},
                                  {"sideways (phi)", across, Seen(result, kKpPhi)}};
  if (Alike(along, across)) loops = {{"both directions", along}};
  for (const NamedLoop& loop : loops) {
    const LoopNumbers& n = loop.numbers;
    const auto number = [](const std::optional<double>& value, int digits, double unit = 1.0) {
      return value ? Rounded(unit * *value, digits) : "-";
    };
    const auto if_stable = [&n](const std::string& text) { return n.stable ? text : "-"; };
    const std::string range = !n.gain_down && !n.gain_up
                                  ? "-"
                                  : (n.gain_down ? Rounded(*n.gain_down, 2) : "0") + " - " +
                                        (n.gain_up ? Rounded(*n.gain_up, 2) : "any");
    const char* const note = !loop.seen ? ": not seen" : n.stable ? "" : ": UNSTABLE";
    table.Add({loop.name + note, Rounded(n.stiffness_ratio, 3),
               if_stable(number(n.damping_ratio, 2)), if_stable(number(n.natural_hz, 2)),
               number(n.phase_margin, 3, kDegrees), number(n.delay_margin, 2), range});
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
