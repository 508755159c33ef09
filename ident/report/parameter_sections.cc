#include "ident/report/parameter_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

constexpr char kProfileLook[] = "fill:none;stroke-width:3;stroke:#009e73";
constexpr char kBootstrapLook[] = "fill:none;stroke-width:3;stroke:#cc79a7";
constexpr double kStripHeight = 50, kIntervalHeight = 6;  // pixels

// A value with its intervals, one above the other, and what it is compared with (an upright line),
// on a scale of its own. Interval ends that tell nothing are infinite.
struct IntervalRow {
  std::string name, unit;
  double value = 0.0, nominal = 0.0;
  std::vector<std::pair<Interval, std::string>> intervals;  // with their looks
};
constexpr char kIntervalLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
constexpr char kToldLook[] = "fill:none;stroke-width:3;stroke:#d55e00";

Chart IntervalStrip(const IntervalRow& row) {
  Chart chart{WithUnit(row.name, row.unit)};
  chart.bare_y = true;
  chart.height = kStripHeight + kIntervalHeight * static_cast<double>(row.intervals.size());
  chart.marks = {row.nominal};
  const double rows = static_cast<double>(row.intervals.size());
  chart.y_from = -1.0 - 0.5 * rows;
  chart.y_to = 1.0 + 0.5 * rows;
  double y = 0.5 * (rows - 1.0);
  for (const auto& [interval, look] : row.intervals) {
    chart.lines.push_back({{{interval.lower, y}, {interval.upper, y}}, look});
    y -= 1.0;
  }
  chart.lines.push_back({{{row.value, 0.0}}, kMeasuredLook, true});
  return chart;
}

// An interval with ends that tell nothing moved to infinity, which charts draw to the edge.
Interval Shown(double value, Interval interval) {
  const Interval known = interval;
  interval.lower = ShownEnd(value, known.lower, known.upper);
  interval.upper = ShownEnd(value, known.upper, known.lower);
  return interval;
}

TextTable EstimateTable(const FitResult& result) {
  TextTable table({"parameter", ">value", ">std error", "95 % interval", "unit", "status",
                   "data/prior/settling, %", ">prior shift, std errors", "prior"});
  const auto percent = [](double share) { return Rounded(std::round(100.0 * share), 3); };
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) {
      table.Add({e.name, Rounded(e.value, 4), "-", "-", e.unit, "fixed", "-", "-", ""});
      continue;
    }
    const ParameterSpec* spec = result.options.table.Find(e.name);
    const Interval shown = e.interval();
    const Shares& s = e.shares;
    const bool unknown = e.status == EstimateStatus::kUnidentifiable;
    const bool no_shares = unknown || e.status == EstimateStatus::kAtBound;
    const bool no_error = no_shares && e.standard_error <= 0.0;
    // The shift by priors and settling together, in standard errors of the value.
    const double pull = (s.prior_pull + s.settling_pull) / e.standard_error;
    table.Add(
        {e.name, Rounded(e.value, 4),
         unknown    ? "infinite"
         : no_error ? "-"
                    : Rounded(shown.standard_error, 3),
         unknown || no_error ? "-" : IntervalText(e.value, shown.lower, shown.upper), e.unit,
         NameOf(e.status),
         no_shares ? "-" : percent(s.data) + "/" + percent(s.prior) + "/" + percent(s.settling),
         no_shares || e.standard_error <= 0.0 ? "-" : (pull > 0.0 ? "+" : "") + Rounded(pull, 2),
         spec != nullptr && spec->prior
             ? Rounded(spec->prior->mean, 3) + " +- " + Rounded(spec->prior->sigma, 3)
             : ""});
  }
  return table;
}

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

