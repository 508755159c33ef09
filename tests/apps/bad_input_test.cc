// Damaged recordings: every executable that reads them refuses with one line that names the file,
// the place and the remedy, and writes nothing.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

using nlohmann::ordered_json;

class BadInputTest : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    model_ = "--model=" + FitModel();
    bvh_ = ReadText(Path(Bvh()));
    push_ = ReadText(Path(PushCsv()));
    text_ = ReadText(manifest_);
  }

  std::string Bvh() const { return "bvh/" + id_ + ".bvh"; }
  std::string PushCsv() const { return "push/" + id_ + ".csv"; }

  // The first `from` of a file's text replaced.
  static std::string Replaced(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "the recording's file has no '" << from << "'";
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }
  void DamageBvh(const std::string& from, const std::string& to) {
    WriteText(Bvh(), Replaced(bvh_, from, to));
  }
  void DamagePush(const std::string& from, const std::string& to) {
    WriteText(PushCsv(), Replaced(push_, from, to));
  }
  void DamageEntry(const std::function<void(ordered_json&)>& change) {
    ordered_json json = ordered_json::parse(text_);
    change(json["recordings"][0]);
    WriteText("manifest.json", json.dump(1));
  }
  // The first motion line, by its number in the file, replaced by what `change` makes of it.
  int FirstMotionLine() const {
    const size_t at = bvh_.find('\n', bvh_.find("Frame Time:")) + 1;
    return 1 + static_cast<int>(std::count(bvh_.begin(), bvh_.begin() + at, '\n'));
  }
  std::string MotionNumber() const {  // the first number of the motion, with its line break before
    const size_t at = bvh_.find('\n', bvh_.find("Frame Time:"));
    return bvh_.substr(at, bvh_.find(' ', at) - at);
  }

  void Restore() {
    WriteText(Bvh(), bvh_);
    WriteText(PushCsv(), push_);
    WriteText("manifest.json", text_);
  }

  void ExpectRefused(const std::vector<std::string>& says) {
    const int files = CountFiles();
    const std::string out = "--json_out=" + Path("out.json");
    EXPECT_TRUE(
        Refused(RunApp("pushid-fit", {Recordings(), "--model_out=" + Path("out.json")}, 30), says));
    EXPECT_TRUE(Refused(RunApp("pushid-evaluate", {model_, Recordings(), out}, 30), says));
    EXPECT_TRUE(Refused(RunApp("pushid-crossvalidate", {Recordings(), out}, 30), says));
    EXPECT_TRUE(
        Refused(RunApp("pushid-predict",
                       {model_, Recordings(), "--id=" + id_, "--out=" + Path("out.csv")}, 30),
                says));
    EXPECT_EQ(CountFiles(), files) << "something was written";
  }

  std::string model_, bvh_, push_, text_;
};

struct DamageCase {
  const char* what;
  std::function<void()> damage;
  std::vector<std::string> says;
};

