// ident: evaluations and cross-validations in words and tables.
#include "ident/validation/scores_text.h"

#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

// A single recording has no error.
std::string WithError(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Rounded(value, 3) + (mean.recordings > 1 ? " +- " + Rounded(error, 2) : "");
}

std::string MeanText(const MeanScore& mean) {
  return WithError(mean.hip_ade, mean.hip_ade_error, mean) + " / " +
         WithError(mean.hip_fde, mean.hip_fde_error, mean);
}

}  // namespace

std::string EvaluationText(const Evaluation& evaluation, bool per_recording) {
  std::string text;
  if (per_recording) {
    TextTable table({"recording", "frames", "hipADE m", "hipFDE m", "static", "const velocity", ""},
                    {true, false, false, false, false, false, true});
    for (size_t i = 0; i < evaluation.model.recordings.size(); ++i) {
      const RecordingScore& r = evaluation.model.recordings[i];
      const bool ok = r.failure.empty();
      table.Add({r.id, std::to_string(r.frames), ok ? Rounded(r.hip_ade, 3) : "-",
                 ok ? Rounded(r.hip_fde, 3) : "-",
                 Rounded(evaluation.static_baseline.recordings[i].hip_ade, 3),
                 Rounded(evaluation.constant_velocity.recordings[i].hip_ade, 3), r.failure});
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
  const char* subject = m.propagation.recordings > 0 ? "pushed person " : "subject ";
  if (m.by_subject.size() > 1) groups(subject, &ScoreSummary::by_subject);
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

namespace {

// One honest sentence on two configurations.
std::string ConclusionText(const PairedDifference& d) {
  if (d.recordings == 0) return d.b + " cannot be compared with " + d.a + ".";
  const std::string by =
      Rounded(std::abs(d.hip_ade), 2) + " +- " + Rounded(d.hip_ade_error, 2) + " m of hipADE";
  if (std::abs(d.hip_ade) <= d.hip_ade_error) {
    return d.b + " is not distinguishable from " + d.a + " (" + by + ").";
  }
  const std::string surely = std::abs(d.hip_ade) > 2.0 * d.hip_ade_error
                                 ? ""
                                 : ", more than one standard error but less than two";
  return d.b + " predicts " + (d.hip_ade < 0.0 ? "better" : "worse") + " than " + d.a + " by " +
         by + surely + ".";
}

}  // namespace

std::string CrossValidationText(const std::vector<CrossValidation>& candidates) {
  std::string text;
  if (candidates.empty()) return text;
  const bool groups = candidates[0].summary.propagation.recordings > 0;
  std::vector<std::string> header = {"fold", "held out", "hipADE m", "hipFDE m", "failed", "fell"};
  if (groups) header.insert(header.end(), {"onset error", "missed movers", "false movers"});
  std::vector<bool> left(header.size(), false);
  left[0] = true;
  TextTable folds(header, left);
  for (const FoldScore& fold : candidates[0].folds) {
    std::vector<std::string> row = {fold.name,
                                    std::to_string(fold.held_out),
                                    Rounded(fold.hip_ade, 3),
                                    Rounded(fold.hip_fde, 3),
                                    std::to_string(fold.failures),
                                    std::to_string(fold.falls)};
    if (groups) {
      const std::vector<std::string> cells = FoldPropagationCells(fold.propagation);
      row.insert(row.end(), cells.begin(), cells.end());
    }
    folds.Add(row);
  }
  text += folds.ToString() + "\n";
  TextTable table(
      {"held out", "hipADE m", "hipFDE m", "frame-weighted", "hipADE - " + candidates[0].predictor,
       "failed", "fell", "fell harder", "settle", groups ? "harder, farther" : ""},
      {true, true, true, true, true, false, false, false, false, false});
  const auto folds_that = [](int number, const CrossValidation& candidate) {
    return candidate.fits > 0 ? std::to_string(number) + " of " + std::to_string(candidate.fits)
                              : "";
  };
  for (const CrossValidation& candidate : candidates) {
    const MeanScore& mean = candidate.summary.mean;
    const MeanScore& frames = candidate.summary.frame_weighted;
    const PairedDifference difference = Compare(candidates[0], candidate);
    const bool compared = &candidate != &candidates[0] && difference.recordings > 0;
    table.Add({candidate.predictor, WithError(mean.hip_ade, mean.hip_ade_error, mean),
               WithError(mean.hip_fde, mean.hip_fde_error, mean),
               Rounded(frames.hip_ade, 3) + " / " + Rounded(frames.hip_fde, 3),
               compared
                   ? Rounded(difference.hip_ade, 2) + " +- " + Rounded(difference.hip_ade_error, 2)
                   : "",
               std::to_string(candidate.failures), std::to_string(candidate.falls),
               candidate.fits > 0 ? std::to_string(candidate.falls_harder) : "",
               folds_that(candidate.settling, candidate),
               groups ? folds_that(candidate.harder_farther, candidate) : ""});
  }
  text += table.ToString() +
          "fell harder: when pushed 1.4 times as hard, until 40 frames past the recording's end\n";
  for (size_t i = 1; i < candidates.size(); ++i) {
    text += ConclusionText(Compare(candidates[0], candidates[i])) + "\n";
  }
  if (!groups) return text;
  std::vector<PropagationColumn> columns;
  for (const CrossValidation& candidate : candidates) {
    columns.push_back({candidate.predictor, &candidate.summary.propagation});
  }
  return text + "\n" + PropagationText(columns);
}

}  // namespace pushid
