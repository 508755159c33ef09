// ident: the picture of a push that travels.
#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"
#include "ident/formations/formation_files.h"

namespace pushid {
namespace {

constexpr double kWaveLeft = 112, kWaveTop = 40, kMapWidth = 610, kWaveWidth = 960, kSide = 770;
constexpr double kFastWalk = 2.5;  // m/s; faster than that somebody falls, and colours saturate
constexpr int kColours = 48;       // levels of speed that are told apart, either way
constexpr char kPushFrame[] = "fill:none;stroke:#ff5a36;stroke-width:2";
constexpr char kBandBorder[] = "stroke:#000;stroke-width:4";
constexpr char kBandLine[] = "stroke:#fff;stroke-width:2";
constexpr char kOnsetDot[] = "fill:#fff;stroke:#000;stroke-width:1";

class WavePicture {
 public:
  WavePicture(const FormationRun& run, const std::string& title,
              const std::vector<OnsetBand>& onsets)
      : run_(run),
        onsets_(onsets),
        row_(std::clamp(380.0 / run.num_people(), 3.0, 30.0)),
        bottom_(kWaveTop + row_ * run.num_people()),
        time_(0.0, run.Seconds(run.num_frames()), kWaveLeft, kWaveLeft + kMapWidth),
        svg_(kWaveWidth, std::max(bottom_ + 62.0, 400.0), title) {
    for (const PersonSummary& person : run.summaries)
      fastest_ = std::max(fastest_, person.peak_speed);
    full_ = std::min(fastest_, kFastWalk);
    svg_.Text(kWaveLeft, 22, title, "ink bold");
  }

  std::string Draw() {
    for (int n = 0; n < run_.num_people(); ++n) Row(n);
    for (int n = 0; n < run_.num_people(); ++n) Label(n);
    Marks();
    TimeAxis();
    ColourBar();
    Plan();
    return svg_.ToString();
  }

 private:
  double RowTop(int person) const { return kWaveTop + row_ * person; }
  // The colour goes with the root of the speed: a wave that fades stays visible.
  double Fraction(double speed) const {
    return full_ > 0.0 ? std::sqrt(std::min(1.0, speed / full_)) : 0.0;
  }
  // Negative for a person who goes back more than aside.
  int Level(int person, int frame) const {
    const double speed = SignedHipSpeed(run_, person, frame);
    const int level = static_cast<int>(std::lround(Fraction(std::abs(speed)) * (kColours - 1)));
    return speed < 0.0 ? -level : level;
  }

  // Frames of the same level are one rectangle.
  void Row(int person) {
    for (int begin = 0, end = 0; begin < run_.num_frames(); begin = end) {
      const int level = Level(person, begin);
      while (end < run_.num_frames() && Level(person, end) == level) ++end;
      const double x = time_(run_.Seconds(begin));
      // Overlaps the next one, for rounded numbers would leave gaps.
      const double overlap = end < run_.num_frames() ? 0.5 : 0.0;
      svg_.Rect({x, RowTop(person), time_(run_.Seconds(end)) - x + overlap, row_},
                "fill:" + SignedColourOf(level / (kColours - 1.0)));
    }
  }

  void Label(int person) {
    const int every = row_ >= 11.0 ? 1 : row_ >= 5.0 ? 5 : 10;
    const double y = RowTop(person) + 0.5 * row_ + 4.0;
    if (person % every == 0) {
      const Vector4<double>& q = run_.recording.scene.people[person].start.q;
      svg_.Text(kWaveLeft - 8, y,
                std::to_string(person) + "  (" + SvgNumber(q[0]) + ", " + SvgNumber(q[1]) + ")",
                "ink small end");
    }
    const Outcome outcome = run_.summaries[person].outcome;
    if (outcome == Outcome::kFell || (outcome == Outcome::kSlow && every == 1)) {
      // There is no room for "slow to settle".
      svg_.Text(kWaveLeft + kMapWidth + 4, y, outcome == Outcome::kSlow ? "slow" : NameOf(outcome),
                "ink small");
    }
  }

  void Marks() {
    for (const ScenePush& push : run_.recording.scene.pushes) {
      const double x = time_(run_.Seconds(push.start_frame));
      svg_.Rect({x, RowTop(push.person) + 1, time_(run_.Seconds(push.EndFrame())) - x, row_ - 2},
                kPushFrame);
    }
    for (int n = 0; n < run_.num_people(); ++n) {
      const int onset = run_.summaries[n].onset_frame;
      if (onset < 0) continue;
      Band(n);
      svg_.Circle(time_(run_.Seconds(onset)), RowTop(n) + 0.5 * row_, std::min(4.0, 0.4 * row_),
                  kOnsetDot);
    }
  }

