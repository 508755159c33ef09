// apps: people who stand, in Python: frequency responses and loops.
#include "apps/python/bindings.h"
#include "ident/prediction/frequency_response.h"

namespace pushid {
namespace {

// A column of the bins as an array.
template <typename Row, typename Value>
Array Column(const std::vector<Row>& rows, Value value) {
  Array array(static_cast<py::ssize_t>(rows.size()));
  auto cells = array.mutable_unchecked<1>();
  for (size_t i = 0; i < rows.size(); ++i) cells(i) = value(rows[i]);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::dict ResponseDict(const FrequencyResponse& response) {
  const auto column = [&response](auto value) { return Column(response.bins, value); };
  py::dict dict;
  dict["name"] = response.Name();
  dict["input_unit"] = response.InputUnit();
  dict["output_unit"] = response.OutputUnit();
  dict["persons"] = response.people;
  dict["recordings"] = response.recordings;
  dict["frequency"] = column([](const FrequencyBin& bin) { return bin.hz; });
  dict["gain"] = column([](const FrequencyBin& bin) { return std::exp(bin.log_gain); });
  dict["log_gain_error"] = column([](const FrequencyBin& bin) { return bin.log_gain_error; });
  dict["phase"] = column([](const FrequencyBin& bin) { return bin.phase; });
  dict["phase_error"] = column([](const FrequencyBin& bin) { return bin.phase_error; });
  dict["coherence"] = column([](const FrequencyBin& bin) { return bin.coherence; });
  dict["people"] = column([](const FrequencyBin& bin) { return double(bin.people); });
  if (response.model.hz.empty()) return dict;
  dict["model_gain"] = column([](const FrequencyBin& bin) { return std::exp(bin.model_log_gain); });
  dict["model_phase"] = column([](const FrequencyBin& bin) { return bin.model_phase; });
  return dict;
}

py::dict ResponsesOf(const Model& model, const std::vector<SharedRecording>& recordings) {
  const IdentifiedModel identified = IdentifiedOf(model);
  const auto responses =
      WithoutGil([&] { return FrequencyResponses(identified, Pendulums(recordings)); });
  py::dict dict;
  for (const FrequencyResponse& response : responses) {
    // Recordings whose segments last differently long are apart.
    std::string key = response.Key();
    for (int i = 2; dict.contains(key); ++i) key = response.Key() + "_" + std::to_string(i);
    dict[py::str(key)] = ResponseDict(response);
  }
  return dict;
}

py::dict LoopDict(const Model& model, double mass, double rod) {
  if (!(mass > 0.0) || !(rod > 0.0)) Raise(Fault::kUsage, Error{"mass and rod must be above 0"});
  const IdentifiedModel identified = IdentifiedOf(model);
  const std::string without = WithoutLinearLoop(identified.options);
  if (!without.empty()) Raise(Fault::kUsage, Error{"the model has no linear loop: " + without});
  py::dict dict;
  for (int plane = 0; plane < 2; ++plane) {
    const LoopNumbers n =
        LinearLoop(identified.options, {mass, rod, 0.0}, identified.parameters, plane).Numbers();
    py::dict loop;
    loop["stiffness_ratio"] = n.stiffness_ratio;
    loop["stable"] = n.stable;
    loop["fastest_growth"] = n.fastest_growth;
    loop["damping_ratio"] = n.damping_ratio;
    loop["natural_hz"] = n.natural_hz;
    loop["phase_margin"] = n.phase_margin;
    loop["delay_margin"] = n.delay_margin;
    loop["crossover_hz"] = n.crossover_hz;
    loop["gain_up"] = n.gain_up;
    loop["gain_down"] = n.gain_down;
    dict[plane == 0 ? "theta" : "phi"] = loop;
  }
  return dict;
}

}  // namespace

void BindStanding(py::module_* module) {
  module->def("frequency_response", &ResponsesOf);
  module->def("loop", &LoopDict);
}

}  // namespace pushid
