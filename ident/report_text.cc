// ident: the report for a terminal.
#include "ident/report_text.h"

#include <cmath>
#include <cstdio>

#include "ident/option_names.h"
#include "ident/preparation_text.h"
#include "ident/starts_text.h"
#include "ident/text_table.h"

namespace pushid {
namespace {

std::string Interval(double lower, double upper) {
  return "[" + Significant(lower) + ", " + Significant(upper) + "]";
}

std::string Count(int number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

std::string HowSure(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  if (!u.clustered) return "standard errors: naive (a single recording cannot be clustered)\n";
  return "standard errors: clustered by recording (" + std::to_string(u.num_clusters) +
         "; Student's t = " + Significant(u.t_quantile, 3) + "); naive ones beside them\n";
}

std::string ParameterTableText(const FitResult& result) {
  TextTable table({"parameter", "value", "std error", "95 % interval", "unit", "status",
                   "naive error", "prior"},
                  {true, false, false, true, true, true, false, true});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed) {
      table.Add({e.name, Significant(e.value), "-", "-", e.unit, "fixed", "-", ""});
      continue;
    }
    const std::string prior =
        spec != nullptr && spec->prior
            ? Significant(spec->prior->mean, 3) + " +- " + Significant(spec->prior->sigma, 3)
            : "";
    const bool unknown = e.status == EstimateStatus::kUnidentifiable;
    table.Add({e.name, Significant(e.value),
               unknown ? "infinite" : Significant(e.standard_error, 3),
               unknown ? "-" : Interval(e.lower95, e.upper95), e.unit, NameOf(e.status),
               unknown ? "infinite" : Significant(e.standard_error_naive, 3), prior});
  }
  return table.ToString();
}

std::string DerivedText(const FitResult& result) {
  TextTable table({"derived", "value", "std error", "95 % interval", "unit"},
                  {true, false, false, true, true});
  for (const Combination& c : result.derived) {
    const bool fixed = c.standard_error == 0.0;
    table.Add({c.name, Significant(c.value), fixed ? "-" : Significant(c.standard_error, 3),
               fixed ? "-" : Interval(c.lower95, c.upper95), c.unit});
  }
  const ParameterTable& specs = result.options.table;
  const std::string held = specs[kKpX].free || specs[kKpY].free
                               ? "Here Kp is fitted too."
                               : "Convention: Kp_x = " + Significant(result.parameters[kKpX]) +
                                     ", Kp_y = " + Significant(result.parameters[kKpY]) +
                                     " N s/m held, mu = c - Kp.";
  return table.ToString() +
         "mu and Kp act on the same velocity: only c = mu + Kp is identifiable. " + held +
         "\nGains are for a person of 85 kg with a rod of 0.95 m (gain scaling: " +
         NameOf(result.options.model.gain_scaling) + ").\n";
}

std::string CorrelationText(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  std::string text;
  for (int i = 0; i < u.correlation.rows(); ++i) {
    for (int j = i + 1; j < u.correlation.cols(); ++j) {
      if (std::abs(u.correlation(i, j)) < 0.9) continue;
      if (u.estimates[j].name.find('[') != std::string::npos) continue;  // a unit's deviation
      text += "  " + u.estimates[i].name + " and " + u.estimates[j].name + ": " +
              Significant(u.correlation(i, j), 2) + "\n";
    }
  }
  return text.empty() ? "" : "correlations beyond 0.9 (the data separate these poorly):\n" + text;
}

std::string DemonstrationName(const Demonstration& d) {
  const std::string who = d.people == 1 ? "" : std::to_string(d.people) + " people in a line, ";
  const std::string where = d.setting.empty() ? "" : d.setting + ": ";
  return where + who + Significant(d.mass) + " kg after " + Significant(d.impulse) + " N s";
}

std::string BehaviourText(const FitResult& result) {
  const Behaviour& b = result.behaviour;
  std::string text, line;
  for (const Demonstration& d : b.demonstrations) {
    if (d.people == 1) continue;
    line += "  " + DemonstrationName(d) + ": they move on by " + Significant(d.distance, 2) +
            " m on average\n";
  }
  if (b.settles) {
    text =
        "after a push of 4, 25 and 80 N s, people of 60, 80 and 100 kg stand again within two "
        "seconds" +
        std::string(line.empty() ? "\n" : "; so do\n" + line);
  } else {
    text = "NOT SETTLING, two seconds after a push:\n";
    for (const Demonstration& d : b.demonstrations) {
      if (d.settled) continue;
      text += "  " + DemonstrationName(d) + ": " +
              (d.fell ? "fell"
                      : "still at " + Significant(d.speed, 2) + " m/s, " + Significant(d.lean, 2) +
                            " rad from rest") +
              "\n";
    }
    text += line;
  }
  if (!b.harder_moves_farther) text += "a harder push does NOT move the line farther\n";
  text += "fastest free mode at rest: " + Significant(b.fastest_growth, 3) + " 1/s (" +
          (b.fastest_growth < 0 ? "stable" : "UNSTABLE") + ")\n";
  return text;
}

std::string PooledText(const FitResult& result) {
  const bool by_setting = !result.settings.empty();
  TextTable table({by_setting ? "setting" : "subject", "kg", "parameter", "value", "std error",
                   "95 % interval", "unit"},
                  {true, false, true, false, false, true, true});
  bool any = false;
  const auto add = [&](const std::string& unit, const std::string& mass,
                       const std::map<std::string, Estimate>& pooled) {
    for (const auto& [name, e] : pooled) {
      table.Add({unit, mass, name, Significant(e.value), Significant(e.standard_error, 3),
                 Interval(e.lower95, e.upper95), e.unit});
      any = true;
    }
  };
  for (const auto& [id, subject] : result.subjects) {
    add(id, Significant(subject.mass_kg), subject.pooled);
  }
  for (const auto& [setting, pooled] : result.settings) add(setting, "", pooled);
  return any ? table.ToString() + "\n" : "";
}

std::string WithError(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Significant(value, 3) + " +- " + Significant(error, 2);
}

std::string MeanText(const MeanScore& mean) {
  return Significant(mean.hip_ade, 3) + " +- " + Significant(mean.hip_ade_error, 2) + " / " +
         Significant(mean.hip_fde, 3) + " +- " + Significant(mean.hip_fde_error, 2);
}

}  // namespace

