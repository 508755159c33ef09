// Dependencies point down only: apps -> ident -> residuals -> datasets -> models, and inside a room
// from a subfolder to those that stand above it in the room's list.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace pushid {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"models", {}},
    {"datasets", {"models"}},
    {"residuals", {"datasets", "models"}},
    {"ident", {"residuals", "datasets", "models"}},
    {"apps", {"ident", "residuals", "datasets", "models"}},
};

// The order of each room's subfolders; "" is the room itself.
const std::map<std::string, std::vector<std::string>> kFloors = {
    {"models", {"", "restoration", "generators"}},
    {"datasets", {"files", "formats", "manifest", "sensors", "loading", "synthetic", "inspection"}},
    {"residuals", {"kernels", "", "lanes", "jets", "cost_functions", "adjoint"}},
    {"ident",
     {"figures",     "parameters",  "problem",    "solver",    "large_networks", "uncertainty",
      "diagnostics", "model",       "observed",   "fit",       "prediction",     "validation",
      "push",        "bodies",      "generators", "forecasts", "training",       "formations",
      "report",      "report/page", "checks",     ""}},
    {"apps", {"support", "flags", "batch", "", "python"}},
};

// The floor that "room/folder/NAME.h" stands on; -1: none.
int FloorOf(const std::string& file) {
  const size_t slash = file.find('/'), last = file.rfind('/');
  const auto& floors = kFloors.at(file.substr(0, slash));
  const std::string folder = last > slash ? file.substr(slash + 1, last - slash - 1) : "";
  const auto at = std::find(floors.begin(), floors.end(), folder);
  return at == floors.end() ? -1 : static_cast<int>(at - floors.begin());
}

std::vector<fs::path> Sources(const fs::path& room) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(room)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".h" || extension == ".cc") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// visit(line number, what stands between the quotes or brackets)
template <typename Visit>
void ForEachInclude(const fs::path& file, Visit visit) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::ifstream stream(file);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    std::smatch match;
    if (std::regex_match(line, match, kInclude)) visit(number, match[1].str());
  }
}

TEST(RoomsTest, NothingIncludesUpward) {
  int files = 0;
  for (const auto& [room, allowed] : kMayInclude) {
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      ++files;
      ForEachInclude(file, [&, &of = room, &may = allowed](int line, const std::string& included) {
        EXPECT_EQ(included.find(".."), std::string::npos)
            << file << ":" << line << ": includes are written from the top: " << included;
        const std::string target = included.substr(0, included.find('/'));
        EXPECT_NE(target, "tests") << file << ":" << line;
        if (kMayInclude.count(target) == 0 || target == of) return;
        EXPECT_TRUE(may.count(target) == 1)
            << file << ":" << line << ": " << of << " must not include " << included;
      });
    }
  }
  EXPECT_GT(files, 50) << "the sources were not found";
}

TEST(RoomsTest, FloorsIncludeOnlyWhatStandsAboveThem) {
  for (const auto& [room, floors] : kFloors) {
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      const std::string here = fs::relative(file, PUSHID_SOURCE_DIR).generic_string();
      const int floor = FloorOf(here);
      EXPECT_GE(floor, 0) << here << ": no folder of the room " << room;
      ForEachInclude(file, [&, &own = room](int line, const std::string& included) {
        if (included.substr(0, included.find('/')) != own) return;
        EXPECT_LE(FloorOf(included), floor) << here << ":" << line << ": must not include "
                                            << included << ", which stands on a later floor";
      });
    }
  }
}

// A file is read at one go.
TEST(RoomsTest, NoSourceIsLongerThan700Lines) {
  for (const auto& [room, allowed] : kMayInclude) {
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      std::ifstream stream(file);
      int lines = 0;
      for (std::string line; std::getline(stream, line);) ++lines;
      EXPECT_LE(lines, 700) << file;
    }
  }
}

// What comments and READMEs call a file is one, by its name or the end of its path.
TEST(RoomsTest, NamedFilesExist) {
  std::vector<fs::path> texts = {fs::path(PUSHID_SOURCE_DIR) / "README.md"};
  std::set<std::string> names;
  for (const char* room : {"models", "datasets", "residuals", "ident", "apps", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PUSHID_SOURCE_DIR) / room)) {
      if (entry.path().filename() == "README.md") texts.push_back(entry.path());
    }
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      texts.push_back(file);
      std::string name = fs::relative(file, PUSHID_SOURCE_DIR).generic_string();
      names.insert(name);
      for (size_t slash; (slash = name.find('/')) != std::string::npos;) {
        names.insert(name = name.substr(slash + 1));
      }
    }
  }
  const std::regex file_name(R"((^|[^\w*/])([a-z][a-z0-9_/]*\.(h|cc))\b)");
  int found = 0;
  for (const fs::path& text : texts) {
    std::ifstream stream(text);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      const size_t start = text.extension() == ".md" ? 0 : line.find("//");
      if (start == std::string::npos) continue;
      for (std::sregex_iterator it(line.begin() + start, line.end(), file_name), end; it != end;
           ++it, ++found) {
        EXPECT_EQ(names.count((*it)[2]), 1u) << text << ":" << number << ": no file " << (*it)[2];
      }
    }
  }
  EXPECT_GT(found, 50) << "the comments were not read";
}

