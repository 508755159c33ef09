#include "ident/prediction/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unsupported/Eigen/FFT>

#include "ident/prediction/prediction.h"
#include "ident/problem/own_axes.h"

namespace pushid {
namespace {

using Eigen::ArrayXcd;
using Eigen::ArrayXd;

Eigen::Map<const ArrayXd> Part(const std::vector<double>& x, int first, int frames) {
  return {x.data() + first, frames};
}

double Variance(const std::vector<double>& x, int first, int frames) {
  const auto part = Part(x, first, frames);
  return (part - part.mean()).square().mean();
}

double Spread(const std::vector<double>& x) {
  return std::sqrt(Variance(x, 0, static_cast<int>(x.size())));
}

// Bins from 0 Hz to half the rate.
ArrayXcd Transformed(const std::vector<double>& x, int first, int frames) {
  const Eigen::VectorXd segment = Part(x, first, frames) - Part(x, first, frames).mean();
  Eigen::VectorXcd bins;
  Eigen::FFT<double>().fwd(bins, segment);
  return bins.head(frames / 2 + 1);
}

// The disturbance that goes on through a recording.
struct ContinuousInput {
  Disturbance kind = Disturbance::kGroundShift;
  int plane = 0;
  std::vector<double> series;  // one per frame
  Segmenting segments = {};
};

std::optional<ContinuousInput> ContinuousInputOf(const PendulumRecording& recording) {
  const GroundMotion& ground = recording.scene.ground;
  if (!ground.moves()) return std::nullopt;
  const int frames = recording.num_frames();
  std::optional<ContinuousInput> best;
  double most = 1e-3;  // m/s^2
  const auto offer = [&](double acceleration, ContinuousInput input) {
    input.segments = SegmentsOf(input.series);
    if (acceleration <= most || input.segments.frames == 0) return;
    most = acceleration;
    best = std::move(input);
  };
  for (int plane = 0; plane < 2; ++plane) {
    std::vector<double> shift, tilt;
    for (int t = 0; t < frames; ++t) {
      shift.push_back(ground.PoseAt(t)[plane]), tilt.push_back(ground.PoseAt(t)[2 + plane]);
    }
    double squares = 0.0;
    for (int t = 1; t + 1 < frames; ++t) {
      const double second = (shift[t + 1] - 2.0 * shift[t] + shift[t - 1]) /
                            (recording.scene.dt * recording.scene.dt);
      squares += second * second;
    }
    offer(std::sqrt(squares / (frames - 2)), {Disturbance::kGroundShift, plane, shift});
    offer(kGravity * Spread(tilt), {Disturbance::kGroundTilt, plane, tilt});
  }
  return best;
}

// One value per frame; where there is none, that of the frame before.
std::vector<double> OutputSeries(const PendulumRecording& recording, int person, int plane,
                                 LoopOutput output) {
  const Body& own = recording.scene.people[person].body;
  const std::vector<PendulumState<double>>& states = recording.states[person];
  std::vector<double> series(recording.num_frames(), 0.0);
  for (int t = 0; t < recording.num_frames(); ++t) {
    if (t > 0) series[t] = series[t - 1];
    if (recording.Weight(person, t) <= 0.0) continue;
    if (output == LoopOutput::kAngle) {
      const Vector3<double> origin = Vector3<double>::Zero();  // angles do not ask for it
      series[t] = InLaboratory(recording.scene.ground, t, origin, states[t]).q[2 + plane];
      continue;
    }
    const PlateFrame& frame = recording.plates[person][t];
    if (frame.weight <= 0.0) continue;
    const double arm = frame.centre[plane] - (states[t].q[plane] - states[0].q[plane]);
    const double sum = own.mass * recording.scene.ground.StepAt(t).gravity * arm +
                       own.cart_height * frame.shear[plane];
    series[t] = plane == 0 ? -sum : sum;
  }
  return series;
}

// Means of log gains, and of phases about that of their sum, with their standard errors.
FrequencyBin MeanOver(const ArrayXcd& responses) {
  const double n = static_cast<double>(responses.size());
  const std::complex<double> sum = (responses / responses.abs().cast<std::complex<double>>()).sum();
  const ArrayXcd logs = (responses / (sum / std::abs(sum))).log();
  const auto error = [n](const ArrayXd& of) {
    return std::sqrt((of - of.mean()).square().sum() / (n - 1.0) / n);
  };
  FrequencyBin mean;
  mean.log_gain = logs.real().mean();
  mean.phase = std::remainder(std::arg(sum) + logs.imag().mean(), 2.0 * M_PI);
  mean.log_gain_error = error(logs.real());
  mean.phase_error = error(logs.imag());
  return mean;
}

struct PersonSpectra {
  CrossSpectra spectra;
  std::optional<LinearLoop> loop;
};

// Segments that last equally long.
struct SegmentGroup {
  FrequencyResponse response;
  std::map<std::string, PersonSpectra> people;  // by subject
};

// A bin is taken or left by everybody's spectra: to take those people alone whose coherence is high
// would take those whose noise happens to be along their answer.
FrequencyResponse ResponseOf(const SegmentGroup& group) {
  FrequencyResponse response = group.response;
  CrossSpectra all;
  for (const auto& [name, person] : group.people) {
    response.people.push_back(name);
    all.Add(person.spectra);
  }
  const Eigen::Index people = static_cast<Eigen::Index>(group.people.size());
  for (int i : all.CoherentBins()) {
    const double hz = i * all.step_hz, c = all.Coherence(i);
    ArrayXcd measured(people), models(people);
    Eigen::Index n = 0;
    for (const auto& [name, person] : group.people) {
      measured[n] = person.spectra.Response(i);
      if (person.loop) {
        const LoopAnswer answer = person.loop->Answer(response.input, hz);
        models[n] = response.output == LoopOutput::kAngle ? answer.angle : answer.torque;
      }
      ++n;
    }
    FrequencyBin bin = MeanOver(measured);
    bin.hz = hz;
    bin.people = static_cast<int>(people);
    bin.coherence = c;
    if (people == 1) {
      bin.log_gain_error = bin.phase_error = std::sqrt((1.0 - c) / (2.0 * c * all.averages));
    }
    if (response.has_model) {
      const FrequencyBin model = MeanOver(models);
      bin.model_log_gain = model.log_gain, bin.model_phase = model.phase;
    }
    response.bins.push_back(bin);
  }
  return response;
}

void Gather(const PendulumRecording& recording, const ModelOptions& options,
            const std::vector<ParameterSet<double>>& parameters,
            std::vector<SegmentGroup>* groups) {
  const double dt = recording.scene.dt;
  if ((recording.num_frames() - 1) * dt < 10.0) return;
  const std::optional<ContinuousInput> input = ContinuousInputOf(recording);
  if (!input) return;
  const Segmenting& segments = input->segments;
  const double seconds = segments.frames * dt;
  for (LoopOutput output : {LoopOutput::kAngle, LoopOutput::kTorque}) {
    auto group = std::find_if(groups->begin(), groups->end(), [&](const SegmentGroup& g) {
      const FrequencyResponse& r = g.response;
      return r.input == input->kind && r.plane == input->plane && r.output == output &&
             std::abs(r.segment_s - seconds) < 0.005 * seconds;
    });
    if (group == groups->end()) group = groups->insert(group, SegmentGroup{});
    FrequencyResponse& response = group->response;
    if (group->people.empty()) {
      response.input = input->kind, response.plane = input->plane, response.output = output;
      response.segment_s = seconds;
      response.has_model = WithoutLinearLoop(options).empty();
    }
    ++response.recordings;
    for (int n = 0; n < recording.num_people(); ++n) {
      if (output == LoopOutput::kTorque && !recording.HasPlates(n)) continue;
      PersonSpectra& person = group->people[recording.subject_ids[n]];
      const auto series = OutputSeries(recording, n, input->plane, output);
      person.spectra.Add(CrossSpectraOf(input->series, series, segments, dt));
      if (response.has_model) {
        person.loop.emplace(options, recording.scene.people[n].body, parameters[n], input->plane);
      }
    }
  }
}

constexpr const char* kAngles[] = {"theta", "phi"};

}  // namespace

int PeriodOf(const std::vector<double>& series) {
  const int frames = static_cast<int>(series.size()), first = frames / 10;
  if (frames < 8) return 0;
  const double variance = Variance(series, first, frames - first);
  if (!(variance > 0.0)) return 0;
  // A slow series repeats itself after a frame or two as well: it has to go away before.
  bool went_away = false;
  int best = 0;
  double least = 0.02 * 0.02 * variance;
  for (int period = 2; period <= frames / 2; ++period) {
    const int compared = frames - first - period;
    const double far = 0.5 * 0.5 * variance * compared;
    double sum = 0.0;
    for (int t = frames - 1; t - period >= first && sum <= far; --t) {
      sum += (series[t] - series[t - period]) * (series[t] - series[t - period]);
    }
    went_away = went_away || sum > far;
    if (!went_away) continue;
    const double apart = sum / compared;
    if (best > 0 && apart >= least) return best;
    if (apart < least) best = period, least = apart;
  }
  return best;
}

Segmenting SegmentsOf(const std::vector<double>& input) {
  const int frames = static_cast<int>(input.size()), period = PeriodOf(input);
  if (period == 0) return {};
  const bool twice = frames / period == 2;
  const int used = twice ? period + period / 2 : (frames / period - 1) * period;
  return {period, frames - used, twice ? period / 2 : period};
}

void CrossSpectra::Add(const CrossSpectra& other) {
  if (uu.size() == 0) {
    *this = other;
    return;
  }
  const Eigen::Index bins = std::min(uu.size(), other.uu.size());
  uu = (uu.head(bins) + other.uu.head(bins)).eval();
  yy = (yy.head(bins) + other.yy.head(bins)).eval();
  yu = (yu.head(bins) + other.yu.head(bins)).eval();
  averages += other.averages;
}

double CrossSpectra::Coherence(int bin) const {
  const double power = uu[bin] * yy[bin];
  return power > 0.0 ? std::norm(yu[bin]) / power : 0.0;
}

std::vector<int> CrossSpectra::CoherentBins() const {
  std::vector<int> bins;
  if (averages <= 1.0) return bins;  // of a single segment it is 1, whatever it holds
  const double by_chance = std::max(0.3, 1.0 - std::pow(0.05, 1.0 / (averages - 1.0)));
  const double least = 1e-4 * uu.tail(uu.size() - 1).maxCoeff();
  for (int i = 1; i < uu.size(); ++i) {
    if (uu[i] > least && Coherence(i) > by_chance) bins.push_back(i);
  }
  return bins;
}

CrossSpectra CrossSpectraOf(const std::vector<double>& input, const std::vector<double>& output,
                            const Segmenting& segments, double dt) {
  const int frames = segments.frames, end = static_cast<int>(std::min(input.size(), output.size()));
  const ArrayXd none = ArrayXd::Zero(frames / 2 + 1);
  CrossSpectra spectra{1.0 / (frames * dt), 0.0, none, none, none.cast<std::complex<double>>()};
  int count = 0;
  for (int first = segments.first; first + frames <= end; first += segments.step, ++count) {
    const ArrayXcd u = Transformed(input, first, frames);
    const ArrayXcd y = Transformed(output, first, frames);
    spectra.uu += u.abs2();
    spectra.yy += y.abs2();
    spectra.yu += y * u.conjugate();
  }
  spectra.averages = 1.0 + (count - 1.0) * segments.step / frames;
  return spectra;
}

std::string FrequencyResponse::InputUnit() const {
  return input == Disturbance::kGroundShift ? "m" : "rad";
}

std::string FrequencyResponse::OutputUnit() const {
  return output == LoopOutput::kAngle ? "rad" : "N m";
}

std::string FrequencyResponse::Name() const {
  const std::string angle = kAngles[plane], axis = plane == 0 ? "x" : "y";
  return (output == LoopOutput::kAngle ? "" : "torque about ") + angle +
         (input == Disturbance::kGroundTilt ? " by the ground's tilt " + angle
                                            : " by the ground's shift along " + axis);
}

std::string FrequencyResponse::Key() const {
  return std::string(output == LoopOutput::kAngle ? "angle_" : "torque_") + kAngles[plane] +
         "_by_" + NameOf(input);
}

std::vector<FrequencyResponse> FrequencyResponses(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters) {
  const auto own = InOwnAxes(recordings, options);
  std::vector<SegmentGroup> groups;
  for (size_t i = 0; i < recordings.size(); ++i) {
    Gather(own ? (*own)[i] : recordings[i], options, parameters[i], &groups);
  }
  std::vector<FrequencyResponse> responses;
  for (const SegmentGroup& group : groups) {
    responses.push_back(ResponseOf(group));
    if (responses.back().bins.empty()) responses.pop_back();
  }
  std::stable_sort(responses.begin(), responses.end(), [](const auto& a, const auto& b) {
    return std::tie(a.input, a.plane, a.output) < std::tie(b.input, b.plane, b.output);
  });
  return responses;
}

std::vector<FrequencyResponse> FrequencyResponses(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::vector<std::vector<ParameterSet<double>>> parameters;
  for (const auto& recording : recordings)
    parameters.push_back(PeoplesParameters(model, recording));
  return FrequencyResponses(recordings, model.options, parameters);
}

TextTable FrequencyTable(const std::vector<FrequencyResponse>& responses) {
  TextTable table({"response", "input_unit", "output_unit", "frequency_hz", "gain", "gain_lower",
                   "gain_upper", "phase_deg", "phase_error_deg", "coherence", "people",
                   "model_gain", "model_phase_deg"});
  const double degrees = 180.0 / M_PI;
  for (const FrequencyResponse& response : responses) {
    for (const FrequencyBin& bin : response.bins) {
      const auto model = [&](double value) {
        return response.has_model ? TableCell(value) : TableCell("");
      };
      table.Add({response.Key(), response.InputUnit(), response.OutputUnit(), bin.hz,
                 std::exp(bin.log_gain), std::exp(bin.log_gain - bin.log_gain_error),
                 std::exp(bin.log_gain + bin.log_gain_error), degrees * bin.phase,
                 degrees * bin.phase_error, bin.coherence, bin.people,
                 model(std::exp(bin.model_log_gain)), model(degrees * bin.model_phase)});
    }
  }
  return table;
}

}  // namespace pushid