std::string Significant(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string ReportText(const FitResult& result) {
  const FitOptions& o = result.options;
  std::string text = "pushid " + result.version + ", preset " + o.preset + ": " +
                     Count(static_cast<int>(result.recordings.size()), "recording") + " (" +
                     result.setting + "), posture " + NameOf(o.model.posture) + ", push " +
                     NameOf(o.model.push) + ", push tail " + NameOf(o.model.push_tail) +
                     ", self force " + NameOf(o.self_force) + ", interaction " +
                     NameOf(o.model.interaction) + "\n\n";
  text += ParameterTableText(result) + HowSure(result) + "\n" + DerivedText(result) + "\n";
  for (const NullDirection& n : result.uncertainty.null_directions) {
    text += "unidentifiable: " + n.sentence + "\n";
  }
  text += CorrelationText(result);
  const std::string pooled = PooledText(result);
  text += (pooled.empty() ? "" : "\n") + pooled;
  text += BehaviourText(result) + "\n";
  text += "cost " + Significant(result.cost, 6) + " after " +
          Count(result.starts[result.best_start].iterations, "iteration") + " from " +
          Count(static_cast<int>(result.starts.size()), "start") + "; " +
          (result.converged ? "converged" : "NOT CONVERGED") + "\n";
  text += PreparationText(result.configuration);
  text += AcrossStartsText(result);
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  return text;
}

std::string EvaluationText(const Evaluation& evaluation, bool per_recording) {
  std::string text;
  if (per_recording) {
    TextTable table({"recording", "frames", "hipADE m", "hipFDE m", "static", "const velocity", ""},
                    {true, false, false, false, false, false, true});
    for (size_t i = 0; i < evaluation.model.recordings.size(); ++i) {
      const RecordingScore& r = evaluation.model.recordings[i];
      const bool ok = r.failure.empty();
      table.Add({r.id, std::to_string(r.frames), ok ? Significant(r.hip_ade, 3) : "-",
                 ok ? Significant(r.hip_fde, 3) : "-",
                 Significant(evaluation.static_baseline.recordings[i].hip_ade, 3),
                 Significant(evaluation.constant_velocity.recordings[i].hip_ade, 3), r.failure});
    }
    text += table.ToString() + "\n";
    if (evaluation.model.propagation.recordings > 0) {
      text += OnsetsText(evaluation.model.recordings) + "\n";
    }
  }
  TextTable table({"hipADE / hipFDE in m", "recordings", "model", "static", "constant velocity"},
                  {true, false, true, true, true});
  auto add = [&table](const std::string& name, const MeanScore& model, const MeanScore& still,
                      const MeanScore& velocity) {
    table.Add({name, std::to_string(model.recordings), MeanText(model), MeanText(still),
               MeanText(velocity)});
  };
  // Not a structured binding: a lambda below uses them, which C++17 has no words for.
  const ScoreSummary &m = evaluation.model, &s = evaluation.static_baseline,
                     &v = evaluation.constant_velocity;
  add("mean over recordings", m.mean, s.mean, v.mean);
  add("frame-weighted", m.frame_weighted, s.frame_weighted, v.frame_weighted);
  auto groups = [&](const char* what, const std::map<std::string, MeanScore> ScoreSummary::*by) {
    for (const auto& [name, mean] : m.*by) {
      add(what + name, mean, (s.*by).at(name), (v.*by).at(name));
    }
  };
  if (m.by_magnitude.size() > 1) groups("strength ", &ScoreSummary::by_magnitude);
  if (m.by_subject.size() > 1) groups("subject ", &ScoreSummary::by_subject);
  if (m.by_setting.size() > 1) groups("setting ", &ScoreSummary::by_setting);
  text += table.ToString();
  if (m.propagation.recordings == 0) return text;
  std::vector<PropagationColumn> columns = {{"model", &m.propagation}};
  if (m.propagation_by_setting.size() > 1) {
    for (const auto& [name, setting] : m.propagation_by_setting)
      columns.push_back({name, &setting});
  }
  columns.push_back({"constant velocity", &v.propagation});
  return text + "\n" + PropagationText(columns);
}

std::string CrossValidationText(const std::vector<CrossValidation>& rivals) {
  std::string text;
  if (rivals.empty()) return text;
  const bool groups = rivals[0].summary.propagation.recordings > 0;
  std::vector<std::string> header = {"fold", "held out", "hipADE m", "hipFDE m", "failed", "fell"};
  if (groups) header.insert(header.end(), {"onset error", "missed movers", "false movers"});
  std::vector<bool> left(header.size(), false);
  left[0] = true;
  TextTable folds(header, left);
  for (const FoldScore& fold : rivals[0].folds) {
    std::vector<std::string> row = {fold.name,
                                    std::to_string(fold.held_out),
                                    Significant(fold.hip_ade, 3),
                                    Significant(fold.hip_fde, 3),
                                    std::to_string(fold.failures),
                                    std::to_string(fold.falls)};
    if (groups) {
      const std::vector<std::string> cells = FoldPropagationCells(fold.propagation);
      row.insert(row.end(), cells.begin(), cells.end());
    }
    folds.Add(row);
  }
  text += folds.ToString() + "\n";
  TextTable table({"held out", "hipADE m", "hipFDE m", "frame-weighted",
                   "hipADE - " + rivals[0].predictor, "failed", "fell", "settle"},
                  {true, true, true, true, true, false, false, false});
  for (const CrossValidation& rival : rivals) {
    const MeanScore& mean = rival.summary.mean;
    const MeanScore& frames = rival.summary.frame_weighted;
    const PairedDifference difference = Compare(rivals[0], rival);
    const bool compared = &rival != &rivals[0] && difference.recordings > 0;
    table.Add({rival.predictor, WithError(mean.hip_ade, mean.hip_ade_error, mean),
               WithError(mean.hip_fde, mean.hip_fde_error, mean),
               Significant(frames.hip_ade, 3) + " / " + Significant(frames.hip_fde, 3),
               compared ? Significant(difference.hip_ade, 2) + " +- " +
                              Significant(difference.hip_ade_error, 2)
                        : "",
               std::to_string(rival.failures), std::to_string(rival.falls),
               rival.fits > 0 ? std::to_string(rival.settling) + " of " + std::to_string(rival.fits)
                              : ""});
  }
  text += table.ToString();
  if (!groups) return text;
  std::vector<PropagationColumn> columns;
  for (const CrossValidation& rival : rivals) {
    columns.push_back({rival.predictor, &rival.summary.propagation});
  }
  return text + "\n" + PropagationText(columns);
}

}  // namespace pushid
