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
  std::vector<Track> tracks = Transposed(person->joints);
  for (Track& track : tracks) change(&track);
  person->joints = Transposed(tracks);
}

constexpr double kShortestRod = 0.12, kLongestRod = 3.0;  // m; a small humanoid robot has 0.3
constexpr double kLargestLean = 1.0;                      // rad; beyond it the person has fallen
constexpr double kFarthest = 1e5;                         // m
constexpr int kFewestFrames = 3;                          // an acceleration takes three

constexpr double kShortestAdult = 0.5, kLongestAdult = 1.5;  // m, of rods

using Eigen::Vector3d;

// Change per frame from the neighbour beyond, where that was seen; otherwise that of the line.
Vector3d Slope(const std::vector<Vector3d>& track, int at, int beyond, const Vector3d& line) {
  const bool seen =
      beyond >= 0 && beyond < static_cast<int>(track.size()) && track[beyond].allFinite();
  return seen ? Vector3d((track[at] - track[beyond]) / (at - beyond)) : line;
}

// Fills the frames between `before` and `after`, which were seen.
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

// y_i = b (x_i + 2 x_{i-1} + x_{i-2}) - a1 y_{i-1} - a2 y_{i-2}
struct Biquad {
  double b, a1, a2;
};

// A filter of which two passes lose 3 dB at the cut-off.
Biquad Butterworth(double cutoff_hz, double rate_hz) {
  const double k = std::tan(M_PI * cutoff_hz / rate_hz) / std::pow(std::sqrt(2.0) - 1.0, 0.25);
  const double q = std::sqrt(2.0) * k;
  const double norm = 1.0 / (1.0 + q + k * k);
  return {k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - q + k * k) * norm};
}

