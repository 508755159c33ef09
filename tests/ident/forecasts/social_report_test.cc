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

std::vector<GroupMotion> GroupsOf(const std::vector<BodyRecording>& recordings,
                                  const SocialCues& cues, size_t begin, size_t end) {
  std::vector<GroupMotion> groups;
  for (size_t i = begin; i < end; ++i) groups.push_back(RecordedGroup(recordings[i], cues, i, 1));
  return groups;
}

// Everybody but the first from another recording: nobody turns to who speaks here.
std::vector<GroupMotion> Shuffled(const std::vector<GroupMotion>& groups) {
  std::vector<GroupMotion> shuffled = groups;
  for (size_t i = 0; i < groups.size(); ++i) {
    shuffled[i].group_states.clear();
    for (size_t n = 0; n < groups[i].people.size(); ++n) {
      const GroupMotion& from = groups[(i + n) % groups.size()];
      shuffled[i].people[n] = from.people[n];
      if (!from.states.empty()) shuffled[i].states[n] = from.states[n];
    }
  }
  return shuffled;
}

// Distance of the transitions of whole groups.
double GroupDistance(const std::vector<GroupMotion>& recorded, std::vector<GroupMotion> motions,
                     const StateFunction& states) {
  const GroupVocabulary vocabulary(recorded, states);
  const auto transitions = [&](const std::vector<GroupMotion>& groups) {
    std::vector<Symbols> all;
    for (const GroupMotion& group : groups) {
      all.push_back(Counted(group, vocabulary.Of(group, states)));
    }
    return CountTransitions(all, static_cast<int>(vocabulary.names().size()), Transitions::kAll);
  };
  return *JensenShannon(transitions(recorded), transitions(motions));
}

class SocialReportTest : public TurnsTest {};

TEST_F(SocialReportTest, StatesFollowTheKnownChain) {
  SyntheticTurnsOptions options = Many(20);
  options.fps = 10.0;  // 1000 s in all
  options.frames = 500;
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
  const Eigen::Matrix3d known = TurnTransitions(options);
  EXPECT_NEAR(known.sum(), 1.0, 1e-12);
  // Of a stationary chain as many steps lead into a state as out of it.
  EXPECT_NEAR((known.rowwise().sum() - known.colwise().sum().transpose()).norm(), 0.0, 1e-12);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      // Of some 400 turns 160 end in a pause: a standard deviation of 8 %.
      EXPECT_NEAR(shares(a, b), known(a, b), 0.25 * known(a, b)) << a << " to " << b;
    }
  }
}

TEST_F(SocialReportTest, AClassifierFindsWhoSpeaks) {
  const auto recordings = MakeTurns(Many(12));
  ASSERT_EQ(recordings.size(), 12u);
  const auto cues = Unwrapped(SocialCuesOf(Truth(), IdsOf(recordings), recordings));
  EXPECT_EQ(cues.states.names, (std::vector<std::string>{"listen", "rest", "speak"}));
  EXPECT_GT(*cues.share_found, 0.8);
  EXPECT_LT(*cues.share_of_most_frequent, 0.6);
}

// One person's transitions are the same with others beside them; those of groups are not.
TEST_F(SocialReportTest, WholeGroupsTellWhetherPeopleAreCoupled) {
  const auto recordings = MakeTurns(Many(16));
  const auto cues = Unwrapped(SocialCuesOf(Truth(), IdsOf(recordings), recordings));
  const StateFunction& states = cues.states;
  const auto first = GroupsOf(recordings, cues, 0, 8);
  const auto second = GroupsOf(recordings, cues, 8, 16);
  const double coupled = GroupDistance(first, second, states);
  const double uncoupled = GroupDistance(first, Shuffled(second), states);
  EXPECT_LT(coupled, 0.2);
  EXPECT_GT(uncoupled, 2.0 * coupled);
  EXPECT_NEAR(*CompareStates(first, second, states).sscp,
              *CompareStates(first, Shuffled(second), states).sscp, 1e-9);
  // The same where states are found in motion: who is looked at counts.
  auto bare = second;
  for (GroupMotion& group : bare) group.states.clear(), group.group_states.clear();
  EXPECT_GT(GroupDistance(first, Shuffled(bare), states), 1.5 * GroupDistance(first, bare, states));
  // Words are one person's own.
  EXPECT_NEAR(*CompareWords(first, second), *CompareWords(first, Shuffled(second)), 1e-9);
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
  EXPECT_FALSE(read.share_found) << "the rules are known";
  BodyEvaluation built_in = Slowed(recordings), from_file = built_in;
  auto json = ToJson(*CompareSocially(recordings, {}, &built_in));
  auto again = ToJson(*CompareSocially(recordings, read, &from_file));
  EXPECT_NE(json["states"], again["states"]);
  json.erase("states"), again.erase("states");
  EXPECT_EQ(json.dump(), again.dump());
  EXPECT_EQ(json["by"]["recorded"]["sscp"], 0.0);
  EXPECT_EQ(json["by"]["recorded"]["group_sscp"], 0.0);
  // Those of a single person, and the sum over frames, are what they were before.
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
  EXPECT_EQ(row.group_transitions.sum(), 3.0 * 299.0);
  const auto figures = SocialFigures(*report, "generator");
  ASSERT_GE(figures.size(), 3u);
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
      EXPECT_NEAR(*a->rows[i].group_sscp, *b->rows[i].group_sscp, 1e-5);
      for (size_t k = 0; k < a->rows[i].sscp_by_frame.size(); ++k) {
        EXPECT_NEAR(*a->rows[i].sscp_by_frame[k], *b->rows[i].sscp_by_frame[k], 1e-5);
      }
    }
  }
  EXPECT_NEAR(*before.cues.share_found, *after.cues.share_found, 1e-5);
}

TEST(GroupVocabularyTest, NamesByHand) {
  const StateFunction states{{"a", "b"}, nullptr};
  EXPECT_EQ(GroupVocabulary::NameOf({1, 0, 1}, states), "1 a + 2 b");
  GroupMotion group;
  group.people.assign(2, BodyMotion(4, StandingPose()));
  group.states = {{0, 0, 1, 1}, {0, 1, 0, 1}};
  const GroupVocabulary own({group}, states);
  EXPECT_EQ(own.names(), (std::vector<std::string>{"1 a + 1 b", "2 a", "2 b", "other"}));
  EXPECT_EQ(own.Of(group, states), (Symbols{1, 0, 0, 2}));
  group.group_states = {"still", "busy", "busy", "busy"};
  const GroupVocabulary named({group}, states);
  EXPECT_EQ(named.names(), (std::vector<std::string>{"busy", "still", "other"}));
  GroupMotion forecast = group;
  forecast.group_states.clear();
  forecast.people.resize(3, forecast.people[0]);
  forecast.states = {{0, 0, 1, 1}, {0, 1, 0, 1}, {1, 1, 1, 1}};
  EXPECT_EQ(named.Of(forecast, states), Symbols(4, 2)) << "nobody does that in threes";
}

}  // namespace
}  // namespace pushid
