// apps: reading a job's files.
#include "apps/batch/batch_results.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "datasets/files/json_file.h"
#include "ident/results/json_pieces.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// Throws what is wrong with it.
Json ReadWhole(const std::string& path) {
  Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) throw std::runtime_error(document.error().ToString());
  return std::move(document.value().content);
}

void AddModel(const Json& model, JobResult* result) {
  for (const Json& parameter : model.at("parameters")) {
    if (parameter.at("status") == "fixed") continue;
    const std::string name = parameter.at("name");
    result->parameters[name] = NumberFrom(parameter.at("value"));
    result->errors[name] = NumberFrom(parameter.at("standard_error"));
  }
  result->cost = NumberFrom(model.at("fit").at("cost"));
  result->warnings = model.at("warnings").get<std::vector<std::string>>();
  result->settles = model.at("behaviour").at("settles");
  result->solve_s = NumberFrom(model.at("run").at("solve_seconds"));
}

// The table shows nothing of a job whose files are not whole.
JobResult Failed(const BatchJob& job, const std::string& reason, double seconds) {
  JobResult result;
  result.job = &job;
  result.status = "failed";
  result.reason = reason;
  result.seconds = seconds;
  return result;
}

}  // namespace

std::string JobFolder(const BatchPlan& plan, const BatchJob& job) {
  return plan.dir + "/jobs/" + job.id;
}

JobResult ReadResult(const BatchPlan& plan, const BatchJob& job) {
  JobResult result;
  result.job = &job;
  const std::string folder = JobFolder(plan, job);
  std::error_code ignored;
  if (!std::filesystem::exists(folder + "/status.json", ignored)) {
    result.status = "open";
    return result;
  }
  std::string file = "status.json";
  try {
    const Json status = ReadWhole(folder + "/" + file);
    result.seconds = status.at("run").at("seconds");
    if (status.at("status") != "done") return Failed(job, status.at("reason"), result.seconds);
    file = "model.json";
    AddModel(ReadWhole(folder + "/" + file), &result);
    if (!job.held_out.empty()) {
      file = "scores.json";
      const Json scores = ReadWhole(folder + "/" + file);
      result.hip_ade = NumberFrom(scores.at("mean").at("hipADE_m"));
      result.hip_fde = NumberFrom(scores.at("mean").at("hipFDE_m"));
    }
    result.status = "done";
    return result;
  } catch (const Json::exception& error) {
    return Failed(job, folder + "/" + file + ": is not what this version writes: " + error.what(),
                  result.seconds);
  } catch (const std::exception& error) {
    return Failed(job, error.what(), result.seconds);
  }
}

}  // namespace pushid
