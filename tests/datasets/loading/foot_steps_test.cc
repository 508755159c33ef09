// Steps of feet that are known, at several rates, with what measured feet have besides.
#include "datasets/loading/foot_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pushid {
namespace {

// One foot's points, one position per frame, m, and weights of frames.
struct FootTracks {
  std::vector<Eigen::Vector3d> ankle, toe, heel;
  std::vector<double> weight;
};

RecordedPerson PersonOf(Foot foot, const FootTracks& tracks) {
  RecordedPerson person;
  const bool left = foot == Foot::kLeft;
  (left ? person.left_ankle : person.right_ankle) = tracks.ankle;
  (left ? person.left_toe : person.right_toe) = tracks.toe;
  (left ? person.left_heel : person.right_heel) = tracks.heel;
  person.weight = tracks.weight;
  return person;
}

std::vector<FootStep> FindSteps(Foot foot, const FootTracks& tracks, double fps) {
  return FindSteps(PersonOf(foot, tracks), fps).steps;
}

double Travel(const FootTracks& tracks, double fps) {
  return FindSteps(PersonOf(Foot::kLeft, tracks), fps).travel;
}

struct KnownStep {
  double lift_off_s, landing_s, x, y;  // where it takes the foot, m
};

// From 0 to 1 between two times, at rest at both: the way of a swinging foot.
double Swing(double t, double from, double to) {
  const double s = std::fmin(1.0, std::fmax(0.0, (t - from) / (to - from)));
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

struct KnownFoot {
  double fps = 60.0, seconds = 2.0;
  std::vector<KnownStep> steps;
  double noise = 0.0;      // m, standard deviation of each coordinate
  double drift = 0.0;      // m/s
  double heel_lift = 0.0;  // m, over the last 0.15 s before each lift-off
  bool toe = true;

  FootTracks Tracks() const {
    std::mt19937 random(7);
    std::normal_distribution<double> gauss(0.0, 1.0);
    const auto noisy = [&](Eigen::Vector3d p) {
      for (double& value : p) value += noise * gauss(random);
      return p;
    };
    FootTracks tracks;
    const int frames = static_cast<int>(std::lround(seconds * fps));
    for (int i = 0; i < frames; ++i) {
      const double t = i / fps;
      Eigen::Vector3d place(drift * t, 0.1, 0.0);
      double heel = 0.0, height = 0.0;
      for (const KnownStep& step : steps) {
        const double way = Swing(t, step.lift_off_s, step.landing_s);
        place += way * Eigen::Vector3d(step.x, step.y, 0.0);
        height += 0.1 * std::sin(M_PI * way);
        heel += heel_lift * (Swing(t, step.lift_off_s - 0.15, step.lift_off_s) - way);
      }
      // The ankle turns about the toe as the heel rises: up, and forward by less.
      tracks.ankle.push_back(noisy(place + Eigen::Vector3d(0.4 * heel, 0.0, 0.1 + height + heel)));
      if (toe) tracks.toe.push_back(noisy(place + Eigen::Vector3d(0.17, 0.0, 0.02 + height)));
    }
    return tracks;
  }
};

std::vector<FootStep> Found(const KnownFoot& foot) {
  return FindSteps(Foot::kLeft, foot.Tracks(), foot.fps);
}

void ExpectKnown(const KnownFoot& foot, double within_s = 0.06) {
  const std::vector<FootStep> found = Found(foot);
  ASSERT_EQ(found.size(), foot.steps.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const KnownStep& known = foot.steps[i];
    EXPECT_NEAR(found[i].lift_off / foot.fps, known.lift_off_s, within_s) << "step " << i;
    EXPECT_NEAR(found[i].landing / foot.fps, known.landing_s, within_s) << "step " << i;
    // A drift carries the foot on between the middles of the two stances too.
    EXPECT_NEAR(found[i].travel.x(), known.x, 0.005 + 1.5 * foot.drift) << "step " << i;
    EXPECT_NEAR(found[i].travel.y(), known.y, 0.005) << "step " << i;
    EXPECT_TRUE(found[i].finished);
  }
}

// 0.3 m forward and 0.4 m to the left between 0.5 and 0.9 s, at 60 frames per second: half a metre
// at 53 degrees. Frames 30 to 54 are the swing; its first and last few millimetres are too slow to
// be told from standing.
TEST(FootSteps, OneStep) {
  const std::vector<FootStep> found = Found({60.0, 2.0, {{0.5, 0.9, 0.3, 0.4}}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].lift_off, 30, 2);
  EXPECT_NEAR(found[0].landing, 54, 2);
  EXPECT_TRUE(found[0].finished);
  EXPECT_NEAR(found[0].Length(), 0.5, 1e-9);
  EXPECT_NEAR(found[0].Direction(), std::atan2(4.0, 3.0), 1e-9);
}

TEST(FootSteps, AtAnyRateWithNoiseDriftAndHeelLifts) {
  for (double fps : {30.0, 50.0, 60.0, 100.0, 120.0, 200.0}) {
    for (bool toe : {true, false}) {
      SCOPED_TRACE(testing::Message() << fps << " per second, toe " << toe);
      KnownFoot foot{fps, 3.0, {{0.5, 0.9, 0.35, 0.0}, {1.6, 1.9, -0.1, 0.1}}, 0.002, 0.01};
      foot.toe = toe;
      foot.heel_lift = toe ? 0.08 : 0.02;
      ExpectKnown(foot, toe ? 0.07 : 0.11);
    }
  }
}

TEST(FootSteps, WhoStandsDoesNotStep) {
  for (double fps : {30.0, 60.0, 200.0}) {
    SCOPED_TRACE(fps);
    KnownFoot foot{fps, 5.0, {}, 0.002, 0.02};  // and drifts by 10 cm
    EXPECT_TRUE(Found(foot).empty());
    foot.toe = false;
    EXPECT_TRUE(Found(foot).empty());
  }
}

// The heel goes up by 10 cm and down again: the ankle moves 4 cm, the toe rests.
TEST(FootSteps, AHeelLiftIsNoStep) {
  KnownFoot foot{60.0, 2.0, {{0.8, 1.1, 0.0, 0.0}}, 0.002};
  foot.heel_lift = 0.1;
  EXPECT_TRUE(Found(foot).empty());
  foot.toe = false;
  EXPECT_TRUE(Found(foot).empty());
}

// A toe that rests keeps even an ankle that swings 10 cm about it from being a step.
TEST(FootSteps, TheToeTellsALongHeelLiftFromAStep) {
  KnownFoot foot{60.0, 2.0, {{0.8, 1.1, 0.0, 0.0}}};
  foot.heel_lift = 0.25;
  EXPECT_TRUE(Found(foot).empty());
  foot.toe = false;
  EXPECT_FALSE(Found(foot).empty());
}

TEST(FootSteps, AShuffleIsNoStep) {
  EXPECT_TRUE(Found({60.0, 2.0, {{0.5, 0.7, 0.04, 0.0}}}).empty());
  EXPECT_EQ(Found({60.0, 2.0, {{0.5, 0.7, 0.07, 0.0}}}).size(), 1u);
  // A slide of 20 cm in two seconds: farther, and never fast.
  EXPECT_TRUE(Found({60.0, 3.0, {{0.5, 2.5, 0.2, 0.0}}}).empty());
}

// Feet that stay, in the noise of markers, under a camera that drifts, with a heel that goes up and
// down; and feet that end elsewhere without a step.
TEST(FootSteps, TravelIsOfFeetThatEndElsewhere) {
  for (bool toe : {true, false}) {
    for (double noise : {0.001, 0.008}) {
      KnownFoot stays{60.0, 1.5, {}, noise, 0.02};
      stays.toe = toe;
      EXPECT_NEAR(Travel(stays.Tracks(), stays.fps), 0.028, 0.01);
      stays.steps = {{0.6, 0.9, 0.0, 0.0}};
      stays.heel_lift = 0.1;
      EXPECT_LT(Travel(stays.Tracks(), stays.fps), 0.04);
      KnownFoot slides{60.0, 3.0, {{0.5, 2.5, 0.2, 0.0}}, noise};
      slides.toe = toe;
      EXPECT_NEAR(Travel(slides.Tracks(), slides.fps), 0.2, 0.01);
    }
  }
}

// Nobody who stands still steps, whatever the noise of the ankles, the only points there are.
TEST(FootSteps, NoiseDoesNotMoveFeet) {
  for (double fps : {60.0, 100.0}) {
    for (double noise : {0.001, 0.005, 0.008}) {
      KnownFoot foot{fps, 1.5, {}, noise};
      foot.toe = false;
      EXPECT_TRUE(Found(foot).empty()) << noise << " m at " << fps;
      EXPECT_LT(Travel(foot.Tracks(), foot.fps), 0.015) << noise << " m at " << fps;
    }
  }
}

TEST(FootSteps, ARestPartsStepsAndAShortOneDoesNot) {
  EXPECT_EQ(Found({60.0, 2.0, {{0.4, 0.7, 0.3, 0.0}, {0.9, 1.2, 0.3, 0.0}}}).size(), 2u);
  EXPECT_EQ(Found({60.0, 2.0, {{0.4, 0.7, 0.3, 0.0}, {0.7, 1.0, 0.3, 0.0}}}).size(), 1u);
}

TEST(FootSteps, CutByTheEndsOfTheRecording) {
  const KnownFoot foot{60.0, 1.0, {{-0.2, 0.3, 0.5, 0.0}, {0.8, 1.2, 0.4, 0.0}}};
  const std::vector<FootStep> found = Found(foot);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].lift_off, 0);
  EXPECT_TRUE(found[0].finished);
  EXPECT_NEAR(found[0].travel.x(), 0.5 * (1.0 - Swing(0.0, -0.2, 0.3)), 0.01);
  EXPECT_FALSE(found[1].finished);
  EXPECT_EQ(found[1].landing, 60);
  EXPECT_NEAR(found[1].travel.x(), 0.4 * Swing(59.0 / 60.0, 0.8, 1.2), 0.01);
}

