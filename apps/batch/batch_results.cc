// apps: reading a job's files.
#include "apps/batch/batch_results.h"

#include "ident/results/result_json.h"
#include "ident/validation/scores_json.h"

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
  result->warnings = fit.warnings;
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

}  // namespace

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
  const Result<ScoreSummary> scores = ReadScores(folder + "/scores.json");
  if (!scores.ok()) return Failed(job, scores.error().ToString(), seconds);
  result.held_out = scores.value().mean;
  return result;
}

}  // namespace pushid
