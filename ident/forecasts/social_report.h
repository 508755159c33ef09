// ident: what groups do, recorded and forecast, as Tanke et al. (ICCV 2023, called SDM) compare it:
// states of people (Eq. 11), how often one follows another (Fig. 5), and SSCP
// and NDMS at every frame that was not shown (Eq. 13 and 14).
//
//   sscp(t)   Jensen and Shannon's distance of the transitions into frame t, of everybody in all
//             forecasts, to all recorded transitions
//   ndms(t)   mean score of the words whose first step ends at frame t
//
// Few people have few transitions at one frame, and even recorded ones are then far from all that
// were recorded: the row "recorded" says how far. Frames are at 60 Hz.
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

// The social states that measures of groups use: built-in ones, or those that somebody
// annotated (Eq. 11 of Tanke et al., ICCV 2023).
//
// Annotators see recorded motion alone. So a state of forecast motion has to be found: by the
// built-in rules where the annotated names are theirs, otherwise by a classifier that is trained on
// the annotated recordings. What it errs shows in the row "recorded" of a social report.

// The states that measures use: which, and what is annotated of each recording.
struct SocialCues {
  StateFunction states = SocialStateFunction();
  std::string source = "built-in";
  std::vector<RecordedStates> annotated = {};  // of each recording; empty: nothing is
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

// Values by frame, from the first that counts on.
using ByFrame = std::vector<std::optional<double>>;

struct SocialRow {
  std::string name;  // of a predictor, or "recorded": recorded motion, its states not annotated
  std::optional<double> sscp, sscp_changes, ndms;
  Eigen::MatrixXd transitions;  // counts
  std::vector<int> people;      // whose transitions there are, by frame
  ByFrame sscp_by_frame, ndms_by_frame;
};

struct SocialReport {
  SocialCues cues;
  int first_frame = 1;          // at 60 Hz
  Eigen::MatrixXd transitions;  // recorded, as annotated where they are
  std::vector<SocialRow> rows;
};

// Compares every predictor of groups in the evaluation and sets its measures of states.
// Nothing without groups.
std::optional<SocialReport> CompareSocially(const std::vector<BodyRecording>& recordings,
                                            const SocialCues& cues, BodyEvaluation* evaluation);

nlohmann::ordered_json ToJson(const SocialReport& report);
std::string SocialText(const SocialReport& report);
// SSCP and NDMS by frame, and changes of state recorded beside those of a predictor, as SVG for a
// page (Animation::figures).
std::vector<std::string> SocialFigures(const SocialReport& report, const std::string& predictor);

}  // namespace pushid
