// apps: fitted models as files that say what made them.
#include "apps/flags/model_file.h"

#include <ctime>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/manifest/select_recordings.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

std::string Today() {
  char text[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace

Provenance ProvenanceOfRun() {
  Provenance from;
  from.version = Version();
  from.configuration = EffectiveFlags();
  // Where the data lay is no part of what was found; the hash is.
  from.configuration.erase("recordings");
  from.changed_flags = ChangedFlags();
  const RecordingFlags flags = RecordingFlagsFromCommandLine();
  from.manifest = flags.manifest;
  from.setting = flags.setting;
  const Result<std::string> hash = HashManifests(flags.manifest);
  if (hash.ok()) from.manifest_hash = hash.value();
  return from;
}

MaybeError WriteModelFile(const std::string& path, const FittedModel& model, int num_threads,
                          double begin) {
  RunInfo run;
  run.date = Today();
  run.host = HostName();
  run.model_path = path;
  run.num_threads = num_threads;
  run.total_seconds = Now() - begin;
  return WriteJson(path, ToJson(model, run));
}

}  // namespace pushid
