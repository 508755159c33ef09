// datasets: BVH motions as data.
#include "datasets/formats/bvh.h"

namespace pushid {

std::vector<BvhChannel> DefaultBvhChannels(bool with_position) {
  std::vector<BvhChannel> channels;
  if (with_position) {
    channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  }
  channels.insert(channels.end(),
                  {BvhChannel::kZrotation, BvhChannel::kYrotation, BvhChannel::kXrotation});
  return channels;
}

const char* Name(BvhChannel channel) {
  static constexpr const char* kNames[] = {"Xposition", "Yposition", "Zposition",
                                           "Xrotation", "Yrotation", "Zrotation"};
  return kNames[static_cast<int>(channel)];
}

int BvhSkeleton::num_channels() const {
  std::size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return static_cast<int>(count);
}

int BvhSkeleton::Find(const std::string& name) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

int BvhMotion::num_frames() const {
  const int channels = skeleton.num_channels();
  return channels > 0 ? static_cast<int>(values.size() / channels) : 0;
}

}  // namespace pushid
