// Models and interaction networks in JSON: what is read can be reported and read again.
#include "ident/network_json.h"
#include "ident/report_text.h"
#include "ident/result_json.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuSecond limit;
  const std::string& path = file.Fill(data, size);
  const Result<FitResult> model = ReadFitResult(path);
  if (model.ok()) Demand(!ReportText(model.value()).empty());
  (void)ReadInteractionNetwork(path);
  return 0;
}
