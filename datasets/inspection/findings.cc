// datasets: doubts about recordings, and pushes beside motions.
#include "datasets/inspection/findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"

namespace pushid {
namespace {

using Vectors = std::vector<Eigen::Vector2d>;

constexpr double kLookBefore = 1.5, kLookAfter = 0.5;  // s around the push
constexpr double kHalfSmoothing = 0.05;                // s
constexpr double kLeastMotion = 0.01;                  // m
constexpr double kNoise = 4.0;                         // standard errors
constexpr double kShareOfSpeed = 0.25;                 // of the largest, at the onset
constexpr double kSwayTime = 0.25;                     // s: what sway before the push goes on for
// People sway before a push; whoever is faster than this, and half as fast as ever after, moves.
constexpr double kSway = 0.05, kFast = 0.08;         // m/s
constexpr double kMostGain = 2.0, kUsualGain = 0.9;  // of those who are quickest to move
constexpr double kSlowToMove = 0.5, kLeastGain = 0.3, kSlideGain = 1.0;  // of who is looked at
constexpr double kSurelyLate = 0.08, kSurelyEarly = 0.15;                // s
constexpr int kSustained = 3, kFewestRows = 5;                           // frames
constexpr double kImpulseEnds = 0.01;                // of the impulse, at both ends
constexpr double kRestBetween = 0.5, kAtRest = 0.2;  // s between pushes; of the peak

// Standard deviation of white noise: of second differences, by their median.
double NoiseOf(const Vectors& path, int axis) {
  std::vector<double> size = {0.0};
  for (size_t t = 2; t < path.size(); ++t) {
    size.push_back(std::fabs(path[t][axis] - 2.0 * path[t - 1][axis] + path[t - 2][axis]));
  }
  return UpperMedian(std::move(size)) / 0.6745 / std::sqrt(6.0);
}

class Comparison {
 public:
  Comparison(const PendulumRecording& recording, int person)
      : recording_(recording), person_(person), dt_(recording.scene.dt) {}

  std::optional<PushAndMotion> Compare() {
    // On ground that moves, the push does not decide when people set off.
    if (recording_.scene.ground.moves() || !FindPush() || !FindPath()) return std::nullopt;
    PushAndMotion found;
    found.speed = impulse_.norm() / Mass();
    Gain(&found);
    const int onset = Onset();
    if (onset < 0) return found;
    const Eigen::Vector2d way = smooth_[std::min(onset + 1, last_ - 1)] - rest_;
    found.angle = std::acos(std::clamp(way.normalized().dot(along_), -1.0, 1.0));
    Lag(onset, &found);
    return found;
  }

 private:
  double Mass() const { return recording_.scene.people[person_].body.mass; }

  // Takes the first push on the person and all that overlap it; false: there is no impulse.
  bool FindPush() {
    std::vector<const ScenePush*> pushes;
    for (const ScenePush& push : recording_.scene.pushes) {
      if (push.person == person_ && !push.force.empty()) pushes.push_back(&push);
    }
    if (pushes.empty()) return false;
    std::sort(pushes.begin(), pushes.end(),
              [](auto* a, auto* b) { return a->start_frame < b->start_frame; });
    kind_ = pushes[0]->kind;
    const int frames = recording_.num_frames();
    force_.assign(frames, Eigen::Vector2d::Zero());
    int end = pushes[0]->EndFrame();
    for (const ScenePush* push : pushes) {
      next_ = push->start_frame < end ? frames : push->start_frame;
      if (push->start_frame >= end) break;
      end = std::max(end, push->EndFrame());
      for (int t = push->start_frame; t < std::min(push->EndFrame(), frames); ++t) {
        const Vector4<double>& row = push->force[t - push->start_frame];
        force_[t] += row.head<2>();
        turns_ = turns_ || !row.tail<2>().isZero(0.0);
      }
    }
    EndWhereItRests();
    impulse_.setZero();
    double all = 0.0, sum = 0.0;
    for (const Eigen::Vector2d& row : force_) {
      impulse_ += dt_ * row;
      all += row.norm();
    }
    if (!(impulse_.norm() > 0.0)) return false;
    along_ = impulse_.normalized();
    start_ = end_ = -1;
    for (int t = 0; t < frames; ++t) {
      sum += force_[t].norm();
      if (start_ < 0 && sum >= kImpulseEnds * all) start_ = t;
      if (end_ < 0 && sum >= (1.0 - kImpulseEnds) * all) end_ = t + 1;
    }
    return true;
  }

