// The READMEs and what they speak of: links lead somewhere, numbers have a study behind them, the
// glossary is that of the program, the first page stays one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/run_app.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = PUSHID_SOURCE_DIR;

std::string ReadFile(const fs::path& path) {
  std::ifstream stream(path);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Files of the project; built ones are left out.
std::vector<fs::path> Readmes() {
  std::vector<fs::path> found = {kSource / "README.md"};
  for (const char* room : {"apps", "ident", "residuals", "datasets", "models", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / room)) {
      if (entry.path().filename() == "README.md") found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// visit(match) for each match of the expression in the text.
template <typename Visit>
void ForEachMatch(const std::string& text, const std::regex& expression, Visit visit) {
  for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) visit(*i);
}

// The text between <!-- name --> and the next <!-- end -->; how many such blocks there are.
std::vector<std::string> Blocks(const std::string& text, const std::string& name) {
  const std::string marker = "<!-- " + name + " -->\n";
  std::vector<std::string> blocks;
  for (size_t at = text.find(marker); at != std::string::npos; at = text.find(marker, at + 1)) {
    const size_t begin = at + marker.size(), end = text.find("<!-- end -->", begin);
    blocks.push_back(end == std::string::npos ? "no end" : text.substr(begin, end - begin));
  }
  return blocks;
}

TEST(ReadmeTest, TheFirstPageIsOnePage) {
  const std::string text = ReadFile(kSource / "README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
}

TEST(ReadmeTest, LinksLeadSomewhere) {
  int links = 0;
  for (const fs::path& readme : Readmes()) {
    ForEachMatch(ReadFile(readme), std::regex(R"(\]\(([^)#]+)(#[^)]*)?\))"),
                 [&](const std::smatch& link) {
                   if (link[1].str().find("://") != std::string::npos) return;
                   ++links;
                   EXPECT_TRUE(fs::exists(readme.parent_path() / link[1].str()))
                       << readme << ": no " << link[1];
                 });
  }
  EXPECT_GT(links, 10) << "the READMEs were not found";
}

// From the top, from the README's own folder, or in a folder of it.
bool NamesFile(const fs::path& readme, const std::string& name) {
  const fs::path folder = readme.parent_path();
  if (fs::exists(kSource / name) || fs::exists(folder / name)) return true;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && fs::exists(entry.path() / name)) return true;
  }
  return false;
}

TEST(ReadmeTest, FilesNamedExist) {
  int files = 0;
  for (const fs::path& readme : Readmes()) {
    ForEachMatch(ReadFile(readme), std::regex(R"(`([a-z0-9_./]+\.(h|cc|py|sh))`)"),
                 [&](const std::smatch& file) {
                   ++files;
                   EXPECT_TRUE(NamesFile(readme, file[1])) << readme << ": no " << file[1];
                 });
  }
  EXPECT_GT(files, 10);
}

// A block of a README names its script, a block of a script has its place in exactly one README,
// and it is filled.
TEST(ReadmeTest, EveryBlockOfNumbersHasItsStudy) {
  std::map<std::string, int> places;
  for (const fs::path& readme : Readmes()) {
    const std::string text = ReadFile(readme);
    ForEachMatch(text, std::regex(R"(\n<!-- (tests/studies/(\w+\.py) (\w+)) -->\n)"),
                 [&](const std::smatch& marker) {
                   const std::string name = marker[1];
                   if (text.compare(marker.position() + marker.length(), 12, "<!-- end -->") == 0) {
                     ADD_FAILURE() << readme << ": block '" << name
                                   << "' is empty; run: python3 tests/studies/" << marker[2] << " "
                                   << marker[3] << " --write";
                   }
                   ++places[name];
                 });
  }
  EXPECT_GT(places.size(), 10u);
  for (const auto& entry : fs::directory_iterator(kSource / "tests/studies")) {
    const std::string script = entry.path().filename().string();
    if (entry.path().extension() != ".py") continue;
    const std::set<std::string> no_numbers = {"studies.py",    "journeys.py",
                                              "inventory.py",  "independent_people.py",
                                              "lab_people.py", "unseen_pushes.py"};
    if (no_numbers.count(script) > 0) continue;
    const std::string text = ReadFile(entry.path());
    const size_t list = text.find("studies.main(__file__, {");
    ASSERT_NE(list, std::string::npos) << script;
    ForEachMatch(text.substr(list), std::regex(R"re("(\w+)": \w+)re"),
                 [&](const std::smatch& block) {
                   const std::string name = "tests/studies/" + script + " " + block[1].str();
                   EXPECT_EQ(places[name], 1) << "READMEs with the line <!-- " << name << " -->";
                   places.erase(name);
                 });
  }
  for (const auto& [name, count] : places)
    ADD_FAILURE() << "no study makes the block '" << name << "'";
}

TEST(ReadmeTest, TheGlossaryIsThatOfTheProgram) {
  setenv("PUSHID_BIN", PUSHID_BIN_DIR, 1);
  const std::string script = kSource / "tests/studies/glossary.sh";
  const AppRun run = Succeeded(RunProgram("/bin/bash", {script, "--print"}));
  const std::vector<std::string> blocks =
      Blocks(ReadFile(kSource / "ident/README.md"), "parameters");
  ASSERT_EQ(blocks.size(), 1u) << "ident/README.md: one line <!-- parameters -->";
  EXPECT_EQ(blocks[0], run.out)
      << "ident/README.md and pushid-fit --list_parameters disagree; mend it by\n"
      << "  PUSHID_BIN=" << PUSHID_BIN_DIR << " bash tests/studies/glossary.sh";
}

}  // namespace
}  // namespace pushid