// "Measure better ...: a_x becomes identified where the height of the pushes is known to 0.01 m",
// of estimates that are weak only because of what is taken as known; empty: nothing could be stated
// better.
std::string SharperText(const FitResult& result) {
  const ModelVerdict& verdict = result.verdict;
  if (verdict.fails() || !verdict.none_identified.empty()) return "";
  const Uncertainty& u = result.uncertainty;
  const bool few = u.about_people_like_them && u.num_people < kFewestPeople;
  std::string text;
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* const spec = result.options.table.Find(e.name);
    const size_t column = ColumnOf(result, e.name);
    const AssumptionTest* const most = WidensMost(verdict, column, true);
    if (spec == nullptr || most == nullptr) continue;
    if (e.status != EstimateStatus::kWeak || few || !Leads(e)) continue;
    const double width = spec->prior ? spec->prior->sigma : spec->scale;
    if (!IsNarrow(spec->transform, width, e.lower95, e.upper95)) continue;
    // The largest of a half, a fifth and a tenth of what is stated by which it would be identified.
    const Interval total = e.interval();
    const double variance = total.standard_error * total.standard_error;
    const double fitted = ToFitted(spec->transform, e.value);
    for (double share : {0.5, 0.2, 0.1}) {
      const double stated = share * most->stated;
      const double left =
          variance - most->Widens(column, most->stated) + most->Widens(column, stated);
      const auto end = [&](double natural) {
        const double half = ToFitted(spec->transform, natural) - fitted;
        return ToNatural(spec->transform,
                         fitted + std::sqrt(std::max(0.0, left / variance)) * half);
      };
      if (!IsNarrow(spec->transform, width, end(total.lower), end(total.upper))) continue;
      text += (text.empty() ? "" : "; ") + e.name + " becomes identified where the " + most->name +
              " is known to " + Rounded(stated, 2) + (most->unit.empty() ? "" : " " + most->unit) +
              " (stated_errors: " + StatedErrorKey(*most) + ")";
      break;
    }
  }
  return text.empty() ? "" : "Measure better and state it in the manifest: " + text + ".";
}

// Beside the interval that decides: that of the data alone, and that of these people alone.
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
    // "height of the pushes (63 %)"
    const size_t column = ColumnOf(result, row.name);
    const AssumptionTest* const most = WidensMost(result.verdict, column, false);
    std::string widened = "-";
    if (most != nullptr) {
      const double part = most->Widens(column, most->stated);
      const double total = row.interval().standard_error;
      widened =
          most->name + " (" + Rounded(100.0 * std::min(1.0, part / (total * total)), 2) + " %)";
    }
    const auto own = cells(Interval{row.standard_error, row.lower95, row.upper95});
    const auto these = cells(row.these);
    table.Add({row.name, own.first, own.second, these.first, these.second, row.unit, widened});
  };
  for (const Estimate& e : result.estimates) {
    if (e.status != EstimateStatus::kFixed) add(e);
  }
  for (const Combination& c : result.derived) add(c);
  return table;
}

// The method of the standard errors, and the people they are about: these, or people like them.
std::string ErrorsText(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  if (!u.clustered) {
    return "standard errors: of the posterior, priors included; a single recording says nothing of "
           "errors between people\n";
  }
  double least = INFINITY, most = 0.0;
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed || !std::isfinite(e.freedom)) continue;
    least = std::min(least, e.freedom);
    most = std::max(most, e.freedom);
  }
  const std::string from = Rounded(least, 2), to = Rounded(most, 2);
  const bool people = u.clustered_by == ClusterBy::kSubject;
  const std::string text =
      "standard errors: clustered by " +
      std::string(people ? (u.two_way ? "person and by who stood together" : "person")
                         : "recording") +
      " (" + std::to_string(u.num_clusters) + (people ? " people" : " recordings") +
      "; Student's t with " + (from == to ? from : from + " to " + to) +
      (to == "1" ? " degree of freedom" : " degrees of freedom") + ")" +
      (u.too_few_clusters ? "; correlations are those of independent frames" : "") + "\n";
  if (u.num_people == 0) return text;  // a model of an older version
  const std::string number = std::to_string(u.num_people);
  if (u.about_people_like_them) {
    return text + "errors and status are about people like these " + number +
           ": people are the units\n";
  }
  return text + (u.num_people == 1
                     ? "errors and status are about this person: of other people one person says "
                       "nothing\n"
                     : "errors and status are about these " + number +
                           " people, not about people like them: recordings are the units\n");
}

