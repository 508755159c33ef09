// A network from the fit to the page: every program takes a model that has one.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using NetworkAppTest = AppTest;

// A line of a table of commas.
std::vector<std::string> CellsOf(std::istream* table) {
  std::string line, cell;
  std::getline(*table, line);
  std::istringstream cells(line);
  std::vector<std::string> all;
  while (std::getline(cells, cell, ',')) all.push_back(cell);
  return all;
}

TEST_F(NetworkAppTest, EveryProgramTakesANetwork) {
  const std::string model =
      "--model=" + FitModel("model.json", {"--self_force=mlp:2", "--network_prior=1"});
  EXPECT_EQ(Json(Path("model.json")).at("self_network").at("weights").size(), 24u);
  Succeeded(RunApp("pushid-report", {model, Recordings(), "--html_out=" + Path("report.html")}));
  Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--json_out=" + Path("scores.json")}));
  Succeeded(
      RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + Path("path.csv")}));
}

TEST_F(NetworkAppTest, ARodThatMovesGoesThroughEveryProgram) {
  const std::string model =
      "--model=" + FitModel("model.json", {"--self_force=mlp:2", "--rod=ldp:2"});
  EXPECT_EQ(Json(Path("model.json")).at("self_network").at("rod").at("kind"), "ldp");
  EXPECT_EQ(Json(Path("model.json")).at("self_network").at("weights").size(), 24u + 29u);
  Succeeded(RunApp("pushid-report", {model, Recordings(), "--html_out=" + Path("report.html")}));
  Succeeded(RunApp("pushid-evaluate", {model, Recordings()}));
  Succeeded(
      RunApp("pushid-predict", {model, Recordings(), "--id=" + id_, "--out=" + Path("path.csv")}));
  EXPECT_TRUE(Contains(ReadText(Path("report.html")), "network mlp:2 and rod ldp:2"));
  EXPECT_TRUE(Contains(ReadText(Path("path.csv")), ",rod_length_m,cart_height_m"));
}

// The hip of a restored body is the tip of the rod as it is in that frame.
TEST_F(NetworkAppTest, BodiesFollowARodThatMoves) {
  const std::string model = "--model=" + FitModel("model.json", {"--rod=ldp:2"});
  Succeeded(RunApp("pushid-predict",
                   {model, Recordings(), "--id=" + id_, "--restoration=rigid", "--postprocess=none",
                    "--out=" + Path("path.csv"), "--poses_out=" + Path("b.csv")}));
  std::istringstream table(ReadText(Path("path.csv")));
  const auto names = CellsOf(&table);
  const auto column = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  std::istringstream joints(ReadText(Path("b.csv")));
  CellsOf(&joints);
  double shortest = 10.0, longest = 0.0;
  for (auto joint = CellsOf(&joints); !joint.empty(); joint = CellsOf(&joints)) {
    if (joint[4] != "Hips") continue;
    const auto row = CellsOf(&table);
    for (int i = 0; i < 3; ++i) {
      const std::string name = std::string("hip_") + "xyz"[i] + "_m";
      EXPECT_NEAR(std::stod(joint[5 + i]), std::stod(row[column(name)]), 2e-5) << joint[0];
    }
    shortest = std::min(shortest, std::stod(row[column("rod_length_m")]));
    longest = std::max(longest, std::stod(row[column("rod_length_m")]));
  }
  EXPECT_GT(longest - shortest, 1e-5) << "the rod does move";
  Succeeded(RunApp("pushid-evaluate", {model, Recordings(), "--restoration=rigid"}));
  Succeeded(
      RunApp("pushid-animate", {model, Recordings(), "--id=" + id_, "--out=" + Path("a.html")}));
  Succeeded(RunApp("pushid-formation",
                   {model, "--formation=line", "--people=3", "--duration=1", "--restoration=rigid",
                    "--recordings=" + manifest_, "--bodies_out=" + Path("f.bvh")}));
}

TEST_F(NetworkAppTest, FlagsThatCannotBeAreNamed) {
  EXPECT_TRUE(
      Refused(RunApp("pushid-fit", {Recordings(), "--rod=gru:4", "--model_out=" + Path("m.json")}),
              {"--rod is 'gru:4'"}));
}

}  // namespace
}  // namespace pushid
