// ident: parameters with their intervals, and how they differ between people.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/fit/interval_agreement.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_tables.h"
#include "ident/report/value_text.h"
#include "ident/report/verdict_text.h"

namespace pushid {
namespace {

constexpr char kClusteredLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
constexpr char kTotalLook[] = "fill:none;stroke-width:3;stroke:#9ca3af";
constexpr char kTheseLook[] = "fill:none;stroke-width:3;stroke:#93c5fd";
constexpr char kProfileLook[] = "fill:none;stroke-width:3;stroke:#009e73";
constexpr char kBootstrapLook[] = "fill:none;stroke-width:3;stroke:#cc79a7";
constexpr char kNominalLook[] = "fill:none;stroke-width:2;stroke:#d55e00";
constexpr double kForestWidth = 900, kForestRow = 44, kForestLeft = 150, kForestRight = 820;

// Ends that tell nothing go to the edge.
Interval Shown(double value, Interval interval) {
  const Interval known = interval;
  interval.lower = ShownEnd(value, known.lower, known.upper);
  interval.upper = ShownEnd(value, known.upper, known.lower);
  return interval;
}

struct ForestRow {
  std::string name, unit;
  double value = 0.0, nominal = 0.0;
  bool has_nominal = false;
  std::vector<std::pair<Interval, std::string>> intervals;  // with their looks
};

// Every row on a scale of its own: units differ.
class Forest {
 public:
  Forest(std::vector<ForestRow> rows, const std::string& title, bool common_scale)
      : rows_(std::move(rows)),
        common_(common_scale),
        svg_(kForestWidth, 50 + kForestRow * static_cast<double>(rows_.size()), title) {}

  std::string Draw(const std::vector<LegendEntry>& legend) {
    DrawLegend(legend, kForestLeft, 16, &svg_);
    for (size_t i = 0; i < rows_.size(); ++i) {
      Row(rows_[i], 40 + kForestRow * (static_cast<double>(i) + 0.4));
    }
    return svg_.ToInline();
  }

 private:
  static void Extend(const ForestRow& row, double* from, double* to) {
    const auto add = [&](double value) {
      if (!std::isfinite(value)) return;
      *from = std::min(*from, value);
      *to = std::max(*to, value);
    };
    add(row.value);
    if (row.has_nominal) add(row.nominal);
    for (const auto& [interval, look] : row.intervals) {
      add(interval.lower);
      add(interval.upper);
    }
  }

  SvgScale Scale(const ForestRow& row) const {
    double from = INFINITY, to = -INFINITY;
    if (common_) {
      for (const ForestRow& each : rows_) Extend(each, &from, &to);
    } else {
      Extend(row, &from, &to);
    }
    const double air = from < to ? 0.06 * (to - from) : std::max(1e-9, 0.1 * std::abs(from));
    return {from - air, to + air, kForestLeft, kForestRight};
  }

  void Row(const ForestRow& row, double y) {
    const SvgScale scale = Scale(row);
    svg_.Text(kForestLeft - 12, y + 4, row.name, "ink end");
    svg_.Line(kForestLeft, y + 14, kForestRight, y + 14, "grid");
    for (double tick : scale.Ticks(6)) {
      svg_.Line(scale(tick), y + 14, scale(tick), y + 17, "axis");
      svg_.Text(scale(tick), y + 26, Rounded(tick, 6), "faint small middle");
    }
    if (row.unit != "1") svg_.Text(kForestRight + 8, y + 17, row.unit, "faint small");
    double at = y - 3.0 * (static_cast<double>(row.intervals.size()) - 1.0);
    for (const auto& [interval, look] : row.intervals) {
      const double lower = std::isfinite(interval.lower) ? scale(interval.lower) : kForestLeft;
      const double upper = std::isfinite(interval.upper) ? scale(interval.upper) : kForestRight;
      svg_.Polyline({{lower, at}, {upper, at}}, look);
      at += 6.0;
    }
    svg_.Circle(scale(row.value), y, 4.5, "ink", row.name + " = " + Rounded(row.value, 4));
    if (!row.has_nominal) return;
    const double x = scale(row.nominal);
    svg_.Polyline({{x, y - 8}, {x + 5, y}, {x, y + 8}, {x - 5, y}, {x, y - 8}}, kNominalLook);
  }

