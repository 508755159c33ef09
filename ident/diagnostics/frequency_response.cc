// ident: measured frequency responses, person by person.
#include "ident/diagnostics/frequency_response.h"

#include <cmath>
#include <map>
#include <tuple>

#include "ident/diagnostics/spectra.h"
#include "ident/problem/own_axes.h"

namespace pushid {
namespace {

constexpr double kShortestRecording = 10.0;  // s
constexpr double kSameDuration = 0.005;      // of segments
constexpr int kCurvePoints = 120;

// One person under one kind of disturbance: spectra, and the closed form.
struct PersonSpectra {
  CrossSpectra spectra;
  std::optional<LinearLoop> loop;
  double lever = 0.0;
  bool by_plates = false;
};

struct Group {
  bool periodic = false;
  int recordings = 0;
  double segment_s = 0.0;
  std::map<std::string, PersonSpectra> people;  // by subject
};

using GroupKey = std::tuple<Disturbance, int, LoopOutput>;

std::complex<double> ModelAt(const PersonSpectra& person, const GroupKey& key, double hz) {
  const auto& [input, plane, output] = key;
  const LoopAnswer answer = person.loop->Answer(input, hz, person.lever);
  return output == LoopOutput::kAngle ? answer.angle : answer.torque;
}

// Means of log gains, and of phases about that of their sum.
struct MeanResponse {
  std::vector<double> log_gain, phase;
  std::complex<double> directions = 0.0;

  void Add(const std::complex<double>& response) {
    log_gain.push_back(std::log(std::abs(response)));
    phase.push_back(std::arg(response));
    directions += response / std::abs(response);
  }
  double Phase() const {
    const double middle = std::arg(directions);
    double sum = 0.0;
    for (double one : phase) sum += std::remainder(one - middle, 2.0 * M_PI);
    return std::remainder(middle + sum / static_cast<double>(phase.size()), 2.0 * M_PI);
  }
  double LogGain() const {
    double sum = 0.0;
    for (double one : log_gain) sum += one;
    return sum / static_cast<double>(log_gain.size());
  }
  // From one to the next; of at least two.
  double Error(const std::vector<double>& values, double mean, bool wraps) const {
    double sum = 0.0;
    for (double one : values) {
      const double off = wraps ? std::remainder(one - mean, 2.0 * M_PI) : one - mean;
      sum += off * off;
    }
    const double n = static_cast<double>(values.size());
    return std::sqrt(sum / (n - 1.0) / n);
  }
};

// all: everybody's spectra, by which a bin is taken or left: to take those people alone whose
// coherence is high would take those whose noise happens to be along their answer.
std::optional<FrequencyBin> BinOf(const Group& group, const GroupKey& key, const CrossSpectra& all,
                                  int bin) {
  if (!IsCoherent(all, bin)) return std::nullopt;
  FrequencyBin result;
  result.hz = bin * all.step_hz;
  result.coherence = all.Coherence(bin);
  MeanResponse measured, model;
  double error = 0.0;
  for (const auto& [name, person] : group.people) {
    const CrossSpectra& spectra = person.spectra;
    error = spectra.RelativeError(bin);
    measured.Add(spectra.Response(bin));
    if (person.loop) model.Add(ModelAt(person, key, result.hz));
    ++result.people;
  }
  result.log_gain = measured.LogGain();
  result.phase = measured.Phase();
  result.log_gain_error = result.phase_error = error;
  if (result.people > 1) {
    result.log_gain_error = measured.Error(measured.log_gain, result.log_gain, false);
    result.phase_error = measured.Error(measured.phase, result.phase, true);
  }
  if (!model.phase.empty()) {
    result.model_log_gain = model.LogGain();
    result.model_phase = model.Phase();
  }
  return result;
}

FrequencyCurve CurveOf(const Group& group, const GroupKey& key, double from, double to) {
  FrequencyCurve curve;
  for (const auto& [name, person] : group.people) {
    if (!person.loop) return curve;
  }
  for (int i = 0; i < kCurvePoints; ++i) {
    const double hz = from * std::pow(to / from, i / (kCurvePoints - 1.0));
    MeanResponse mean;
    for (const auto& [name, person] : group.people) mean.Add(ModelAt(person, key, hz));
    curve.hz.push_back(hz);
    curve.log_gain.push_back(mean.LogGain());
    curve.phase.push_back(mean.Phase());
  }
  return curve;
}

FrequencyResponse ResponseOf(const Group& group, const GroupKey& key) {
  FrequencyResponse response;
  std::tie(response.input, response.plane, response.output) = key;
  response.periodic = group.periodic;
  response.recordings = group.recordings;
  response.segment_s = group.segment_s;
  CrossSpectra all;  // whose input has the power
  for (const auto& [name, person] : group.people) {
    response.people.push_back(name);
    response.by_plates = response.by_plates || person.by_plates;
    all.Add(person.spectra);
  }
  for (int bin : BinsWithPower(all, group.periodic)) {
    if (const auto one = BinOf(group, key, all, bin)) response.bins.push_back(*one);
  }
  if (response.bins.empty()) return response;
  response.model = CurveOf(group, key, response.bins.front().hz, response.bins.back().hz);
  return response;
}

class Gathering {
 public:
  explicit Gathering(const ModelOptions& options)
      : options_(options), has_loop_(WithoutLinearLoop(options).empty()) {}