  // A sensor's record may hold several pushes, of which only the first is compared.
  void EndWhereItRests() {
    double peak = 0.0;
    for (const Eigen::Vector2d& row : force_) peak = std::max(peak, row.norm());
    const int frames = static_cast<int>(force_.size()), rest = static_cast<int>(kRestBetween / dt_);
    for (int t = 0, last = frames; t < frames; ++t) {
      if (!(force_[t].norm() > kAtRest * peak)) continue;
      if (t - last > rest) {
        next_ = std::min(next_, t - rest / 2);
        std::fill(force_.begin() + last + rest / 2, force_.end(), Eigen::Vector2d::Zero());
        return;
      }
      last = t;
    }
  }

  // The point that carries the mass, smoothed, and its velocity, around the push; of a cart that is
  // pushed by itself the cart, behind which a pole lags.
  bool FindPath() {
    const double hip = turns_ ? 1.0 - kCartShare : 0.0;
    const int frames = recording_.num_frames();
    half_ = std::max(1, static_cast<int>(std::lround(kHalfSmoothing / dt_)));
    first_ = std::max(0, start_ - static_cast<int>(kLookBefore / dt_));
    last_ = std::min(next_, end_ + static_cast<int>(kLookAfter / dt_));
    if (last_ - first_ < 2 * half_ + kSustained) return false;
    for (int t = 0; t < frames; ++t) {
      if (t >= first_ && t < last_ && !(recording_.Weight(person_, t) > 0.0)) return false;
      path_.push_back(hip * recording_.hip[person_][t].head<2>() +
                      (1.0 - hip) * recording_.states[person_][t].q.head<2>());
    }
    noise_ = std::max(NoiseOf(path_, 0), NoiseOf(path_, 1));
    smooth_.resize(frames);
    velocity_.assign(frames, Eigen::Vector2d::Zero());
    for (int t = first_; t < last_; ++t) {
      smooth_[t] = Mean(t, std::min({half_, t, frames - 1 - t}));
      velocity_[t] = Slope(std::max(0, t - 2 * half_), std::min(frames, t + 2 * half_ + 1));
    }
    double sum = 0.0;
    for (int k = -2 * half_; k <= 2 * half_; ++k) sum += k * dt_ * k * dt_;
    speed_error_ = noise_ / std::sqrt(sum);
    return true;
  }

  Eigen::Vector2d Mean(int t, int half) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = t - half; k <= t + half; ++k) sum += path_[k];
    return sum / (2 * half + 1);
  }

  // Slope of a line fitted to the frames [from, to).
  Eigen::Vector2d Slope(int from, int to) const {
    const double middle = 0.5 * (from + to - 1);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double squares = 0.0;
    for (int t = from; t < to; ++t) {
      sum += (t - middle) * dt_ * path_[t];
      squares += (t - middle) * (t - middle) * dt_ * dt_;
    }
    return squares > 0.0 ? Eigen::Vector2d(sum / squares) : Eigen::Vector2d::Zero();
  }

  void Gain(PushAndMotion* found) const {
    double gain = 0.0, error = 0.0;
    if (kind_ != PushKind::kExternal) {
      // The push's rows are all that moves the person: their motion is compared with the recorded
      // one.
      double speed = 0.0, way = 0.0, squares = 0.0, product = 0.0;
      for (int t = start_; t <= std::min(end_, last_ - 1); ++t) {
        product += way * (path_[t] - path_[start_]).dot(along_);
        squares += way * way;
        way += dt_ * speed + 0.5 * dt_ * dt_ * force_[t].dot(along_) / Mass();
        speed += dt_ * force_[t].dot(along_) / Mass();
      }
      gain = squares > 0.0 ? product / squares : 1.0;
      error = squares > 0.0 ? noise_ * std::sqrt(2.0 / squares) : 0.0;
    } else {
      for (int t = first_; t < last_; ++t) gain = std::max(gain, velocity_[t].dot(along_));
      gain /= found->speed;
      error = speed_error_ / found->speed;
    }
    found->gain = gain;
    found->least_gain = gain - 3.0 * error;
    found->largest_gain = gain + 3.0 * error;
  }

