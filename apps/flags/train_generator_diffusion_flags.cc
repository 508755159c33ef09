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
              "(all equal), none; mean_all and heads (attention) as in SDM");
DEFINE_string(
    pooling_at, pushid::NameOf(kDiffusion.structure.join),
    "diffusion: where people see each other: levels (in the middle and on the way up), bottleneck "
    "(in the middle alone)");
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

void ReadDiffusionFlags(TrainGeneratorFlags* flags) {
  DiffusionTrainingOptions& diffusion = flags->options.diffusion;
  OrFail(ParseName("--pooling", FLAGS_pooling, &diffusion.structure.pooling));
  OrFail(ParseName("--pooling_at", FLAGS_pooling_at, &diffusion.structure.join));
  OrFail(ParseName("--frame", FLAGS_frame, &diffusion.structure.frame));
  TakeInRange("joint_weight", FLAGS_joint_weight, 0.0, 1e6, &diffusion.joint_weight);
  TakeInRange("difference_weight", FLAGS_difference_weight, 0.0, 1e6, &diffusion.difference_weight);
  TakeInRange("bystanders", FLAGS_bystanders, 0.0, 1.0, &diffusion.bystanders);
  if (diffusion.structure.frame == MotionFrame::kOwn) {
    if (diffusion.joint_weight > 0.0) {
      throw Error{"--frame=own has no joint errors in m; give --joint_weight=0"};
    }
    diffusion.turn = diffusion.size = 0.0;  // own frames are turned and scaled already
  }
  if (flags->steps > 0) diffusion.steps = flags->steps;
  if (flags->batch > 0) diffusion.groups = flags->batch;
  if (flags->learning_rate > 0.0) diffusion.learning_rate = flags->learning_rate;
}

const KindFlags<TrainGeneratorFlags> kDiffusionFlags(GeneratorKind::kDiffusion,
                                                     {"pooling", "pooling_at", "frame",
                                                      "joint_weight", "difference_weight",
                                                      "bystanders"},
                                                     ReadDiffusionFlags);

}  // namespace
}  // namespace pushid