  void Add(const PendulumRecording& recording,
           const std::vector<ParameterSet<double>>& parameters) {
    if ((recording.num_frames() - 1) * recording.scene.dt < kShortestRecording) return;
    const std::optional<ContinuousInput> input = ContinuousInputOf(recording);
    if (!input) return;
    const Segmenting segments = SegmentsOf(input->series, recording.scene.dt);
    if (segments.frames == 0) return;
    for (int n = 0; n < recording.num_people(); ++n) {
      if (input->kind == Disturbance::kForce && n != input->person) continue;
      for (LoopOutput output : {LoopOutput::kAngle, LoopOutput::kTorque}) {
        AddOutput(recording, parameters[n], n, *input, segments, output);
      }
    }
  }

  std::vector<FrequencyResponse> Responses() const {
    std::vector<FrequencyResponse> responses;
    for (const auto& [key, groups] : groups_) {
      for (const Group& group : groups) {
        responses.push_back(ResponseOf(group, key));
        if (responses.back().bins.empty()) responses.pop_back();
      }
    }
    return responses;
  }

 private:
  // The group of segments that last as long.
  Group& GroupFor(const GroupKey& key, const Segmenting& segments, double seconds) {
    for (Group& group : groups_[key]) {
      if (group.periodic == segments.periodic &&
          std::abs(group.segment_s - seconds) < kSameDuration * seconds) {
        return group;
      }
    }
    groups_[key].push_back({segments.periodic, 0, seconds, {}});
    return groups_[key].back();
  }

  void AddOutput(const PendulumRecording& recording, const ParameterSet<double>& p, int n,
                 const ContinuousInput& input, const Segmenting& segments, LoopOutput output) {
    const double dt = recording.scene.dt;
    const GroupKey key{input.kind, input.plane, output};
    Group& group = GroupFor(key, segments, segments.frames * dt);
    const bool plates = output == LoopOutput::kTorque && recording.HasPlates(n);
    const std::vector<double> series = OutputSeries(recording, n, input.plane, output, options_, p);
    PersonSpectra& person = group.people[recording.subject_ids[n]];
    person.spectra.Add(CrossSpectraOf(input.series, series, segments, dt));
    person.by_plates = person.by_plates || plates;
    person.lever = input.lever;
    if (has_loop_) {
      person.loop.emplace(options_, recording.scene.people[n].body, p, input.plane);
    }
    if (n == 0 || input.kind == Disturbance::kForce) ++group.recordings;
  }

  const ModelOptions& options_;
  bool has_loop_;
  std::map<GroupKey, std::vector<Group>> groups_;
};

std::string AngleName(int plane) { return plane == 0 ? "theta" : "phi"; }
std::string AxisName(int plane) { return plane == 0 ? "x" : "y"; }

}  // namespace

std::string FrequencyResponse::InputUnit() const {
  switch (input) {
    case Disturbance::kGroundShift:
      return "m";
    case Disturbance::kGroundTilt:
      return "rad";
    case Disturbance::kForce:
      break;
  }
  return "N";
}

std::string FrequencyResponse::OutputUnit() const {
  return output == LoopOutput::kAngle ? "rad" : "N m";
}

std::string FrequencyResponse::Name() const {
  const std::string what =
      output == LoopOutput::kAngle ? AngleName(plane) : "torque about " + AngleName(plane);
  switch (input) {
    case Disturbance::kGroundShift:
      return what + " by the ground's shift along " + AxisName(plane);
    case Disturbance::kGroundTilt:
      return what + " by the ground's tilt " + AngleName(plane);
    case Disturbance::kForce:
      break;
  }
  return what + " by the push along " + AxisName(plane);
}

std::string FrequencyResponse::Key() const {
  return NameOf(output) + "_" + AngleName(plane) + "_by_" + NameOf(input);
}

std::vector<FrequencyResponse> FrequencyResponses(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters) {
  const auto own = InOwnAxes(recordings, options);
  const std::vector<PendulumRecording>& seen = own ? *own : recordings;
  Gathering gathering(options);
  for (size_t i = 0; i < seen.size(); ++i) gathering.Add(seen[i], parameters[i]);
  return gathering.Responses();
}

TextTable FrequencyTable(const std::vector<FrequencyResponse>& responses) {
  TextTable table({"response", "input_unit", "output_unit", "frequency_hz", "gain", "gain_lower",
                   "gain_upper", "phase_deg", "phase_error_deg", "coherence", "people",
                   "model_gain", "model_phase_deg"});
  const double degrees = 180.0 / M_PI;
  for (const FrequencyResponse& response : responses) {
    const bool closed = !response.model.hz.empty();
    for (const FrequencyBin& bin : response.bins) {
      table.Add({response.Key(), response.InputUnit(), response.OutputUnit(), bin.hz,
                 std::exp(bin.log_gain), std::exp(bin.log_gain - bin.log_gain_error),
                 std::exp(bin.log_gain + bin.log_gain_error), degrees * bin.phase,
                 degrees * bin.phase_error, bin.coherence, bin.people,
                 closed ? TableCell(std::exp(bin.model_log_gain)) : TableCell(""),
                 closed ? TableCell(degrees * bin.model_phase) : TableCell("")});
    }
  }
  return table;
}

}  // namespace pushid
