// The report page's explorable person: the WebAssembly in it moves as pushid-formation's people do.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"
#include "tests/apps/browser.h"

namespace pushid {
namespace {

// Waits for the model, then pushes less.
constexpr char kProbe[] = R"js(<script>(async function () {
  const said = document.getElementById('exp-said'), note = document.createElement('pre');
  while (!said.dataset.hip) await new Promise(done => setTimeout(done, 20));
  const whole = said.dataset.hip, push = document.querySelector('#exp-sliders input');
  const mass = JSON.parse(document.getElementById('exp-data').textContent).inputs[0];
  push.value = 640;  // 42 N s
  push.dispatchEvent(new Event('input'));
  const less = said.dataset.hip;
  document.getElementById('exp-reset').click();
  note.id = 'probe';
  note.textContent = [mass, whole, less, said.dataset.hip === whole,
                      document.querySelectorAll('#exp-graph polygon').length].join(' ');
  document.body.append(note);
})();</script></body>)js";

class ExploreTest : public AppTest {
 protected:
  // Where the hip is in the last of 6 s at 60 Hz, by pushid-formation.
  double Displaced(const std::string& model, double mass, const std::string& push) {
    std::ostringstream kilograms;
    kilograms.precision(17);
    kilograms << mass;
    Succeeded(RunApp("pushid-formation",
                     {"--model=" + model, "--formation=line", "--people=1", "--push=" + push,
                      "--mass=" + kilograms.str(), "--csv_out=" + Path("p.csv")}));
    std::istringstream lines(ReadText(Path("p.csv")));
    std::string line, cell;
    for (int frame = -1; frame < 360; ++frame) std::getline(lines, line);
    std::istringstream cells(line);
    for (int column = 0; column <= 12; ++column) std::getline(cells, cell, ',');
    return std::atof(cell.c_str());  // hip_x_m
  }
};

TEST_F(ExploreTest, MovesAsAFormationOfOne) {
  if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
  // The law of who steps is another one in a model of people who touch.
  const std::vector<std::vector<std::string>> models = {
      {},
      {"--preset=group", "--stance=steps",
       "--fix=contact_stiffness,contact_distance,contact_kappa,contact_damping"}};
  for (const std::vector<std::string>& flags : models) {
    const std::string model = FitModel(flags.empty() ? "alone.json" : "rows.json", flags);
    Succeeded(RunApp("pushid-report", {"--model=" + model, "--html_out=" + Path("r.html"),
                                       "--explore", "--overwrite"}));
    std::string page = ReadText(Path("r.html"));
    if (!Contains(page, "exp-wasm")) GTEST_SKIP() << "built without emscripten";
    page.replace(page.find("</body>"), 7, kProbe);
    const AppRun seen = Browse(Path("browser"), WriteText("probed.html", page), 5000);
    EXPECT_FALSE(Contains(seen.err, "CONSOLE")) << seen.err;
    std::istringstream said(WhatItSaid(seen));
    double mass = 0.0, whole = 0.0, less = 0.0;
    std::string back;
    int bands = 0;
    said >> mass >> whole >> less >> back >> bands;
    EXPECT_NEAR(whole, Displaced(model, mass, "80"), 1e-8);
    EXPECT_NEAR(less, Displaced(model, mass, "42"), 1e-8);
    EXPECT_GT(whole, less);
    EXPECT_EQ(back, "true") << "as fitted again";
    EXPECT_EQ(bands, 1);
  }
}

TEST_F(ExploreTest, IsLeftOutWhereAskedTo) {
  Succeeded(RunApp("pushid-report",
                   {"--model=" + FitModel(), "--explore=false", "--html_out=" + Path("r.html")}));
  EXPECT_FALSE(Contains(ReadText(Path("r.html")), "exp-wasm"));
}

}  // namespace
}  // namespace pushid