// The convention that separates mu from Kp, the quoted person, and which gains are tied.
std::string ConventionText(const FitResult& result) {
  const ParameterTable& specs = result.options.table;
  std::vector<std::string> per_frame, tied;
  for (Parameter id : {kKdX, kKdY, kKdTheta, kKdPhi}) {
    if (!Acts(id, result.options.model)) continue;
    per_frame.push_back(specs[id].name + " " + Rounded(kLdpRate * result.parameters[id], 4));
  }
  bool one_passive = false;
  for (const ParameterSpec& spec : specs.specs) {
    if (!spec.tied_to || !Acts(spec.id, result.options.model)) continue;
    if (result.parameters[spec.id] == 0.0) continue;
    one_passive = one_passive || spec.id == kPassiveDamping;
    if (spec.id != kPassiveDamping) tied.push_back(spec.name + " = " + specs[*spec.tied_to].name);
  }
  std::string quoted = std::string(IsOneMachine(result.options.model)
                                       ? "Gains are those of the recorded body"
                                       : "Gains are for a person of 85 kg with a rod of 0.95 m") +
                       " (gain scaling: " + NameOf(result.options.model.gain_scaling) + ").\n";
  // LDP's Kd multiply differences from frame to frame.
  if (result.options.preset.rfind("ldp", 0) == 0 && !per_frame.empty()) {
    quoted += "In LDP's units, per frame of 1/60 s: " + Joined(per_frame) + ".\n";
  }
  if (!tied.empty()) {
    quoted += "Sideways as forwards: " + Joined(tied) + " (--directions=isotropic).\n";
  }
  if (one_passive) {
    quoted +=
        "One passive share: passive_damping = passive_stiffness (--free=passive_damping: its "
        "own).\n";
  }
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

// The shared values, and how far units differ from them.
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

constexpr double kContrastLevel = 0.05;

constexpr int kBars = 24;

ReportFigure CorrelationFigure(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  // Deviations of units and initial velocities are left out.
  const size_t size = std::min(result.options.table.Free().size(), u.estimates.size());
  Chart map{"correlation of the estimates"};
  map.width = kWidestMap;
  std::vector<std::string> header = {"parameter"};
  for (size_t i = 0; i < size; ++i) header.push_back(u.estimates[i].name);
  TextTable numbers(header);
  for (size_t i = 0; i < size; ++i) {
    map.y_categories.push_back(u.estimates[i].name);
    map.x_categories.push_back(u.estimates[i].name);
    std::vector<std::string> cells = {u.estimates[i].name};
    std::vector<double> row;
    for (size_t j = 0; j < size; ++j) {
      row.push_back(u.correlation(static_cast<int>(i), static_cast<int>(j)));
      cells.push_back(DoubleText(row.back()));
    }
    map.cells.push_back(row);
    numbers.Add(cells);
  }
  return {
      "correlation",
      "Near 1 or -1: the data determine the joint effect of two parameters, but not that of each.",
      {{}, {map}},
      numbers};
}

// True for a combination that is a multiple of one parameter: its curve is drawn already.
bool IsAlias(const FittedModel& model, const Profile& p) {
  const FitResult& result = model.fit;
  const bool parameter = result.options.table.Find(p.name) != nullptr;
  return !parameter &&
         std::any_of(model.profiles.begin(), model.profiles.end(), [&](const auto& q) {
           return &q != &p && result.options.table.Find(q.name) != nullptr &&
                  q.points.size() == p.points.size() && q.threshold == p.threshold &&
                  q.cost == p.cost &&
                  std::abs(q.lower95 / q.estimate - p.lower95 / p.estimate) < 1e-9;
         });
}

}  // namespace

ReportFigure IntervalFigure(const FittedModel& model, bool known) {
  Figure figure;
  TextTable numbers({"parameter", "unit", "value", "nominal", "lower95", "upper95",
                     "profile_lower95", "profile_upper95", "bootstrap_lower95",
                     "bootstrap_upper95"});
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    if (known && e.status != EstimateStatus::kIdentified) continue;
    IntervalRow row{e.name, e.unit, e.value, spec->nominal, {}};
    std::vector<std::string> cells = {e.name, e.unit, DoubleText(e.value),
                                      DoubleText(spec->nominal)};
    const auto add = [&](const std::optional<Interval>& interval, const char* look) {
      if (interval) row.intervals.push_back({Shown(e.value, *interval), look});
      cells.push_back(interval ? DoubleText(interval->lower) : "");
      cells.push_back(interval ? DoubleText(interval->upper) : "");
    };
    add(e.interval(), kIntervalLook);
    add(ProfileInterval(model, e.name), kProfileLook);
    add(BootstrapInterval(model, e.name), kBootstrapLook);
    figure.panels.push_back(IntervalStrip(row));
    numbers.Add(cells);
  }
  figure.legend = {{"95 % interval", kIntervalLook}};
  if (!model.profiles.empty()) figure.legend.push_back({"profile", kProfileLook});
  if (model.bootstrap) figure.legend.push_back({"bootstrap", kBootstrapLook});
  figure.legend.push_back({"nominal", kMarkLook});
  return {
      known ? "known" : "forest",
      (known ? "What the recordings identify: values" : "Fitted values") +
          std::string(" (dots) with 95 % intervals, and nominal values (upright lines). Every row "
                      "has its own scale; an open interval extends to the edge."),
      figure, numbers};
}

