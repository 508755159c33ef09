// Helpers of tests: values of results, temporary folders and files, the real recordings.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "datasets/files/error.h"

namespace pushid {

// The value; an error is printed and ends the test.
template <typename T>
T Unwrapped(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().ToString());
  return std::move(result).value();
}

// The error as users read it, or "no error".
template <typename T>
std::string ProblemOf(const Result<T>& result) {
  return result.ok() ? "no error" : result.error().ToString();
}
inline std::string ProblemOf(const MaybeError& error) {
  return error ? error->ToString() : "no error";
}

// A fixture with a temporary folder.
class TempDirTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "pushid-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  // Writes or overwrites a file, creates its folders, and returns its path.
  std::string WriteText(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  // Number of files in the folder and below.
  int CountFiles() const {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      count += entry.is_regular_file() ? 1 : 0;
    }
    return count;
  }

  std::filesystem::path folder_;
};

inline std::string ReadText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// A folder of real data that contains a file of this name: the folder in the environment variable,
// or
// ../shared/FOLDER relative to the source; "" if there is none.
inline std::string SharedFolder(const char* variable, const std::string& folder,
                                const std::string& file) {
  const char* named = std::getenv(variable);
  const std::filesystem::path root =
      named != nullptr && *named != '\0'
          ? std::filesystem::path(named)
          : std::filesystem::path(PUSHID_SOURCE_DIR) / ".." / "shared" / folder;
  std::error_code ignored;
  return std::filesystem::exists(root / file, ignored) ? root.string() : "";
}

// The folder of the real recordings; "" if there are none, in which case a test skips itself:
//
//   if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
inline std::string RecordingsRoot() {
  return SharedFolder("PUSHID_RECORDINGS", "fzj_push", "manifest.json");
}

constexpr char kNoRecordings[] =
    "the real recordings are not here; name their folder by PUSHID_RECORDINGS";

// EXPECT_TRUE(Contains(text, part)) that shows both when it fails.
inline ::testing::AssertionResult Contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << part << "' is not in '" << text << "'";
}

}  // namespace pushid