  std::vector<ForestRow> rows_;
  bool common_;
  SvgPicture svg_;
};

constexpr char kDataLook[] = "stroke:none;fill:#3b82f6";
constexpr char kPriorLook[] = "stroke:none;fill:#d55e00";
constexpr char kSettlingLook[] = "stroke:none;fill:#009e73";
constexpr double kBarRow = 26, kBarHeight = 14;
constexpr double kLeastDrawn = 0.001;  // a share that is narrower than a pixel

// A bar a parameter, in three parts.
ReportFigure SharesFigure(const FitResult& result) {
  std::vector<const Estimate*> shown;
  for (const Estimate& e : result.estimates) {
    const bool split =
        e.status != EstimateStatus::kFixed && e.status != EstimateStatus::kUnidentifiable;
    if (split && result.options.table.Find(e.name) != nullptr) shown.push_back(&e);
  }
  SvgPicture svg(kForestWidth, 36 + kBarRow * static_cast<double>(shown.size()),
                 "shares of data, prior and settling");
  std::vector<LegendEntry> legend = {{"data", kDataLook}};
  const auto drawn = [&shown](double Shares::*part) {
    return std::any_of(shown.begin(), shown.end(),
                       [part](const Estimate* e) { return e->shares.*part >= kLeastDrawn; });
  };
  if (drawn(&Shares::prior)) legend.push_back({"prior", kPriorLook});
  if (drawn(&Shares::settling)) legend.push_back({"settling", kSettlingLook});
  DrawLegend(legend, kForestLeft, 16, &svg);
  TextTable numbers(
      {"parameter", "data", "prior", "settling", "prior_pull", "settling_pull", "unit", "status"});
  double y = 32;
  for (const Estimate* e : shown) {
    svg.Text(kForestLeft - 12, y + kBarHeight - 3, e->name, "ink end");
    double x = kForestLeft;
    const Shares& s = e->shares;
    const std::tuple<const char*, double, const char*> parts[] = {
        {"data", s.data, kDataLook},
        {"prior", s.prior, kPriorLook},
        {"settling", s.settling, kSettlingLook}};
    for (const auto& [name, share, look] : parts) {
      const double width = std::clamp(share, 0.0, 1.0) * (kForestRight - kForestLeft);
      svg.Rect({x, y, width, kBarHeight}, look,
               std::string(name) + " " + Rounded(100.0 * share, 3) + " %");
      x += width;
    }
    svg.Text(kForestRight + 8, y + kBarHeight - 3, NameOf(e->status), "faint small");
    numbers.Add({e->name, s.data, s.prior, s.settling, s.prior_pull, s.settling_pull, e->unit,
                 NameOf(e->status)});
    y += kBarRow;
  }
  return {"shares", "Shares of each value's variance: data, prior and settling constraint.",
          svg.ToInline(), numbers};
}

const Agreement* Find(const std::vector<Agreement>& rows, const std::string& name) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&name](const Agreement& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

ReportSection ParameterSection(const ReportSource& source) {
  ReportSection section;
  section.paragraphs = {IdentifiedText(source.fit), SharesNote(), HowSure(source.fit),
                        ConventionText(source.fit)};
  section.Say(GainsText(source.fit));
  section.Show("fitted and held", EstimateTable(source.fit));
  section.Show("derived", DerivedTable(source.fit));
  if (source.fit.verdict.checked()) {
    section.Show("taken as known, and what the recordings say of it", AssumptionTable(source.fit));
  }
  const std::vector<Agreement> agreements = CompareIntervals(source.model);
  std::vector<ForestRow> rows;
  bool told_apart = false, with_total = false;
  TextTable numbers({"parameter", "unit", "value", "nominal", "clustered_lower95",
                     "clustered_upper95", "total_lower95", "total_upper95", "these_people_lower95",
                     "these_people_upper95", "profile_lower95", "profile_upper95",
                     "bootstrap_lower95", "bootstrap_upper95"});
  for (const Estimate& e : source.fit.estimates) {
    const ParameterSpec* spec = source.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    const Agreement* agreement = Find(agreements, e.name);
    ForestRow row{e.name, e.unit, e.value, spec->nominal, true, {}};
    const Interval clustered{e.standard_error, e.lower95, e.upper95};
    row.intervals.push_back({Shown(e.value, clustered), kClusteredLook});
    std::vector<std::string> cells = {e.name, e.unit, DoubleText(e.value),
                                      DoubleText(spec->nominal)};
    const auto add = [&](const Interval* interval, const char* look) {
      if (interval != nullptr && look != nullptr) {
        row.intervals.push_back({Shown(e.value, *interval), look});
      }
      cells.push_back(interval == nullptr ? "" : DoubleText(interval->lower));
      cells.push_back(interval == nullptr ? "" : DoubleText(interval->upper));
    };
    add(&clustered, nullptr);
    const Interval total =
        e.total ? Interval{e.total->error, e.total->lower95, e.total->upper95} : clustered;
    add(e.total ? &total : nullptr, kTotalLook);
    with_total = with_total || e.total;
    add(e.these ? &*e.these : nullptr, kTheseLook);
    told_apart = told_apart || e.these;
    const bool known = agreement != nullptr;
    add(known && agreement->profile ? &*agreement->profile : nullptr, kProfileLook);
    add(known && agreement->bootstrap ? &*agreement->bootstrap : nullptr, kBootstrapLook);
    rows.push_back(row);
    numbers.Add(cells);
  }
  std::vector<LegendEntry> legend = {{"clustered 95 %", kClusteredLook}};
  if (told_apart)
    legend = {{"people like them, 95 %", kClusteredLook}, {"these people", kTheseLook}};
  if (with_total) legend.push_back({"total 95 %", kTotalLook});
  if (!source.model.profiles.empty()) legend.push_back({"profile", kProfileLook});
  if (source.model.bootstrap) legend.push_back({"bootstrap", kBootstrapLook});
  legend.push_back({"nominal", kNominalLook});
  const ReportFigure shares = SharesFigure(source.fit);
  if (!shares.numbers.empty()) section.figures.push_back(shares);
  section.figures.push_back(
      {"forest",
       "Fitted values (dots) with their 95 % intervals against the nominal values (diamonds). "
       "Every row has its own scale; an open interval extends to the edge.",
       Forest(rows, "parameters against nominal values", false).Draw(legend), numbers});
  return section;
}

ReportSection UnitSection(const ReportSource& source) {
  const std::string by = source.fit.options.pool_by;
  ReportSection section;
  section.title = "By " + by;
  const TextTable pooled = PooledTable(source.fit);
  if (pooled.empty()) return section;
  section.paragraphs = {
      "Partially pooled: each value deviates from the shared value (diamond) as far as its "
      "recordings require."};
  if (by != kSubjectUnit && by != kSettingLabel) {
    section.paragraphs.back() += " A recording without a " + by + " is grouped by its setting.";
  }
  std::map<std::string, std::vector<ForestRow>> by_parameter;
  const auto add = [&](const std::string& unit, const std::map<std::string, Estimate>& estimates) {
    for (const auto& [name, e] : estimates) {
      const double shared = source.fit.parameters[source.fit.options.table.Find(name)->id];
      ForestRow row{unit, e.unit, e.value, shared, true, {}};
      row.intervals.push_back(
          {Shown(e.value, {e.standard_error, e.lower95, e.upper95}), kClusteredLook});
      by_parameter[name].push_back(row);
    }
  };
  for (const auto& [id, subject] : source.fit.subjects) add(id, subject.pooled);
  for (const auto& [setting, estimates] : source.fit.settings) add(setting, estimates);
  const std::vector<LegendEntry> legend = {{"clustered 95 %", kClusteredLook},
                                           {"shared value", kNominalLook}};
  for (const auto& [name, rows] : by_parameter) {
    TextTable numbers({"unit", "value", "lower95", "upper95", "shared"});
    for (const ForestRow& row : rows) {
      const Interval& interval = row.intervals[0].first;
      numbers.Add({row.name, row.value, interval.lower, interval.upper, row.nominal});
    }
    section.folds.push_back(
        {name,
         {{"units_" + name, name + " by " + by, Forest(rows, name, true).Draw(legend), numbers}}});
  }
  section.Show("", pooled);
  section.Show("spread of the values", SpreadTable(source.fit));
  return section;
}

}  // namespace pushid
