// datasets: gaps, filter and frame rate of tracks, and recordings of them.
#include "datasets/loading/motion_tracks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/units.h"
#include "datasets/loading/laboratory_record.h"
#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/manifest.h"
#include "models/enum_names.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kSlowestCutoff = 0.5;  // Hz
constexpr double kNearlyAsFast = 0.95;  // of the old rate: there is next to nothing to alias

// change(track) for hip, feet and, where they were kept, every joint.
template <typename Change>
void ForEachTrack(RecordedPerson* person, const Change& change) {
  for (const PendulumTrack& row : kPendulumTracks) {
    Track& track = person->*row.track;
    if (!track.empty()) change(&track);
  }
  if (person->joints.empty()) return;
  std::vector<Track> tracks(person->joints[0].size());
  for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
    for (const auto& frame : person->joints) tracks[joint].push_back(frame[joint]);
    change(&tracks[joint]);
  }
  person->joints.assign(tracks[0].size(), Track(tracks.size()));
  for (std::size_t frame = 0; frame < person->joints.size(); ++frame) {
    for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
      person->joints[frame][joint] = tracks[joint][frame];
    }
  }
}

bool IsRate(double value) { return FrameRateProblem(value).empty(); }

constexpr double kShortestRod = 0.12, kLongestRod = 3.0;  // m; a small humanoid robot has 0.3
constexpr double kLargestLean = 1.0;                      // rad; beyond it the person has fallen
constexpr double kFarthest = 1e5;                         // m
constexpr int kFewestFrames = 3;                          // an acceleration takes three

constexpr double kShortestAdult = 0.5, kLongestAdult = 1.5;  // m, of rods

MaybeError CheckTrack(const RecordedPerson& person, const char* what,
                      const std::vector<Eigen::Vector3d>& track) {
  for (std::size_t frame = 0; frame < track.size(); ++frame) {
    // Written so that NaN fails.
    if (!(track[frame].cwiseAbs().maxCoeff() < kFarthest) || !track[frame].allFinite()) {
      return Error{std::string("the ") + what + " is " + Rounded(track[frame].norm(), 3) +
                       " m from the origin at frame " + std::to_string(frame) +
                       ": a number is damaged, or the unit is wrong (--length_unit)",
                   person.file, 0};
    }
  }
  return std::nullopt;
}

using Eigen::Vector3d;

// Per frame, from the neighbour beyond where it was seen; otherwise that of the straight line.
Vector3d Slope(const std::vector<Vector3d>& track, int at, int beyond, const Vector3d& line) {
  const bool seen =
      beyond >= 0 && beyond < static_cast<int>(track.size()) && track[beyond].allFinite();
  return seen ? Vector3d((track[at] - track[beyond]) / (at - beyond)) : line;
}

// Between the seen frames `before` and `after`.
void FillInside(int before, int after, bool curved, std::vector<Vector3d>* track) {
  const Vector3d from = (*track)[before], to = (*track)[after];
  const double span = after - before;
  const Vector3d line = (to - from) / span;
  const Vector3d m0 = curved ? Slope(*track, before, before - 1, line) : line;
  const Vector3d m1 = curved ? Slope(*track, after, after + 1, line) : line;
  for (int i = before + 1; i < after; ++i) {
    const double s = (i - before) / span, r = 1.0 - s;
    (*track)[i] = r * r * (1.0 + 2.0 * s) * from + s * r * r * span * m0 +
                  s * s * (3.0 - 2.0 * s) * to - s * s * r * span * m1;
  }
}

constexpr double kManyInterpolated = 0.1;  // of the frames that count

bool Many(int interpolated, int counting) {
  return interpolated > kManyInterpolated * static_cast<double>(counting);
}

double TwoPassCorrection() { return std::pow(std::sqrt(2.0) - 1.0, 0.25); }

// y_i = b (x_i + 2 x_{i-1} + x_{i-2}) - a1 y_{i-1} - a2 y_{i-2}
struct Biquad {
  double b, a1, a2;
};

// A filter of which two passes lose 3 dB at the cut-off.
Biquad Butterworth(double cutoff_hz, double rate_hz) {
  const double k = std::tan(M_PI * cutoff_hz / rate_hz) / TwoPassCorrection();
  const double q = std::sqrt(2.0) * k;
  const double norm = 1.0 / (1.0 + q + k * k);
  return {k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - q + k * k) * norm};
}

