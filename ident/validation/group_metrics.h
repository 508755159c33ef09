// ident: metrics of predicted groups beyond the distance of joints: whether people move like
// people, and whether a push travels through the group as recorded.
//
//   sscp           Jensen and Shannon's distance of the transitions between social states
//   sscp_changes   the same of changes of state alone; no value where nothing ever changes
//   ndms           how alike words of motion are to the nearest recorded ones: 1 for the same,
//                  1/2 for what rests with them
//   pushed_named   recordings whose pushed person moves first
//   onset_order    share of pairs of people who begin to move in the recorded order
//   onset_error    |begin - recorded begin| in the mean over people who move in both, s
//   false_movers, missed_movers   people who begin to move in one of the two alone
//
// When a person begins to move: prediction/propagation.h. What these can see and cannot:
// validation/README.md.
//
// Frames that a predictor was shown do not count. Of states and words those count whose steps from
// frame to frame end at first_frame or later, in recorded groups as in predicted ones, so that no
// word is found among shown frames. Onsets count that were not shown: people who begin to move
// earlier are left out, and pushed_named counts recordings in which nobody does.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/text_table.h"
#include "ident/model/model_rollout.h"
#include "models/restoration/group_motion.h"

namespace pushid {

// The states of people, frame by frame (Eq. 11 of Tanke et al., ICCV 2023, called SDM), at the rate
// of words and transitions, 60 Hz. They are annotated (datasets/loading/generator_data.h) or follow
// from the motion as a StateFunction has them.

struct GroupMotion {
  std::vector<BodyMotion> people;
  double dt = 1.0 / 60.0;
  int pushed_person = 0;
  int first_frame = 1;  // that counts; everybody knows frame 0
  // Annotated states, a value per frame of `people`; empty: not annotated.
  std::vector<Symbols> states = {};  // [person], of the names of a StateFunction
};

// Transitions and words are those of 60 frames a second.
std::vector<BodyMotion> AtWordRate(const GroupMotion& group);
// The frame, at the words' rate, at which the first step that counts begins.
std::ptrdiff_t FirstStep(const GroupMotion& group);

// States of all frames, [person].
std::vector<Symbols> StatesOfPeople(const GroupMotion& group, const StateFunction& states);
// The states that count, preceded by the first of them again, as at frame 0.
Symbols Counted(const GroupMotion& group, const Symbols& symbols);

// All people's states that count.
std::vector<Symbols> CountedStates(const std::vector<GroupMotion>& groups,
                                   const StateFunction& states);

// All people's frames whose steps count.
std::vector<BodyMotion> CountedMotions(const std::vector<GroupMotion>& groups);

// Measures of what people do, for any number of groups against any others; all of them are
// symmetric but ndms, whose words are those of `motions`.
struct SocialMetrics {
  std::optional<double> sscp, sscp_changes, ndms;
};
SocialMetrics CompareStates(const std::vector<GroupMotion>& recorded,
                            const std::vector<GroupMotion>& motions);
std::optional<double> CompareWords(const std::vector<GroupMotion>& recorded,
                                   const std::vector<GroupMotion>& motions);

struct OnsetMetrics {
  int recordings = 0, pushed_named = 0;  // in which nobody was shown to begin
  int pairs = 0, in_order = 0;  // of people who begin in the recording, at different frames
  int movers = 0;               // people who begin in both
  double error_sum = 0.0;       // s, over the movers
  int false_movers = 0, missed_movers = 0;
};
void AddOnsets(const GroupMotion& recorded, const GroupMotion& predicted, OnsetMetrics* metrics);

struct GroupMetrics {
  SocialMetrics social;
  OnsetMetrics onsets;
};
// predicted: of each recorded group, in the same order.
GroupMetrics CompareGroups(const std::vector<GroupMotion>& recorded,
                           const std::vector<GroupMotion>& predicted);

nlohmann::ordered_json ToJson(const GroupMetrics& metrics);

// A row for each predictor.
TextTable GroupMetricsTable(const NamedValues<GroupMetrics>& predictors);
// The table, and a line on what the metrics can and cannot see.
std::string GroupMetricsText(const NamedValues<GroupMetrics>& predictors);

}  // namespace pushid
