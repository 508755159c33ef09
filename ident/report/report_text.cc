#include "ident/report/report_text.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/linear_loop.h"
#include "ident/problem/statistics.h"
#include "ident/report/advice.h"
#include "ident/report/fit_sections.h"
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

// The settings in which a harder push does not move the line farther.
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

constexpr int kFewUnits = 5;  // of fewer a bootstrap has too few distinct resamples

constexpr double kFar = 0.5;  // shares beyond it are no more than a direction: tests are linear
constexpr double kLargestFactor = 10.0;
constexpr size_t kNamedSuspects = 3;

struct Remedy {
  const char *name, *text;  // of an assumption
};
constexpr Remedy kRemedies[] = {
    {"scale of the pushes", "check the unit and the calibration of the force, and the masses"},
    {"lag of the pushes", "check the clocks of forces and cameras"},
    {"height of the pushes", "check at which height the pushes act"},
    {"zero of the pushes", "check what the sensor reads before the push"},
    {"masses", "check the masses, and the unit of the force"},
    {"frame rate", "check the frame rate"},
    {"drift of the cameras", "check whether positions drift, or people walk before the push"},
    {"second pushes", "check whether people were pushed again after what was recorded"},
    {"share of the masses in the carts", "try --body=anthropometric"},
    {kStepName, "resample the motion (--resample_fps=240)"},
    {kReactionDelayName, "try --delay=one"}};

// The remedy for a quantity of the laboratory; null where the model has it as a parameter.
const Remedy* FindRemedy(const AssumptionTest& test) {
  const auto found = std::find_if(std::begin(kRemedies), std::end(kRemedies),
                                  [&test](const Remedy& r) { return r.name == test.name; });
  return found == std::end(kRemedies) ? nullptr : found;
}

// A value without a unit is a share, or for a held gain the logarithm of a factor.
bool IsLogarithm(const AssumptionTest& test) {
  return test.unit.empty() && FindRemedy(test) == nullptr;
}

// "0.6 +- 0.2 frames", "-3 +- 1 %", "factor 0.74 (0.6 to 0.91)". One Newton step is linear, so a
// factor beyond kLargestFactor is no more than a direction.
std::string ValueText(const AssumptionTest& test) {
  if (IsLogarithm(test)) {
    if (std::abs(test.wanted) > std::log(kLargestFactor)) {
      return test.wanted > 0.0 ? "much larger" : "much smaller";
    }
    return "factor " + Rounded(std::exp(test.wanted), 2) + " (" +
           Rounded(std::exp(test.wanted - test.error), 2) + " to " +
           Rounded(std::exp(test.wanted + test.error), 2) + ")";
  }
  const double factor = test.unit.empty() ? 100.0 : 1.0;
  return Rounded(factor * test.wanted, 2) + " +- " + Rounded(factor * test.error, 2) + " " +
         (test.unit.empty() ? "%" : test.unit);
}

// "+- 3 %", "factor 2".
std::string StatedText(const AssumptionTest& test) {
  if (!(test.stated > 0.0)) return "-";
  if (IsLogarithm(test) && test.stated > std::log(kLargestFactor)) return "any factor";
  if (IsLogarithm(test)) return "factor " + Rounded(std::exp(test.stated), 2);
  return "+- " + (test.unit.empty() ? Rounded(100.0 * test.stated, 2) + " %"
                                    : Rounded(test.stated, 2) + " " + test.unit);
}

template <typename Test>
const Test* Surest(const std::vector<Test>& tests) {
  const auto least = std::min_element(tests.begin(), tests.end(),
                                      [](const Test& a, const Test& b) { return a.p < b.p; });
  return least == tests.end() ? nullptr : &*least;
}

