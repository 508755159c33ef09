// datasets: BVH files written.
#include <cmath>
#include <unordered_set>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/bvh_header.h"

namespace pushid {
namespace {

// What would make the file unreadable; "" when nothing does.
std::string SkeletonProblem(const BvhSkeleton& skeleton) {
  std::unordered_set<std::string> names;
  std::vector<int> path;  // from the root to the joint before
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const BvhJoint& joint = skeleton.joints[i];
    if (joint.name.empty() || joint.name != Trimmed(joint.name) ||
        joint.name.find_first_of("{}\n\r") != std::string::npos) {
      return "the joint name " + Quoted(joint.name) + " cannot be written";
    }
    if (!names.insert(joint.name).second) {
      return "two joints are called " + Quoted(joint.name);
    }
    while (!path.empty() && path.back() != joint.parent) path.pop_back();
    if (path.empty() && joint.parent != -1) {
      return "joint " + Quoted(joint.name) + " is not in depth-first order";
    }
    path.push_back(static_cast<int>(i));
    if (!joint.offset.allFinite()) return "the offset of " + Quoted(joint.name) + " is not finite";
    for (const Eigen::Vector3d& end_site : joint.end_sites) {
      if (!end_site.allFinite()) return "an end site of " + Quoted(joint.name) + " is not finite";
    }
    for (std::size_t a = 0; a < joint.channels.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (joint.channels[a] == joint.channels[b]) {
          return "joint " + Quoted(joint.name) + " lists " + NameOf(joint.channels[a]) + " twice";
        }
      }
    }
  }
  if (skeleton.num_channels() == 0) return "no joint has any channels";
  return "";
}

std::string MotionProblem(const BvhMotion& motion) {
  const std::string problem = SkeletonProblem(motion.skeleton);
  if (!problem.empty()) return problem;
  if (motion.values.empty() || motion.values.size() % motion.skeleton.num_channels() != 0) {
    return "there are " + std::to_string(motion.values.size()) + " values for " +
           std::to_string(motion.skeleton.num_channels()) + " channels per frame";
  }
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    if (!std::isfinite(motion.values[i])) {
      return "a value of frame " + std::to_string(i / motion.skeleton.num_channels()) +
             " is not finite";
    }
  }
  return FrameTimeProblem(motion.frame_time_s);
}

class HierarchyWriter {
 public:
  HierarchyWriter(const BvhMotion& motion, LengthUnit unit) : motion_(motion), unit_(unit) {}

  std::string Write() {
    text_ = "HIERARCHY\n";
    const std::vector<BvhJoint>& joints = motion_.skeleton.joints;
    std::vector<int> path;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      while (!path.empty() && path.back() != joints[i].parent) {
        path.pop_back();
        Line(path.size(), "}");
      }
      const bool leaf = i + 1 == joints.size() || joints[i + 1].parent != static_cast<int>(i);
      Open(joints[i], path.size(), leaf);
      path.push_back(static_cast<int>(i));
    }
    while (!path.empty()) {
      path.pop_back();
      Line(path.size(), "}");
    }
    return std::move(text_);
  }

 private:
  void Line(std::size_t depth, const std::string& content) {
    text_.append(depth, '\t');
    text_ += content + "\n";
  }

  std::string OffsetText(const Eigen::Vector3d& offset) const {
    std::string text = "OFFSET";
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      AppendDouble(ConvertLength(offset[axis], motion_.length_unit, unit_), &text);
    }
    return text;
  }

  void Open(const BvhJoint& joint, std::size_t depth, bool leaf) {
    Line(depth, (depth == 0 ? "ROOT " : "JOINT ") + joint.name);
    Line(depth, "{");
    Line(depth + 1, OffsetText(joint.offset));
    std::string channels = "CHANNELS " + std::to_string(joint.channels.size());
    for (BvhChannel channel : joint.channels) channels += " " + NameOf(channel);
    Line(depth + 1, channels);
    for (const Eigen::Vector3d& end_site : joint.end_sites) EndSite(end_site, depth + 1);
    if (leaf && joint.end_sites.empty()) EndSite(Eigen::Vector3d::Zero(), depth + 1);
  }

  void EndSite(const Eigen::Vector3d& offset, std::size_t depth) {
    Line(depth, "End Site");
    Line(depth, "{");
    Line(depth + 1, OffsetText(offset));
    Line(depth, "}");
  }

  const BvhMotion& motion_;
  const LengthUnit unit_;
  std::string text_;
};

}  // namespace

MaybeError WriteBvh(const std::string& path, const BvhMotion& motion, LengthUnit unit) {
  const std::string problem = MotionProblem(motion);
  if (!problem.empty()) return Error{"the motion cannot be written: " + problem, path, 0};

  std::vector<bool> is_length;  // per channel
  for (const BvhJoint& joint : motion.skeleton.joints) {
    for (BvhChannel channel : joint.channels) is_length.push_back(!IsRotation(channel));
  }
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append(HierarchyWriter(motion, unit).Write());
  file.Append("MOTION\nFrames: " + std::to_string(motion.num_frames()) +
              "\nFrame Time: " + DoubleText(motion.frame_time_s) + "\n");
  std::string row;
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    const std::size_t channel = i % is_length.size();
    const double value = motion.values[i];
    AppendDouble(is_length[channel] ? ConvertLength(value, motion.length_unit, unit) : value, &row);
    row += channel + 1 == is_length.size() ? '\n' : ' ';
    if (channel + 1 == is_length.size()) {
      file.Append(row);
      row.clear();
    }
  }
  return file.Commit();
}

}  // namespace pushid
