// Disks that are full and folders that may not be written: the path is named, the exit code is 1,
// nothing is left half-written, and a batch goes on when there is space again.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

constexpr char kNoMounts[] = "mounting a small disk needs root";

// The recordings are on a disk as always; "disk" is a small one of its own.
class SmallDiskTest : public BatchFixture {
 protected:
  void TearDown() override {
    if (mounted_) umount2(Path("disk").c_str(), MNT_DETACH);
    BatchFixture::TearDown();
  }

  // False where mounting is not allowed.
  bool Mount(int kilobytes) {
    fs::create_directory(Path("disk"));
    const std::string options = "size=" + std::to_string(kilobytes) + "k";
    mounted_ = mount("pushid-test", Path("disk").c_str(), "tmpfs", 0, options.c_str()) == 0;
    return mounted_;
  }

  // All but so many bytes.
  void Fill(size_t but) const {
    const size_t space = fs::space(Path("disk")).available;
    std::ofstream(Path("disk/filler"), std::ios::binary) << std::string(space - but, 'x');
    ASSERT_LT(fs::space(Path("disk")).available, but + 8192);
  }

  bool MakeReadOnly() const {
    return mount("pushid-test", Path("disk").c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "") == 0;
  }

  std::vector<std::string> OnDisk() const {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(Path("disk"))) {
      if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(Path("disk")));
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  // Bytes of all files below a folder.
  size_t SizeOfFiles(const std::string& name) const {
    size_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(Path(name))) {
      if (entry.is_regular_file()) bytes += entry.file_size();
    }
    return bytes;
  }

  bool mounted_ = false;
};

struct Output {
  std::string app;
  std::vector<std::string> arguments;
  std::string path;  // on the disk
};

std::vector<Output> Outputs(const std::string& recordings, const std::string& model,
                            const std::string& id, const std::string& disk) {
  const std::string out = disk + "/out", use = "--model=" + model, quiet = "--quiet";
  return {
      {"pushid-fit", {recordings, "--model_out=" + out, quiet}, out},
      {"pushid-report", {use, recordings, "--html_out=" + out, quiet}, out},
      {"pushid-evaluate", {use, recordings, "--json_out=" + out, quiet}, out},
      {"pushid-predict", {use, recordings, "--id=" + id, "--out=" + out, quiet}, out},
      {"pushid-crossvalidate", {recordings, "--folds=2", "--json_out=" + out, quiet}, out},
      {"pushid-simulate", {"--out=" + disk + "/made", "--people=1", quiet}, disk + "/made"},
  };
}

TEST_F(SmallDiskTest, FullEveryOutputSaysSoAndNothingIsLeft) {
  if (!Mount(64)) GTEST_SKIP() << kNoMounts;
  const std::string model = FitModel();
  Fill(0);
  for (const Output& output : Outputs(Recordings(), model, id_, Path("disk"))) {
    const AppRun run = RunApp(output.app, output.arguments);
    EXPECT_EQ(run.exit_code, 1) << output.app << run.err;
    EXPECT_TRUE(Contains(run.err, output.path)) << output.app;
    EXPECT_TRUE(Contains(run.err, "No space left on device")) << output.app;
    fs::remove_all(Path("disk/made"));
    EXPECT_EQ(OnDisk(), std::vector<std::string>{"filler"}) << output.app;
  }
}

TEST_F(SmallDiskTest, FullTheEarlierModelStays) {
  if (!Mount(256)) GTEST_SKIP() << kNoMounts;
  const std::string model = FitModel("disk/model.json"), before = ReadText(model);
  Fill(4096);
  const AppRun run = RunApp("pushid-fit", {Recordings(), "--model_out=" + model, "--seed=2"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(Contains(run.err, model + ": cannot write it: No space left on device"));
  EXPECT_EQ(ReadText(model), before);
  EXPECT_EQ(OnDisk(), (std::vector<std::string>{"filler", "model.json"}));
}

TEST_F(SmallDiskTest, ReadOnlyEveryOutputIsRefused) {
  if (!Mount(64)) GTEST_SKIP() << kNoMounts;
  const std::string model = FitModel();
  ASSERT_TRUE(MakeReadOnly());
  for (const Output& output : Outputs(Recordings(), model, id_, Path("disk"))) {
    EXPECT_TRUE(Refused(RunApp(output.app, output.arguments), {output.path, "Read-only"}))
        << output.app;
  }
  EXPECT_TRUE(Refused(Batch(Plan("", {{"a", ""}}, "disk/out")), {"disk/out", "Read-only"}));
  EXPECT_TRUE(OnDisk().empty());
}

// For those who are not root, whom modes bind.
TEST_F(SmallDiskTest, AFolderWithoutWritingRightsIsNamed) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(Path("closed"));
  fs::permissions(Path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {Recordings(), "--model_out=" + Path("closed/m.json")}),
                      {Path("closed/m.json"), "Permission denied"}));
}

// Output that a full disk swallows must not look done.
TEST_F(SmallDiskTest, AResultThatCannotBePrintedIsAFailure) {
  const std::string fit = std::string(PUSHID_BIN_DIR) + "/pushid-fit";
  const AppRun run =
      RunProgram("/bin/sh", {"-c", "'" + fit + "' '" + Recordings() + "' --quiet >/dev/full"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(Contains(run.err, "stdout cannot be written: No space left on device"));
}

TEST_F(SmallDiskTest, ABatchGoesOnWhenThereIsSpaceAgain) {
  if (!Mount(4096)) GTEST_SKIP() << kNoMounts;
  const std::string jobs = "group_by = \"recording\"";
  const std::vector<std::pair<std::string, std::string>> variants = {{"a", ""}};
  Succeeded(Batch(Plan(jobs, variants, "whole", "whole.toml")));
  const std::string plan = Plan(jobs, variants, "disk/out");
  Fill(SizeOfFiles("whole") / 3);  // of twelve jobs, two at a time, one at least fits
  const AppRun full = Batch(plan, {"--jobs=2"});
  EXPECT_EQ(full.exit_code, 1) << full.out << full.err;
  EXPECT_TRUE(Contains(full.err, Path("disk/out")));
  EXPECT_TRUE(Contains(full.err, "No space left on device"));
  for (const std::string& file : OnDisk()) {
    EXPECT_FALSE(Contains(file, ".tmp.")) << file;
  }
  fs::remove(Path("disk/filler"));
  const AppRun again = Succeeded(Batch(plan, {"--jobs=2"}));
  EXPECT_FALSE(Contains(again.out, " 0 done before")) << again.out;  // finished jobs are kept
  EXPECT_EQ(Table("disk/out"), Table("whole"));
}

}  // namespace
}  // namespace pushid
