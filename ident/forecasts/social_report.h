// ident: what groups do, recorded and forecast, as Tanke et al. (ICCV 2023, called SDM) compare it:
// states of people and of whole groups (Eq. 11), how often one follows another (Fig. 5), and SSCP
// and NDMS at every frame that was not shown (Eq. 13 and 14).
//
//   sscp(t)   Jensen and Shannon's distance of the transitions into frame t, of everybody in all
//             forecasts, to all recorded transitions; group_sscp(t) of whole groups' symbols
//   ndms(t)   mean score of the words whose first step ends at frame t
//
// Few people have few transitions at one frame, and even recorded ones are then far from all that
// were recorded: the row "recorded" says how far. Frames are at 60 Hz.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/bodies/body_evaluation.h"
#include "ident/forecasts/social_cues.h"

namespace pushid {

// At each frame from the first that counts on.
using ByFrame = std::vector<std::optional<double>>;

struct SocialRow {
  std::string name;  // of a predictor, or "recorded": recorded motion, its states not annotated
  std::optional<double> sscp, sscp_changes, group_sscp, ndms;
  Eigen::MatrixXd transitions, group_transitions;  // counts
  std::vector<int> people;                         // whose transitions there are, by frame
  ByFrame sscp_by_frame, group_sscp_by_frame, ndms_by_frame;
};

struct SocialReport {
  SocialCues cues;
  std::vector<std::string> group_names;
  int first_frame = 1;                             // at 60 Hz
  Eigen::MatrixXd transitions, group_transitions;  // recorded, as annotated where they are
  std::vector<SocialRow> rows;
};

// Of every predictor of groups in the evaluation, whose measures of states it sets to these.
// Nothing without groups.
std::optional<SocialReport> CompareSocially(const std::vector<BodyRecording>& recordings,
                                            const SocialCues& cues, BodyEvaluation* evaluation);

nlohmann::ordered_json ToJson(const SocialReport& report);
std::string SocialText(const SocialReport& report);
// SSCP and NDMS by frame, and changes of state recorded beside those of a predictor, as SVG for a
// page (Animation::figures).
std::vector<std::string> SocialFigures(const SocialReport& report, const std::string& predictor);

}  // namespace pushid
