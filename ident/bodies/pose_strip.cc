// ident: the strip of poses.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "datasets/files/number_text.h"
#include "ident/bodies/animation.h"
#include "ident/figures/chart.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kStripHeight = 226, kTop = 56, kBottom = 34, kSide = 16;
constexpr double kHighest = 2.05;          // m, of a panel
constexpr double kNewtonsPerMetre = 1000;  // length of force arrows
constexpr double kLeastForce = 5.0;        // N, that is drawn

constexpr char kRecordedLook[] = "stroke:#9a9a9a;stroke-width:2;opacity:0.8";
constexpr char kPendulumLook[] = "stroke:#d1495b;stroke-width:1.5;stroke-dasharray:4 3";
constexpr char kForceLook[] = "stroke:#e0a100;stroke-width:3";

std::string PushLook() {
  return std::string("fill:none;stroke-width:2.5;stroke:") + kAnimatedPushColour;
}

// Right limbs darker than left ones, so that a pose reads from the side.
bool OnRight(int joint) { return (joint >= 6 && joint < 10) || (joint >= 14 && joint < 18); }

std::string ColourOfWhat(int what) {
  return kAnimationColours[static_cast<size_t>(what) % std::size(kAnimationColours)];
}

std::string BoneLook(const AnimatedPerson& person, int what, int joint) {
  if (person.recorded) return kRecordedLook;
  return "stroke:" + ColourOfWhat(what) + ";stroke-width:2.2" +
         (OnRight(joint) ? "" : ";opacity:0.6");
}

// One moment: offset puts x = 0 m at a pixel.
class Panel {
 public:
  Panel(double pixels_per_metre, double x_pixel, double floor_pixel, SvgPicture* svg)
      : scale_(pixels_per_metre), x_(x_pixel), floor_(floor_pixel), svg_(svg) {}

  // `what`: which of the what-ifs; several are told apart by their pendulums too.
  void Draw(const AnimatedPerson& person, int what, bool several, int t) {
    if (t < static_cast<int>(person.body.size())) {
      const Pose& pose = person.body[t];
      for (int j = 1; j < kBodyJoints; ++j) {
        Bone(pose.col(kBodyParents[j]), pose.col(j), BoneLook(person, what, j));
      }
      const Eigen::Vector3d head = pose.col(kBodyHead);
      svg_->Circle(X(head), Y(head), 0.085 * scale_,
                   person.recorded ? "fill:#9a9a9a;opacity:0.6" : "fill:" + ColourOfWhat(what));
    }
    const bool hidden = person.recorded && !person.body.empty();  // the body says it all
    if (t < static_cast<int>(person.cart.size()) && !hidden) {
      const std::string own = several ? "stroke:" + ColourOfWhat(what) + ";stroke-width:1.5" : "";
      Bone(person.cart[t], person.tip[t],
           person.recorded ? kRecordedLook
           : several       ? own
                           : kPendulumLook);
      const std::string colour = several ? ColourOfWhat(what) : "#d1495b";
      svg_->Circle(X(person.tip[t]), Y(person.tip[t]), 3,
                   "fill:" + (person.recorded ? "#9a9a9a" : colour));
    }
    if (t >= static_cast<int>(person.force.size())) return;
    const Eigen::Vector3d force(person.force[t][0], person.force[t][1], 0.0);
    if (force.norm() < kLeastForce) return;
    Bone(person.tip[t], person.tip[t] + force / kNewtonsPerMetre, kForceLook);
  }

  // The feet that stand, the left one paler; recorded ones under predicted ones.
  void DrawFeet(const AnimatedPerson& person, int what, int t) {
    for (const Footprint& print : person.footprints) {
      if (t < print.landing || t >= print.lift_off) continue;
      const double ahead = std::cos(person.facing), x = x_ + scale_ * print.place.x();
      const double y = floor_ + (person.recorded ? 6.5 : 2.5);
      const char* const paler = print.foot == Foot::kLeft ? ";opacity:0.5" : "";
      svg_->Line(x - scale_ * kSoleBehind * ahead, y, x + scale_ * kSoleBefore * ahead, y,
                 "stroke-width:3;stroke:" +
                     (person.recorded ? std::string("#9a9a9a") : ColourOfWhat(what)) + paler);
    }
  }

