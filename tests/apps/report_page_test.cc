// pushid-report's page in a real browser (Debian's chromium, headless), and its numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ident/figures/svg.h"
#include "tests/apps/app_fixture.h"
#include "tests/apps/browser.h"

namespace pushid {
namespace {

// Drives the page as a person would and writes down what happened, as text of a new element.
constexpr char kProbe[] = R"js(
  const figure = document.querySelector('iframe.moving').contentDocument;
  const find = id => figure.getElementById(id), shows = () => find('view').toDataURL();
  const differs = change => { const before = shows(); change(); return shows() !== before; };
  const tell = (id, event) => find(id).dispatchEvent(new Event(event));
  said.push('slider ' + (differs(() => { find('time').value = 20; tell('time', 'input'); }) ? 'moves' : 'is dead'));
  said.push('clock ' + find('clock').textContent);
  find('recording').value = 1;
  tell('recording', 'change');
  said.push('slider back at ' + find('time').value);
  for (const id of ['recorded', 'predicted', 'pendulums', 'forces', 'footprints']) {
    said.push(id + ' ' + (find(id) && differs(() => find(id).click()) ? 'drawn' : 'missing'));
    if (find(id)) find(id).click();
  }
  find('play').click();
  said.push('button says ' + find('play').textContent);
  const broken = [...document.querySelectorAll('nav a')].filter(
      a => !document.querySelector(a.getAttribute('href')));
  said.push('broken links ' + broken.length);
  said.push('wide ' + (document.documentElement.scrollWidth > window.innerWidth));
)js";

class ReportPage : public AppTest {};

TEST_F(ReportPage, WorksInABrowser) {
  if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
  const std::string model = CheckedModel({"--profile=mu", "--bootstrap=9"});
  Succeeded(RunApp("pushid-report",
                   {"--model=" + model, Recordings(), "--html_out=" + Path("report.html")}));
  std::string page = ReadText(Path("report.html"));
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg")) << "opens from disk";
  EXPECT_FALSE(Contains(page, "https://"));
  const AppRun seen =
      Succeeded(Browse(Path("browser"), WriteText("probed.html", Probed(page, kProbe))));
  EXPECT_FALSE(Contains(seen.err, "CONSOLE")) << seen.err;
  for (const char* section :
       {"summary", "parameters", "identifiability", "profiles", "behaviour", "figure", "motion",
        "recordings", "leverage", "residuals", "provenance"}) {
    EXPECT_TRUE(Contains(seen.out, "<section id=\"" + std::string(section) + "\">"));
  }
  const size_t probe = seen.out.find("<pre id=\"probe\">");
  ASSERT_NE(probe, std::string::npos) << "the page's script stopped early";
  const std::string said = seen.out.substr(probe, 500);
  for (const char* expected : {"slider moves", "clock 0.33 s", "slider back at 0", "recorded drawn",
                               "predicted drawn", "pendulums drawn", "footprints drawn",
                               "button says Pause", "broken links 0", "wide false"}) {
    EXPECT_TRUE(Contains(said, expected)) << said;
  }
}

// On a desk and on a telephone; folded tables count as well.
TEST_F(ReportPage, LeadsWithPictures) {
  if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
  Succeeded(RunApp("pushid-report",
                   {"--model=" + FitModel(), Recordings(), "--html_out=" + Path("report.html")}));
  const std::string page = ReadText(Path("report.html"));
  ASSERT_TRUE(Contains(page, "<figure>"));
  EXPECT_LT(page.find("<figure>"), page.find("<table>"));
  EXPECT_LT(page.find("<figure>"), page.find("<nav"));
  EXPECT_LT(page.find("What to do next"), page.find("What is known"));
  const AppRun seen = Browse(Path("browser"), WriteText("probed.html", Framed({Probed(page, R"js(
  const panel = document.querySelector('figure .panels.scroll svg').getBoundingClientRect();
  said.push(panel.top + 0.5 * panel.height < innerHeight ? 'seen at once' : 'starts at ' + panel.top);
  const beside = document.querySelector('nav').getBoundingClientRect().right <= panel.left;
  const text = document.querySelector('p:not(header p)').getBoundingClientRect();
  said.push((beside ? 'links beside' : 'links below') + (text.width > innerWidth / 2 ? '' : ', narrow'));
)js")})));
  EXPECT_EQ(WhatItSaid(seen, 0), "seen at once; links beside");
  EXPECT_EQ(WhatItSaid(seen, 1), "seen at once; links below");
}

TEST_F(ReportPage, FiguresAndTablesAsFiles) {
  const std::string model = CheckedModel({"--profile=mu"});
  const std::vector<std::string> flags = {"--model=" + model, Recordings(), "--details",
                                          "--figures_out=" + Path("figures")};
  const AppRun run = Succeeded(RunApp("pushid-report", flags));
  for (const char* heading : {"What was fitted\n===============", "Profile likelihood",
                              "What to try next", "Measured and predicted motion"}) {
    EXPECT_TRUE(Contains(run.out, heading));
  }
  const std::string captions = ReadText(Path("figures/captions.md"));
  for (const std::string& name :
       {std::string("typical"), std::string("forest"), std::string("profiles"),
        std::string("explained"), std::string("residual_correlations"), "motion_" + id_,
        "forces_" + id_}) {
    SCOPED_TRACE(name);
    const std::string csv = ReadText(Path("figures/" + name + ".csv"));
    const size_t columns = static_cast<size_t>(
        std::count(csv.begin(), csv.begin() + static_cast<long>(csv.find('\n')), ','));
    EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 1);
    EXPECT_EQ(
        static_cast<size_t>(std::count(csv.begin(), csv.end(), ',')) % std::max<size_t>(1, columns),
        0u)
        << "rows of different lengths";
    const std::string svg = ReadText(Path("figures/" + name + ".svg"));
    EXPECT_TRUE(Contains(svg, "<title>" + name + "</title>"));
    const size_t from = captions.find("**" + name + "** ");
    ASSERT_NE(from, std::string::npos);
    const size_t begin = from + name.size() + 5;
    const std::string caption = captions.substr(begin, captions.find('\n', begin) - begin);
    EXPECT_GT(caption.size(), 10u);
  }
  EXPECT_TRUE(Contains(ReadText(Path("figures/table_parameters_1.csv")), "parameter,value"));
  EXPECT_FALSE(std::filesystem::exists(Path("figures/known.svg"))) << "two people identify nothing";
}

TEST_F(ReportPage, FiguresReplaceFiguresAlone) {
  const std::string model = FitModel();
  const std::string out = "--figures_out=" + Path("figures");
  const auto write = [&](const std::vector<std::string>& more) {
    return RunApp("pushid-report", With({"--model=" + model, out}, more));
  };
  ASSERT_EQ(write({}).exit_code, 0);
  EXPECT_TRUE(Refused(write({}), {"captions.md", "already exists", "--overwrite"}));
  WriteText("figures/old.svg", "");
  ASSERT_EQ(write({"--overwrite"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(Path("figures/old.svg"))) << "the folder is new as a whole";
  std::filesystem::remove(Path("figures/captions.md"));
  EXPECT_TRUE(Refused(write({"--overwrite"}), {"holds other files"}));
  for (const auto& entry : std::filesystem::directory_iterator(Path(""))) {
    EXPECT_FALSE(Contains(entry.path().string(), ".tmp.")) << entry.path();
  }
}

TEST_F(ReportPage, WithoutRecordingsTheRestStands) {
  const AppRun run = Succeeded(
      RunApp("pushid-report", {"--model=" + FitModel(), "--html_out=" + Path("report.html")}));
  EXPECT_TRUE(Contains(run.err, "without --recordings"));
  const std::string page = ReadText(Path("report.html"));
  EXPECT_TRUE(Contains(page, "<section id=\"parameters\">"));
  EXPECT_FALSE(Contains(page, "<section id=\"figure\">"));
}

TEST_F(ReportPage, RecordingsThatChangedAreNamed) {
  const std::string model = FitModel();
  const std::string push = Json(manifest_)["recordings"][0]["push_csv"];
  WriteText(push, ReadText(Path(push)) + "\n");
  const AppRun run =
      Succeeded(RunApp("pushid-report", {"--model=" + model, Recordings(), "--details"}));
  EXPECT_TRUE(Contains(run.out, id_));
  EXPECT_TRUE(Contains(run.out, "changed since the fit"));
}

}  // namespace
}  // namespace pushid