// A tenth of all frames lost one by one, and 0.2 s of standing in one piece.
TEST(FootSteps, ThroughGaps) {
  KnownFoot foot{100.0, 3.0, {{0.5, 0.9, 0.35, 0.0}, {2.0, 2.3, -0.2, 0.0}}, 0.001};
  FootTracks tracks = foot.Tracks();
  tracks.weight.assign(tracks.ankle.size(), 1.0);
  std::mt19937 random(3);
  for (std::size_t t = 0; t < tracks.ankle.size(); ++t) {
    if (random() % 10 != 0 && (t < 130 || t >= 150)) continue;
    tracks.weight[t] = 0.0;
    tracks.ankle[t] = tracks.toe[t] = Eigen::Vector3d(9.0, 9.0, 9.0);  // means nothing
  }
  const std::vector<FootStep> found = FindSteps(Foot::kRight, tracks, foot.fps);
  ASSERT_EQ(found.size(), 2u);
  for (int i : {0, 1}) {
    EXPECT_NEAR(found[i].lift_off / foot.fps, foot.steps[i].lift_off_s, 0.07);
    EXPECT_NEAR(found[i].landing / foot.fps, foot.steps[i].landing_s, 0.07);
    EXPECT_EQ(found[i].foot, Foot::kRight);
  }
}