  double Fastest(int from, int to) const {
    return std::accumulate(velocity_.begin() + from, velocity_.begin() + to, 0.0,
                           [](double most, const auto& v) { return std::max(most, v.norm()); });
  }

  // The frame where the person sets off, -1: nowhere. Sets rest_, distance_ and before_.
  int Onset() {
    const double fastest = Fastest(first_, last_);
    // Slopes up to here see nothing after the push's start.
    const int until = std::max(first_, start_ - 2 * half_);
    const double sway = until > first_ + 2 * half_ ? Fastest(first_, until) : 0.0;
    before_ = sway > std::max(kSway, 5.0 * speed_error_) && (sway > kFast || sway > 0.5 * fastest);
    const int from = before_ ? first_ : std::max(first_, start_ - 1);
    const int behind = before_ ? std::min(first_ + 2 * half_, std::max(start_, first_ + 1)) : from;
    const int rests = before_ ? first_ : std::max(first_, from - 2 * half_);
    const int count = std::max(1, behind - rests);
    rest_.setZero();
    for (int t = rests; t < rests + count; ++t) rest_ += path_[t] / count;
    const double error = noise_ * std::sqrt(1.0 / (2 * half_ + 1) + 1.0 / count);
    distance_ = std::max({kLeastMotion, kNoise * error, before_ ? 0.0 : kSwayTime * sway});
    for (int t = from, moved = 0; t < last_; ++t) {
      const bool moves =
          (smooth_[t] - rest_).norm() > distance_ && velocity_[t].norm() > kShareOfSpeed * fastest;
      moved = moves ? moved + 1 : 0;
      if (moved == kSustained) return t - kSustained + 1;
    }
    return -1;
  }

  // The frame by which `gain` times the force alone has brought the mass as far as the onset.
  double FrameOfWay(double gain) const {
    double speed = 0.0, way = 0.0;
    const int frames = static_cast<int>(force_.size());
    for (int t = 0; t < frames; ++t) {
      if (way > distance_) return t;
      const double force = gain * force_[t].dot(along_) / Mass();
      way += dt_ * speed + 0.5 * dt_ * dt_ * force;
      speed += dt_ * force;
    }
    if (!(speed > 0.0)) return HUGE_VAL;
    return frames + std::max(0.0, (distance_ - way) / (dt_ * speed));
  }

  void Lag(int onset, PushAndMotion* found) const {
    if (before_) {
      const double late = (start_ - onset) * dt_;
      if (late > kSurelyLate) found->push_late = late;
    }
    if (kind_ != PushKind::kExternal || found->push_late > 0.0) return;
    const double soonest = FrameOfWay(kMostGain * std::max(found->gain, kUsualGain));
    const double latest = FrameOfWay(kSlowToMove * std::clamp(found->gain, kLeastGain, kSlideGain));
    const double shift = dt_ * (onset - FrameOfWay(std::max(found->gain, kLeastGain)));
    if (dt_ * (soonest - onset) > kSurelyLate) found->push_late = std::fabs(shift);
    if (dt_ * (onset - latest) > kSurelyEarly) found->push_early = shift;
  }

  const PendulumRecording& recording_;
  const int person_;
  const double dt_;
  Vectors force_;  // by frame of the recording
  PushKind kind_ = PushKind::kExternal;
  bool turns_ = false;  // whether any row has a torque about the ankles
  int next_ = 0;        // the frame where a later push begins, or the recording ends
  Eigen::Vector2d impulse_, along_, rest_;
  int start_ = 0, end_ = 0, first_ = 0, last_ = 0, half_ = 1;  // frames; of the impulse, looked at
  Vectors path_, smooth_, velocity_;
  double noise_ = 0.0, speed_error_ = 0.0, distance_ = 0.0;
  bool before_ = false;  // moved before the push began
};