// Filters in place, from the steady state at the first value.
void Pass(const Biquad& filter, std::vector<Vector3d>* x) {
  Vector3d x1 = x->front(), x2 = x1, y1 = x1, y2 = x1;
  for (Vector3d& value : *x) {
    const Vector3d y = filter.b * (value + 2.0 * x1 + x2) - filter.a1 * y1 - filter.a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

using Position = Eigen::Vector3d;

constexpr double kRounding = 1e-9;  // of a frame

// The place of new frame i among the old frames.
double OldFrame(int i, double from_hz, double to_hz) { return i * from_hz / to_hz; }

}  // namespace

MaybeError CheckPreparation(const PreparationOptions& options) {
  if (!(options.max_gap_s >= 0.0 && options.max_gap_s <= 10.0)) {
    return Error{"--max_gap_s is " + Rounded(options.max_gap_s) + "; it must be from 0 to 10 s"};
  }
  if (options.lowpass_hz != 0.0 &&
      !(options.lowpass_hz >= kSlowestCutoff && options.lowpass_hz <= 1e4)) {
    return Error{"--lowpass_hz is " + Rounded(options.lowpass_hz) +
                 "; it must be a cut-off of at least " + Rounded(kSlowestCutoff) +
                 " Hz (a lower one removes the push), or 0 for none"};
  }
  if (options.resample_fps != 0.0 && !IsRate(options.resample_fps)) {
    return Error{"--resample_fps is " + Rounded(options.resample_fps) +
                 "; it must be from 1 to 10000 frames per second, or 0 for the recording's own"};
  }
  return std::nullopt;
}

MaybeError PrepareMotion(const PreparationOptions& options, Recording* recording) {
  const double from = recording->fps, to = options.resample_fps;
  if (options.lowpass_hz > 0.0) {
    const double highest = HighestCutoff(from);
    if (options.lowpass_hz >= highest) {
      return Error{"--lowpass_hz=" + Rounded(options.lowpass_hz) + " is too high for its rate of " +
                   Rounded(from) + " frames per second: it must be below " + Rounded(highest, 3) +
                   " Hz"};
    }
    for (RecordedPerson& person : recording->people) {
      ForEachTrack(&person, [&](Track* track) { LowPass(options.lowpass_hz, from, track); });
    }
  }
  if (to == 0.0 || to == from) return std::nullopt;
  if (to < kNearlyAsFast * from && !(options.lowpass_hz > 0.0 && options.lowpass_hz <= 0.5 * to)) {
    return Error{"--resample_fps=" + Rounded(to) + " is below its " + Rounded(from) +
                 " frames per second: faster movements would be aliased; pass --lowpass_hz=" +
                 Rounded(to / 4.0, 3) + " or another cut-off of at most half the new rate"};
  }
  if (ResampledFrames(recording->num_frames(), from, to) < 3) {
    return Error{"fewer than three frames are left at --resample_fps=" + Rounded(to)};
  }
  for (RecordedPerson& person : recording->people) {
    ForEachTrack(&person, [&](Track* track) { *track = ResampleTrack(*track, from, to); });
    if (!person.weight.empty()) person.weight = ResampleWeights(person.weight, from, to);
  }
  for (Push& push : recording->pushes) {
    push = ResamplePush(push, from, to);
    // A push that ends with the motion may reach into a frame that is not there any more.
    const int room = recording->num_frames() - push.start_frame;
    if (static_cast<int>(push.force.size()) > room) push.force.resize(std::max(room, 1));
  }
  recording->fps = to;
  return std::nullopt;
}

MaybeError CheckMotion(const RecordedPerson& person, double metres_per_unit) {
  if (person.hip.size() < kFewestFrames) {
    return Error{"the motion has " + std::to_string(person.hip.size()) +
                     " frames; at least three are needed",
                 person.file, 0};
  }
  const Eigen::Vector3d rod = person.hip[0] - 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  const double length = rod.norm();
  if (!(length >= kShortestRod && length <= kLongestRod)) {
    const std::optional<LengthUnit> likely =
        UnitThatGives(length / metres_per_unit, kShortestAdult, kLongestAdult);
    return Error{
        "the hip is " + Rounded(length, 3) + " m high above the ankles when lengths are read as " +
            LengthText(metres_per_unit) + ": " +
            (likely ? "looks like " + NameOf(*likely) + ", pass --length_unit=" + NameOf(*likely)
                    : "check the unit (--length_unit) and the joints chosen; give odd "
                      "units in metres (--length_scale)"),
        person.file, 0};
  }
  const double lean = std::acos(std::fmin(1.0, std::fmax(-1.0, rod.z() / length)));
  if (lean > kLargestLean) {
    return Error{"at frame 0 the line from the ankles to the hip leans " +
                     Rounded(lean * 180.0 / 3.14159265358979323846, 3) +
                     " degrees from up: if the file's vertical axis is another, set \"up\" and "
                     "\"forward\" in the manifest; otherwise check \"joints\"",
                 person.file, 0};
  }
  if (MaybeError failed = CheckTrack(person, "hip", person.hip)) return failed;
  if (MaybeError failed = CheckTrack(person, "left ankle", person.left_ankle)) return failed;
  return CheckTrack(person, "right ankle", person.right_ankle);
}

GapCount FillGaps(int max_gap, std::vector<Vector3d>* track, std::vector<double>* weight) {
  GapCount count;
  const int frames = static_cast<int>(track->size());
  for (int begin = 0; begin < frames;) {
    if ((*track)[begin].allFinite()) {
      ++begin;
      continue;
    }
    int end = begin;
    while (end < frames && !(*track)[end].allFinite()) ++end;
    const int length = end - begin;
    const bool inside = begin > 0 && end < frames;
    const bool fill = inside && length <= max_gap;
    ++count.gaps;
    count.longest = std::max(count.longest, length);
    (fill ? count.filled_frames : count.excluded_frames) += length;
    if (!fill) std::fill(weight->begin() + begin, weight->begin() + end, 0.0);
    if (inside) {
      FillInside(begin - 1, end, fill, track);
    } else if (length < frames) {
      const Vector3d nearest = begin > 0 ? (*track)[begin - 1] : (*track)[end];
      std::fill(track->begin() + begin, track->begin() + end, nearest);
    }
    begin = end;
  }
  return count;
}

FilledTracks FillTracks(int max_gap, const std::vector<std::vector<Vector3d>*>& tracks) {
  FilledTracks filled;
  const size_t frames = tracks.empty() ? 0 : tracks[0]->size();
  std::vector<bool> seen(frames, true);
  filled.weight.assign(frames, 1.0);
  for (std::vector<Vector3d>* track : tracks) {
    for (size_t t = 0; t < frames; ++t) {
      if (!(*track)[t].allFinite()) seen[t] = false;
    }
    filled.gaps += FillGaps(max_gap, track, &filled.weight).gaps;
  }
  int counting = 0;
  for (size_t t = 0; t < frames; ++t) {
    if (filled.weight[t] == 0.0) continue;
    ++counting;
    if (!seen[t]) ++filled.interpolated_frames;
  }
  filled.excluded_frames = static_cast<int>(frames) - counting;
  filled.many = Many(filled.interpolated_frames, counting);
  if (!filled.many) return filled;
  const double share = static_cast<double>(counting - filled.interpolated_frames) / counting;
  for (size_t t = 0; t < frames; ++t) {
    if (filled.weight[t] > 0.0 && !seen[t]) filled.weight[t] = share;
  }
  return filled;
}

std::string FilledTracks::Warning(double max_gap_s) const {
  if (gaps == 0) return "";
  const std::string frames = std::to_string(weight.size());
  std::string text = "has " + CountText(gaps, "gap") + " in hip and ankles; those of up to " +
                     Rounded(max_gap_s) + " s are interpolated, " +
                     std::to_string(excluded_frames) + " of " + frames + " frames are left out";
  if (many) {
    text += "; " + std::to_string(interpolated_frames) +
            " of the others are interpolated, more than a tenth: these count "
            "less; fill the gaps from other markers, or leave the recording out";
  }
  return text;
}

double HighestCutoff(double rate_hz) { return 0.499 * rate_hz; }

void LowPass(double cutoff_hz, double rate_hz, std::vector<Vector3d>* track) {
  const int frames = static_cast<int>(track->size());
  if (frames < 3) return;
  const Biquad filter = Butterworth(cutoff_hz, rate_hz);
  // Long enough for the filter to forget its start.
  const int wing = std::min(frames - 1, static_cast<int>(std::ceil(2.0 * rate_hz / cutoff_hz)));
  std::vector<Vector3d> x;
  x.reserve(frames + 2 * wing);
  const Vector3d first = track->front(), last = track->back();
  for (int i = wing; i > 0; --i) x.push_back(2.0 * first - (*track)[i]);
  x.insert(x.end(), track->begin(), track->end());
  for (int i = 1; i <= wing; ++i) x.push_back(2.0 * last - (*track)[frames - 1 - i]);
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  std::copy(x.begin() + wing, x.begin() + wing + frames, track->begin());
}

int ResampledFrames(int frames, double from_hz, double to_hz) {
  return static_cast<int>(std::floor((frames - 1) * to_hz / from_hz + kRounding)) + 1;
}

std::vector<Position> ResampleTrack(const std::vector<Position>& track, double from_hz,
                                    double to_hz) {
  std::vector<Position> result;
  for (int i = 0; i < ResampledFrames(static_cast<int>(track.size()), from_hz, to_hz); ++i) {
    result.push_back(ValueBetween(track, OldFrame(i, from_hz, to_hz)));
  }
  return result;
}

std::vector<double> ResampleWeights(const std::vector<double>& weight, double from_hz,
                                    double to_hz) {
  const int frames = static_cast<int>(weight.size());
  std::vector<double> result;
  for (int i = 0; i < ResampledFrames(frames, from_hz, to_hz); ++i) {
    const double at = OldFrame(i, from_hz, to_hz);
    const int before = std::clamp(static_cast<int>(std::floor(at + kRounding)), 0, frames - 1);
    const int after = std::clamp(static_cast<int>(std::ceil(at - kRounding)), 0, frames - 1);
    result.push_back(std::min(weight[before], weight[after]));
  }
  return result;
}

Push ResamplePush(const Push& push, double from_hz, double to_hz) {
  Push result = push;
  result.force.clear();
  // A row is the mean over half a frame before and after its own; what is before the first new
  // row's goes to that row.
  const auto new_frame = [&](double old_edge) { return (old_edge - 0.5) * to_hz / from_hz + 0.5; };
  const auto old_edge = [&](int new_row) { return (new_row - 0.5) * from_hz / to_hz + 0.5; };
  const int first = static_cast<int>(std::floor(new_frame(push.start_frame) + kRounding));
  const int end = static_cast<int>(std::ceil(new_frame(push.EndFrame()) - kRounding));
  result.start_frame = std::max(0, first);
  for (int i = result.start_frame; i < end; ++i) {
    Eigen::Vector4d impulse = Eigen::Vector4d::Zero();  // over the new row, in old frames
    const double from = i == 0 ? std::min<double>(old_edge(0), push.start_frame) : old_edge(i);
    const double to = old_edge(i + 1);
    for (int row = 0; row < static_cast<int>(push.force.size()); ++row) {
      const double left = std::max<double>(from, row + push.start_frame);
      const double right = std::min<double>(to, row + push.start_frame + 1.0);
      if (right > left) impulse += (right - left) * push.force[row];
    }
    result.force.push_back(impulse * to_hz / from_hz);
  }
  return result;
}

namespace {

Error Of(const std::string& id, const std::string& what) {
  return Error{"recording " + Quoted(id) + ": " + what};
}

template <typename Rows>
void AddRows(const Rows& rows, ContentHash* hash) {
  for (const auto& row : rows) hash->Add(row.data(), row.size());
}

Result<RecordedPerson> PersonFrom(TrackedPerson tracks, int max_gap, const std::string& id,
                                  FilledTracks* filled) {
  if (!(tracks.mass_kg > 0.0 && tracks.mass_kg <= kHeaviestPerson)) {
    return Of(id, "the mass of " + Quoted(tracks.id) + " is " + Rounded(tracks.mass_kg) +
                      " kg; it must be above 0 and at most " + Rounded(kHeaviestPerson));
  }
  const size_t frames = tracks.hip.size();
  if (tracks.left_ankle.size() != frames || tracks.right_ankle.size() != frames) {
    return Of(id, "hip and ankles of " + Quoted(tracks.id) + " have " + std::to_string(frames) +
                      ", " + std::to_string(tracks.left_ankle.size()) + " and " +
                      std::to_string(tracks.right_ankle.size()) + " frames; they share them");
  }
  RecordedPerson person;
  person.subject_id = tracks.id;
  person.mass_kg = tracks.mass_kg;
  *filled = FillTracks(max_gap, {&tracks.hip, &tracks.left_ankle, &tracks.right_ankle});
  if (frames > 0 && filled->weight[0] == 0.0) {
    return Of(id, "at frame 0, where the fit starts, hip or ankles of " + Quoted(tracks.id) +
                      " are missing; leave out the frames before they are visible");
  }
  person.plates = std::move(tracks.plates);
  person.hip = std::move(tracks.hip);
  person.left_ankle = std::move(tracks.left_ankle);
  person.right_ankle = std::move(tracks.right_ankle);
  if (!filled->AllCount()) person.weight = filled->weight;
  if (MaybeError wrong = CheckMotion(person, 1.0)) {
    return Of(id, tracks.id + ": " + wrong->message);
  }
  return person;
}

MaybeError CheckPush(const TrackedRecording& tracks, const Push& push, int frames) {
  const int people = static_cast<int>(tracks.people.size());
  if (push.person < 0 || push.person >= people) {
    return Of(tracks.id, "there is no person " + std::to_string(push.person) + " to push; it has " +
                             std::to_string(people) + ", counted from 0");
  }
  const int rows = static_cast<int>(push.force.size());
  if (push.start_frame < 0 || rows == 0 || push.start_frame > frames - 2 ||
      push.start_frame + rows > frames) {
    return Of(tracks.id, "a push of " + std::to_string(rows) + " rows from frame " +
                             std::to_string(push.start_frame) + " is not within its " +
                             std::to_string(frames) + " frames");
  }
  for (const Eigen::Vector4d& row : push.force) {
    if (!row.allFinite()) return Of(tracks.id, "the push has a value that is not finite");
  }
  return std::nullopt;
}

// Ground and platforms share the motion's frames.
MaybeError TakeLaboratory(std::vector<GroundPose> ground, const PreparationOptions& preparation,
                          Recording* recording, ContentHash* hash) {
  const auto frames = static_cast<size_t>(recording->num_frames());
  const auto differ = [&](const std::string& what, size_t rows) {
    return Of(recording->id, what + " has " + std::to_string(rows) + " rows, the motion " +
                                 std::to_string(frames) + " frames; they share them");
  };
  bool any = !ground.empty();
  if (any && ground.size() != frames) return differ("ground", ground.size());
  AddRows(ground, hash);
  for (GroundPose& pose : ground) {
    if (!pose.allFinite()) return Of(recording->id, "ground has a value that is not finite");
  }
  const GroundPose first = ground.empty() ? GroundPose(GroundPose::Zero()) : ground[0];
  for (GroundPose& pose : ground) pose -= first;
  const auto some = static_cast<size_t>(std::max(5.0, 1.0 + std::round(0.1 * recording->fps)));
  const double speed = GroundSpeedAtFirst(
      {ground.begin(), ground.begin() + static_cast<std::ptrdiff_t>(std::min(some, ground.size()))},
      1.0 / recording->fps);
  if (speed > kGroundAtRest) {
    return Of(recording->id, "the ground moves by " + Rounded(speed, 2) +
                                 " per second (m or rad) at frame 0, where people are taken to be "
                                 "at rest; start the recording earlier");
  }
  recording->ground = std::move(ground);
  for (size_t n = 0; n < recording->people.size(); ++n) {
    const std::vector<PlateSample>& plates = recording->people[n].plates;
    if (plates.empty()) continue;
    any = true;
    const std::string whose = "plates of " + Quoted(recording->people[n].subject_id);
    if (plates.size() != frames) return differ(whose, plates.size());
    for (const PlateSample& sample : plates) {
      if (!sample.force.allFinite() || !sample.centre.allFinite()) {
        return Of(recording->id, whose + " have a value that is not finite");
      }
      hash->Add(sample.force.data(), 3);
      hash->Add(sample.centre.data(), 3);
    }
    if (MaybeError wrong = CheckPlates("", *recording, static_cast<int>(n))) {
      return Of(recording->id, wrong->message);
    }
  }
  if (any && preparation.resample_fps > 0.0) {
    return Of(recording->id,
              "ground and plates are taken at the motion's frames; leave resampling out");
  }
  return std::nullopt;
}

}  // namespace

Result<Recording> RecordingFromTracks(TrackedRecording tracks,
                                      const PreparationOptions& preparation, Warnings* warnings) {
  const std::string rate = FrameRateProblem(tracks.fps);
  if (!rate.empty()) return Of(tracks.id, "fps " + rate);
  if (tracks.people.empty()) return Of(tracks.id, "it contains no people");
  Recording recording;
  recording.id = tracks.id;
  recording.fps = tracks.fps;
  recording.labels = std::move(tracks.labels);
  if (recording.labels.setting().empty()) recording.labels.Set(kSettingLabel, "single");
  recording.pushed_person = tracks.pushed_person;
  recording.push_kind = tracks.push_kind;
  recording.initial_velocity = tracks.initial_velocity;
  ContentHash hash;
  const int max_gap = static_cast<int>(std::floor(preparation.max_gap_s * tracks.fps + 1e-9));
  for (TrackedPerson& one : tracks.people) {
    for (const auto* track : {&one.hip, &one.left_ankle, &one.right_ankle}) AddRows(*track, &hash);
    const std::string who = one.id;
    FilledTracks filled;
    Result<RecordedPerson> person = PersonFrom(std::move(one), max_gap, tracks.id, &filled);
    if (!person.ok()) return person.error();
    const std::string gaps = filled.Warning(preparation.max_gap_s);
    if (!gaps.empty() && warnings != nullptr) {
      warnings->emplace_back("recording " + Quoted(tracks.id) + ": " + who + " " + gaps, tracks.id,
                             "a person " + gaps);
    }
    recording.people.push_back(std::move(person.value()));
    if (recording.people.back().hip.size() != recording.people[0].hip.size()) {
      return Of(tracks.id, "its people have different numbers of frames");
    }
  }
  for (const Push& push : tracks.pushes) {
    if (MaybeError wrong = CheckPush(tracks, push, recording.num_frames())) return *wrong;
    AddRows(push.force, &hash);
  }
  if (MaybeError wrong = TakeLaboratory(std::move(tracks.ground), preparation, &recording, &hash)) {
    return *std::move(wrong);
  }
  recording.pushes = std::move(tracks.pushes);
  recording.content_hash = hash.Hex();
  if (MaybeError failed = CheckPreparation(preparation)) return *failed;
  if (MaybeError failed = PrepareMotion(preparation, &recording)) {
    return Of(recording.id, failed->message);
  }
  return recording;
}

double HeightFraction(const Body& body, const Vector4<double>& q, double height) {
  return (height - body.cart_height) / (body.rod_length * std::cos(q[2]) * std::cos(q[3]));
}

std::vector<Eigen::Vector4d> PushAtHeight(const RecordedPerson& person, int start,
                                          const std::vector<Eigen::Vector3d>& forces,
                                          const PushHeight& height) {
  const auto pose = [&person](size_t frame) {
    const size_t t = std::min(frame, person.hip.size() - 1);
    return MapSkeleton(person.hip[t], person.left_ankle[t], person.right_ankle[t]);
  };
  const MappedPose first = pose(0);
  const Body body{person.mass_kg, first.rod_length, first.cart_height};
  const double fraction =
      height.metres ? HeightFraction(body, pose(start).q, *height.metres) : height.fraction;
  std::vector<Eigen::Vector4d> rows;
  for (size_t t = 0; t < forces.size(); ++t) {
    rows.push_back(GeneralizedForce<double>(body, pose(start + t).q, forces[t], fraction));
  }
  return rows;
}

MaybeError CheckLasts(const RecordTimes& times, const std::string& file, int line) {
  const double frame = 1.0 / times.fps, end_s = times.start_s + times.seconds;
  const bool begins = times.first_s <= times.start_s + 0.5 * frame;
  if (begins && times.last_s >= end_s - times.spare * frame) return {};
  return Error{std::string(times.lasts) + " from " + Rounded(times.first_s, 4) + " to " +
                   Rounded(times.last_s, 4) + " s, but the motion from " +
                   Rounded(times.start_s, 4) + " to " + Rounded(end_s, 4) +
                   " s of that clock; record it longer, cut the motion (end_frame), or give the "
                   "right clock at frame 0 as \"start\"",
               file, line};
}

Eigen::Vector3d ValueBetween(const std::vector<Eigen::Vector3d>& track, double at) {
  const int last = static_cast<int>(track.size()) - 1;
  if (at <= 0.0) return track[0];
  if (at >= last) return track[last];
  const int nodes = std::min(4, last + 1);
  const int first = std::clamp(static_cast<int>(at) - 1, 0, last + 1 - nodes);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < nodes; ++i) {
    double weight = 1.0;
    for (int k = 0; k < nodes; ++k) {
      if (k != i) weight *= (at - first - k) / (i - k);
    }
    sum += weight * track[first + i];
  }
  return sum;
}

}  // namespace pushid