// Filters in place, from the steady state at the first value.
void Pass(const Biquad& filter, std::vector<Vector3d>* x) {
  Vector3d x1 = x->front(), x2 = x1, y1 = x1, y2 = x1;
  for (Vector3d& value : *x) {
    const Vector3d y = filter.b * (value + 2.0 * x1 + x2) - filter.a1 * y1 - filter.a2 * y2;
    x2 = std::exchange(x1, value);
    y2 = std::exchange(y1, y);
    value = y;
  }
}

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
  if (options.resample_fps != 0.0 && !FrameRateProblem(options.resample_fps).empty()) {
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
    return Error{StrCat("the motion has ", person.hip.size(), " frames; at least three are needed"),
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
  for (const auto& [name, track] : {std::pair("hip", &person.hip),
                                    {"left ankle", &person.left_ankle},
                                    {"right ankle", &person.right_ankle}}) {
    for (std::size_t frame = 0; frame < track->size(); ++frame) {
      const Vector3d& place = (*track)[frame];
      if (place.allFinite() && place.cwiseAbs().maxCoeff() < kFarthest) continue;
      return Error{
          StrCat("the ", name, " is ", Rounded(place.norm(), 3), " m from the origin at frame ",
                 frame, ": a number is damaged, or the unit is wrong (--length_unit)"),
          person.file};
    }
  }
  return std::nullopt;
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
    if (!fill) {
      count.excluded_frames += length;
      std::fill(weight->begin() + begin, weight->begin() + end, 0.0);
    }
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
  filled.many = filled.interpolated_frames > kManyInterpolated * static_cast<double>(counting);
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
  std::string text = StrCat("has ", CountText(gaps, "gap"), " in hip and ankles; those of up to ",
                            Rounded(max_gap_s), " s are interpolated, ", excluded_frames, " of ",
                            frames, " frames are left out");
  if (many) {
    text += StrCat("; ", interpolated_frames,
                   " of the others are interpolated, more than a tenth: these count "
                   "less; fill the gaps from other markers, or leave the recording out");
  }
  return text;
}

double HighestCutoff(double rate_hz) { return 0.499 * rate_hz; }

void LowPass(double cutoff_hz, double rate_hz, std::vector<Vector3d>* track) {
  const int frames = static_cast<int>(track->size());
  if (frames < 3) return;
  const Biquad filter = Butterworth(cutoff_hz, rate_hz);
  // Wings are long enough for the filter to forget its start.
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

std::vector<Vector3d> ResampleTrack(const std::vector<Vector3d>& track, double from_hz,
                                    double to_hz) {
  std::vector<Vector3d> result;
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

[[noreturn]] void FailOf(const std::string& id, const std::string& what) {
  throw Error{"recording " + Quoted(id) + ": " + what};
}

template <typename Rows>
void AddRows(const Rows& rows, ContentHash* hash) {
  for (const auto& row : rows) hash->Add(row.data(), row.size());
}

// Fills gaps and checks the person of a recording called `id`.
void CompletePerson(int max_gap, const std::string& id, RecordedPerson* person,
                    FilledTracks* filled) {
  const std::string who = Quoted(person->subject_id);
  if (!(person->mass_kg > 0.0 && person->mass_kg <= kHeaviestPerson)) {
    FailOf(id, "the mass of " + who + " is " + Rounded(person->mass_kg) +
                   " kg; it must be above 0 and at most " + Rounded(kHeaviestPerson));
  }
  const size_t frames = person->hip.size();
  if (person->left_ankle.size() != frames || person->right_ankle.size() != frames) {
    FailOf(id, StrCat("hip and ankles of ", who, " have ", frames, ", ", person->left_ankle.size(),
                      " and ", person->right_ankle.size(), " frames; they share them"));
  }
  *filled = FillTracks(max_gap, {&person->hip, &person->left_ankle, &person->right_ankle});
  if (frames > 0 && filled->weight[0] == 0.0) {
    FailOf(id, "at frame 0, where the fit starts, hip or ankles of " + who +
                   " are missing; leave out the frames before they are visible");
  }
  if (!filled->AllCount()) person->weight = filled->weight;
  if (MaybeError wrong = CheckMotion(*person, 1.0)) {
    FailOf(id, person->subject_id + ": " + wrong->message);
  }
}

void CheckPush(const Recording& recording, const Push& push) {
  const int people = static_cast<int>(recording.people.size()), frames = recording.num_frames();
  if (push.person < 0 || push.person >= people) {
    FailOf(recording.id, StrCat("there is no person ", push.person, " to push; it has ", people,
                                ", counted from 0"));
  }
  const int rows = static_cast<int>(push.force.size());
  if (push.start_frame < 0 || rows == 0 || push.start_frame > frames - 2 ||
      push.start_frame + rows > frames) {
    FailOf(recording.id, StrCat("a push of ", rows, " rows from frame ", push.start_frame,
                                " is not within its ", frames, " frames"));
  }
  for (const Eigen::Vector4d& row : push.force) {
    if (!row.allFinite()) FailOf(recording.id, "the push has a value that is not finite");
  }
}

// Checks ground and platforms, which share the motion's frames, and turns ground to count from
// frame 0.
void CompleteLaboratory(const PreparationOptions& preparation, Recording* recording,
                        ContentHash* hash) {
  const auto frames = static_cast<size_t>(recording->num_frames());
  const auto check_frames = [&](const std::string& what, size_t rows) {
    if (rows == frames) return;
    FailOf(recording->id,
           StrCat(what, " has ", rows, " rows, the motion ", frames, " frames; they share them"));
  };
  std::vector<GroundPose>& ground = recording->ground;
  bool any = !ground.empty();
  if (any) check_frames("ground", ground.size());
  AddRows(ground, hash);
  const GroundPose first = any ? ground[0] : GroundPose(GroundPose::Zero());
  for (GroundPose& pose : ground) {
    if (!pose.allFinite()) FailOf(recording->id, "ground has a value that is not finite");
    pose -= first;
  }
  const auto some = static_cast<size_t>(std::max(5.0, 1.0 + std::round(0.1 * recording->fps)));
  const double speed = GroundSpeedAtFirst(
      {ground.begin(), ground.begin() + static_cast<std::ptrdiff_t>(std::min(some, ground.size()))},
      1.0 / recording->fps);
  if (speed > kGroundAtRest) {
    FailOf(recording->id, "the ground moves by " + Rounded(speed, 2) +
                              " per second (m or rad) at frame 0, where people are taken to be "
                              "at rest; start the recording earlier");
  }
  for (size_t n = 0; n < recording->people.size(); ++n) {
    const std::vector<PlateSample>& plates = recording->people[n].plates;
    if (plates.empty()) continue;
    any = true;
    const std::string whose = "plates of " + Quoted(recording->people[n].subject_id);
    check_frames(whose, plates.size());
    for (const PlateSample& sample : plates) {
      if (!sample.force.allFinite() || !sample.centre.allFinite()) {
        FailOf(recording->id, whose + " have a value that is not finite");
      }
      hash->Add(sample.force.data(), 3);
      hash->Add(sample.centre.data(), 3);
    }
    const MaybeError wrong = Caught([&] { CheckPlates("", *recording, static_cast<int>(n)); });
    if (wrong) FailOf(recording->id, wrong->message);
  }
  if (any && preparation.resample_fps > 0.0) {
    FailOf(recording->id,
           "ground and plates are taken at the motion's frames; leave resampling out");
  }
}

}  // namespace

Result<Recording> RecordingFromTracks(Recording tracks, const PreparationOptions& preparation,
                                      Warnings* warnings) {
  return Caught([&] {
    const std::string& id = tracks.id;
    const std::string rate = FrameRateProblem(tracks.fps);
    if (!rate.empty()) FailOf(id, "fps " + rate);
    if (tracks.people.empty()) FailOf(id, "it contains no people");
    if (tracks.labels.setting().empty()) tracks.labels.Set(kSettingLabel, "single");
    ContentHash hash;
    const int max_gap = static_cast<int>(std::floor(preparation.max_gap_s * tracks.fps + 1e-9));
    for (RecordedPerson& person : tracks.people) {
      for (const auto* track : {&person.hip, &person.left_ankle, &person.right_ankle}) {
        AddRows(*track, &hash);
      }
      FilledTracks filled;
      CompletePerson(max_gap, id, &person, &filled);
      const std::string gaps = filled.Warning(preparation.max_gap_s);
      if (!gaps.empty()) {
        WarnOf(id, person.subject_id + " " + gaps, warnings, "a person " + gaps);
      }
      if (person.hip.size() != tracks.people[0].hip.size()) {
        FailOf(id, "its people have different numbers of frames");
      }
    }
    for (const Push& push : tracks.pushes) {
      CheckPush(tracks, push);
      AddRows(push.force, &hash);
    }
    CompleteLaboratory(preparation, &tracks, &hash);
    tracks.content_hash = hash.Hex();
    OrThrow(CheckPreparation(preparation));
    if (MaybeError failed = PrepareMotion(preparation, &tracks)) FailOf(id, failed->message);
    return std::move(tracks);
  });
}

void WarnOf(const std::string& id, const std::string& what, Warnings* warnings,
            const std::string& of_many) {
  if (warnings == nullptr) return;
  warnings->emplace_back("recording " + Quoted(id) + ": " + what, id,
                         of_many.empty() ? what : of_many);
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

std::vector<Eigen::Vector3d> MeanTrack(const std::vector<std::vector<Eigen::Vector3d>>& tracks,
                                       const std::vector<int>& chosen) {
  if (chosen.empty()) return {};
  Track mean = tracks[chosen[0]];
  for (std::size_t frame = 0; frame < mean.size(); ++frame) {
    for (std::size_t i = 1; i < chosen.size(); ++i) mean[frame] += tracks[chosen[i]][frame];
    mean[frame] /= static_cast<double>(chosen.size());
  }
  return mean;
}

std::vector<Track> Transposed(const std::vector<Track>& rows) {
  std::vector<Track> columns(rows[0].size());
  for (const Track& row : rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(row[i]);
  }
  return columns;
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