TEST_F(BadInputTest, MotionFiles) {
  const std::string line = Bvh() + ":" + std::to_string(FirstMotionLine()) + ": ";
  const std::string number = MotionNumber();
  const std::vector<DamageCase> cases = {
      {"missing", [&] { std::filesystem::remove(Path(Bvh())); }, {Bvh(), "no such file"}},
      {"empty", [&] { WriteText(Bvh(), ""); }, {Bvh(), "not a BVH file"}},
      {"not a BVH", [&] { WriteText(Bvh(), "frame,fx\n0,1\n"); }, {Bvh() + ":1", "not a BVH file"}},
      {"truncated in the hierarchy",
       [&] { WriteText(Bvh(), bvh_.substr(0, bvh_.find("MOTION") / 2)); },
       {Bvh() + ":"}},
      {"truncated in the motion",
       [&] { WriteText(Bvh(), bvh_.substr(0, bvh_.size() * 4 / 5)); },
       {Bvh() + ":"}},
      {"too few frames told",
       [&] { DamageBvh("Frames: 45", "Frames: 44"); },
       {Bvh() + ":", "wrong frame count", "44"}},
      {"too many frames told",
       [&] { DamageBvh("Frames: 45", "Frames: 46"); },
       {Bvh() + ":", "wrong frame count", "46"}},
      {"NaN", [&] { DamageBvh(number, "\nnan"); }, {line, "'nan'"}},
      {"infinity", [&] { DamageBvh(number, "\ninf"); }, {line, "'inf'"}},
      {"text", [&] { DamageBvh(number, "\nleft"); }, {line, "'left'"}},
      {"absurd number", [&] { DamageBvh(number, "\n1e300"); }, {Bvh(), "damaged"}},
      {"no frame time",
       [&] { DamageBvh("Frame Time: 0.0", "Frame Time: 0.000000000"); },
       {Bvh() + ":", "frame time"}},
      {"zero frame time", [&] { DamageBvh("Frame Time: 0.01", "Frame Time: 0 "); }, {Bvh() + ":"}},
      {"negative frame time",
       [&] { DamageBvh("Frame Time: ", "Frame Time: -"); },
       {Bvh() + ":", "frame time"}},
      {"metres read as mm",
       [&] { DamageEntry([](ordered_json& r) { r["length_unit"] = "m"; }); },
       {Bvh(), "looks like mm, pass --length_unit=mm"}},
  };
  for (const DamageCase& one : cases) {
    SCOPED_TRACE(one.what);
    one.damage();
    ExpectRefused(one.says);
    Restore();
  }
}

TEST_F(BadInputTest, FewerThanThreeFrames) {
  DamageEntry([](ordered_json& r) { r.erase("frames"); });
  // Two frames: the header and two lines of the motion.
  size_t end = bvh_.find('\n', bvh_.find("Frame Time:"));
  for (int i = 0; i < 2; ++i) end = bvh_.find('\n', end + 1);
  WriteText(Bvh(), Replaced(bvh_.substr(0, end + 1), "Frames: 45", "Frames: 2"));
  ExpectRefused({Bvh(), "2 frames", "three"});
}

TEST_F(BadInputTest, PushFiles) {
  const std::string csv = PushCsv();
  const std::vector<DamageCase> cases = {
      {"missing", [&] { std::filesystem::remove(Path(csv)); }, {csv, "no such file"}},
      {"empty", [&] { WriteText(csv, ""); }, {csv, "empty"}},
      {"header alone", [&] { WriteText(csv, "frame,fx,fy,ftheta,fphi\n"); }, {csv}},
      {"wrong header", [&] { DamagePush("frame,fx", "time,fx"); }, {csv + ":1", "frame,fx,fy"}},
      {"text", [&] { DamagePush("\n0,", "\n0,abc"); }, {csv + ":2", "fx", "abc"}},
      {"NaN",
       [&] { WriteText(csv, "frame,fx,fy,ftheta,fphi\n0,nan,0,0,0\n"); },
       {csv + ":2", "fx is missing"}},
      {"row left out", [&] { DamagePush("\n1,", "\n2,"); }, {csv + ":3", "frame"}},
      {"row twice", [&] { DamagePush("\n1,", "\n0,"); }, {csv + ":3", "frame"}},
      {"missing value",
       [&] { WriteText(csv, "frame,fx,fy,ftheta,fphi\n0,1,2,3\n"); },
       {csv + ":2", "4 values"}},
      {"longer than the motion",
       [&] {
         std::string rows = "frame,fx,fy,ftheta,fphi\n";
         for (int i = 0; i < 46; ++i) rows += std::to_string(i) + ",1,0,0,0\n";
         WriteText(csv, rows);
       },
       {csv, "longer than the motion", "46 rows", "45 frames"}},
  };
  for (const DamageCase& one : cases) {
    SCOPED_TRACE(one.what);
    one.damage();
    ExpectRefused(one.says);
    Restore();
  }
}

