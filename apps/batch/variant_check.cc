// apps: asking pushid-fit about flags.
#include "apps/batch/variant_check.h"

#include <algorithm>
#include <cstdio>

#include "apps/support/child_process.h"

namespace pushid {
namespace {

// The last line on stderr of a command that fails, without the name of who says it; nothing when
// it does not fail.
std::string ComplaintOf(const std::vector<std::string>& command) {
  std::FILE* pipe = popen((ShellText(command) + " 2>&1 >/dev/null").c_str(), "r");
  if (pipe == nullptr) return command[0] + " cannot be started";
  std::string last = command[0] + " fails", text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\n') {
      text += static_cast<char>(c);
    } else if (!text.empty()) {
      last = std::exchange(text, "");
    }
  }
  if (pclose(pipe) == 0) return "";
  for (const std::string who : {"pushid-fit: error: ", "ERROR: "}) {
    if (last.rfind(who, 0) == 0) return last.substr(who.size());
  }
  return last;
}

}  // namespace

MaybeError CheckVariants(const BatchPlan& plan, const std::vector<BatchJob>& jobs,
                         const std::string& bin) {
  for (const BatchVariant& variant : plan.variants) {
    const bool wanted = std::any_of(jobs.begin(), jobs.end(), [&variant](const BatchJob& job) {
      return job.variant == variant.name;
    });
    if (!wanted) continue;
    std::vector<std::string> command = {bin + "/pushid-fit", "--check"};
    command.insert(command.end(), variant.flags.begin(), variant.flags.end());
    const std::string complaint = ComplaintOf(command);
    if (complaint.empty()) continue;
    return Error{"variant '" + variant.name + "': " + complaint, plan.path, variant.line};
  }
  return std::nullopt;
}

}  // namespace pushid