ReportSection ParameterSection(const FittedModel& model) {
  ReportSection section{"parameters", "Parameters"};
  section.paragraphs = {
      "Shares: fractions of a value's variance due to the data, its prior and the settling "
      "constraint. Prior shift: how far prior and constraint together move the value, in "
      "standard errors of the data alone. Prior-held: the data account for less than half.",
      ErrorsText(model.fit), ConventionText(model.fit)};
  section.Say(SharperText(model.fit));
  section.Show("", EstimateTable(model.fit));
  TextTable derived({"derived", ">value", ">std error", "95 % interval", "unit"});
  for (const Combination& c : model.fit.derived) {  // c_x, c_y and gains per mass
    const Interval shown = c.interval();
    const bool fixed = c.standard_error == 0.0;
    derived.Add({c.name, Rounded(c.value, 4), fixed ? "-" : Rounded(shown.standard_error, 3),
                 fixed ? "-" : IntervalText(c.value, shown.lower, shown.upper), c.unit});
  }
  section.Show("", derived);
  section.Show("what the intervals are made of", PartsTable(model.fit));
  if (model.fit.verdict.checked()) {
    section.Say(ModelVerdictText(model.fit.verdict));
    section.Show("taken as known, and what the recordings say of it", AssumptionTable(model.fit));
  }
  section.figures.push_back(IntervalFigure(model, false));
  return section;
}

ReportSection UnitSection(const FittedModel& model) {
  const FitResult& fit = model.fit;
  const std::string by = fit.options.pool_by;
  ReportSection section{"units"};
  const bool may_lack = by != kSubjectUnit && by != kSettingLabel;
  section.title = "By " + by + (may_lack ? " or setting" : "");
  const bool by_setting = !fit.settings.empty();
  std::vector<std::string> header = {by};
  if (!by_setting) header.push_back(">kg");
  header.insert(header.end(), {"parameter", ">value", ">std error", "95 % interval", "unit"});
  TextTable pooled(header);
  std::map<std::string, std::pair<Chart, TextTable>> by_parameter;
  const auto add = [&](const std::vector<std::string>& unit,
                       const std::map<std::string, Estimate>& estimates) {
    for (const auto& [name, e] : estimates) {
      std::vector<std::string> cells = unit;
      cells.insert(cells.end(), {name, Rounded(e.value, 4), Rounded(e.standard_error, 3),
                                 IntervalText(e.value, e.lower95, e.upper95), e.unit});
      if (cells.size() == header.size()) pooled.Add(cells);
      auto& [chart, numbers] =
          by_parameter
              .try_emplace(name, Chart(),
                           TextTable({"unit", "value", "lower95", "upper95", "shared"}))
              .first->second;
      const double shared = fit.parameters[fit.options.table.Find(name)->id];
      const double row = static_cast<double>(chart.y_categories.size());
      const Interval shown = Shown(e.value, {e.standard_error, e.lower95, e.upper95});
      chart.title = WithUnit(name, e.unit);
      chart.marks = {shared};
      chart.y_categories.push_back(unit[0]);
      chart.lines.push_back({{{shown.lower, row}, {shown.upper, row}}, kIntervalLook});
      chart.lines.push_back({{{e.value, row}}, kMeasuredLook, true});
      numbers.Add({unit[0], e.value, shown.lower, shown.upper, shared});
    }
  };
  for (const auto& [id, subject] : fit.subjects) {
    add({id, Rounded(subject.mass_kg, 4)}, subject.pooled);
  }
  for (const auto& [setting, estimates] : fit.settings) add({setting}, estimates);
  if (pooled.empty()) return section;
  section.paragraphs = {
      "Partially pooled: each value deviates from the shared value as far as its "
      "recordings require."};
  if (may_lack) {
    section.paragraphs.back() += " A recording without a " + by + " is grouped by its setting.";
  }
  for (const auto& [name, drawn] : by_parameter) {
    section.figures.push_back(
        {"units_" + name,
         name + " by " + by +
             ": values (dots), 95 % intervals, and the shared value (upright line).",
         {{}, {drawn.first}},
         drawn.second});
  }
  section.Show("", pooled);
  section.Show("", SpreadTable(fit));
  return section;
}