constexpr double kRestTime = 0.2;                       // s
constexpr double kLeastShare = 0.01, kRestShare = 0.3;  // of the peak, of what is a rest
constexpr double kSteady = 0.3;                         // of it: by how much its halves may differ
// Shares of the peak: a force that is still on; a slow start, after which no sudden end is
// expected.
constexpr double kStillOn = 0.5, kSlowStart = 0.25;
// Shares of the peak: what counts as equal, and what a clipped push would have reached above it at
// least, as its slopes beside the flat part go on.
constexpr double kSameValue = 1e-6, kCutOff = 0.1;

// Size of the horizontal force, N.
double Length(const Vector4<double>& row) { return row.head<2>().norm(); }

double Peak(const ScenePush& push) {
  return std::accumulate(push.force.begin(), push.force.end(), 0.0,
                         [](double peak, const auto& row) { return std::max(peak, Length(row)); });
}

Eigen::Vector2d MeanForce(const ScenePush& push, size_t from, size_t to) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (size_t t = from; t < to; ++t) sum += push.force[t].head<2>();
  return sum / static_cast<double>(to - from);
}

constexpr double kDegree = M_PI / 180.0;
constexpr double kAside = 60.0 * kDegree, kAgainst = 120.0 * kDegree;
constexpr double kTooMuch = 3.0, kTooLittle = 0.25;           // of an external push
constexpr double kNetFactor = 3.0;                            // of a net one, either way
constexpr double kStrongPush = 1000.0;                        // N
constexpr double kStandsOut = 3.0;                            // times the largest of the other rows
constexpr double kLightest = 25.0, kHeaviest = 130.0;         // kg
constexpr double kStature = 2.0;                              // over the rod
constexpr double kThinnest = 10.0, kFattest = 45.0;           // kg/m^2
constexpr double kShortRod = 0.5, kLongRod = 1.3;             // m
constexpr double kFastest = 10.0;                             // m/s
constexpr double kSlowestRate = 10.0, kFastestRate = 2000.0;  // 1/s
constexpr double kFacesElsewhere = 75.0 * kDegree;            // one foot may be ahead
constexpr double kApart = 0.05;                               // m; closer ankles say nothing
constexpr std::size_t kNamedCases = 4;                        // cases of a sentence

bool SameMotion(const PendulumRecording& a, const PendulumRecording& b) {
  if (a.id == b.id) return false;
  if (!a.content_hash.empty() && a.content_hash == b.content_hash) return true;
  return a.num_frames() > 0 && a.hip == b.hip;
}

// The findings of one recording.
class Judge {
 public:
  explicit Judge(const PendulumRecording& recording) : r_(recording) {}

  std::vector<Finding> Look() {
    const double rate = 1.0 / r_.scene.dt;
    if (!(rate >= kSlowestRate && rate <= kFastestRate)) Add(FindingKind::kRate, "", rate);
    for (int n = 0; n < r_.num_people(); ++n) {
      LookAtBody(n);
      if (const auto compared = ComparePush(r_, n)) LookAtMotion(n, *compared);
    }
    for (const ScenePush& push : r_.scene.pushes) LookAtRows(push);
    return std::move(found_);
  }

 private:
  void Add(FindingKind kind, const std::string& about, double value) {
    found_.push_back({kind, r_.id, about, value});
  }
  std::string Who(int n) const { return r_.num_people() > 1 ? r_.subject_ids[n] : ""; }

  void LookAtBody(int n) {
    const Body& body = r_.scene.people[n].body;
    const double stature = kStature * body.rod_length;
    const double index = body.mass / (stature * stature);
    const bool rod = body.rod_length >= kShortRod && body.rod_length <= kLongRod;
    if (!rod) Add(FindingKind::kRod, Who(n), body.rod_length);
    if (!(body.mass >= kLightest && body.mass <= kHeaviest) ||
        (rod && !(index >= kThinnest && index <= kFattest))) {
      Add(FindingKind::kMass, r_.subject_ids[n], body.mass);
    }
    double speed = 0.0;
    int fastest = 0;
    for (int t = 1; t < r_.num_frames(); ++t) {
      const double now = (r_.hip[n][t] - r_.hip[n][t - 1]).norm() / r_.scene.dt;
      if (now > speed) speed = now, fastest = t;
    }
    if (speed <= kFastest) return;
    const std::string who = Who(n);
    Add(FindingKind::kSpeed, StrCat(who.empty() ? "" : who + ", ", "frame ", fastest), speed);
  }

