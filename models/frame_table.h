// models: one value for everybody at every frame of a rollout.
#pragma once

#include <cstddef>
#include <vector>

#include "models/ipm.h"

namespace pushid {

// Frames 0 .. num_frames - 1, stored frame by frame.
template <typename Value>
class FrameTable {
 public:
  FrameTable() = default;
  FrameTable(int num_frames, int num_people)
      : num_people_(num_people), values_(static_cast<size_t>(num_frames) * num_people) {}
  Value& At(int frame, int person) { return values_[Index(frame, person)]; }
  const Value& At(int frame, int person) const { return values_[Index(frame, person)]; }
  // Everybody at one frame, in a row.
  const Value* Frame(int frame) const { return values_.data() + Index(frame, 0); }
  int num_people() const { return num_people_; }
  int num_frames() const {
    return num_people_ == 0 ? 0 : static_cast<int>(values_.size()) / num_people_;
  }

 private:
  size_t Index(int frame, int person) const {
    return static_cast<size_t>(frame) * num_people_ + person;
  }
  int num_people_ = 0;
  std::vector<Value> values_;
};

template <typename T>
using RolloutPath = FrameTable<PendulumState<T>>;

}  // namespace pushid