ReportSection ContrastSection(const FittedModel& model) {
  ReportSection section{"contrast"};
  if (!model.fit.contrast) return section;
  const Contrast& contrast = *model.fit.contrast;
  section.title = "By " + contrast.label + ": " + contrast.second + " less " + contrast.first;
  section.Say(ContrastText(model.fit));
  section.Show("", ContrastTable(contrast));
  // Rows have scales of their own with zero in the middle: units differ, signs do not.
  Figure forest;
  forest.legend = {{"95 %", kIntervalLook}, {"differs after Holm's correction", kToldLook}};
  TextTable numbers({"parameter", "unit", "first", "second", "difference", "lower95", "upper95",
                     "effect_sd", "p", "p_holm"});
  for (const ContrastRow& row : contrast.rows) {
    double reach = std::abs(row.difference);
    for (double end : {row.lower95, row.upper95}) {
      if (std::isfinite(end)) reach = std::max(reach, std::abs(end));
    }
    reach = reach > 0.0 ? 1.08 * reach : 1.0;
    const char* const look = row.p_holm < kContrastLevel ? kToldLook : kIntervalLook;
    Chart& strip = forest.panels.emplace_back(IntervalStrip(
        {row.name, row.unit, row.difference, 0.0, {{{0.0, row.lower95, row.upper95}, look}}}));
    strip.y_label = "Holm's p " + Rounded(row.p_holm, 2);
    strip.x_from = -reach;
    strip.x_to = reach;
    numbers.Add({row.name, row.unit, row.first, row.second, row.difference, row.lower95,
                 row.upper95, row.effect ? TableCell(*row.effect) : TableCell(""), row.p,
                 row.p_holm});
  }
  section.figures.push_back(
      {"contrast",
       "Differences (dots) with their 95 % intervals. Every row has its own "
       "scale around zero (upright line); an open interval extends to the edge.",
       forest, numbers});
  return section;
}

ReportSection IdentifiabilitySection(const FittedModel& model) {
  ReportSection section{"identifiability", "Identifiability"};
  const Diagnostics& d = model.fit.diagnostics;
  section.Say("Condition number of the scaled Jacobian: " + Rounded(d.start.condition_number, 3) +
              " at the start, " + Rounded(model.fit.uncertainty.condition_number, 3) +
              " at the optimum.");
  for (const NullDirection& n : model.fit.uncertainty.null_directions) {
    section.Say("Unidentifiable: " + n.sentence);
  }
  if (model.fit.uncertainty.null_directions.empty()) {
    section.Say("Data, priors and constraints together determine all directions.");
  }
  for (const std::string& held : model.fit.uncertainty.held_directions) {
    section.Say("Prior-dependent: " + held);
  }
  for (const std::string& note : d.start.notes) section.Say("Start: " + note);
  const Uncertainty& u = model.fit.uncertainty;
  std::string correlated;
  for (int i = 0; i < u.correlation.rows(); ++i) {
    for (int j = i + 1; j < u.correlation.cols(); ++j) {
      const bool deviation = u.estimates[j].name.find('[') != std::string::npos;  // of a unit
      if (std::abs(u.correlation(i, j)) < 0.9 || deviation) continue;
      correlated += "  " + u.estimates[i].name + " and " + u.estimates[j].name + ": " +
                    Rounded(u.correlation(i, j), 2) + "\n";
    }
  }
  section.Say(correlated.empty()
                  ? ""
                  : "correlations beyond 0.9 (the data separate these poorly):\n" + correlated);
  section.figures.push_back(CorrelationFigure(model.fit));
  return section;
}

