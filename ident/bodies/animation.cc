// ident: collecting what an animation shows; the strip of poses.
#include "ident/bodies/animation.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kStripHeight = 210, kTop = 40, kBottom = 34, kSide = 16;
constexpr double kHighest = 2.05;          // m, of a panel
constexpr double kNewtonsPerMetre = 1000;  // length of force arrows

// Right limbs darker than left ones, so that a pose reads from the side.
bool OnRight(int joint) { return (joint >= 6 && joint < 10) || (joint >= 14 && joint < 18); }

std::string BoneLook(const AnimatedPerson& person, int joint) {
  if (person.recorded) return "stroke:#9a9a9a;stroke-width:2;opacity:0.8";
  return OnRight(joint) ? "stroke:#1f5f8b;stroke-width:2.2" : "stroke:#3aa0d8;stroke-width:2.2";
}

// One moment: offset puts x = 0 m at a pixel.
class Panel {
 public:
  Panel(double pixels_per_metre, double x_pixel, double floor_pixel, SvgPicture* svg)
      : scale_(pixels_per_metre), x_(x_pixel), floor_(floor_pixel), svg_(svg) {}

  void Draw(const AnimatedPerson& person, int t) {
    if (t < static_cast<int>(person.body.size())) {
      const Pose& pose = person.body[t];
      for (int j = 1; j < kBodyJoints; ++j) {
        Bone(pose.col(kBodyParents[j]), pose.col(j), BoneLook(person, j));
      }
      const Eigen::Vector3d head = pose.col(kBodyHead);
      svg_->Circle(X(head), Y(head), 0.085 * scale_,
                   person.recorded ? "fill:#9a9a9a;opacity:0.6" : "fill:#3aa0d8");
    }
    if (t < static_cast<int>(person.cart.size())) {
      Bone(person.cart[t], person.tip[t], "stroke:#d1495b;stroke-width:1.5;stroke-dasharray:4 3");
      svg_->Circle(X(person.tip[t]), Y(person.tip[t]), 3, "fill:#d1495b");
    }
    if (t >= static_cast<int>(person.force.size())) return;
    const Eigen::Vector3d force(person.force[t][0], person.force[t][1], 0.0);
    if (force.norm() < 5.0) return;
    Bone(person.tip[t], person.tip[t] + force / kNewtonsPerMetre, "stroke:#e0a100;stroke-width:3");
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

void AddBodies(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
               bool recorded, Animation* animation) {
  for (size_t n = 0; n < bodies.size(); ++n) {
    AnimatedPerson person;
    person.name = names[n];
    person.recorded = recorded;
    person.body = bodies[n];
    animation->people.push_back(std::move(person));
  }
}

}  // namespace

int Animation::num_frames() const {
  size_t frames = 0;
  for (const AnimatedPerson& person : people) {
    frames = std::max({frames, person.body.size(), person.tip.size()});
  }
  return static_cast<int>(frames);
}

void AddPrediction(const PendulumRecording& recording, const Prediction& prediction,
                   const std::vector<BodyMotion>& bodies, Animation* animation) {
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    AnimatedPerson person;
    person.name = recording.subject_ids[n];
    if (n < static_cast<int>(bodies.size())) person.body = bodies[n];
    person.tip = prediction.hip[n];
    for (int t = 0; t < prediction.path.num_frames(); ++t) {
      const Vector4<double>& q = prediction.path.At(t, n).q;
      person.cart.emplace_back(q[0], q[1], recording.scene.people[n].body.cart_height);
      person.force.push_back(prediction.forces.At(t, n).Total());
    }
    animation->people.push_back(std::move(person));
  }
}

void AddRecorded(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  AddBodies(names, bodies, true, animation);
}

void AddForecast(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  AddBodies(names, bodies, false, animation);
}

std::string PoseStripSvg(const Animation& animation, int poses) {
  const auto [low, high] = ExtentX(animation);
  const double scale = (kStripHeight - kTop - kBottom) / kHighest;
  const double panel = scale * (high - low) + kSide;
  const double floor = kStripHeight - kBottom;
  const double width = std::max(480.0, panel * poses + kSide);
  SvgPicture svg(width, kStripHeight, animation.title);
  svg.Text(kSide, 18, animation.title, "ink bold");
  svg.Text(kSide, 32,
           "recorded grey, predicted blue (right limbs darker), pendulum red, net force "
           "yellow (1 m = 1000 N)",
           "faint small");
  svg.Line(0, floor, width, floor, "axis");
  const int last = animation.num_frames() - 1;
  for (int i = 0; i < poses; ++i) {
    const int t = poses > 1 ? static_cast<int>(std::lround(1.0 * i * last / (poses - 1))) : 0;
    const double left = kSide + panel * i;
    Panel drawn(scale, left - scale * low, floor, &svg);
    for (const bool recorded : {true, false}) {
      for (const AnimatedPerson& person : animation.people) {
        if (person.recorded == recorded) drawn.Draw(person, t);
      }
    }
    svg.Text(left + 0.5 * (panel - kSide), floor + 18, Rounded(t * animation.dt, 3) + " s",
             "axis middle");
  }
  return svg.ToString();
}

}  // namespace pushid