  void LookAtMotion(int n, const PushAndMotion& motion) {
    const double angle = motion.angle.value_or(0.0), degrees = std::round(angle / kDegree);
    const bool net = std::any_of(r_.scene.pushes.begin(), r_.scene.pushes.end(),
                                 [](const auto& p) { return p.kind != PushKind::kExternal; });
    // A recording may begin while the person moves already.
    const bool moving = r_.initial_velocity != InitialVelocity::kZero;
    if (motion.push_late > 0.0 && !moving) {
      Add(FindingKind::kLate, Who(n), motion.push_late);
    } else if (angle > kAgainst) {
      Add(FindingKind::kAgainst, Who(n), degrees);
    } else if (angle > kAside) {
      Add(FindingKind::kAside, Who(n), degrees);
    } else if (net && !moving &&
               (motion.least_gain > kNetFactor || motion.largest_gain < 1.0 / kNetFactor)) {
      Add(FindingKind::kNetGain, Who(n), motion.gain);
    } else if (!net && (motion.least_gain > kTooMuch || motion.largest_gain < kTooLittle)) {
      Add(FindingKind::kGain, Who(n), motion.gain);
    } else if (motion.push_early > 0.0) {
      Add(FindingKind::kEarly, Who(n), motion.push_early);
    }
  }

  void LookAtRows(const ScenePush& push) {
    const double peak = Peak(push);
    const std::string who = Who(push.person);
    if (peak > kStrongPush) Add(FindingKind::kStrong, who, peak);
    if (FirstRowStandsOut(push.force)) Add(FindingKind::kFirstRow, who, Length(push.force[0]));
    const double rest = RestingForce(push, r_.scene.dt);
    if (rest > 0.0) Add(FindingKind::kZero, who, rest);
    if (rest == 0.0 && HasNoEnd(push, r_.num_frames())) {
      Add(FindingKind::kNoEnd, who, Length(push.force.back()));
    }
    if (IsClipped(push)) Add(FindingKind::kClipped, who, peak);
  }

  const PendulumRecording& r_;
  std::vector<Finding> found_;
};

std::string Case(const Finding& finding, const char* unit) {
  std::string who = finding.recording;
  if (!finding.about.empty()) who += (who.empty() ? "" : ", ") + finding.about;
  if (finding.kind == FindingKind::kCopy) return finding.recording + " in " + finding.about;
  const double value = finding.value;
  return who + ": " + (value > 100.0 ? std::to_string(std::lround(value)) : Rounded(value, 3)) +
         (*unit != '\0' ? " " : "") + unit;
}

}  // namespace

std::optional<PushAndMotion> ComparePush(const PendulumRecording& recording, int person) {
  return Comparison(recording, person).Compare();
}

double RestingForce(const ScenePush& push, double dt) {
  const size_t rows = push.force.size();
  const auto at_rest = static_cast<size_t>(std::ceil(kRestTime / dt));
  if (push.kind != PushKind::kExternal || at_rest < 4 || rows < 2 * at_rest) return 0.0;
  const size_t from = rows - at_rest, middle = rows - at_rest / 2;
  const Eigen::Vector2d mean = MeanForce(push, from, rows);
  const double peak = Peak(push);
  double largest = 0.0, squares = 0.0;
  for (size_t t = from; t < rows; ++t) {
    largest = std::max(largest, Length(push.force[t]));
    squares += (push.force[t].head<2>() - mean).squaredNorm();
  }
  const double error = std::sqrt(squares) / static_cast<double>(at_rest);
  const double drift = (MeanForce(push, from, middle) - MeanForce(push, middle, rows)).norm(),
               rest = mean.norm();
  const bool some = rest > kLeastShare * peak && rest > kNoise * error;
  return some && drift <= kSteady * rest && largest < kRestShare * peak ? rest : 0.0;
}