  // Under the dot: a light bar with dark ends, seen on every colour.
  void Band(int person) {
    if (onsets_.empty() || onsets_[person].moved == 0.0) return;
    const double y = RowTop(person) + 0.5 * row_, half = std::min(4.0, 0.3 * row_);
    const double from = time_(onsets_[person].from), to = time_(onsets_[person].to);
    svg_.Line(from, y, to, y, kBandBorder);
    svg_.Line(from, y, to, y, kBandLine);
    for (const double x : {from, to}) svg_.Line(x, y - half, x, y + half, kBandBorder);
  }

  void TimeAxis() {
    svg_.Line(kWaveLeft, bottom_, kWaveLeft + kMapWidth, bottom_, "axis");
    for (double t : time_.Ticks(8)) {
      svg_.Line(time_(t), bottom_, time_(t), bottom_ + 4, "axis");
      svg_.Text(time_(t), bottom_ + 17, SvgNumber(t), "ink small middle");
    }
    svg_.Text(kWaveLeft + 0.5 * kMapWidth, bottom_ + 33, "time (s)", "ink middle");
    svg_.Text(kWaveLeft - 8, kWaveTop - 8, "person (x, y in m)", "faint small end");
    const double y = bottom_ + 50;
    svg_.Rect({kWaveLeft, y - 9, 16, 10}, kPushFrame);
    svg_.Text(kWaveLeft + 22, y, "push", "faint small");
    svg_.Circle(kWaveLeft + 68, y - 4, 4, kOnsetDot);
    const std::string onset = "onset: the hip has moved 2 cm";
    svg_.Text(
        kWaveLeft + 78, y,
        onset +
            (onsets_.empty() ? "" : "; bar: 90 % interval from the uncertainty of the parameters"),
        "faint small");
  }

  void ColourBar() {
    constexpr double kHalf = 80.0, kStep = kHalf / kColours;
    const double middle = kSide + kHalf;
    svg_.Text(kSide, kWaveTop + 2, "speed of the hip (m/s)", "ink");
    for (int k = -kColours; k < kColours; ++k) {
      svg_.Rect({middle + kStep * k, kWaveTop + 10, kStep, 12},
                "fill:" + SignedColourOf((k + 0.5) / kColours));
    }
    for (double v : SvgScale(0.0, full_, 0.0, 1.0).Ticks(2)) {
      for (double side : {-1.0, 1.0}) {
        const double x = middle + side * kHalf * Fraction(v);
        svg_.Line(x, kWaveTop + 22, x, kWaveTop + 26, "axis");
        if (v > 0.0 || side > 0.0) svg_.Text(x, kWaveTop + 37, SvgNumber(v), "ink small middle");
      }
    }
    svg_.Text(kSide, kWaveTop + 51, "back", "ink small");
    svg_.Text(middle + kHalf, kWaveTop + 51, "forward or aside", "ink small end");
    svg_.Text(kSide, kWaveTop + 66,
              full_ < fastest_
                  ? "saturated from " + Rounded(full_, 3) + " on; fastest " + Rounded(fastest_, 3)
                  : "full colour: " + Rounded(full_, 3) + ", the fastest",
              "faint small");
  }

  // Seen from above, x to the right as the push goes, y (left) up.
  void Plan() {
    if (run_.num_people() > 60) return;
    const auto& people = run_.recording.scene.people;
    double x_max = 0.0, y_max = 0.0;
    for (const ScenePerson& person : people) {
      x_max = std::max(x_max, person.start.q[0]);
      y_max = std::max(y_max, std::abs(person.start.q[1]));
    }
    const double pixels =
        std::min(140.0 / std::max(x_max, 0.1), 110.0 / std::max(2.0 * y_max, 0.1));
    const double left = kSide + 12, middle = kWaveTop + 114 + pixels * y_max;
    double radius = 11.0;
    for (size_t n = 1; n < people.size(); ++n) {
      const double gap = (people[n].start.q - people[n - 1].start.q).head<2>().norm();
      radius = std::min(radius, 0.47 * pixels * gap);
    }
    std::set<int> pushed;
    for (const ScenePush& push : run_.recording.scene.pushes) pushed.insert(push.person);
    svg_.Text(kSide, kWaveTop + 90, "from above; pushes go right", "ink");
    for (size_t n = 0; n < people.size(); ++n) {
      const double x = left + pixels * people[n].start.q[0];
      const double y = middle - pixels * people[n].start.q[1];
      svg_.Circle(x, y, radius, pushed.count(static_cast<int>(n)) ? kPushFrame : "ring");
      if (radius >= 6.5) svg_.Text(x, y + 3.5, std::to_string(n), "ink small middle");
    }
  }

  const FormationRun& run_;
  const std::vector<OnsetBand>& onsets_;  // empty: none are drawn
  const double row_, bottom_;
  const SvgScale time_;
  double fastest_ = 0.0, full_ = 0.0;  // m/s; the speed of full colour
  SvgPicture svg_;
};

}  // namespace

std::string WaveSvg(const FormationRun& run, const std::string& title,
                    const std::vector<OnsetBand>& onsets) {
  return WavePicture(run, title, onsets).Draw();
}

}  // namespace pushid