ReportSection ProfileSection(const FittedModel& model) {
  ReportSection section{"profiles", "Profile likelihood"};
  if (model.profiles.empty()) return section;
  section.paragraphs = {
      "Each parameter is moved away from its estimate and everything else refitted; the 95 % "
      "interval ends where the cost has risen by the threshold. A profile that stays flat means "
      "that the data do not determine the parameter."};
  section.Show("", IntervalTable(model));
  Figure figure;
  TextTable ends({"profile of", "why it ended below", "above"});
  TextTable numbers({"parameter", "unit", "value", "cost_above_best", "threshold"});
  for (const Profile& p : model.profiles) {
    if (p.lower_end != "threshold" || p.upper_end != "threshold") {
      ends.Add({p.name, p.lower_end, p.upper_end});
    }
    Chart chart{p.name, WithUnit(p.name, p.unit)};
    chart.Shrink();
    ChartPoints points;
    for (const ProfilePoint& point : p.points) {
      points.emplace_back(point.value, (point.cost - p.cost) / p.threshold);
      numbers.Add({p.name, p.unit, point.value, point.cost - p.cost, p.threshold});
    }
    chart.lines = {{points, kPredictedLook}, {points, kDotLook, true}};
    chart.levels = {1.0};
    chart.marks = {p.estimate};
    chart.y_from = -0.1;
    chart.y_to = 2.0;
    if (p.points.size() > 1 && !IsAlias(model, p)) figure.panels.push_back(chart);
  }
  section.Show("profiles that ended elsewhere than at the threshold", ends);
  section.figures.push_back(
      {"profiles",
       "Cost above the optimum, over the 95 % threshold (dashed); the estimate is the line.",
       figure, numbers});
  return section;
}

ReportSection BootstrapSection(const FittedModel& model) {
  ReportSection section{"bootstrap", "Bootstrap"};
  if (!model.bootstrap || model.bootstrap->values.empty()) return section;
  const Bootstrap& b = *model.bootstrap;
  section.paragraphs = {"The fit was repeated on samples drawn with replacement, " +
                        ResamplingText(b) + "."};
  if (model.profiles.empty()) {
    section.Show("", IntervalTable(model));
  }
  Figure figure;
  std::vector<std::string> header;
  for (size_t i = 0; i < b.names.size(); ++i) {
    header.push_back(b.names[i] + " (" + b.units[i] + ")");
    const Estimate* estimate = nullptr;
    for (const Estimate& e : model.fit.estimates) {
      if (e.name == b.names[i]) estimate = &e;
    }
    if (estimate == nullptr) continue;  // combinations are their parameter on another scale
    std::vector<double> values;
    for (const auto& row : b.values) values.push_back(row[i]);
    Chart& chart =
        figure.panels.emplace_back(Chart{b.names[i], WithUnit(b.names[i], b.units[i]), "replicas"});
    chart.Shrink();
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double width = (*high - *low) / kBars;
    std::vector<int> counts(kBars, 0);
    for (double value : values) {
      ++counts[width > 0.0 ? std::min(kBars - 1, static_cast<int>((value - *low) / width)) : 0];
    }
    ChartBand bars{{}, {}, "stroke:none;fill:#cc79a7;fill-opacity:.75"};
    for (int k = 0; k < kBars; ++k) {
      for (const double x : {*low + k * width, *low + (k + 1) * width}) {
        bars.lower.emplace_back(x, 0.0);
        bars.upper.emplace_back(x, counts[k]);
      }
    }
    chart.bands = {bars};
    chart.marks = {estimate->value};
    chart.y_from = 0.0;
  }
  TextTable numbers(header);
  for (const auto& row : b.values) {
    std::vector<std::string> cells;
    for (double value : row) cells.push_back(DoubleText(value));
    numbers.Add(cells);
  }
  section.figures.push_back(
      {"bootstrap", "Replicas, and the estimate of the fit (line).", figure, numbers});
  return section;
}

ReportSection HorizonCheckSection(const FittedModel& model) {
  ReportSection section{"horizon_check", "Estimates from fewer frames"};
  if (!model.horizon_check || model.horizon_check->refits.empty()) return section;
  section.paragraphs = {
      "The fit was repeated on only so many frames of every recording, counted from the start of "
      "its push. A parameter with physical meaning keeps its value; one that drifts compensates "
      "for something that the model omits.",
      DriftText(*model.horizon_check)};
  section.Show("", HorizonTable(*model.horizon_check));
  return section;
}

}  // namespace pushid
