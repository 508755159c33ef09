// ident: segments and their Fourier transforms (Eigen's), series of what moves people and of how
// they answer, and frequency responses person by person.
#include "ident/prediction/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unsupported/Eigen/FFT>

#include "ident/prediction/prediction.h"
#include "ident/problem/own_axes.h"
#include "models/net_force.h"

namespace pushid {
namespace {

constexpr double kRepeats = 0.02, kAway = 0.5;             // of the standard deviation
constexpr double kSegments = 9.0;                          // that overlap by half
constexpr double kShortestSegment = 4.0, kLongest = 30.0;  // s
// Overlapping by half under Hann's window, segments are as good as so many independent ones.
constexpr double kOverlapWorth = 9.0 / 11.0;
constexpr double kLeastPower = 1e-6, kLeastLine = 1e-4, kLeastCoherence = 0.3, kChance = 0.05;

double MeanOf(const std::vector<double>& x, int first, int frames) {
  double sum = 0.0;
  for (int t = first; t < first + frames; ++t) sum += x[t];
  return sum / frames;
}

std::vector<double> HannWindow(int frames) {
  std::vector<double> window(frames);
  for (int t = 0; t < frames; ++t) window[t] = 0.5 - 0.5 * std::cos(2.0 * M_PI * t / frames);
  return window;
}

// Bins from 0 Hz to half the rate.
std::vector<std::complex<double>> Transformed(const std::vector<double>& x, int first, int frames,
                                              const std::vector<double>& window) {
  const double mean = MeanOf(x, first, frames);
  std::vector<double> segment(frames);
  for (int t = 0; t < frames; ++t) {
    segment[t] = (x[first + t] - mean) * (window.empty() ? 1.0 : window[t]);
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> bins;
  fft.fwd(bins, segment);
  bins.resize(frames / 2 + 1);
  return bins;
}

}  // namespace

int PeriodOf(const std::vector<double>& series) {
  const int frames = static_cast<int>(series.size()), first = frames / 10;
  if (frames < 8) return 0;
  const double mean = MeanOf(series, first, frames - first);
  double variance = 0.0;
  for (int t = first; t < frames; ++t) variance += (series[t] - mean) * (series[t] - mean);
  variance /= frames - first;
  if (!(variance > 0.0)) return 0;
  // A slow series repeats itself after a frame or two as well: it has to go away before.
  bool went_away = false;
  int best = 0;
  double least = kRepeats * kRepeats * variance;
  for (int period = 2; period <= frames / 2; ++period) {
    const int compared = frames - first - period;  // three tenths of the series at least
    const double far = kAway * kAway * variance * compared;
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

Segmenting SegmentsOf(const std::vector<double>& input, double dt) {
  const int frames = static_cast<int>(input.size());
  Segmenting segments;
  if (const int period = PeriodOf(input); period > 0) {
    // What is left out of the beginning, where the answer is not yet periodic.
    const bool twice = frames / period == 2;
    const int used = twice ? period + period / 2 : (frames / period - 1) * period;
    segments = {period, frames - used, twice ? period / 2 : period, true};
    return segments;
  }
  const double seconds =
      std::clamp(2.0 * frames * dt / (kSegments + 1.0), kShortestSegment, kLongest);
  segments.frames = static_cast<int>(std::lround(seconds / dt));
  segments.step = segments.frames / 2;
  if (frames < 2 * segments.frames) segments.frames = 0;  // three segments
  return segments;
}

void CrossSpectra::Add(const CrossSpectra& other) {
  if (uu.empty()) {
    *this = other;
    return;
  }
  const size_t bins = std::min(uu.size(), other.uu.size());
  uu.resize(bins), yy.resize(bins), yu.resize(bins);
  for (size_t i = 0; i < bins; ++i) {
    uu[i] += other.uu[i];
    yy[i] += other.yy[i];
    yu[i] += other.yu[i];
  }
  averages += other.averages;
}

double CrossSpectra::Coherence(int bin) const {
  const double power = uu[bin] * yy[bin];
  return power > 0.0 ? std::norm(yu[bin]) / power : 0.0;
}

double CrossSpectra::RelativeError(int bin) const {
  const double coherence = Coherence(bin);
  return coherence > 0.0 ? std::sqrt((1.0 - coherence) / (2.0 * coherence * averages)) : INFINITY;
}

CrossSpectra CrossSpectraOf(const std::vector<double>& input, const std::vector<double>& output,
                            const Segmenting& segments, double dt) {
  CrossSpectra spectra;
  const int frames = segments.frames;
  if (frames < 2) return spectra;
  const std::vector<double> window = segments.periodic ? std::vector<double>() : HannWindow(frames);
  const size_t bins = frames / 2 + 1;
  spectra.step_hz = 1.0 / (frames * dt);
  spectra.uu.assign(bins, 0.0), spectra.yy.assign(bins, 0.0), spectra.yu.assign(bins, 0.0);
  int count = 0;
  const int end = static_cast<int>(std::min(input.size(), output.size()));
  for (int first = segments.first; first + frames <= end; first += segments.step, ++count) {
    const auto u = Transformed(input, first, frames, window);
    const auto y = Transformed(output, first, frames, window);
    for (size_t i = 0; i < bins; ++i) {
      spectra.uu[i] += std::norm(u[i]);
      spectra.yy[i] += std::norm(y[i]);
      spectra.yu[i] += y[i] * std::conj(u[i]);
    }
  }
  const double periods = 1.0 + (count - 1.0) * segments.step / frames;
  spectra.averages = segments.periodic ? periods : count < 2 ? count : kOverlapWorth * count;
  return spectra;
}

std::vector<int> BinsWithPower(const CrossSpectra& spectra, bool periodic) {
  const double least = periodic ? kLeastLine : kLeastPower;
  std::vector<int> bins;
  double most = 0.0;
  for (size_t i = 1; i < spectra.uu.size(); ++i) most = std::max(most, spectra.uu[i]);
  for (size_t i = 1; i < spectra.uu.size(); ++i) {
    if (spectra.uu[i] > least * most) bins.push_back(static_cast<int>(i));
  }
  return bins;
}

bool IsCoherent(const CrossSpectra& spectra, int bin) {
  if (spectra.averages <= 1.0) return false;  // of a single segment it is 1, whatever it holds
  const double by_chance = 1.0 - std::pow(kChance, 1.0 / (spectra.averages - 1.0));
  return spectra.Coherence(bin) > std::max(kLeastCoherence, by_chance);
}

namespace {

// What moves a person on and on: none where nothing does, as pushes of a fraction of a second.
struct ContinuousInput {
  Disturbance kind = Disturbance::kGroundShift;
  int plane = 0;
  int person = 0;              // who is pushed
  double lever = 0.0;          // m, of a force
  std::vector<double> series;  // one per frame
};

// Of a recording, the parts in which the input has to have a tenth of its spread.
constexpr int kParts = 5, kMostParts = 4;
constexpr double kLeastPart = 0.1;
constexpr double kActiveShare = 0.5;         // of the frames, in which a push acts
constexpr double kLeastAcceleration = 1e-3;  // m/s^2, root mean square

double RootMeanSquare(const std::vector<double>& series) {
  double sum = 0.0;
  for (double value : series) sum += value * value;
  return series.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(series.size()));
}

// What is not there at rest: less its mean.
double Spread(std::vector<double> series) {
  double mean = 0.0;
  for (double value : series) mean += value / static_cast<double>(series.size());
  for (double& value : series) value -= mean;
  return RootMeanSquare(series);
}

// Whether it goes on: in most parts of the recording, not in one as a step does.
bool GoesOn(const std::vector<double>& series) {
  const size_t part = series.size() / kParts;
  if (part < 2) return false;
  const double whole = Spread(series);
  int moving = 0;
  for (int i = 0; i < kParts; ++i) {
    const auto from = series.begin() + static_cast<std::ptrdiff_t>(i * part);
    const std::vector<double> own(from, from + static_cast<std::ptrdiff_t>(part));
    moving += Spread(own) > kLeastPart * whole;
  }
  return moving >= kMostParts;
}

std::vector<double> GroundSeries(const GroundMotion& ground, int row, int frames) {
  std::vector<double> series;
  for (int t = 0; t < frames; ++t) series.push_back(ground.PoseAt(t)[row]);
  return series;
}

std::vector<double> SecondDifference(const std::vector<double>& series, double dt) {
  std::vector<double> second;
  for (size_t t = 1; t + 1 < series.size(); ++t) {
    second.push_back((series[t + 1] - 2.0 * series[t] + series[t - 1]) / (dt * dt));
  }
  return second;
}

struct Pushing {
  std::vector<double> force, torque;
  int active = 0;  // frames
};

// By external pushes: those of other kinds stand for what the ground does as well.
Pushing PushingOf(const PendulumRecording& recording, int person, int plane) {
  Pushing pushing;
  for (int t = 0; t < recording.num_frames(); ++t) {
    Vector4<double> sum = Vector4<double>::Zero();
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.person != person || !push.Active(t) || push.kind != PushKind::kExternal) continue;
      sum += push.force[t - push.start_frame];
    }
    pushing.force.push_back(sum[plane]);
    pushing.torque.push_back(sum[2 + plane]);
    pushing.active += !sum.isZero(0.0);
  }
  return pushing;
}

// What was not seen is taken as it was before.
void Hold(std::vector<double>* series) {
  series->push_back(series->empty() ? 0.0 : series->back());
}

// The ankles' torque by platforms, less that at rest (head comment).
std::vector<double> TorqueByPlates(const PendulumRecording& recording, int person, int plane) {
  std::vector<double> torque;
  const Body& body = recording.scene.people[person].body;
  const GroundMotion& ground = recording.scene.ground;
  const double place = recording.states[person][0].q[plane];
  for (int t = 0; t < recording.num_frames(); ++t) {
    const PlateFrame& frame = recording.plates[person][t];
    if (frame.weight <= 0.0 || recording.Weight(person, t) <= 0.0) {
      Hold(&torque);
      continue;
    }
    const double g = ground.StepAt(t).gravity;
    const double arm = frame.centre[plane] - (recording.states[person][t].q[plane] - place);
    const double sum = body.mass * g * arm + body.cart_height * frame.shear[plane];
    torque.push_back(plane == 0 ? -sum : sum);
  }
  return torque;
}

std::vector<double> TorqueByMotion(const PendulumRecording& recording, int person, int plane,
                                   const ModelOptions& options, const ParameterSet<double>& p) {
  const Scene& scene = recording.scene;
  const BodyOf<double> body =
      DynamicBody<double>(options, scene.people[person].body, p, options.stance == Stance::kFixed);
  std::vector<double> torque;
  for (int t = 0; t + 1 < recording.num_frames(); ++t) {
    // Of an acceleration three frames must be known.
    if (std::min({recording.Weight(person, std::max(t - 1, 0)), recording.Weight(person, t),
                  recording.Weight(person, t + 1)}) <= 0.0) {
      Hold(&torque);
      continue;
    }
    const PendulumState<double>& state = recording.states[person][t];
    const GroundStep& ground = scene.ground.StepAt(t);
    Vector4<double> push = PushForceAt(scene, person, t);
    if (options.body == BodyModel::kTable) push *= p[kPushGain];
    const Vector4<double> a =
        (recording.states[person][t + 1].qd - state.qd) / scene.dt + ground.acceleration;
    const Vector4<double> more =
        (ground.gravity / kGravity - 1.0) * Gravity(body, Angles<double>(state.q)) - push;
    torque.push_back((InverseDynamics(body, state, a) + more)[2 + plane]);
  }
  Hold(&torque);
  return torque;
}

std::vector<double> AngleInLaboratory(const PendulumRecording& recording, int person, int plane) {
  const Vector3<double> origin = Vector3<double>::Zero();  // angles do not ask for it
  std::vector<double> angle;
  for (int t = 0; t < recording.num_frames(); ++t) {
    if (recording.Weight(person, t) <= 0.0) {
      Hold(&angle);
      continue;
    }
    const PendulumState<double>& state = recording.states[person][t];
    angle.push_back(InLaboratory(recording.scene.ground, t, origin, state).q[2 + plane]);
  }
  return angle;
}

std::optional<ContinuousInput> ContinuousInputOf(const PendulumRecording& recording) {
  std::optional<ContinuousInput> best;
  double most = kLeastAcceleration;
  const int frames = recording.num_frames();
  const auto offer = [&](double acceleration, ContinuousInput input) {
    if (acceleration <= most || !GoesOn(input.series)) return;
    most = acceleration;
    best = std::move(input);
  };
  const GroundMotion& ground = recording.scene.ground;
  for (int plane = 0; plane < 2; ++plane) {
    if (ground.moves()) {
      std::vector<double> shift = GroundSeries(ground, plane, frames);
      const double by_shift = RootMeanSquare(SecondDifference(shift, recording.scene.dt));
      offer(by_shift, {Disturbance::kGroundShift, plane, 0, 0.0, std::move(shift)});
      std::vector<double> tilt = GroundSeries(ground, 2 + plane, frames);
      const double by_tilt = kGravity * Spread(tilt);
      offer(by_tilt, {Disturbance::kGroundTilt, plane, 0, 0.0, std::move(tilt)});
    }
    for (int n = 0; n < recording.num_people(); ++n) {
      Pushing pushing = PushingOf(recording, n, plane);
      if (pushing.active < kActiveShare * frames) continue;
      double both = 0.0, square = 0.0;
      for (int t = 0; t < frames; ++t) {
        both += pushing.force[t] * pushing.torque[t];
        square += pushing.force[t] * pushing.force[t];
      }
      const double by_force = Spread(pushing.force) / recording.scene.people[n].body.mass;
      const double lever = square > 0.0 ? both / square : 0.0;
      offer(by_force, {Disturbance::kForce, plane, n, lever, std::move(pushing.force)});
    }
  }
  return best;
}

// One value per frame; where the person was not seen, that of the frame before. recording: as the
// model sees it (own_axes.h).
std::vector<double> OutputSeries(const PendulumRecording& recording, int person, int plane,
                                 LoopOutput output, const ModelOptions& options,
                                 const ParameterSet<double>& p) {
  if (output == LoopOutput::kAngle) return AngleInLaboratory(recording, person, plane);
  if (recording.HasPlates(person)) return TorqueByPlates(recording, person, plane);
  return TorqueByMotion(recording, person, plane, options, p);
}

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

struct SegmentGroup {
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
std::optional<FrequencyBin> BinOf(const SegmentGroup& group, const GroupKey& key,
                                  const CrossSpectra& all, int bin) {
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

FrequencyCurve CurveOf(const SegmentGroup& group, const GroupKey& key, double from, double to) {
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

FrequencyResponse ResponseOf(const SegmentGroup& group, const GroupKey& key) {
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
      for (const SegmentGroup& group : groups) {
        responses.push_back(ResponseOf(group, key));
        if (responses.back().bins.empty()) responses.pop_back();
      }
    }
    return responses;
  }

 private:
  // The group of segments that last as long.
  SegmentGroup& GroupFor(const GroupKey& key, const Segmenting& segments, double seconds) {
    for (SegmentGroup& group : groups_[key]) {
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
    SegmentGroup& group = GroupFor(key, segments, segments.frames * dt);
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
  std::map<GroupKey, std::vector<SegmentGroup>> groups_;
};

std::string AngleName(int plane) { return plane == 0 ? "theta" : "phi"; }
std::string AxisName(int plane) { return plane == 0 ? "x" : "y"; }

}  // namespace

std::string FrequencyResponse::InputUnit() const {
  return input == Disturbance::kGroundShift ? "m" : input == Disturbance::kGroundTilt ? "rad" : "N";
}

std::string FrequencyResponse::OutputUnit() const {
  return output == LoopOutput::kAngle ? "rad" : "N m";
}

std::string FrequencyResponse::Name() const {
  return (output == LoopOutput::kAngle ? "" : "torque about ") + AngleName(plane) +
         (input == Disturbance::kGroundTilt    ? " by the ground's tilt " + AngleName(plane)
          : input == Disturbance::kGroundShift ? " by the ground's shift along " + AxisName(plane)
                                               : " by the push along " + AxisName(plane));
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

std::vector<FrequencyResponse> FrequencyResponses(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::vector<std::vector<ParameterSet<double>>> parameters;
  for (const PendulumRecording& recording : recordings) {
    parameters.push_back(PeoplesParameters(model, recording));
  }
  return FrequencyResponses(recordings, model.options, parameters);
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
