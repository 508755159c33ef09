// apps: asking programs about flags.
#include "apps/batch/variant_check.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

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
  const std::string program = std::filesystem::path(command[0]).filename().string();
  for (const std::string& who : {program + ": error: ", std::string("ERROR: ")}) {
    if (last.rfind(who, 0) == 0) return last.substr(who.size());
  }
  return last;
}

MaybeError CheckRestoration(const BatchPlan& plan, const BatchVariant& variant,
                            const std::string& bin) {
  const std::string trainer = bin + "/pushid-train-restoration";
  const auto wrong = [&](const std::string& what) {
    return Error{"variant '" + variant.name + "': " + what, plan.path, variant.restoration_line};
  };
  std::error_code ignored;
  if (!std::filesystem::exists(trainer, ignored)) {
    return wrong("a restoration needs " + trainer + ", which is only built with LibTorch");
  }
  // Which model and where to is said by each job.
  std::vector<std::string> command = {trainer, "--check", "--model=model.json",
                                      "--out=restoration"};
  command.insert(command.end(), variant.restoration->begin(), variant.restoration->end());
  const std::string complaint = ComplaintOf(command);
  if (complaint.empty()) return std::nullopt;
  return wrong(complaint);
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
    if (!complaint.empty()) {
      return Error{"variant '" + variant.name + "': " + complaint, plan.path, variant.line};
    }
    if (!variant.restoration) continue;
    if (MaybeError error = CheckRestoration(plan, variant, bin)) return error;
  }
  return std::nullopt;
}

}  // namespace pushid
