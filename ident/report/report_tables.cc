// ident: tables and sentences of a result.

#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/problem/behaviour_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/report_text.h"

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

TextTable LinesTable(const FitResult& result) {
  TextTable table = TextTable::OfNumbers(
      {"line pushed forwards, " + WaitText(result.options.model) + " later", "mean advance, m",
       "advance of pushed person, m", "mean displacement, m"});
  const bool differ = SettingsDiffer(result.behaviour);
  for (const SettlingSimulation& d : result.behaviour.simulations) {
    if (d.people == 1) continue;
    table.Add({SettlingSimulationName(d, differ), Rounded(d.advance, 2),
               Rounded(d.pushed_advance, 2), Rounded(d.distance, 2)});
  }
  return table;
}

namespace {

// What is left of a motion that has died out is 0.
std::string MotionText(double value) {
  constexpr double kNothing = 1e-6;
  return Rounded(std::abs(value) < kNothing ? 0.0 : value, 2);
}

}  // namespace

TextTable BehaviourTable(const FitResult& result) {
  TextTable table({"settling simulation", WaitText(result.options.model) + " after the push", "m/s",
                   "rad from rest", "mean advance, m", "advance of pushed person, m"},
                  {true, true, false, false, false, false});
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