// What the core does without: nothing but itself, what builds on it, and programs includes it.
TEST(RoomsTest, TheCoreIncludesNoOptionalLibrary) {
  const std::map<std::string, std::set<std::string>> may_include = {
      {"residuals/adjoint", {"ident/large_networks"}},
      {"ident/large_networks", {}},
      {"ident/forecasts", {"ident/training"}},
      {"ident/training", {}},
  };
  const auto folder_of = [](const std::string& file) { return file.substr(0, file.rfind('/')); };
  std::set<std::string> found;
  for (const auto& [room, allowed] : kMayInclude) {
    if (room == "apps") continue;
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      const std::string here = folder_of(fs::relative(file, PUSHID_SOURCE_DIR).generic_string());
      found.insert(here);
      ForEachInclude(file, [&](int line, const std::string& included) {
        const auto optional = may_include.find(folder_of(included));
        if (optional == may_include.end() || optional->first == here) return;
        EXPECT_EQ(optional->second.count(here), 1u)
            << file << ":" << line << ": must do without " << included;
      });
    }
  }
  for (const auto& [folder, by] : may_include) EXPECT_EQ(found.count(folder), 1u) << folder;
}

// The maths stays free of the solver, the log, JSON and files.
TEST(RoomsTest, ModelsArePlainMaths) {
  const std::vector<std::string> forbidden = {"ceres/",  "glog/",  "gflags/",    "nlohmann/",
                                              "fstream", "cstdio", "filesystem", "iostream"};
  for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / "models")) {
    ForEachInclude(file, [&](int line, const std::string& included) {
      for (const std::string& start : forbidden) {
        EXPECT_NE(included.rfind(start, 0), 0u) << file << ":" << line << ": " << included;
      }
    });
  }
}

// LibTorch is for training alone, and stays in files that say so: nothing else needs it to build.
TEST(RoomsTest, LibTorchStaysInItsFiles) {
  for (const auto& [room, allowed] : kMayInclude) {
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      const std::string name = file.stem().string();
      const bool may = name.size() > 6 && name.compare(name.size() - 6, 6, "_torch") == 0;
      ForEachInclude(file, [&](int line, const std::string& included) {
        if (may) {
          EXPECT_NE(included.rfind("glog/", 0), 0u) << file << ":" << line << ": both define LOG";
          return;
        }
        EXPECT_NE(included.rfind("torch/", 0), 0u) << file << ":" << line;
        EXPECT_EQ(included.find("_torch.h"), std::string::npos) << file << ":" << line;
      });
    }
  }
}

// Each of Eigen's decompositions takes the compiler seconds in every source that uses one
// (models/decompositions.h); closed forms of small matrices (LU) do not.
TEST(RoomsTest, DecompositionsStayInOneFile) {
  for (const auto& [room, allowed] : kMayInclude) {
    for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / room)) {
      const std::string name = file.filename().string();
      if (name == "decompositions.cc" || name.find("_torch.") != std::string::npos) continue;
      ForEachInclude(file, [&](int line, const std::string& included) {
        for (const char* header : {"Dense", "Cholesky", "Eigenvalues", "QR", "SVD"}) {
          EXPECT_NE(included, std::string("Eigen/") + header) << file << ":" << line;
        }
      });
    }
  }
}

// A citation, a wheel and the changelog name the version that the programs print.
TEST(RoomsTest, OneVersion) {
  const auto found = [](const char* file, const std::string& line) {
    std::ifstream stream(fs::path(PUSHID_SOURCE_DIR) / file);
    std::smatch match;
    for (std::string text; std::getline(stream, text);) {
      if (std::regex_search(text, match, std::regex(line))) return match[1].str();
    }
    return std::string("none");
  };
  const std::string number = "([0-9]+\\.[0-9]+\\.[0-9]+)";
  const std::string version = found("CMakeLists.txt", "^project\\(pushid VERSION " + number);
  EXPECT_NE(version, "none");
  EXPECT_EQ(found("CITATION.cff", "^version: " + number), version);
  EXPECT_EQ(found("apps/python/pyproject.toml", "^version = \"" + number), version);
  EXPECT_EQ(found("CHANGELOG.md", "^## " + number), version);
}

// Flags that programs share are read in one folder, those of one program alone in its own file:
// support, batches and Python know none.
TEST(RoomsTest, FlagsStayWithPrograms) {
  const std::regex flag(R"(\b(FLAGS|DEFINE_[a-z0-9]+|DECLARE_[a-z0-9]+)(_\w+|\())");
  int found = 0;
  for (const fs::path& file : Sources(fs::path(PUSHID_SOURCE_DIR) / "apps")) {
    const std::string folder = file.parent_path().filename();
    // Messages set flags of glog's own.
    const bool may = folder == "flags" || folder == "apps" || file.filename() == "app_support.cc";
    std::ifstream stream(file);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      if (!std::regex_search(line, flag)) continue;
      ++found;
      EXPECT_TRUE(may) << file << ":" << number
                       << ": flags are read in apps/flags and by programs: " << line;
    }
  }
  EXPECT_GT(found, 50) << "the flags were not found";
}

}  // namespace
}  // namespace pushid
