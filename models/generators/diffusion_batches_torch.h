// models: groups drawn and changed, as the diffusion module wants them. Included by *_torch.cc
// files alone.
#pragma once

#include "models/generators/diffusion_module_torch.h"
#include "models/generators/diffusion_trainer.h"

namespace pushid {

class DiffusionBatches {
 public:
  DiffusionBatches(const std::vector<ObservedGroup>& groups, const JointScales& scales,
                   const DiffusionTrainingOptions& options);

  bool empty() const { return groups_.empty() && alone_.empty(); }
  // Of a training step, with all that is random in it.
  DiffusionBatch Draw(int step) const;
  // Of these groups as they are, of which the first frame is shown; at most `most`.
  DiffusionBatch AsTheyAre(int most) const;

 private:
  ObservedGroup Varied(const ObservedGroup& group) const;
  void AddBystanders(ObservedGroup* group) const;

  const JointScales scales_;
  const DiffusionTrainingOptions& options_;
  std::vector<ObservedGroup> groups_, alone_;
};

// One group's features as a batch of it alone.
DiffusionBatch BatchOf(const GroupFeatures& features, const DiffusionStructure& structure);

}  // namespace pushid
