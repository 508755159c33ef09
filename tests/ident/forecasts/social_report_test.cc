// People who talk in turns, whose states are known: what a classifier finds, and what the measures
// tell apart.
#include "ident/forecasts/social_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/ident/turn_samples.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticTurnsOptions Many(int recordings) {
  SyntheticTurnsOptions options;
  options.recordings = recordings;
  return options;
}

class SocialReportTest : public TurnsTest {};

TEST_F(SocialReportTest, StatesFollowTheKnownChain) {
  SyntheticTurnsOptions options = Many(20);
  options.frames = 3000;  // 1000 s in all
  ASSERT_FALSE(WriteSyntheticTurns(Path("turns"), options));
  const StateTable truth = Truth();
  std::vector<Symbols> people;
  for (int i = 0; i < options.recordings; ++i) {
    const std::string id = "turns_" + std::string(i < 9 ? "0" : "") + std::to_string(i + 1);
    std::vector<std::string> subjects;
    for (int n = 1; n <= 3; ++n) subjects.push_back("T" + std::to_string(3 * i + n));
    const auto states = Unwrapped(StatesOf(truth, id, subjects, options.frames));
    for (const auto& person : states.people) {
      people.emplace_back();
      for (const std::string& name : person) {
        people.back().push_back(static_cast<int>(*FromName<TurnState>(name)));
      }
    }
  }
  Eigen::MatrixXd shares = CountTransitions(people, 3, Transitions::kAll);
  shares /= shares.sum();
  const Eigen::Matrix3d known = TurnTransitions();
  EXPECT_NEAR(known.sum(), 1.0, 1e-12);
  // A stationary chain has as many steps into a state as out of it.
  EXPECT_NEAR((known.rowwise().sum() - known.colwise().sum().transpose()).norm(), 0.0, 1e-12);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      // About 160 of 400 turns end in a pause: a standard deviation of 8 %.
      EXPECT_NEAR(shares(a, b), known(a, b), 0.25 * known(a, b)) << a << " to " << b;
    }
  }
}

TEST_F(SocialReportTest, AClassifierFindsWhoSpeaks) {
  const auto recordings = MakeTurns(Many(12));
  ASSERT_EQ(recordings.size(), 12u);
  const auto cues = Unwrapped(SocialCuesOf(Truth(), IdsOf(recordings), recordings));
  EXPECT_EQ(cues.states.names, (std::vector<std::string>{"listen", "rest", "speak"}));
  double right = 0.0, all = 0.0;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const GroupMotion annotated = RecordedGroup(recordings[i], cues, i, 1);
    const auto found = cues.states.of(AtWordRate(annotated), 1.0 / kWordRate);
    const auto known = StatesOfPeople(annotated, cues.states);
    for (size_t n = 0; n < known.size(); ++n) {
      for (size_t t = 0; t < known[n].size(); ++t) {
        right += found[n][t] == known[n][t] ? 1.0 : 0.0;
        all += 1.0;
      }
    }
  }
  EXPECT_GT(right / all, 0.8);
}

// A forecast of half the speed, of every recording.
BodyEvaluation Slowed(const std::vector<BodyRecording>& recordings) {
  BodyScores scores;
  for (const BodyRecording& recording : recordings) {
    std::vector<BodyMotion> slow = recording.bodies;
    for (size_t n = 0; n < slow.size(); ++n) {
      for (size_t t = 0; t < slow[n].size(); ++t) slow[n][t] = recording.bodies[n][t / 2];
    }
    scores["generator"].push_back(ScoreBodies(recording, slow));
  }
  return SummarizeAll(recordings, scores);
}

TEST_F(SocialReportTest, BuiltInStatesFromAFileAreTheBuiltInOnes) {
  const auto recordings = MakeTurns(Many(3));
  ASSERT_FALSE(WriteStates(Path("states.csv"), StatesInUse(recordings, {})));
  const auto read = Unwrapped(
      SocialCuesOf(ReadStates(Path("states.csv")).value(), IdsOf(recordings), recordings));
  BodyEvaluation built_in = Slowed(recordings), from_file = built_in;
  auto json = ToJson(*CompareSocially(recordings, {}, &built_in));
  auto again = ToJson(*CompareSocially(recordings, read, &from_file));
  EXPECT_NE(json["states"], again["states"]);
  json.erase("states"), again.erase("states");
  EXPECT_EQ(json.dump(), again.dump());
  EXPECT_EQ(json["by"]["recorded"]["sscp"], 0.0);
  // Metrics of a single person, and the sum over frames, do not change.
  const BodyEvaluation plain = Slowed(recordings);
  EXPECT_EQ(plain.at("generator").groups->social.sscp,
            built_in.at("generator").groups->social.sscp);
  EXPECT_EQ(plain.at("generator").groups->social.ndms,
            built_in.at("generator").groups->social.ndms);
}

TEST_F(SocialReportTest, EveryFrameHasItsValue) {
  const auto recordings = MakeTurns(Many(3));
  BodyEvaluation evaluation = Slowed(recordings);
  const auto report = CompareSocially(recordings, {}, &evaluation);
  ASSERT_TRUE(report);
  const SocialRow& row = report->rows[1];
  EXPECT_EQ(row.name, "generator");
  ASSERT_EQ(row.sscp_by_frame.size(), 299u) << "frames 1 to 299";
  EXPECT_EQ(row.people, std::vector<int>(299, 9));
  ASSERT_EQ(row.ndms_by_frame.size(), 281u) << "words of 20 frames";
  double sum = 0.0;
  for (const auto& value : row.ndms_by_frame) sum += *value / 281.0;
  EXPECT_NEAR(sum, *row.ndms, 1e-9) << "all recordings are as long";
  EXPECT_EQ(row.transitions.sum(), 9.0 * 299.0);
  const auto figures = SocialFigures(*report, "generator");
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_TRUE(Contains(figures[0], "NDMS by frame"));
  EXPECT_TRUE(Contains(figures[1], "people: changes of state a minute"));
  EXPECT_TRUE(SocialFigures(*report, "nobody").empty());
}

TEST_F(SocialReportTest, TheOrderOfPeopleMakesNoDifference) {
  auto recordings = MakeTurns(Many(4));
  const StateTable truth = Truth();
  const auto report = [&](const SocialCues& cues) {
    BodyEvaluation again = Slowed(recordings);
    return *CompareSocially(recordings, cues, &again);
  };
  const auto cues = [&] { return SocialCuesOf(truth, IdsOf(recordings), recordings).value(); };
  const SocialReport before = report(cues()), before_built_in = report({});
  for (BodyRecording& recording : recordings) {
    std::swap(recording.bodies[0], recording.bodies[2]);
    std::swap(recording.pendulum.subject_ids[0], recording.pendulum.subject_ids[2]);
  }
  const SocialReport after = report(cues()), after_built_in = report({});
  for (const auto& [a, b] :
       {std::pair(&before, &after), std::pair(&before_built_in, &after_built_in)}) {
    for (size_t i = 0; i < a->rows.size(); ++i) {
      EXPECT_NEAR(*a->rows[i].sscp, *b->rows[i].sscp, 1e-5);
      for (size_t k = 0; k < a->rows[i].sscp_by_frame.size(); ++k) {
        EXPECT_NEAR(*a->rows[i].sscp_by_frame[k], *b->rows[i].sscp_by_frame[k], 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace pushid
