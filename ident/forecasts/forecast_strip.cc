// ident: a strip of poses, with the fan of sampled futures.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"
#include "ident/forecasts/forecast_scene.h"

namespace pushid {
namespace {

constexpr double kPanelHeight = 260, kTop = 40, kBottom = 26, kSide = 16;
constexpr size_t kMostFutures = 20;  // more of them hide one another

struct View {
  int across, up;  // axes of the picture
  double low_across, high_across, low_up, high_up;
};

View ViewOf(const ForecastScene& scene) {
  const ParticleLayout& layout = scene.layout;
  View view{3 - layout.up_axis - layout.mirrored_axis, layout.up_axis, 1e9, -1e9, 1e9, -1e9};
  const auto see = [&view](const Trajectories& motion) {
    for (Eigen::Index t = 0; t < motion.cols(); ++t) {
      for (Eigen::Index i = 0; i + 2 < motion.rows(); i += 3) {
        view.low_across = std::min<double>(view.low_across, motion(i + view.across, t));
        view.high_across = std::max<double>(view.high_across, motion(i + view.across, t));
        view.low_up = std::min<double>(view.low_up, motion(i + view.up, t));
        view.high_up = std::max<double>(view.high_up, motion(i + view.up, t));
      }
    }
  };
  for (const Trajectories* motion : {&scene.observed, &scene.recorded, &scene.forecast}) {
    see(*motion);
  }
  for (size_t i = 0; i < std::min(kMostFutures, scene.futures.size()); ++i) {
    see(scene.futures[i].motion);
  }
  return view;
}

}  // namespace

std::string ForecastStripSvg(const ForecastScene& scene, int poses) {
  const View view = ViewOf(scene);
  const double scale = (kPanelHeight - kTop - kBottom) / std::max(0.1, view.high_up - view.low_up);
  const double panel = scale * (view.high_across - view.low_across) + kSide;
  const double width = std::max(520.0, poses * panel + kSide);
  SvgPicture svg(width, kPanelHeight, scene.title);
  svg.Text(kSide, 18, scene.title, "ink bold");
  svg.Text(kSide, 32, "recorded grey, sampled futures faint, forecast blue", "faint small");
  const auto draw = [&](const Trajectories& motion, Eigen::Index t, double left,
                        const std::string& look) {
    if (t < 0 || t >= motion.cols()) return;
    const auto x = [&](const Eigen::Vector3f& p) {
      return left + scale * (p(view.across) - view.low_across);
    };
    const auto y = [&](const Eigen::Vector3f& p) {
      return kPanelHeight - kBottom - scale * (p(view.up) - view.low_up);
    };
    for (int i = 0; i < scene.layout.num_particles(); ++i) {
      const int parent = scene.layout.parents[i];
      if (parent == kNoBone) continue;
      const Eigen::Vector3f end = motion.col(t).segment<3>(3 * i);
      const Eigen::Vector3f start = parent == kFixedPoint
                                        ? Eigen::Vector3f(scene.layout.fixed.col(i))
                                        : Eigen::Vector3f(motion.col(t).segment<3>(3 * parent));
      svg.Line(x(start), y(start), x(end), y(end), look);
      // All fixed points hang on the root, which is the origin.
      const Eigen::Vector3f root = Eigen::Vector3f::Zero();
      if (parent == kFixedPoint) svg.Line(x(root), y(root), x(start), y(start), look);
    }
  };
  const int observed = scene.num_observed(), last = scene.num_frames() - 1;
  for (int k = 0; k < poses; ++k) {
    const double share = poses > 1 ? static_cast<double>(k) / (poses - 1) : 1.0;
    const int frame = static_cast<int>(std::lround(observed - 1 + share * (last - (observed - 1))));
    const int t = frame - observed;
    const double left = kSide + k * panel;
    for (size_t i = 0; i < std::min(kMostFutures, scene.futures.size()); ++i) {
      draw(scene.futures[i].motion, t, left, "stroke:#7fb3e6;stroke-width:1;opacity:0.35");
    }
    draw(t < 0 ? scene.observed : scene.recorded, t < 0 ? frame : t, left,
         "stroke:#8a8a8a;stroke-width:3");
    draw(scene.forecast, t, left, "stroke:#2a78c8;stroke-width:2");
    svg.Text(left + 0.5 * (panel - kSide), kPanelHeight - 8, Rounded((t + 1) * scene.dt, 3) + " s",
             "axis middle");
  }
  return svg.ToString();
}

}  // namespace pushid
