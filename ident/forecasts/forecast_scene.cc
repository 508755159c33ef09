#include "ident/forecasts/forecast_scene.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "datasets/files/atomic_file.h"

namespace pushid {
namespace {

constexpr size_t kMostFutures = 20;  // on a page; more of them hide one another

// An animated person: the observed frames, then `next`.
AnimatedPerson PersonOf(const ForecastScene& scene, const Trajectories& next,
                        const std::string& what) {
  const ParticleLayout& layout = scene.layout;
  const int particles = layout.num_particles();
  const int axes[] = {3 - layout.up_axis - layout.mirrored_axis, layout.mirrored_axis,
                      layout.up_axis};  // of the page's x, y and z
  AnimatedPerson person;
  person.what = what;
  person.parents = layout.parents;
  // The fixed points follow the particles; their parent is the origin, the last joint.
  for (int& parent : person.parents) {
    if (parent == kFixedPoint) parent = particles + static_cast<int>(&parent - &person.parents[0]);
  }
  for (int i = 0; i < particles; ++i) {
    person.parents.push_back(layout.parents[i] == kFixedPoint ? 2 * particles : -1);
  }
  person.parents.push_back(-1);
  for (int t = 0; t < scene.num_observed() + static_cast<int>(next.cols()); ++t) {
    const bool seen = t < scene.num_observed();
    const Eigen::VectorXf now = seen ? scene.observed.col(t) : next.col(t - scene.num_observed());
    Eigen::Matrix3Xd joints = Eigen::Matrix3Xd::Zero(3, 2 * particles + 1);
    for (int i = 0; i < particles; ++i) {
      for (int k = 0; k < 3; ++k) {
        joints(k, i) = now[3 * i + axes[k]];
        if (layout.fixed.cols() > 0) joints(k, particles + i) = layout.fixed(axes[k], i);
      }
    }
    person.joints.push_back(std::move(joints));
  }
  return person;
}

void AppendRows(const char* source, int future, const Trajectories& motion, int first_frame,
                const ForecastScene& scene, AtomicFile* file) {
  char row[256];
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    const int frame = first_frame + static_cast<int>(t);
    for (int i = 0; i < scene.layout.num_particles(); ++i) {
      const Eigen::Vector3f p = motion.col(t).segment<3>(3 * i);
      std::snprintf(row, sizeof row, "%d,%.9g,%s,%d,%s,%.6f,%.6f,%.6f\n", frame, frame * scene.dt,
                    source, future, scene.layout.names[i].c_str(), p.x(), p.y(), p.z());
      file->Append(row);
    }
  }
}

}  // namespace

Animation ToAnimation(const ForecastScene& scene) {
  Animation animation;
  animation.title = scene.title;
  animation.dt = scene.dt;
  animation.people.push_back(PersonOf(scene, scene.recorded, ""));
  animation.people.back().recorded = true;
  for (size_t i = 0; i < std::min(kMostFutures, scene.futures.size()); ++i) {
    animation.people.push_back(PersonOf(scene, scene.futures[i].motion, "sampled futures"));
  }
  animation.people.push_back(PersonOf(scene, scene.forecast, "forecast"));
  double low = 0.0;
  for (const AnimatedPerson& person : animation.people) {
    for (const auto& joints : person.joints) low = std::min(low, joints.row(2).minCoeff());
  }
  for (AnimatedPerson& person : animation.people) {
    for (auto& joints : person.joints) joints.row(2).array() -= low;
  }
  return animation;
}

MaybeError WriteForecastCsv(const std::string& path, const ForecastScene& scene) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append("frame,time_s,source,future,joint,x_m,y_m,z_m\n");
  const int next = scene.num_observed();
  AppendRows("observed", 0, scene.observed, 0, scene, &file);
  AppendRows("recorded", 0, scene.recorded, next, scene, &file);
  AppendRows("forecast", 0, scene.forecast, next, scene, &file);
  for (size_t i = 0; i < scene.futures.size(); ++i) {
    AppendRows("future", static_cast<int>(i) + 1, scene.futures[i].motion, next, scene, &file);
  }
  return file.Commit();
}

}  // namespace pushid
