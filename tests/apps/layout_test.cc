// Pages and pictures in a real browser (Debian's chromium, headless), as wide as a desk's and as a
// telephone's: nothing overlaps, nothing is cut off, nothing complains.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"
#include "tests/apps/browser.h"

namespace pushid {
namespace {

class LayoutTest : public AppTest {
 protected:
  void SetUp() override {
    if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
    AppTest::SetUp();
  }

  // The layout's faults at both widths; the last remark, how many labels were seen, is none. Pages
  // of these numbers have labels.
  void ExpectGoodLayout(std::vector<std::string> pages, const std::set<size_t>& labelled) {
    for (std::string& page : pages) page = Probed(page, kLayoutProbe);
    const AppRun seen = Browse(Path("browser"), WriteText("probed.html", Framed(pages)));
    EXPECT_FALSE(Contains(seen.err, "CONSOLE")) << seen.err;
    int frame = 0;
    for (size_t i = 0; i < pages.size(); ++i) {
      for (const int width : kWidths) {
        SCOPED_TRACE("page " + std::to_string(i) + ", width " + std::to_string(width));
        const std::string said = WhatItSaid(seen, frame++);
        EXPECT_FALSE(Contains(said, "; ")) << said;
        EXPECT_TRUE(Contains(said, " labels in " + std::to_string(width) + " pixels"));
        EXPECT_EQ(said.rfind("0 labels", 0) == 0, labelled.count(i) == 0) << said;
      }
    }
  }

  static std::string PageOf(const std::string& picture) {
    return "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"></head><body>"
           "<div style=\"overflow-x:auto\">" +
           picture + "</div></body></html>";
  }
};

// Folds are opened: what they hide is laid out as well.
std::string Opened(std::string page) {
  for (size_t at = 0; (at = page.find("<details>", at)) != std::string::npos; ++at) {
    page.replace(at, 9, "<details open>");
  }
  return page;
}

TEST_F(LayoutTest, AReportOfAFewParameters) {
  const std::string model = CheckedModel({"--profile=mu", "--bootstrap=9"});
  Succeeded(RunApp("pushid-report",
                   {"--model=" + model, Recordings(), "--html_out=" + Path("report.html")}));
  ExpectGoodLayout({Opened(ReadText(Path("report.html")))}, {0});
}

TEST_F(LayoutTest, AReportOfManyParameters) {
  const std::string model = FitModel("model.json", {"--self_force=linear", "--free=Kd_theta"});
  Succeeded(RunApp("pushid-report",
                   {"--model=" + model, Recordings(), "--html_out=" + Path("report.html")}));
  ExpectGoodLayout({Opened(ReadText(Path("report.html")))}, {0});
}

// Each in a file of its own.
TEST_F(LayoutTest, FiguresInFiles) {
  const std::string model = CheckedModel({"--profile=mu", "--bootstrap=9"});
  Succeeded(RunApp("pushid-report",
                   {"--model=" + model, Recordings(), "--figures_out=" + Path("figures")}));
  std::string figures;
  for (const auto& entry : std::filesystem::directory_iterator(Path("figures"))) {
    if (entry.path().extension() != ".svg") continue;
    // Their section names them in what the probe says.
    figures += "<section id=\"" + entry.path().stem().string() + "\">" +
               ReadText(entry.path().string()) + "</section>";
  }
  ExpectGoodLayout({PageOf(figures)}, {0});
}

TEST_F(LayoutTest, PicturesOfAFormation) {
  const std::string model = FitModel();
  Succeeded(RunApp("pushid-formation",
                   {"--model=" + model, "--formation=line", "--people=5",
                    "--svg_out=" + Path("wave.svg"), "--html_out=" + Path("wave.html")}));
  const std::string page = ReadText(Path("wave.html"));
  ExpectGoodLayout({page, PageOf(ReadText(Path("wave.svg")))}, {1});
  EXPECT_FALSE(Contains(page, "id=\"recorded\"")) << "nothing was recorded";
}

TEST_F(LayoutTest, AnAnimationOfSeveralWhatIfs) {
  const std::string model = FitModel();
  Succeeded(
      RunApp("pushid-animate", {"--model=" + model, Recordings(), "--id=" + id_, "--set=mu=10",
                                "--set=mu=60,a_x=-8", "--out=" + Path("a.html")}));
  const std::string page = ReadText(Path("a.html"));
  for (const char* entry : {"recorded", "as fitted", "mu=10", "mu=60,a_x=-8"}) {
    EXPECT_TRUE(Contains(page, entry));
  }
  ExpectGoodLayout({page}, {1});
  EXPECT_TRUE(
      Refused(RunApp("pushid-animate", {"--model=" + model, Recordings(), "--id=" + id_,
                                        "--set=mu=10", "--set=mew=1", "--out=" + Path("b.html")}),
              {"--set", "'mew'"}));
}

// Draws a frame in which the push acts: the script of the page runs through.
TEST_F(LayoutTest, TheMovingFigureMoves) {
  const std::string model = FitModel();
  Succeeded(RunApp("pushid-animate",
                   {"--model=" + model, Recordings(), "--id=" + id_, "--out=" + Path("a.html")}));
  const AppRun seen =
      Browse(Path("browser"), WriteText("probed.html", Probed(ReadText(Path("a.html")), R"js(
  const time = document.getElementById('time'), canvas = document.getElementById('view');
  const before = canvas.toDataURL();
  time.value = 3;
  time.dispatchEvent(new Event('input'));
  said.push(canvas.toDataURL() === before ? 'stands' : 'moves');
  said.push(document.getElementById('clock').textContent);
)js")));
  EXPECT_FALSE(Contains(seen.err, "CONSOLE")) << seen.err;
  EXPECT_EQ(WhatItSaid(seen), "moves; 0.05 s, frame 3");
}

TEST_F(LayoutTest, ForcesAreToldBesideTheMotion) {
  const std::vector<std::string> flags = {"--model=" + FitModel(), Recordings(), "--id=" + id_,
                                          "--out=" + Path("a.html")};
  std::vector<std::string> told = flags, wrong = flags;
  told.push_back("--explain=auto");
  wrong.push_back("--explain=nobody");
  const AppRun run = Succeeded(RunApp("pushid-animate", told));
  EXPECT_TRUE(Contains(run.out, ": 0 s pushed, up to "));
  const std::string page = ReadText(Path("a.html"));
  EXPECT_TRUE(Contains(page, ": 0 s pushed, up to "));
  ExpectGoodLayout({page}, {});
  EXPECT_TRUE(Refused(RunApp("pushid-animate", wrong), {"--explain", "'nobody'", "there are"}));
}

}  // namespace
}  // namespace pushid
