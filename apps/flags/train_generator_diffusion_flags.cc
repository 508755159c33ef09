// apps: flags of pushid-train-generator that train generators of diffusion alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/train_generator_flags.h"

namespace {
const pushid::DiffusionTrainingOptions kDiffusion;
}  // namespace

DEFINE_string(pooling, pushid::NameOf(kDiffusion.structure.pooling),
              "diffusion: interaction between people: local (by distance, ahead and behind), mean "
              "(all equal), attention, none");
DEFINE_string(
    pooling_at, pushid::NameOf(kDiffusion.structure.join),
    "diffusion: where people see each other: levels (added after every block), bottleneck "
    "(joined to the middle's input)");
DEFINE_string(frame, pushid::NameOf(kDiffusion.structure.frame),
              "diffusion: frame of the motion: group (displacements, nothing turned), own (joints "
              "seen from the hip and turned to face forward, with where it faces; zero mean and "
              "unit variance)");
DEFINE_double(joint_weight, kDiffusion.joint_weight,
              "diffusion: weight of the joint error in m in the loss; needs --frame=group");
DEFINE_double(difference_weight, kDiffusion.difference_weight,
              "diffusion: weight of the differences of frames in the loss");
DEFINE_double(bystanders, kDiffusion.bystanders,
              "diffusion: fraction of the training groups to which people far away are added");

namespace pushid {
namespace {

// Tanke et al., "Social Diffusion", ICCV 2023; flags that are given change it.
void SetPublished(DiffusionTrainingOptions* options) {
  options->structure.pooling = SocialPooling::kMeanAll;
  options->structure.join = SocialJoin::kBottleneck;
  options->structure.frame = MotionFrame::kOwn;
  options->joint_weight = options->difference_weight = 0.0;
  options->bystanders = options->turn = options->size = 0.0;
}

// A flag that is not given leaves what a preset says.
template <typename Value, typename Flag>
MaybeError TakeName(const char* flag, const Flag& text, Value* value) {
  return Given(flag) ? ParseName("--" + std::string(flag), text, value) : std::nullopt;
}
MaybeError TakeGiven(const char* flag, double number, double most, double* value) {
  return Given(flag) ? TakeInRange(flag, number, 0.0, most, value) : std::nullopt;
}

MaybeError ReadDiffusionFlags(TrainGeneratorFlags* flags) {
  DiffusionTrainingOptions& diffusion = flags->options.diffusion;
  if (flags->published == PublishedMethod::kSdm) SetPublished(&diffusion);
  for (const MaybeError& error :
       {TakeName("pooling", FLAGS_pooling, &diffusion.structure.pooling),
        TakeName("pooling_at", FLAGS_pooling_at, &diffusion.structure.join),
        TakeName("frame", FLAGS_frame, &diffusion.structure.frame),
        TakeGiven("joint_weight", FLAGS_joint_weight, 1e6, &diffusion.joint_weight),
        TakeGiven("difference_weight", FLAGS_difference_weight, 1e6, &diffusion.difference_weight),
        TakeGiven("bystanders", FLAGS_bystanders, 1.0, &diffusion.bystanders)}) {
    if (error) return error;
  }
  if (diffusion.structure.frame == MotionFrame::kOwn && diffusion.joint_weight > 0.0) {
    return Error{"--frame=own has no joint errors in m; give --joint_weight=0"};
  }
  if (flags->steps > 0) diffusion.steps = flags->steps;
  if (flags->batch > 0) diffusion.groups = flags->batch;
  if (flags->learning_rate > 0.0) diffusion.learning_rate = flags->learning_rate;
  return std::nullopt;
}

const KindFlags<TrainGeneratorFlags> kDiffusionFlags(GeneratorKind::kDiffusion,
                                                     {"pooling", "pooling_at", "frame",
                                                      "joint_weight", "difference_weight",
                                                      "bystanders"},
                                                     ReadDiffusionFlags);

}  // namespace
}  // namespace pushid