TEST_F(BadInputTest, Manifests) {
  auto entry = [this](std::function<void(ordered_json&)> change) {
    return [this, change] { DamageEntry(change); };
  };
  auto set = [&entry](const char* key, ordered_json value) {
    return entry([key, value](ordered_json& r) { r[key] = value; });
  };
  auto mass = [&entry](double kg) {
    return entry([kg](ordered_json& r) { r["subjects"][0]["mass_kg"] = kg; });
  };
  const std::string at = "manifest.json:";
  const std::vector<DamageCase> cases = {
      {"missing", [&] { std::filesystem::remove(manifest_); }, {"manifest.json", "no such file"}},
      {"empty file", [&] { WriteText("manifest.json", ""); }, {"manifest.json", "empty"}},
      {"no recordings",
       [&] { WriteText("manifest.json", "{\"recordings\": []}\n"); },
       {at + "1:", "no recordings"}},
      {"no list", [&] { WriteText("manifest.json", "{}\n"); }, {at, "recordings is missing"}},
      {"no JSON",
       [&] { WriteText("manifest.json", "{\n \"recordings\": [,]\n}\n"); },
       {at + "2:17", "JSON"}},
      {"cut off",
       [&] { WriteText("manifest.json", text_.substr(0, text_.size() / 2)); },
       {at, "JSON"}},
      {"zero fps", set("fps", 0), {at, id_, "fps is 0"}},
      {"negative fps", set("fps", -60), {at, id_, "fps is -60"}},
      {"absurd fps", set("fps", 1e9), {at, id_, "fps is"}},
      {"fps as text", set("fps", "60"), {at, id_, "fps must be"}},
      {"no mass", mass(0), {at, id_, "mass_kg is 0"}},
      {"negative mass", mass(-70), {at, id_, "mass_kg is -70"}},
      {"grams", mass(70000), {at, id_, "mass_kg is 70000"}},
      {"unknown joint",
       entry([](ordered_json& r) { r["joints"]["hip"] = "belly"; }),
       {Bvh(), "'belly'"}},
      {"joint index", entry([](ordered_json& r) { r["joints"]["hip"] = 99; }), {Bvh(), "99"}},
      {"wrong frame count", set("frames", 44), {Bvh(), "wrong frame count", "44"}},
      {"key missing", entry([](ordered_json& r) { r.erase("bvh"); }), {at, id_, "bvh is missing"}},
      {"push kind", set("push_kind", "strong"), {at, id_, "push_kind", "external"}},
      {"pushed person", set("pushed_person", 3), {at, id_, "pushed_person"}},
      {"unit", set("length_unit", "inch"), {at, id_, "length_unit", "mm, cm or m"}},
      {"duplicate id",
       [&] {
         ordered_json json = ordered_json::parse(text_);
         json["recordings"][1]["id"] = id_;
         WriteText("manifest.json", json.dump(1));
       },
       {at, id_, "unique"}},
  };
  for (const DamageCase& one : cases) {
    SCOPED_TRACE(one.what);
    one.damage();
    ExpectRefused(one.says);
    Restore();
  }
}

TEST_F(BadInputTest, FoldersAndDevicesAreNoFiles) {
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recordings=/"}), {"/: ", "not a file"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recordings=/dev/null"}), {"/dev/null: ", "empty"}));
  EXPECT_TRUE(Refused(RunApp("pushid-fit", {"--recordings=/dev/zero"}), {"/dev/zero: ", "large"}));
}

TEST_F(BadInputTest, ARecordingWithoutAPush) {
  DamageEntry([](ordered_json& r) { r.erase("push_csv"); });
  EXPECT_TRUE(
      Refused(RunApp("pushid-fit", {Recordings()}), {id_, "neither a push", "pushid-push"}));
  EXPECT_TRUE(Refused(RunApp("pushid-crossvalidate", {Recordings()}),
                      {id_, "neither a push", "pushid-push"}));
}

}  // namespace
}  // namespace pushid
