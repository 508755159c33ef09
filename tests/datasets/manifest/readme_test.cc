// The room's README: its examples are read as they stand, and its table has every key.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/manifest.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class ReadmeTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    std::ifstream file(std::string(PUSHID_SOURCE_DIR) + "/datasets/README.md");
    std::stringstream text;
    text << file.rdbuf();
    readme_ = text.str();
    ASSERT_FALSE(readme_.empty());
  }

  // The block of JSON that holds `key`, as a file.
  std::string Block(const std::string& key) const {
    const std::string begin = "```json\n";
    for (std::size_t at = readme_.find(begin); at != std::string::npos;
         at = readme_.find(begin, at + 1)) {
      const std::size_t from = at + begin.size();
      const std::string block = readme_.substr(from, readme_.find("```", from) - from);
      if (Contains(block, key)) return WriteText("block.json", block);
    }
    ADD_FAILURE() << "no block of JSON has " << key;
    return "";
  }

  std::string readme_;
};

TEST_F(ReadmeTest, TheExamplesAreRead) {
  const Manifest manifest = Unwrapped(ReadManifest(Block("\"recordings\"")));
  EXPECT_TRUE(MisspeltKeys(manifest.recordings[0]).empty());
  const Result<ColumnMapping> mapping = ReadColumnMapping(Block("\"columns\""));
  EXPECT_TRUE(mapping.ok()) << mapping.error().ToString();
}

TEST_F(ReadmeTest, TheTableHasEveryKey) {
  for (const std::string& key : ManifestKeys()) {
    EXPECT_TRUE(Contains(readme_, "`" + key + "`")) << key;
  }
  for (const MotionFormatRow& row : kMotionFormats) {
    for (const char* ending : row.endings) {
      if (ending == nullptr) continue;
      EXPECT_TRUE(Contains(readme_, std::string("`.") + ending + "`")) << ending;
    }
  }
}

}  // namespace
}  // namespace pushid