// Positions that are not numbers are not seen either; where the foot is elsewhere after the gap,
// the step lies in it.
TEST(FootSteps, AStepThatNobodySawIsFoundInItsGap) {
  KnownFoot foot{60.0, 2.0, {{0.6, 0.9, 0.3, 0.0}}};
  foot.toe = false;
  FootTracks tracks = foot.Tracks();
  for (int t = 34; t < 56; ++t) tracks.ankle[t].setConstant(std::nan(""));
  const std::vector<FootStep> found = FindSteps(Foot::kLeft, tracks, foot.fps);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].lift_off, 34, 3);
  EXPECT_NEAR(found[0].landing, 56, 3);
  EXPECT_NEAR(found[0].Length(), 0.3, 1e-9);
}

TEST(FootSteps, NothingSeenAndSingleFrames) {
  FootTracks tracks;
  EXPECT_TRUE(FindSteps(Foot::kLeft, tracks, 60.0).empty());
  tracks.ankle = {{0, 0, 0}};
  EXPECT_TRUE(FindSteps(Foot::kLeft, tracks, 60.0).empty());
  tracks.ankle.assign(50, Eigen::Vector3d::Constant(std::nan("")));
  EXPECT_TRUE(FindSteps(Foot::kLeft, tracks, 60.0).empty());
}

TEST(FootSteps, BothFeetOfAPerson) {
  RecordedPerson person;
  const FootTracks left = KnownFoot{60.0, 2.0, {{1.0, 1.3, 0.3, 0.0}}}.Tracks();
  const FootTracks right = KnownFoot{60.0, 2.0, {{0.4, 0.8, 0.3, 0.0}}}.Tracks();
  person.left_ankle = left.ankle;
  person.right_ankle = right.ankle;
  const PersonSteps steps = FindSteps(person, 60.0);  // without toes
  ASSERT_EQ(steps.steps.size(), 2u);
  EXPECT_TRUE(steps.Stepped());
  EXPECT_EQ(steps.First()->foot, Foot::kRight);
  EXPECT_FALSE(steps.Stands(Foot::kRight, 36));
  EXPECT_TRUE(steps.Stands(Foot::kLeft, 36));
  EXPECT_TRUE(steps.Stands(Foot::kRight, steps.First()->landing));
  EXPECT_EQ(StepsText(steps, 60.0).find("right 0.4"), 0u) << StepsText(steps, 60.0);
  EXPECT_EQ(PersonSteps().First(), nullptr);
  EXPECT_FALSE(PersonSteps().Stepped());
}

TEST(FootSteps, InWords) {
  PersonSteps steps;
  EXPECT_EQ(StepsText(steps, 50.0), "none");
  steps.steps = {{Foot::kRight, 20, 40, true, {-0.3, 0.1}},
                 {Foot::kLeft, 45, 60, false, {0.05, 0.12}},
                 {Foot::kRight, 50, 60, false, {0.05, -0.12}},
                 {Foot::kLeft, 50, 60, true, {0.3, -0.29}}};
  EXPECT_EQ(StepsText(steps, 50.0),
            "right 0.4-0.8 s 0.32 m backwards; left from 0.9 s 0.13 m to the left, cut off; "
            "right from 1 s 0.13 m to the right, cut off; left 1-1.2 s 0.42 m forwards");
}

}  // namespace
}  // namespace pushid
