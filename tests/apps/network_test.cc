// A network from the fit to the page: every program takes a model that has one.
#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using NetworkAppTest = AppTest;

TEST_F(NetworkAppTest, EveryProgramTakesAnEnsemble) {
  const std::string model =
      FitModel("model.json", {"--self_force=mlp:2", "--ensemble=2", "--network_prior=1"});
  EXPECT_EQ(Json(model).at("self_network").at("weights").size(), 24u);
  EXPECT_EQ(Json(model).at("ensemble").size(), 1u);
  for (const auto& [app, arguments] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"pushid-report", {Recordings(), "--html_out=" + Path("report.html")}},
           {"pushid-evaluate", {Recordings(), "--json_out=" + Path("scores.json")}},
           {"pushid-predict", {Recordings(), "--id=" + id_, "--out=" + Path("path.csv")}}}) {
    std::vector<std::string> all = {"--model=" + model};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto run = RunApp(app, all);
    EXPECT_EQ(run.exit_code, 0) << app << ": " << run.err;
  }
}

}  // namespace
}  // namespace pushid
