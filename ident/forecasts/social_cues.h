// ident: the social states that measures of groups use: built-in ones, or those that somebody
// annotated (Eq. 11 of Tanke et al., ICCV 2023).
//
// Annotators see recorded motion alone. So a state of forecast motion has to be found: by the
// built-in rules where the annotated names are theirs, otherwise by a classifier that is trained on
// the annotated recordings. What it errs shows in the row "recorded" of a social report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/state_csv.h"
#include "ident/bodies/body_recording.h"
#include "ident/validation/group_states.h"

namespace pushid {

// The states that measures use: which, and what is annotated of each recording.
struct SocialCues {
  StateFunction states = SocialStateFunction();
  std::string source = "built-in";
  std::vector<RecordedStates> annotated = {};  // of each recording; empty: nothing is
  // Where states of motion are found by a classifier (models/restoration/state_classifier.h): the
  // share found in recordings left out of its training, and that of the most frequent state.
  std::optional<double> share_found = {}, share_of_most_frequent = {};
};

// Annotated states. Where all of their names are those of SocialState, states of any other motion
// are the built-in ones; otherwise a classifier learns them from the annotated people. ids: of the
// whole manifest. Errors: those of the table; fewer than two states, or nobody annotated, though
// others are to be found.
Result<SocialCues> SocialCuesOf(const StateTable& table, const std::vector<std::string>& ids,
                                const std::vector<BodyRecording>& recordings);

// A recording as it is compared: annotated, where it is and `annotated` is true.
GroupMotion RecordedGroup(const BodyRecording& recording, const SocialCues& cues, size_t index,
                          int first_frame, bool annotated = true);

// States of the recordings as measures use them, frame by frame, for WriteStates.
std::vector<RecordedStates> StatesInUse(const std::vector<BodyRecording>& recordings,
                                        const SocialCues& cues);

}  // namespace pushid
