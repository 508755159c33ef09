// TOML: plans of pushid-batch. What is read has all that a batch needs.
#include "apps/batch/batch.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const Result<BatchPlan> read = ReadPlan(file.Fill(data, size));
  if (!read.ok()) {
    Demand(!read.error().ToString().empty());
    return 0;
  }
  const BatchPlan& plan = read.value();
  Demand(!plan.manifest.empty() && !plan.dir.empty() && !plan.variants.empty());
  Demand(plan.folds >= 0 && plan.folds != 1 && plan.bootstrap >= 0);
  Demand(plan.time_limit_s >= 0.0);
  for (const BatchVariant& variant : plan.variants) Demand(!variant.name.empty());
  return 0;
}
