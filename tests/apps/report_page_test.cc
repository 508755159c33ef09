// pushid-report's page in a real browser (Debian's chromium, headless), and its numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"
#include "tests/apps/browser.h"

namespace pushid {
namespace {

// Drives the page as a person would and writes down what happened, as text of a new element.
constexpr char kProbe[] = R"js(  const find = id => document.getElementById(id);
  const before = find('fig-stage').innerHTML;
  find('fig-time').value = 10;
  find('fig-time').dispatchEvent(new Event('input'));
  said.push('slider ' + (find('fig-stage').innerHTML !== before ? 'moves' : 'is dead'));
  said.push('clock ' + find('fig-clock').textContent);
  find('fig-recording').value = 1;
  find('fig-recording').dispatchEvent(new Event('change'));
  said.push('slider back at ' + find('fig-time').value);
  said.push('skeleton lines ' + (find('fig-stage').querySelectorAll('line.b').length > 0));
  said.push('pendulums ' + find('fig-stage').querySelectorAll('circle.p').length);
  find('fig-play').click();
  said.push('button says ' + find('fig-play').textContent);
  const broken = [...document.querySelectorAll('nav a')].filter(
      a => !document.querySelector(a.getAttribute('href')));
  said.push('broken links ' + broken.length);
  said.push('wide ' + (document.documentElement.scrollWidth > window.innerWidth));
)js";

class ReportPage : public AppTest {};

TEST_F(ReportPage, WorksInABrowser) {
  if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
  const std::string model = FitModel("model.json", {"--profile=mu", "--bootstrap=9"});
  const AppRun run = RunApp(
      "pushid-report", {"--model=" + model, Recordings(), "--html_out=" + Path("report.html")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::string page = ReadText(Path("report.html"));
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg")) << "opens from disk";
  EXPECT_EQ(page.find("https://"), std::string::npos);
  const AppRun seen = Browse(Path("browser"), WriteText("probed.html", Probed(page, kProbe)));
  ASSERT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_EQ(seen.err.find("CONSOLE"), std::string::npos) << seen.err;
  for (const char* section :
       {"summary", "parameters", "identifiability", "profiles", "bootstrap", "behaviour", "figure",
        "motion", "recordings", "leverage", "residuals", "solve", "design", "provenance"}) {
    EXPECT_TRUE(Contains(seen.out, "<section id=\"" + std::string(section) + "\">"));
  }
  const size_t probe = seen.out.find("<pre id=\"probe\">");
  ASSERT_NE(probe, std::string::npos) << "the page's script stopped early";
  const std::string said = seen.out.substr(probe, 300);
  for (const char* expected :
       {"slider moves", "clock 0.33 s", "slider back at 0", "skeleton lines true", "pendulums 2",
        "button says pause", "broken links 0", "wide false"}) {
    EXPECT_TRUE(Contains(said, expected));
  }
}

TEST_F(ReportPage, NumbersBehindEveryPlot) {
  const std::string model = FitModel("model.json", {"--profile=mu"});
  const AppRun run = RunApp(
      "pushid-report", {"--model=" + model, Recordings(), "--text", "--csv_dir=" + Path("csv")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* heading : {"What was fitted\n===============", "Profile likelihood",
                              "What to record next", "Measured and predicted motion"}) {
    EXPECT_TRUE(Contains(run.out, heading));
  }
  for (const std::string& name :
       {std::string("forest"), std::string("correlation"), std::string("profiles"),
        std::string("explained"), std::string("leverage"), std::string("residual_correlations"),
        std::string("trace"), "motion_" + id_, "forces_" + id_}) {
    const std::string csv = ReadText(Path("csv/" + name + ".csv"));
    const size_t columns = static_cast<size_t>(
        std::count(csv.begin(), csv.begin() + static_cast<long>(csv.find('\n')), ','));
    EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 1) << name;
    EXPECT_EQ(
        static_cast<size_t>(std::count(csv.begin(), csv.end(), ',')) % std::max<size_t>(1, columns),
        0u)
        << name << " has rows of different lengths";
  }
}

TEST_F(ReportPage, WithoutRecordingsTheRestStands) {
  const AppRun run =
      RunApp("pushid-report", {"--model=" + FitModel(), "--html_out=" + Path("report.html")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Contains(run.err, "without --recordings"));
  const std::string page = ReadText(Path("report.html"));
  EXPECT_TRUE(Contains(page, "<section id=\"parameters\">"));
  EXPECT_EQ(page.find("<section id=\"figure\">"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST_F(ReportPage, RecordingsThatChangedAreNamed) {
  const std::string model = FitModel();
  const std::string push = Json(manifest_)["recordings"][0]["push_csv"];
  WriteText(push, ReadText(Path(push)) + "\n");
  const AppRun run = RunApp("pushid-report", {"--model=" + model, Recordings(), "--text"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Contains(run.out, id_));
  EXPECT_TRUE(Contains(run.out, "changed since the fit"));
}

}  // namespace
}  // namespace pushid
