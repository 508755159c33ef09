// Models and interaction networks in JSON: what is read can be reported, written and read again.
#include "datasets/files/json_file.h"
#include "ident/model/model_json.h"
#include "ident/report/report_text.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pushid;
  static MemoryFile file;
  const CpuLimit limit;
  const std::string& path = file.Fill(data, size);
  const Result<FittedModel> model = ReadFittedModel(path);
  if (model.ok()) {
    Demand(!ScreenOf(model.value()).ToString().empty());
    const auto written = ToJson(model.value(), RunInfo{});
    const Result<FittedModel> again = FittedModelFromJson(written, "written");
    Demand(again.ok() && ToJson(again.value(), RunInfo{}).dump() == written.dump());
  }
  return 0;
}
