#include "ident/forecasts/forecast_scene.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/formats/units.h"

namespace pushid {
namespace {

constexpr size_t kMostFutures = 20;  // more of them hide one another

// The observed frames and what follows them.
AnimatedPerson PersonOf(const ForecastScene& scene, const Trajectories& next,
                        const std::string& what) {
  const ParticleLayout& layout = scene.layout;
  const int particles = layout.num_particles();
  const int axes[] = {3 - layout.up_axis - layout.mirrored_axis, layout.mirrored_axis,
                      layout.up_axis};  // of the page's x, y and z
  AnimatedPerson person;
  person.what = what;
  person.parents = layout.parents;
  // Behind the particles the fixed points, which hang on the origin.
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

// Particles in the order of a BVH file, every one followed by what hangs on it.
void AddBelow(const ParticleLayout& layout, int parent, std::vector<int>* order) {
  for (int i = 0; i < layout.num_particles(); ++i) {
    if (layout.parents[i] != parent) continue;
    order->push_back(i);
    AddBelow(layout, i, order);
  }
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

MaybeError WriteCsv(const std::string& path, const ForecastScene& scene) {
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

MaybeError WriteOneBvh(const std::string& path, const ForecastScene& scene,
                       const Trajectories& next) {
  Trajectories whole(scene.observed.rows(), scene.observed.cols() + next.cols());
  whole << scene.observed, next;
  return WriteBvh(path, ToBvh(whole, scene.layout, scene.dt));
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

BvhMotion ToBvh(const Trajectories& motion, const ParticleLayout& layout, double dt) {
  BvhMotion bvh;
  bvh.frame_time_s = dt;
  std::vector<int> order;
  AddBelow(layout, kNoBone, &order);
  const bool has_fixed = order.empty();
  if (has_fixed) {
    BvhJoint root;
    root.name = "root";
    root.channels = DefaultBvhChannels(true);
    bvh.skeleton.joints.push_back(root);
    AddBelow(layout, kFixedPoint, &order);
  }
  const int first = has_fixed ? 1 : 0;
  std::vector<int> joint_of(layout.num_particles());
  for (size_t k = 0; k < order.size(); ++k) joint_of[order[k]] = static_cast<int>(k) + first;
  const auto local = [&](Eigen::Index t, int particle) -> Eigen::Vector3f {
    const Eigen::Vector3f place = motion.col(t).segment<3>(3 * particle);
    const int parent = layout.parents[particle];
    if (parent < 0) return kMillimetres * place;
    return kMillimetres * (place - motion.col(t).segment<3>(3 * parent));
  };
  for (int particle : order) {
    BvhJoint joint;
    joint.name = layout.names[particle];
    const int parent = layout.parents[particle];
    joint.parent = parent >= 0 ? joint_of[parent] : has_fixed ? 0 : -1;
    joint.offset = local(0, particle).cast<double>();
    joint.channels = DefaultBvhChannels(true);
    const auto hanging = std::count(layout.parents.begin(), layout.parents.end(), particle);
    if (hanging == 0) joint.end_sites.push_back(Eigen::Vector3d::Zero());
    bvh.skeleton.joints.push_back(joint);
  }
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    if (has_fixed) bvh.values.insert(bvh.values.end(), 6, 0.0);
    for (int particle : order) {
      const Eigen::Vector3f place = local(t, particle);
      for (int k = 0; k < 3; ++k) bvh.values.push_back(place(k));
      bvh.values.insert(bvh.values.end(), 3, 0.0);
    }
  }
  return bvh;
}

MaybeError CheckPosesPath(const std::string& flag, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (path.empty() || IsBodyFile(path) || ending == ".csv") return std::nullopt;
  return Error{flag + " is '" + path + "'; it must end in .bvh or .csv"};
}

Result<std::vector<std::string>> WritePoses(const std::string& path, const ForecastScene& scene) {
  if (MaybeError error = CheckPosesPath("the file of poses", path)) return *error;
  if (std::filesystem::path(path).extension() == ".csv") {
    if (MaybeError error = WriteCsv(path, scene)) return *error;
    return std::vector<std::string>{path};
  }
  std::vector<std::string> files = {path};
  if (MaybeError error = WriteOneBvh(path, scene, scene.forecast)) return *error;
  for (size_t i = 0; i < scene.futures.size(); ++i) {
    const std::string stem = std::filesystem::path(path).replace_extension().string();
    files.push_back(stem + "_future_" + std::to_string(i + 1) + ".bvh");
    if (MaybeError error = WriteOneBvh(files.back(), scene, scene.futures[i].motion)) return *error;
  }
  return files;
}

}  // namespace pushid
