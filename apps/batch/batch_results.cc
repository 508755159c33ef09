// apps: reading a job's files.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/batch/batch.h"
#include "datasets/files/json_fields.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/model/model_json.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

void AddModel(const FitResult& fit, JobResult* result) {
  for (const Estimate& estimate : fit.estimates) {
    if (estimate.status == EstimateStatus::kFixed) continue;
    result->parameters[estimate.name] = estimate.value;
    result->errors[estimate.name] = estimate.standard_error;
    result->statuses[estimate.name] = estimate.status;
    result->data_shares[estimate.name] = estimate.shares.data;
  }
  result->cost = fit.cost;
  for (const Warning& warning : fit.warnings) result->warnings.push_back(warning.text);
  result->settles = fit.behaviour.settles;
  result->solve_s = fit.solve_seconds;
}

// The table shows nothing of a job whose files are not whole.
JobResult Failed(const BatchJob& job, const std::string& reason, double seconds) {
  JobResult result;
  result.job = &job;
  result.status = {JobState::kFailed, reason, seconds};
  return result;
}

Result<std::vector<HeldOutScore>> ReadHeldOut(const std::string& path, bool bodies) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  const Result<ScoreSummary> hips = ScoresFromJson(document.value().content, path);
  if (!hips.ok()) return hips.error();
  std::vector<HeldOutScore> scores;
  if (!bodies) {
    for (const HipMetric& metric : kHipMetrics) {
      scores.push_back({metric, hips.value().mean.*metric.value});
    }
    return scores;
  }
  const Result<BodyMetrics> restored = MeanBodyMetrics(document.value().content, path);
  if (!restored.ok()) return restored.error();
  for (int m = 0; m < kNumBodyMetrics; ++m) {
    scores.push_back({kBodyMetrics[m], restored.value()[m]});
  }
  return scores;
}

}  // namespace

const double* JobResult::HeldOut(const Metric& metric) const {
  const auto at = std::find_if(held_out.begin(), held_out.end(), [&metric](const auto& score) {
    return score.metric.Key() == metric.Key();
  });
  return at == held_out.end() ? nullptr : &at->value;
}

std::vector<Metric> HeldOutMetrics(const std::vector<JobResult>& rows) {
  std::vector<Metric> metrics;
  for (const JobResult& row : rows) {
    for (const HeldOutScore& score : row.held_out) {
      const bool known = std::any_of(metrics.begin(), metrics.end(), [&score](const Metric& m) {
        return m.Key() == score.metric.Key();
      });
      if (!known) metrics.push_back(score.metric);
    }
  }
  return metrics;
}

std::string JobFolder(const BatchPlan& plan, const BatchJob& job) {
  return plan.dir + "/jobs/" + job.id;
}

JobResult ReadResult(const BatchPlan& plan, const BatchJob& job) {
  const std::string folder = JobFolder(plan, job);
  const Result<JobStatus> status = ReadJobStatus(folder);
  if (!status.ok()) return Failed(job, status.error().ToString(), 0.0);
  const double seconds = status.value().seconds;
  JobResult result;
  result.job = &job;
  result.status = status.value();
  if (!result.done()) return result;
  const Result<FittedModel> model = ReadFittedModel(folder + "/model.json");
  if (!model.ok()) return Failed(job, model.error().ToString(), seconds);
  AddModel(model.value().fit, &result);
  if (job.held_out.empty()) return result;
  auto scores = ReadHeldOut(folder + "/scores.json", job.restoration_flags.has_value());
  if (!scores.ok()) return Failed(job, scores.error().ToString(), seconds);
  result.held_out = std::move(scores.value());
  return result;
}

namespace {

std::string StatusFile(const std::string& folder) { return folder + "/status.json"; }

}  // namespace

MaybeError WriteJobStatus(const std::string& folder, const BatchJob& job, const JobStatus& status,
                          const std::vector<std::vector<std::string>>& commands) {
  const nlohmann::ordered_json json = {
      {"schema", "pushid-job/1"}, {"id", job.id},           {"variant", job.variant},
      {"group", job.group},       {"replica", job.replica}, {"status", NameOf(status.state)},
      {"reason", status.reason},  {"commands", commands},   {"run", {{"seconds", status.seconds}}}};
  return WriteJson(StatusFile(folder), json);
}

Result<JobStatus> ReadJobStatus(const std::string& folder) {
  JobStatus status;
  std::error_code ignored;
  if (!std::filesystem::exists(StatusFile(folder), ignored)) return status;
  const Result<JsonDocument> read = ReadJsonDocument(StatusFile(folder));
  if (!read.ok()) return read.error();
  const JsonDocument& document = read.value();
  JsonFields fields(document, document.content, "", "status");
  fields.Require("status", "done or failed");
  status.state = fields.Choice("status", JobState::kFailed);
  status.reason = fields.Text("reason", "why the job failed");
  if (fields.Require("run", "an object with the seconds")) {
    JsonFields run(document, fields.At("run"), fields.Pointer("run"), "status, run");
    status.seconds = run.Number("seconds", "how long the job took");
    fields.Add(run);
  }
  if (fields.failed()) return *fields.error();
  return status;
}

}  // namespace pushid