bool HasNoEnd(const ScenePush& push, int num_frames) {
  if (push.kind != PushKind::kExternal || push.force.size() < kFewestRows) return false;
  const double peak = Peak(push);
  if (!(Length(push.force.back()) > kStillOn * peak)) return false;
  return push.EndFrame() >= num_frames - 1 || Length(push.force.front()) < kSlowStart * peak;
}

bool IsClipped(const ScenePush& push) {
  if (push.kind != PushKind::kExternal) return false;
  const double peak = Peak(push);
  const auto& rows = push.force;
  const auto at_top = [peak](const auto& row) { return Length(row) > (1.0 - kSameValue) * peak; };
  const auto first = std::find_if(rows.begin(), rows.end(), at_top);
  const auto after = std::find_if_not(first, rows.end(), at_top);
  if (after - first < 3 || first == rows.begin() || after == rows.end()) return false;
  const double slope = std::min(peak - Length(*(first - 1)), peak - Length(*after));
  return 2 * (after - first) < static_cast<long>(rows.size()) &&
         0.5 * static_cast<double>(after - first) * slope > kCutOff * peak;
}

const std::vector<FindingRow>& Names(FindingKind) {
  using Kind = FindingKind;
  static const std::vector<FindingRow> kRows = {
      {"push against motion", Kind::kAgainst, "the person moves against the push", "degrees off",
       "is the push's sign right, and are `up` and `forward`?", true},
      {"push beside motion", Kind::kAside, "the person moves in another direction than the push",
       "degrees off", "are `up` and `forward` right, and the direction of the push?", true},
      {"impulse", Kind::kGain, "the speed that the push gives is not its impulse over the mass",
       "times it",
       "is the force in N (1 kN = 1000 N, 1 kgf = 9.81 N, 1 lbf = 4.45 N), its gain right, and the "
       "mass in kg?",
       true},
      {"net impulse", Kind::kNetGain,
       "the motion during a net push is not what its force makes of the mass", "times it",
       "was it computed from this motion, with this mass and in N? a measured push is external",
       true},
      {"late push", Kind::kLate, "the person moves before being pushed", "s",
       "is the push's start right (start_frame, first_frame), and the sensor's clock "
       "(pushid-push --sensor_start)? a person who moves all the time needs "
       "initial_velocity",
       true},
      {"early push", Kind::kEarly, "the person moves long after being pushed", "s late",
       "is the push's start right (start_frame, first_frame), and the sensor's clock "
       "(pushid-push --sensor_start)?",
       true},
      {"force at rest", Kind::kZero, "the force does not return to zero", "N at the end",
       "the sensor has an offset, which counts as a push: subtract it (pushid-push does)", true},
      {"push without an end", Kind::kNoEnd, "the push ends while its force is large",
       "N at the end", "is the record cut off? Give all of it", true},
      {"flat top", Kind::kClipped, "the force rises and then stays at its largest value", "N",
       "the sensor's range was exceeded, and the push was larger: leave these recordings out "
       "(--leave_out)",
       true},
      {"strong push", Kind::kStrong, "the push is above 1 kN", "N",
       "people rarely push so hard: is its unit N, and is its window right?", false},
      {"first row", Kind::kFirstRow, "the push's first row stands out", "N",
       "the person already moves when the push begins: see pushid-push --initial_velocity", false},
      {"mass", Kind::kMass, "the mass is unusual for the height of the hip", "kg",
       "is mass_kg right, and in kg?", true},
      {"rod", Kind::kRod, "the distance between hip and ankles is implausible", "m",
       "are `joints` and the unit (length_unit) right?", true},
      {"speed", Kind::kSpeed, "the hip is implausibly fast", "m/s",
       "does a marker jump there, and are length_unit and fps right?", true},
      {"frame rate", Kind::kRate, "the frame rate is unusual", "per second",
       "is fps really frames per second?", true},
      {"facing", Kind::kFacing, "according to the ankles people do not face forward", "degrees off",
       "are `up` and `forward` right, and the ankles not exchanged?", true},
      {"copy", Kind::kCopy, "the same motion is repeated", "",
       "copies add nothing and count once: leave them out (--leave_out)", true},
  };
  return kRows;
}