  // A ring round the hip of who is pushed; while it acts the push, which ends there, and its size.
  void Mark(const Eigen::Vector3d& hip, const AnimatedPush& push, int t) {
    svg_->Circle(X(hip), Y(hip), 7, PushLook());
    if (t < push.start || t >= push.start + static_cast<int>(push.force.size())) return;
    const Vector4<double>& force = push.force[t - push.start];
    const double size = force.head<2>().norm();
    if (size < kLeastForce) return;
    Bone(hip - Eigen::Vector3d(force[0], force[1], 0.0) / kNewtonsPerMetre, hip, PushLook());
    const double back = force[0] < 0.0 ? 6.0 : -6.0;
    for (const double side : {-4.0, 4.0}) {
      svg_->Line(X(hip), Y(hip), X(hip) + back, Y(hip) + side, PushLook());
    }
    svg_->Text(X(hip), kTop + 4, SvgNumber(std::round(size)) + " N", "ink small middle");
  }

 private:
  double X(const Eigen::Vector3d& p) const { return x_ + scale_ * p.x(); }
  double Y(const Eigen::Vector3d& p) const { return floor_ - scale_ * p.z(); }
  void Bone(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const std::string& look) {
    svg_->Line(X(a), Y(a), X(b), Y(b), look);
  }

  const double scale_, x_, floor_;
  SvgPicture* svg_;
};

// Where a person's hip is; nothing beyond the last frame.
std::optional<Eigen::Vector3d> HipAt(const AnimatedPerson& person, int t) {
  if (t < static_cast<int>(person.tip.size())) return person.tip[t];
  if (t < static_cast<int>(person.body.size())) return person.body[t].col(0);
  return std::nullopt;
}

// How far everybody's joints, or hips, go from one frame to the next: the sum over people.
double MotionTo(const Animation& animation, int t) {
  double sum = 0.0;
  for (const AnimatedPerson& person : animation.people) {
    if (t < static_cast<int>(person.body.size())) {
      sum += (person.body[t] - person.body[t - 1]).colwise().norm().mean();
    } else if (t < static_cast<int>(person.tip.size())) {
      sum += (person.tip[t] - person.tip[t - 1]).norm();
    }
  }
  return sum;
}

// Frames that part the motion into equal stretches, first and last among them; in time where
// nothing moves. Even frames would show a fall in one pose and waiting in six.
std::vector<int> FramesByMotion(const Animation& animation, int poses) {
  const int last = animation.num_frames() - 1;
  std::vector<double> way = {0.0};
  for (int t = 1; t <= last; ++t) way.push_back(way.back() + MotionTo(animation, t));
  std::vector<int> frames;
  for (int i = 0; i < poses; ++i) {
    const double share = poses > 1 ? static_cast<double>(i) / (poses - 1) : 0.0;
    const auto there = std::lower_bound(way.begin(), way.end(), share * way.back());
    const int by_motion = static_cast<int>(std::min<std::ptrdiff_t>(last, there - way.begin()));
    const int by_time = static_cast<int>(std::lround(share * last));
    frames.push_back(way.back() > 0.0 ? (i == poses - 1 ? last : by_motion) : by_time);
  }
  return frames;
}

// The same with the moment at which a push is hardest in the place of the one next to it: a short
// push would fall between two.
std::vector<int> FramesWithPush(const Animation& animation, int poses) {
  std::vector<int> frames = FramesByMotion(animation, poses);
  int hardest = -1;
  double most = kLeastForce;
  for (const AnimatedPush& push : animation.pushes) {
    for (size_t i = 0; i < push.force.size(); ++i) {
      const double size = push.force[i].head<2>().norm();
      if (size > most) most = size, hardest = push.start + static_cast<int>(i);
    }
  }
  if (hardest < 0 || hardest >= animation.num_frames() || poses < 3) return frames;
  const auto nearest = std::min_element(
      frames.begin() + 1, frames.end() - 1,
      [hardest](int a, int b) { return std::abs(a - hardest) < std::abs(b - hardest); });
  if (std::find(frames.begin(), frames.end(), hardest) == frames.end()) *nearest = hardest;
  std::sort(frames.begin(), frames.end());
  return frames;
}

