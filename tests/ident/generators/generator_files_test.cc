// Generators as files: round trips, and errors that say what is wrong.
#include "ident/generators/generator_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/solver/solver.h"
#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class GeneratorFilesTest : public TempDirTest {
 protected:
  GeneratorFilesTest() {
    trained_.settings.observed = 12;
    trained_.settings.predicted = 6;
    trained_.settings.layout = FourParticles();
    (*trained_.settings.training)["note"] = "of a test";
    TrainedParticles& particles = Particles();
    particles.members = {RandomParticles(1), RandomParticles(2)};
    RidgeFit fit;
    fit.Add(SwayingMotion(100, 0.0f), 12, 6);
    particles.partners = {fit.Solve(1e-3), {RandomSimlpe(1)}};
    particles.ridge_share = 0.4;
    particles.simlpe_share = 0.5;
    particles.jitter = 0.7;
  }
  std::string ErrorOf(const std::string& folder) { return ProblemOf(ReadGenerator(folder)); }
  std::string ErrorAfter(const std::string& from, const std::string& to) {
    EXPECT_FALSE(WriteGenerator(Path("g"), trained_));
    std::string text = ReadText(Path("g/generator.json"));
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at == std::string::npos) return "";
    WriteText("g/generator.json", text.replace(at, from.size(), to));
    return ErrorOf(Path("g"));
  }
  TrainedParticles& Particles() { return *particles_; }
  const std::shared_ptr<TrainedParticles> particles_ = std::make_shared<TrainedParticles>();
  TrainedNetworks trained_ = {{}, particles_};
  const std::vector<ObservedMotion> people_ = {{SwayingMotion(12, 0.4f)}};
};

TEST_F(GeneratorFilesTest, ComeBackToTheLastBit) {
  ASSERT_FALSE(WriteGenerator(Path("g"), trained_));
  const TrainedNetworks loaded = Unwrapped(ReadGenerator(Path("g")));
  EXPECT_EQ(loaded.Make()->Forecast(people_, 6)[0], trained_.Make()->Forecast(people_, 6)[0]);
  const GeneratorSettings& settings = loaded.settings;
  EXPECT_EQ(settings.observed, 12);
  EXPECT_EQ(settings.layout.names, FourParticles().names);
  EXPECT_EQ(settings.layout.parents, FourParticles().parents);
  EXPECT_EQ(settings.layout.mirrored, FourParticles().mirrored);
  EXPECT_EQ(settings.layout.weights, FourParticles().weights);
  EXPECT_EQ((*settings.training)["note"], "of a test");
}

TEST_F(GeneratorFilesTest, WhatMayChangeChanges) {
  ASSERT_FALSE(WriteGenerator(Path("g"), trained_));
  GeneratorChanges changes;
  changes.ridge = false;
  changes.particles.project_bones = false;
  const TrainedNetworks loaded = Unwrapped(ReadGenerator(Path("g")));
  ParticleGeneratorOptions options;
  options.ridge_share = 0.0, options.project_bones = false;
  const ParticleGenerator expected(FourParticles(), Particles().members, Particles().partners,
                                   options);
  EXPECT_EQ(loaded.Make(changes)->Forecast(people_, 6)[0], expected.Forecast(people_, 6)[0]);
}

TEST_F(GeneratorFilesTest, MistakesAreNamed) {
  EXPECT_TRUE(Contains(ErrorOf(Path("none")),
                       "--model names the folder that "
                       "pushid-train-generator --out wrote"));
  EXPECT_TRUE(Contains(ErrorAfter("\"kind\": \"particles\"", "\"kind\": \"waves\""),
                       "kind is 'waves'; it must be particles or diffusion"));
  EXPECT_TRUE(Contains(ErrorAfter("\"format\": 1", "\"format\": 2"), "format 2"));
  EXPECT_TRUE(Contains(ErrorAfter("\"poses\": true", "\"poses\": false"), "member0.input"));
  EXPECT_TRUE(Contains(ErrorAfter("\"members\": 2", "\"members\": 3"), "member2"));
  EXPECT_TRUE(Contains(ErrorAfter("\"members\": 2", "\"members\": 0"), "1 to 100"));
  EXPECT_TRUE(Contains(ErrorAfter("\"observed\": 12", "\"observed\": 11"), "simlpe0.block0.mix"));
  EXPECT_TRUE(Contains(ErrorAfter("\"simlpe_share\": 0.5", "\"simlpe_share\": 1.5"),
                       "simlpe_share must lie between 0 and 1"));
  EXPECT_TRUE(Contains(ErrorAfter("\"blocks\": 2", "\"blocks\": 0"), "1 to 1000"));
  Particles().partners.simlpe.clear();
  EXPECT_TRUE(Contains(ErrorAfter("\"members\": 0", "\"members\": 1"), "blocks must be 1 to 1000"));
  EXPECT_TRUE(Contains(
      ErrorAfter("\"members\": 0,\n      \"blocks\": 0", "\"members\": 1,\n      \"blocks\": 2"),
      "simlpe0.pose_mean is missing; train again"));
  Particles().simlpe_share = 0.0;
  EXPECT_TRUE(Contains(ErrorAfter("\"observed\": 12", "\"observed\": 3"), "more observed frames"));
  EXPECT_TRUE(Contains(ErrorAfter("\"observed\": 12", "\"seen\": 12"), "observed"));
  EXPECT_TRUE(Contains(ErrorAfter("\"parent\": 0", "\"parent\": 7"), "particle 1"));
  EXPECT_TRUE(Contains(ErrorAfter("\"up_axis\": 1", "\"up_axis\": 0"), "up_axis"));
}

TEST_F(GeneratorFilesTest, DamagedWeightsAreSeen) {
  ASSERT_FALSE(WriteGenerator(Path("g"), trained_));
  std::string bytes = ReadText(Path("g/weights.npy"));
  bytes[bytes.size() - 2] ^= 1;
  WriteText("g/weights.npy", bytes);
  EXPECT_TRUE(Contains(ErrorOf(Path("g")), "weights_hash differs"));
}

}  // namespace
}  // namespace pushid
