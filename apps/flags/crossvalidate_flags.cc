// apps: the flags of pushid-crossvalidate alone.
#include "apps/flags/crossvalidate_flags.h"

#include <gflags/gflags.h>

#include <sstream>

#include "apps/flags/command_line.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::CrossvalidateFlags kDefaults;
}

DEFINE_string(scheme, pushid::NameOf(kDefaults.scheme),
              "what is held out: stratified (folds by setting, strength and subject), interleaved "
              "(recordings of a setting assigned to folds in turn), subject or setting (one at a "
              "time), strong (all strong pushes)");
DEFINE_int32(folds, kDefaults.folds, "folds of the stratified and the interleaved scheme");
DEFINE_string(folds_file, "",
              "file with the folds, instead of --scheme: JSON, {\"folds\": [{\"name\": \"1\", "
              "\"held_out\": [ids]}]}; all other recordings are fitted");
DEFINE_int32(repeats, kDefaults.repeats, "repeats of the stratified scheme, each with new folds");
DEFINE_string(compare, "",
              "further candidates, semicolon-separated: name: --flag=value ... added to the flags "
              "given, as in 'pd: --preset=ldp; linear: --self_force=linear'");
DEFINE_bool(yardsticks, kDefaults.baselines,
            "also score the baselines: static, constant velocity and ridge regression");
DEFINE_string(frontier_out, "",
              "plot accuracy against settling, one point per configuration, here (SVG)");
DEFINE_bool(bands, kDefaults.bands,
            "also score how often predictive 50 and 90 % bands contain the held-out recordings");
DEFINE_string(json_out, "", "write the scores here (JSON)");

namespace pushid {
namespace {

MaybeError ReadCandidates(const std::string& text, CrossvalidateFlags* flags) {
  std::stringstream list(text);
  for (std::string item; std::getline(list, item, ';');) {
    const std::string trimmed(Trimmed(item));
    if (trimmed.empty()) continue;
    const size_t colon = trimmed.find(':');
    const std::string name(Trimmed(trimmed.substr(0, colon)));
    if (colon == std::string::npos || name.empty()) {
      return Error{"--compare: '" + trimmed + "' is not 'name: --flag=value ...'"};
    }
    const Result<GivenOptions> options = ParseOptionWords(trimmed.substr(colon + 1));
    if (!options.ok()) return Error{"--compare, '" + name + "': " + options.error().message};
    flags->candidates.emplace_back(name, options.value());
  }
  return std::nullopt;
}

}  // namespace

Result<CrossvalidateFlags> CrossvalidateFlagsFromCommandLine() {
  CrossvalidateFlags flags;
  if (MaybeError error = ParseName("--scheme", FLAGS_scheme, &flags.scheme)) return *error;
  for (const char* one : {"scheme", "folds", "repeats"}) {
    if (FLAGS_folds_file.empty() || !Given(one)) continue;
    return Error{std::string("--folds_file already gives the folds; leave --") + one + " out"};
  }
  if (MaybeError error = ReadCandidates(FLAGS_compare, &flags)) return *error;
  flags.folds_file = FLAGS_folds_file;
  flags.folds = FLAGS_folds;
  flags.repeats = FLAGS_repeats;
  flags.baselines = FLAGS_yardsticks;
  flags.frontier_out = FLAGS_frontier_out;
  flags.json_out = FLAGS_json_out;
  flags.bands = FLAGS_bands;
  return flags;
}

}  // namespace pushid
