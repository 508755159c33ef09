// models: feet that stand while the pendulum's model says so, and land where its cart is.
//
//   standing   ankle and toe do not move, however high and fast the restoration has them
//   stepping   they go where the restoration has them, and rest where it has them rest (the other
//              foot stands while one steps, and the model says nothing of which); what held them
//              fades over release_frames
//   landing    over the step's last fade_frames they come to the places where they will stand: as
//              far apart as in the restoration, at the height of frame 0, their midpoint as far
//              from the cart as at frame 0
// A place that the leg misses by more than out_of_reach is let go; once that has faded the foot
// stands where the restoration has it.
//
// Rejected: both feet free while the model steps (the standing one slides). Each foot's own landing
// place from the cart (its stance at frame 0 again). A person who ends astride would be pulled into
// parallel feet.
#pragma once

#include "models/restoration/postprocess.h"

namespace pushid {

// person.stands has an entry for each frame of the motion.
void PlantFeet(const RestorationInput& person, const PostprocessOptions& options,
               BodyMotion* motion);

}  // namespace pushid