// Assumptions that the recordings contradict, the surest first: measured ones; without any, held
// gains; without any, terms that are left out, which can imitate all others.
std::vector<const AssumptionTest*> Suspects(const ModelVerdict& v) {
  if (v.p_assumptions >= kVerdictLevel) return {};
  const double tests = static_cast<double>(v.NumTested());
  std::vector<const AssumptionTest*> kinds[3];
  for (const AssumptionTest& test : v.assumptions) {
    if (test.p * tests >= kVerdictLevel) continue;
    kinds[FindRemedy(test) != nullptr ? 0 : test.stated > 0.0 ? 1 : 2].push_back(&test);
  }
  for (auto& kind : kinds) {
    if (kind.empty()) continue;
    std::sort(kind.begin(), kind.end(),
              [](const AssumptionTest* a, const AssumptionTest* b) { return a->p < b->p; });
    kind.resize(std::min(kind.size(), kNamedSuspects));
    return kind;
  }
  return {};
}

// The body that gains are quoted for, as the end of a title.
std::string GainsAreFor(GainScaling scaling) {
  if (scaling == GainScaling::kNone) return "";
  return std::string("; gains for 85 kg") +
         (scaling == GainScaling::kBody ? " and a rod of 0.95 m" : "");
}

// The true step lies between none and the one that was taken, so that no integrator explains
// a larger one: it imitates people who react late.
std::string RemedyText(const ModelVerdict& v, const AssumptionTest& test) {
  if (test.name == kStepName && test.wanted > 0.0) {
    for (const AssumptionTest& other : v.assumptions) {
      if (other.name == kReactionDelayName) return "people who react late look so: try --delay=one";
    }
  }
  const Remedy* const remedy = FindRemedy(test);
  return remedy != nullptr ? remedy->text : "try --free=" + test.name;
}

