#include "ident/report/parameter_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "datasets/files/json_file.h"
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

constexpr double kFileRounding = 1e-6;  // of a parameter
constexpr char kIntervalLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
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
const AssumptionTest* WidensMost(const ModelVerdict& verdict, size_t column) {
  const AssumptionTest* most = nullptr;
  double widest = 0.0;
  for (const AssumptionTest& test : verdict.assumptions) {
    const double widens = test.Widens(column, test.stated);
    if (widens > widest) most = &test, widest = widens;
  }
  return most;
}

// The intervals beside the one that decides: of the data alone, and of these people alone.
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
    const AssumptionTest* const most = WidensMost(result.verdict, column);
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
  const GainScaling scaling = result.options.model.gain_scaling;
  std::string quoted =
      std::string(IsOneMachine(result.options.model) ? "Gains are those of the recorded body"
                  : scaling == GainScaling::kNone    ? "Gains are the same for every body"
                  : scaling == GainScaling::kMass
                      ? "Gains are for a person of 85 kg"
                      : "Gains are for a person of 85 kg with a rod of 0.95 m") +
      " (gain scaling: " + NameOf(scaling) + ").\n";
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

// Every parameter has a chart with a scale of its own: its intervals one above the other, and what
// it is compared with as an upright line.
ReportFigure IntervalFigure(const FittedModel& model, bool known) {
  Figure figure;
  TextTable numbers({"parameter", "unit", "value", "nominal", "lower95", "upper95",
                     "profile_lower95", "profile_upper95", "bootstrap_lower95",
                     "bootstrap_upper95"});
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    if (known && e.status != EstimateStatus::kIdentified) continue;
    std::vector<std::string> cells = {e.name, e.unit, DoubleText(e.value),
                                      DoubleText(spec->nominal)};
    std::vector<std::pair<Interval, const char*>> intervals;
    const auto add = [&](const std::optional<Interval>& interval, const char* look) {
      if (interval) intervals.push_back({Shown(e.value, *interval), look});
      cells.push_back(interval ? DoubleText(interval->lower) : "");
      cells.push_back(interval ? DoubleText(interval->upper) : "");
    };
    add(e.interval(), kIntervalLook);
    add(ProfileInterval(model, e.name), kProfileLook);
    add(BootstrapInterval(model, e.name), kBootstrapLook);
    const double rows = static_cast<double>(intervals.size());
    Chart& chart = figure.panels.emplace_back(Chart{WithUnit(e.name, e.unit)});
    chart.bare_y = true;
    chart.height = kStripHeight + kIntervalHeight * rows;
    chart.marks = {spec->nominal};
    chart.y_from = -1.0 - 0.5 * rows;
    chart.y_to = 1.0 + 0.5 * rows;
    double y = 0.5 * (rows - 1.0);
    for (const auto& [interval, look] : intervals) {
      chart.lines.push_back({{{interval.lower, y}, {interval.upper, y}}, look});
      y -= 1.0;
    }
    chart.lines.push_back({{{e.value, 0.0}}, kMeasuredLook, true});
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
  const auto add = [&](const std::vector<std::string>& unit,
                       const std::map<std::string, Estimate>& estimates) {
    for (const auto& [name, e] : estimates) {
      std::vector<std::string> cells = unit;
      cells.insert(cells.end(), {name, Rounded(e.value, 4), Rounded(e.standard_error, 3),
                                 IntervalText(e.value, e.lower95, e.upper95), e.unit});
      if (cells.size() == header.size()) pooled.Add(cells);
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
  return section;
}

ReportSection ProfileSection(const FittedModel& model) {
  ReportSection section{"profiles", "Profile likelihood, bootstrap, fewer frames"};
  if (!model.profiles.empty()) {
    section.Say(
        "Profiles: each parameter is moved away from its estimate and everything else refitted; "
        "the "
        "95 % interval ends where the cost has risen by the threshold. A profile that stays flat "
        "means that the data do not determine the parameter.");
  }
  if (model.bootstrap) {
    section.Say("Bootstrap: the fit was repeated on samples drawn with replacement, " +
                ResamplingText(*model.bootstrap) + ".");
  }
  section.Show("", IntervalTable(model));
  if (model.horizon_check && !model.horizon_check->refits.empty()) {
    section.Say(
        "Fewer frames: the fit was repeated on only so many frames of every recording, counted "
        "from "
        "the start of its push. A parameter with physical meaning keeps its value; one that drifts "
        "compensates for something that the model omits.");
    section.Say(DriftText(*model.horizon_check));
    section.Show("", HorizonTable(*model.horizon_check));
  }
  if (model.profiles.empty()) return section;
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

Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path) {
  const Result<JsonDocument> document = ReadJsonDocument(manifest_path);
  if (!document.ok()) return document.error();
  try {
    return document.value()
        .content.at("synthetic")
        .at("truth")
        .get<std::map<std::string, double>>();
  } catch (const nlohmann::json::exception&) {
    if (document.value().content.contains(
            nlohmann::ordered_json::json_pointer("/synthetic/formation"))) {
      return Error{
          "a formation of pushid-formation: its truth is the model it was rolled out "
          "with; compare with that model's own report",
          manifest_path};
    }
    return Error{"no `synthetic.truth`: only recordings of pushid-simulate have a known truth",
                 manifest_path};
  }
}

std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth) {
  TextTable table({"parameter", ">truth", ">fitted", ">std error", "95 % interval", "unit", ""});
  int covered = 0, compared = 0;
  for (const Estimate& e : result.estimates) {
    const auto known = truth.find(e.name);
    if (e.status == EstimateStatus::kFixed || known == truth.end()) continue;
    // Without noise an interval shrinks below what the files' decimals can hold.
    const double slack = kFileRounding * std::abs(known->second);
    const Interval i = e.interval();
    const bool inside = i.lower - slack <= known->second && known->second <= i.upper + slack;
    ++compared;
    covered += inside;
    table.Add({e.name, Rounded(known->second, 4), Rounded(e.value, 4), Rounded(i.standard_error, 3),
               IntervalText(e.value, i.lower, i.upper), e.unit, inside ? "covers" : "misses"});
  }
  return table.ToString() + std::to_string(covered) + " of " + std::to_string(compared) +
         " intervals cover the truth (on average one in 20 does not)\n";
}

}  // namespace pushid
