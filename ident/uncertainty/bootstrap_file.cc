// ident: reading and writing finished replicas, a line of JSON each.
#include "ident/uncertainty/bootstrap_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_problem.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// Two runs with the same header find the same replicas.
std::string Header(const FitProblem& problem, const Bootstrap& bootstrap) {
  ContentHash fit;
  fit.Add(SettingsJson(problem.options()).dump());
  for (const PendulumRecording& recording : problem.recordings()) {
    fit.Add(recording.id + "\n" + recording.content_hash + "\n");
  }
  const Json header = {{"format", "pushid bootstrap"},
                       {"seed", bootstrap.seed},
                       {"drawn_by", NameOf(bootstrap.drawn_by)},
                       {"fit", fit.Hex()},
                       {"names", bootstrap.names}};
  return header.dump();
}

// False for a line that no run wrote whole.
bool ReadValues(const Json& row, ReplicaValues* values) {
  if (!row["replica"].is_number_integer() || !row["values"].is_array()) return false;
  for (const Json& value : row["values"]) {
    if (!value.is_number()) return false;
    values->push_back(value.get<double>());
  }
  return true;
}

// Of the system; streams do not keep it.
std::string Reason() { return errno != 0 ? std::strerror(errno) : "unknown reason"; }

std::string Line(int replica, const ReplicaValues& values) {
  return Json{{"replica", replica}, {"values", values}}.dump();
}

}  // namespace

MaybeError BootstrapFile::Open(const FitProblem& problem, const BootstrapOptions& options,
                               const Bootstrap& bootstrap) {
  path_ = options.file;
  if (path_.empty()) return std::nullopt;
  const std::string header = Header(problem, bootstrap);
  std::string kept = header + "\n";
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored)) {
    errno = 0;
    std::ifstream old(path_, std::ios::binary);
    if (!old) return Error{"cannot be read: " + Reason() + "; its replicas would be lost", path_};
    std::string line;
    if (std::getline(old, line) && line != header) {
      return Error{
          "this file belongs to a bootstrap with another fit, seed, resampling or data; give "
          "another one with --bootstrap_file, or delete it",
          path_};
    }
    while (std::getline(old, line)) {
      const Json row = Json::parse(line, nullptr, false);
      if (!row.is_object() || !row.contains("replica") || !row.contains("values")) break;
      ReplicaValues values;
      if (!ReadValues(row, &values)) break;
      if (!values.empty() && values.size() != bootstrap.names.size()) break;
      finished_[row["replica"].get<int>()] = values;
      kept += line + "\n";
    }
    if (old.bad()) return Error{"cannot be read to its end: " + Reason(), path_};
  }
  if (MaybeError error = WriteFileAtomically(path_, kept)) return error;
  errno = 0;
  stream_.open(path_, std::ios::binary | std::ios::app);
  if (!stream_) return Error{"cannot be written: " + Reason(), path_};
  return std::nullopt;
}

MaybeError BootstrapFile::Append(int replica, const ReplicaValues& values) {
  if (path_.empty()) return std::nullopt;
  errno = 0;
  stream_ << Line(replica, values) << "\n" << std::flush;
  if (stream_) return std::nullopt;
  return Error{"replica " + std::to_string(replica) + " cannot be written: " + Reason() +
                   "; free some disk space and run the same command to continue",
               path_};
}

}  // namespace pushid