// Findings that contradict the model.
std::vector<std::string> Contradictions(const ModelVerdict& v) {
  std::vector<std::string> found = v.of_pushes;
  const auto add = [&found](const std::string& what) { found.push_back(what); };
  const std::vector<const AssumptionTest*> wanted = Suspects(v);
  if (!wanted.empty()) {
    // "the lag of the pushes 0.6 +- 0.2 frames larger", "Kd_theta 40 % smaller".
    std::vector<std::string> all;
    for (const AssumptionTest* test : wanted) {
      const bool share = test->unit.empty();
      const double size = std::abs(IsLogarithm(*test) ? std::expm1(test->wanted) : test->wanted);
      const double factor = share ? 100.0 : 1.0;
      const std::string unit = share ? " %" : test->unit == "1" ? "" : " " + test->unit;
      const std::string how_much =
          share && size > kFar
              ? "more than a half"
              : Rounded(factor * size, 2) + " +- " + Rounded(factor * test->error, 2) + unit;
      all.push_back(test->name + " " + how_much + (test->wanted > 0.0 ? " larger" : " smaller"));
    }
    add("of what is taken as known, the recordings want " + Joined(all, ", or ") +
        " (p = " + Rounded(v.p_assumptions, 2) + " after " + std::to_string(v.NumTested()) +
        " tests); " + RemedyText(v, *wanted.front()));
  }
  const PartTest* part = Surest(v.parts);
  if (part != nullptr && v.p_parts < kVerdictLevel) {
    add(part->part + " ask for another " + part->parameter + " than all of them (p = " +
        Rounded(v.p_parts, 2) + " after " + std::to_string(v.parts.size()) + " tests)");
    if (part->part == kFromTheSide) found.back() += "; try --directions=body";
  }
  const MotionTest* motion = Surest(v.motion.tests);
  if (motion != nullptr && v.p_motion < kVerdictLevel) {
    const std::string unit = motion->unit.empty() ? "" : " " + motion->unit;
    add(std::string("the recorded ") + motion->quantity + " differs from the predicted one by " +
        Rounded(motion->difference, 2) + " +- " + Rounded(motion->error, 2) + unit + " (p = " +
        Rounded(v.p_motion, 2) + " after " + std::to_string(v.motion.tests.size()) + " tests)");
  }
  if (v.motion.explained < kLeastExplained) {
    add("it explains " + Rounded(100.0 * v.motion.explained, 2) +
        " % of the hip's squared displacement in the median recording");
  }
  return found;
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
  // Slopes of a contrast are those of the joint fit; DifferencesText tells what people's own fits
  // know better.
  const auto contrasted = [&result](const std::string& name) {
    const size_t at = name.find('~');
    return result.contrast && at != std::string::npos &&
           name.substr(at + 1) == result.contrast->label;
  };
  std::vector<const Estimate*> free;
  for (const Estimate& e : result.estimates) {
    if (e.status != EstimateStatus::kFixed && !contrasted(e.name)) free.push_back(&e);
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

std::string DifferencesText(const FitResult& result) {
  constexpr size_t kMost = 3;
  if (!result.contrast || result.contrast->rows.empty()) return "";
  std::vector<const ContrastRow*> rows;
  for (const ContrastRow& row : result.contrast->rows) {
    if (row.status != EstimateStatus::kUnidentifiable) rows.push_back(&row);
  }
  const size_t all = rows.size();
  std::stable_sort(rows.begin(), rows.end(),
                   [](const ContrastRow* a, const ContrastRow* b) { return a->p < b->p; });
  rows.resize(std::min(all, kMost));
  std::vector<std::string> differences;
  for (const ContrastRow* row : rows) {
    const std::string p = ProbabilityText(row->p_holm);
    differences.push_back(row->name + " " + Rounded(row->difference, 3) + " " +
                          IntervalText(row->difference, row->lower95, row->upper95, 3) +
                          (row->unit == "1" ? "" : " " + row->unit) + " (p " +
                          (p[0] == '<' ? "" : "= ") + p + ")");
  }
  return Capitalized(result.contrast->second) + " less " + result.contrast->first + ": " +
         (differences.empty() ? "nothing is known" : Joined(differences)) +
         (all == 0 ? "."
                   : "; Holm's p of " + CountText(all, "parameter") +
                         (all > kMost ? ", the others by --details." : "."));
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

std::string NetworkText(const FitResult& result) {
  const auto& network = result.options.model.learned;
  if (network == nullptr) return "";
  return (network->shape.any() ? "network " : "") + LearnedName(*network) + " (" +
         CountText(network->num_weights(), "weight") + ", " +
         (result.options.network_prior > 0.0 ? "prior " + Rounded(result.options.network_prior, 4)
                                             : "no prior") +
         (network->num_weights() > kMostGaussNewtonWeights
              ? ", trained together with the free parameters by Adam, fixed while errors were "
                "computed"
              : "") +
         ")";
}

std::string ForecastText(const ForecastRule& f) {
  const std::string judged =
      f.folds > 0
          ? "by models fitted without them, in " + std::to_string(f.folds) + " folds"
          : "by the model that was fitted to them: too few people or recordings to leave some out, "
            "so expect larger errors on new recordings";
  return "From a quarter of a second of first frames on (--observed) the rollout and a filter with "
         "an unknown force are combined; after half a second the filter has the weight " +
         Rounded(std::min(1.0, std::sqrt(f.input_time / 0.5)), 2) + ". Forecasts of " +
         std::to_string(f.recordings) + " recordings " + judged + ". The filter's tail is " +
         Rounded(f.tail, 2) + " times as strong and as long as the model's.\n";
}

std::optional<Interval> ProfileInterval(const FittedModel& model, const std::string& name) {
  for (const Profile& p : model.profiles) {
    if (p.name == name) return Interval{0.0, p.lower95, p.upper95};
  }
  return std::nullopt;
}

std::optional<Interval> BootstrapInterval(const FittedModel& model, const std::string& name) {
  if (!model.bootstrap) return std::nullopt;
  const Bootstrap& b = *model.bootstrap;
  for (size_t i = 0; i < b.names.size(); ++i) {
    if (b.names[i] == name) return Interval{b.standard_error[i], b.lower95[i], b.upper95[i]};
  }
  return std::nullopt;
}

TextTable IntervalTable(const FittedModel& model) {
  TextTable table({"95 % intervals", ">value", "clustered", "profile", "bootstrap", "class"});
  const auto add = [&](const auto& row) {
    const auto profile = ProfileInterval(model, row.name);
    const auto bootstrap = BootstrapInterval(model, row.name);
    if (!profile && !bootstrap) return;
    std::string classification;
    for (const Profile& p : model.profiles) {
      if (p.name != row.name) continue;
      classification = NameOf(p.classification);
      if (p.by_data_alone && *p.by_data_alone != p.classification) {
        classification += ", by the data alone " + NameOf(*p.by_data_alone);
      }
    }
    const auto text = [&](const std::optional<Interval>& i) {
      return i ? IntervalText(row.value, i->lower, i->upper, 3) : "-";
    };
    table.Add({WithUnit(row.name, row.unit), Rounded(row.value, 3),
               text(Interval{0.0, row.lower95, row.upper95}), text(profile), text(bootstrap),
               classification});
  };
  for (const Estimate& e : model.fit.estimates) {
    if (e.status != EstimateStatus::kFixed) add(e);
  }
  for (const Combination& c : model.fit.derived) {
    if (c.standard_error != 0.0) add(c);
  }
  return table;
}

std::string ResamplingText(const Bootstrap& b) {
  const std::string what = b.drawn_by == ClusterBy::kSubject ? "people" : "recordings";
  const std::string number = b.drawn_from > 0 ? std::to_string(b.drawn_from) + " " : "";
  std::string text = "resampling " + number + what + ": " + std::to_string(b.values.size()) +
                     " of " + std::to_string(b.replicas) + " replicas, seed " +
                     std::to_string(b.seed);
  if (b.people_shared) {
    text +=
        "; people share recordings and cannot be drawn individually, so the correlation between a "
        "person's recordings is neglected";
  }
  if (b.drawn_from > 0 && b.drawn_from < kFewUnits) {
    text += "; of " + number + what + " only " + Rounded(DistinctResamples(b.drawn_from), 3) +
            " distinct resamples exist: its intervals are rough, and usually too narrow";
  }
  return text;
}

std::string FirstSentences(const FitResult& result, bool brief) {
  const std::vector<RecordingDiagnostics>& recordings = result.diagnostics.recordings;
  std::vector<std::string> ids;  // of recordings of which the model explains less than nothing
  const RecordingDiagnostics* worst = nullptr;
  for (const RecordingDiagnostics& r : recordings) {
    if (!WorseThanStatic(r)) continue;
    ids.push_back(r.id);
    if (worst == nullptr || r.explained < worst->explained) worst = &r;
  }
  if (worst == nullptr) return ModelVerdictText(result.verdict, false, brief);
  const bool most = 2 * ids.size() >= recordings.size();
  return std::string(most ? "This fit loses to standing still, which" : "Standing still") +
         " predicts " + std::to_string(ids.size()) + " of " + std::to_string(recordings.size()) +
         " recordings better (" + ListOfNames(ids, 3, "recordings") +
         "; the worst is explained to " + Rounded(worst->explained, 3) + " %)" +
         (most ? ": do not use the gains; try another --stance, and check pushes and axes. "
               : ". ") +
         ModelVerdictText(result.verdict, true, brief);
}

Screen ScreenOf(const FittedModel& model) {
  const FitResult& result = model.fit;
  const Provenance& from = model.provenance;  // empty where no program fitted
  Screen screen;
  screen.title = (from.version.empty() ? "pushid" : "pushid " + from.version) + ", preset " +
                 result.options.preset + ": " + CountText(result.recordings.size(), "recording") +
                 (from.setting.empty() ? "" : " (" + from.setting + ")") +
                 GainsAreFor(result.options.model.gain_scaling);
  screen.verdict =
      (result.converged ? "" : "The solve did NOT converge. ") + FirstSentences(result, true);
  screen.tables = {ShortTable(result)};
  screen.paragraphs = {DifferencesText(result), GainsText(result), BalanceText(result)};
  screen.warnings = WarningTexts(result);
  if (!model.advice.empty()) {
    screen.next = {model.advice.front().sentence, CommandFor(from, model.advice.front().command)};
  }
  screen.rest = "the rest: --details; a page: pushid-report --html_out; all numbers: " +
                (from.model_file.empty() ? "--model_out" : from.model_file);
  return screen;
}

std::string ModelVerdictText(const ModelVerdict& v, bool more, bool brief) {
  const std::string none =
      v.none_identified.empty() ? "" : "Nothing is identified: " + v.none_identified + ". ";
  if (!v.checked()) return none + "The model was not checked: " + v.not_checked + ".";
  if (v.fails()) {
    const std::vector<std::string> found = Contradictions(v);
    const std::string rest = std::to_string(found.size() - std::min<size_t>(1, found.size()));
    const bool cut = brief && found.size() > 1;
    return none + "The model does not fit these recordings: " +
           (cut ? found.front() + "; " + rest + " more by --details" : Joined(found, "; ")) +
           ". Nothing is called identified.";
  }
  const std::string explains =
      std::isnan(v.motion.explained)
          ? std::string("the motion was not recorded.")
          : std::string(brief ? "the model" : "it") + " explains " +
                Rounded(100.0 * v.motion.explained, 3) +
                " % of the hip's squared displacement in the median recording.";
  const std::string check =
      none + "The model check found no " + (more ? "other " : "") + "contradiction";
  if (brief) return check + "; " + explains;
  return check + ": " + std::to_string(v.NumTested()) +
         " quantities that are taken as known (p = " + Rounded(v.p_assumptions, 2) + "), " +
         CountText(v.parts.size(), "score") +
         " of parts of the data (p = " + Rounded(v.p_parts, 2) + ") and " +
         CountText(v.motion.tests.size(), "measure") +
         " of feet and hips (p = " + Rounded(v.p_motion, 2) + "; each after all tests, " +
         std::to_string(v.freedom) + " degrees of freedom; less than " + Rounded(kVerdictLevel, 2) +
         " contradicts); " + explains;
}

TextTable AssumptionTable(const FitResult& result) {
  TextTable table({"taken as known", ">stated", ">recordings want", ">t (stated in it)", ">p",
                   "by itself moves most"});
  for (const AssumptionTest& test : result.verdict.assumptions) {
    std::string moves = test.moves.empty() ? "" : "nothing";
    double most = 1e-6;  // standard errors: differences of rollouts round by that
    const size_t known = std::min(test.moves.size(), result.uncertainty.estimates.size());
    for (size_t i = 0; i < known; ++i) {
      const Estimate& e = result.uncertainty.estimates[i];
      if (e.standard_error <= 0.0 || std::abs(test.moves[i]) < most * e.standard_error) continue;
      most = std::abs(test.moves[i]) / e.standard_error;
      // One Newton step is linear: a move beyond the value itself is no more than a direction.
      const ParameterSpec* const spec = result.options.table.Find(e.name);
      const double far = std::max(std::abs(e.value), spec != nullptr ? spec->scale : 0.0);
      moves = e.name + (std::abs(test.moves[i]) > far ? std::string(" by more than its size")
                                                      : " by " + Rounded(test.moves[i], 2) +
                                                            (e.unit == "1" ? "" : " " + e.unit));
    }
    const bool tells = test.error > 0.0;
    table.Add({test.name, StatedText(test), tells ? ValueText(test) : "-",
               tells ? Rounded(test.t, 2) : "-", tells ? Rounded(test.p, 2) : "-", moves});
  }
  return table;
}

}  // namespace pushid
