// People of another model, tests/studies/laboratory.sh: data whose truth is not the fitted model.
// What is found of it, what is not, and that the report says so.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class LaboratoryApp : public TempDirTest {
 protected:
  static nlohmann::ordered_json ParameterOf(const nlohmann::ordered_json& model,
                                            const std::string& name) {
    for (const auto& parameter : model["parameters"]) {
      if (parameter["name"] == name) return parameter;
    }
    return {};
  }
};

TEST_F(LaboratoryApp, FindsTheStiffnessAndSaysThatTheModelIsWrong) {
  setenv("PUSHID_BIN", PUSHID_BIN_DIR, 1);
  const AppRun run = RunProgram(
      "/bin/bash", {std::string(PUSHID_SOURCE_DIR) + "/tests/studies/laboratory.sh", Path("lab")});
  unsetenv("PUSHID_BIN");
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const auto truth = ReadJsonDocument(Path("lab/truth.json")).value().content["synthetic"]["truth"];
  const auto model = ReadJsonDocument(Path("lab/standing.json")).value().content;
  const auto stiffness = ParameterOf(model, "Kp_theta"),
             delay = ParameterOf(model, "reaction_delay");
  EXPECT_NEAR(stiffness["value"].get<double>() / truth["Kp_theta"].get<double>(), 1.0, 0.1);
  // One link bends nowhere: the hips take up the push, and the delay comes out too short.
  const double found = delay["value"], true_delay = truth["reaction_delay"];
  EXPECT_LT(found, 0.6 * true_delay);
  EXPECT_GT(delay["total"]["interval_95"][1].get<double>(), true_delay);
  for (const auto& parameter : model["parameters"]) {
    EXPECT_NE(parameter["status"], "identified") << parameter["name"];
  }
  const std::string result = run.out.substr(run.out.find("== Result"));
  for (const char* said : {"recovered within 10 %: Kp_theta (", "not recovered: ",
                           "reaction_delay (", "The model does not fit these recordings",
                           "Nothing is called identified", "the recordings ask for pushes ",
                           "who steps, predicted by the model of who stands", "an extrapolation"}) {
    EXPECT_TRUE(Contains(result, said)) << result;
  }
  EXPECT_LT(result.find("Kp_theta ("), result.find("not recovered"));
  EXPECT_GT(result.find("reaction_delay ("), result.find("not recovered"));
}

}  // namespace
}  // namespace pushid