// What the strip draws, and no more.
std::vector<LegendEntry> LegendOf(const Animation& animation) {
  std::vector<LegendEntry> legend;
  const auto any = [&animation](auto has) {
    return std::any_of(animation.people.begin(), animation.people.end(), has);
  };
  if (any([](const AnimatedPerson& p) { return p.recorded; })) {
    legend.push_back({"recorded", kRecordedLook});
  }
  const std::vector<std::string> whats = WhatsOf(animation);
  const bool bodies = any([](const AnimatedPerson& p) { return !p.recorded && !p.body.empty(); });
  for (size_t k = 0; k < whats.size(); ++k) {
    const bool alone = whats.size() == 1 && whats[0].empty();
    if (alone && !bodies) continue;  // pendulums have an entry of their own
    legend.push_back({alone              ? "predicted, left limbs paler"
                      : whats[k].empty() ? kAsFitted
                                         : whats[k],
                      "stroke-width:2.5;stroke:" + ColourOfWhat(static_cast<int>(k))});
  }
  if (whats.size() == 1 &&
      any([](const AnimatedPerson& p) { return !p.recorded && !p.tip.empty(); })) {
    legend.push_back({"pendulum", kPendulumLook});
  }
  if (any([](const AnimatedPerson& p) { return !p.force.empty(); })) {
    legend.push_back({"net force, 1 m = 1000 N", kForceLook});
  }
  if (!animation.pushes.empty()) legend.push_back({"pushed person and push", PushLook()});
  return legend;
}

// Smallest and largest x of everything that is shown.
std::pair<double, double> ExtentX(const Animation& animation) {
  double low = 1e9, high = -1e9;
  const auto see = [&](double x) { low = std::min(low, x), high = std::max(high, x); };
  for (const AnimatedPerson& person : animation.people) {
    for (const Pose& pose : person.body) see(pose.row(0).minCoeff()), see(pose.row(0).maxCoeff());
    for (const auto& tip : person.tip) see(tip.x());
  }
  return low > high ? std::make_pair(-1.0, 1.0) : std::make_pair(low - 0.1, high + 0.1);
}

}  // namespace

SvgPicture PoseStrip(const Animation& animation, int poses) {
  const auto [low, high] = ExtentX(animation);
  const double scale = (kStripHeight - kTop - kBottom) / kHighest;
  const double panel = scale * (high - low) + kSide;
  const double floor = kStripHeight - kBottom;
  const std::vector<LegendEntry> legend = LegendOf(animation);
  const double width = std::max({480.0, panel * poses + kSide, 2.0 * kSide + LegendWidth(legend)});
  SvgPicture svg(width, kStripHeight, animation.title);
  svg.Text(kSide, 18, animation.title, "ink bold");
  DrawLegend(legend, kSide, 38, &svg);
  svg.Line(0, floor, panel * poses + kSide, floor, "axis");
  const std::vector<std::string> whats = WhatsOf(animation);
  const std::vector<int> frames = FramesWithPush(animation, poses);
  for (int i = 0; i < poses; ++i) {
    const int t = frames[i];
    const double left = kSide + panel * i;
    Panel drawn(scale, left - scale * low, floor, &svg);
    for (const bool recorded : {true, false}) {
      for (const AnimatedPerson& person : animation.people) {
        if (person.recorded != recorded) continue;
        const auto what = std::find(whats.begin(), whats.end(), person.what) - whats.begin();
        drawn.Draw(person, static_cast<int>(what), whats.size() > 1, t);
        drawn.DrawFeet(person, static_cast<int>(what), t);
      }
    }
    for (const AnimatedPush& push : animation.pushes) {
      // The last of the name: predicted before recorded.
      for (auto p = animation.people.rbegin(); p != animation.people.rend(); ++p) {
        const auto hip = HipAt(*p, t);
        if (p->name != push.person || !hip) continue;
        drawn.Mark(*hip, push, t);
        break;
      }
    }
    svg.Text(left + 0.5 * (panel - kSide), floor + 22, Rounded(t * animation.dt, 3) + " s",
             "axis middle");
  }
  return svg;
}

}  // namespace pushid