bool FirstRowStandsOut(const std::vector<Vector4<double>>& force) {
  if (force.size() < 3) return false;
  double others = 0.0;
  for (size_t t = 1; t < force.size(); ++t) others = std::max(others, Length(force[t]));
  return Length(force[0]) > kStandsOut * others;
}

std::vector<Finding> FindingsOf(const PendulumRecording& recording) {
  return Judge(recording).Look();
}

// The facing follows from the line between the ankles, where it is long enough.
std::vector<Finding> FacingFindings(const Recording& recording) {
  std::vector<Finding> found;
  // Forward is the way of the push: a group that nobody and nothing pushes may face each other.
  const bool moved = !recording.pushes.empty() || !recording.ground.empty();
  if (!moved && recording.people.size() > 1) return found;
  for (const RecordedPerson& person : recording.people) {
    const Eigen::Vector2d to_the_left = (person.left_ankle[0] - person.right_ankle[0]).head<2>();
    const double facing = std::fabs(std::atan2(-to_the_left.x(), to_the_left.y()));
    if (to_the_left.norm() < kApart || facing <= kFacesElsewhere) continue;
    found.push_back(
        {FindingKind::kFacing, recording.id, person.subject_id, std::round(facing / kDegree)});
  }
  return found;
}

std::vector<Finding> FindingsOf(const Recording& recording) {
  std::vector<Finding> found = FindingsOf(MakePendulumRecording(recording));
  for (Finding& finding : FacingFindings(recording)) found.push_back(std::move(finding));
  return found;
}

std::vector<int> CopyOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<int> first(recordings.size(), -1);
  for (size_t i = 0; i < recordings.size(); ++i) {
    for (size_t j = i + 1; first[i] < 0 && j < recordings.size(); ++j) {
      if (first[j] < 0 && SameMotion(recordings[i], recordings[j])) first[j] = static_cast<int>(i);
    }
  }
  return first;
}

std::vector<Finding> FindingsOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<Finding> found;
  for (const PendulumRecording& recording : recordings) {
    for (Finding& finding : FindingsOf(recording)) found.push_back(std::move(finding));
  }
  std::map<int, std::vector<std::string>> copies;
  const std::vector<int> first = CopyOf(recordings);
  for (size_t i = 0; i < first.size(); ++i) {
    if (first[i] >= 0) copies[first[i]].push_back(recordings[i].id);
  }
  for (const auto& [of, ids] : copies) {
    found.push_back(
        {FindingKind::kCopy, recordings[of].id, ListOfNames(ids), static_cast<double>(ids.size())});
  }
  return found;
}

std::vector<Finding> FitFindings(std::vector<Finding> findings) {
  const auto other = [](const Finding& finding) { return !RowOf(finding.kind).in_fits; };
  findings.erase(std::remove_if(findings.begin(), findings.end(), other), findings.end());
  return findings;
}

std::vector<std::string> FindingTexts(const std::vector<Finding>& findings) {
  std::vector<std::string> texts;
  for (const FindingRow& row : Names(FindingKind{})) {
    std::vector<std::string> cases;
    for (const Finding& finding : findings) {
      if (finding.kind == row.value) cases.push_back(Case(finding, row.unit));
    }
    if (cases.empty()) continue;
    const std::string count = CountText(cases.size(), "case");
    if (cases.size() > kNamedCases) {
      cases.resize(kNamedCases);
      cases.emplace_back("...");
    }
    texts.push_back(row.what + (" in " + count) + " (" + Joined(cases, "; ") + "); " + row.advice);
  }
  return texts;
}

Warnings FindingWarnings(const std::vector<Finding>& findings) {
  const std::vector<std::string> texts = FindingTexts(findings);
  return {texts.begin(), texts.end()};
}

Warnings FacingWarnings(const std::vector<Recording>& recordings) {
  std::vector<Finding> found;
  for (const Recording& recording : recordings) {
    for (Finding& finding : FacingFindings(recording)) found.push_back(std::move(finding));
  }
  return FindingWarnings(found);
}

}  // namespace pushid
