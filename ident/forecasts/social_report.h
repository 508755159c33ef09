// ident: recorded and forecast groups compared as by Tanke et al. (ICCV 2023, called SDM): states
// of people (Eq. 11), their transitions (Fig. 5), and SSCP and NDMS at every forecast frame (Eq. 13
// and 14).
//
//   sscp(t)   Jensen-Shannon distance between the transitions into frame t, of all people in all
//             forecasts, and all recorded transitions
//   ndms(t)   mean score of the words whose first step ends at frame t
//
// With few people there are few transitions at one frame, so that even recorded ones differ from
// the total: the row "recorded" has this distance. Frames are at 60 Hz.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/generator_data.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/validation/group_metrics.h"

namespace pushid {

// The states used by measures of groups: built-in or annotated ones (SDM's Eq. 11).
//
// Only recorded motion is annotated. States of forecasts are found by the built-in rules if all
// annotated names are those of SocialState, otherwise by a classifier that is trained on the
// annotated recordings. The row "recorded" of a social report shows the classifier's errors.
struct SocialCues {
  StateFunction states = SocialStateFunction();
  std::string source = "built-in";
  std::vector<RecordedStates> annotated = {};  // of each recording; empty: built-in states
};

// ids: of the whole manifest. Errors: those of the table; fewer than two states or annotated
// recordings for the classifier.
Result<SocialCues> SocialCuesOf(const StateTable& table, const std::vector<std::string>& ids,
                                const std::vector<BodyRecording>& recordings);

// annotated: use the annotated states, if there are any.
GroupMotion RecordedGroup(const BodyRecording& recording, const SocialCues& cues, size_t index,
                          int first_frame, bool annotated = true);

// The states of the recordings that measures use, frame by frame, for WriteStates.
std::vector<RecordedStates> StatesInUse(const std::vector<BodyRecording>& recordings,
                                        const SocialCues& cues);

// Values by frame, from the first forecast frame on.
using ByFrame = std::vector<std::optional<double>>;

struct SocialRow {
  std::string name;  // of a predictor, or "recorded": recorded motion without its annotations
  std::optional<double> sscp, sscp_changes, ndms;
  Eigen::MatrixXd transitions;  // counts
  std::vector<int> people;      // number of people with a transition, by frame
  ByFrame sscp_by_frame, ndms_by_frame;
};

struct SocialReport {
  SocialCues cues;
  int first_frame = 1;          // at 60 Hz
  Eigen::MatrixXd transitions;  // recorded; annotated ones if there are any
  std::vector<SocialRow> rows;
};

// Compares each predictor of groups in the evaluation and sets its measures of states. Empty if
// there are no groups.
std::optional<SocialReport> CompareSocially(const std::vector<BodyRecording>& recordings,
                                            const SocialCues& cues, BodyEvaluation* evaluation);

nlohmann::ordered_json ToJson(const SocialReport& report);
std::string SocialText(const SocialReport& report);
// SSCP and NDMS by frame, and changes of state recorded beside those of a predictor, as SVG for a
// page (Animation::figures).
std::vector<std::string> SocialFigures(const SocialReport& report, const std::string& predictor);

}  // namespace pushid
