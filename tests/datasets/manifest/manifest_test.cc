#include "datasets/manifest/manifest.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/test_support.h"

namespace pushid {
namespace {

using ManifestTest = TempDirTest;

constexpr char kGoodManifest[] = R"({
 "name": "a name the program does not know",
 "units": {"bvh_length": "cm", "force": "N"},
 "recordings": [
  {
   "id": "a",
   "setting": "single",
   "subjects": [{"id": "s1", "mass_kg": 67.5, "order": 0}],
   "fps": 60,
   "pushed_person": 0,
   "bvh": ["bvh/a.bvh"],
   "push_csv": "push/a.csv",
   "push_kind": "net",
   "magnitude": "weak",
   "anomalies": ["none"]
  },
  {
   "id": "b",
   "setting": "row_1",
   "subjects": [
    {"id": "s1", "mass_kg": 67.5},
    {"id": "s2", "mass_kg": 1e2}
   ],
   "fps": 59.94,
   "pushed_person": 1,
   "bvh": ["bvh/b0.bvh", "/elsewhere/b1.bvh"],
   "magnitude": "strong",
   "condition_code": "p",
   "joints": {"hip": "Hips", "left_ankle": 3}, "why": "because", "split": "eval",
   "up": "+y",
   "forward": "Z",
   "length_unit": "m",
   "pushes": [{"person": 0, "csv": "push/b.csv", "start_frame": 12, "sensor": "F1"}],
   "initial_velocity": "free",
   "frames": 91
  }
 ]
}
)";

// The manifest states errors for all, and a recording its own on top of them.
TEST_F(ManifestTest, StatedErrors) {
  auto json = nlohmann::ordered_json::parse(kGoodManifest);
  json["stated_errors"] = {{"mass", 0.01}, {"push_zero_N", 0.5}};
  json["recordings"][0]["stated_errors"] = {{"mass", 0.02}};
  const auto read = [&] { return ReadManifest(WriteText("stated.json", json.dump(1))); };
  const Manifest manifest = Unwrapped(read());
  const StatedErrors& own = manifest.recordings[0].stated_errors;
  EXPECT_EQ(own.mass, 0.02);
  EXPECT_EQ(own.push_zero_N, 0.5);
  EXPECT_EQ(own.push_scale, StatedErrors().push_scale);
  json["recordings"][0]["stated_errors"] = {{"mass", -0.02}};
  EXPECT_TRUE(Contains(read().error().ToString(), "stated_errors: mass must be a standard"));
  json["recordings"][0]["stated_errors"] = {{"mass", 3}};
  EXPECT_TRUE(Contains(read().error().ToString(), "mass is a share: 0.05 means 5 %"));
  json["recordings"][0]["stated_errors"] = {{"weight", 0.02}};
  EXPECT_TRUE(Contains(read().error().ToString(), "weight is not known; there may be push_scale"));
  json["recordings"][0]["stated_errors"] = 0.02;
  EXPECT_TRUE(Contains(read().error().ToString(), "must be an object"));
}

TEST_F(ManifestTest, ReadsEverything) {
  const Manifest read = Unwrapped(ReadManifest(WriteText("manifest.json", kGoodManifest)));
  EXPECT_EQ(read.length.length_unit, LengthUnit::kCentimetre);
  ASSERT_EQ(read.recordings.size(), 2u);
  const ManifestRecording& a = read.recordings[0];
  EXPECT_EQ(a.id, "a");
  EXPECT_EQ(a.labels.setting(), "single");
  EXPECT_EQ(a.fps, 60.0);
  ASSERT_EQ(a.subjects.size(), 1u);
  EXPECT_EQ(a.subjects[0].id, "s1");
  EXPECT_EQ(a.subjects[0].mass_kg, 67.5);
  EXPECT_EQ(a.motion, std::vector<std::string>{"bvh/a.bvh"});
  EXPECT_EQ(a.push_csv, "push/a.csv");
  EXPECT_EQ(a.push_kind, PushKind::kNet);
  EXPECT_EQ(a.labels.magnitude(), "weak");
  EXPECT_EQ(a.up, "z");
  EXPECT_EQ(a.initial_velocity, InitialVelocity::kZero);
  EXPECT_FALSE(a.length.length_unit || a.frames || a.joints.Of(kBodyHip));
  EXPECT_EQ(a.line, 5);

  const ManifestRecording& b = read.recordings[1];
  EXPECT_EQ(b.line, 17);
  EXPECT_EQ(b.pushed_person, 1);
  EXPECT_EQ(b.push_csv, "");
  EXPECT_EQ(b.push_kind, PushKind::kExternal);
  EXPECT_EQ(b.labels.condition(), "p");
  EXPECT_EQ(b.labels.Of("why"), "because");
  EXPECT_EQ(b.labels.Keys(),
            (std::vector<std::string>{"condition", "magnitude", "setting", "split", "why"}));
  EXPECT_TRUE(MisspeltKeys(b).empty()) << "split is a label";
  EXPECT_EQ(b.joints.Of(kBodyHip)->name, "Hips");
  EXPECT_EQ(b.joints.Of(kLeftAnkle)->index, 3);
  EXPECT_FALSE(b.joints.Of(kRightAnkle));
  EXPECT_EQ(b.up, "+y");
  EXPECT_EQ(b.length.length_unit, LengthUnit::kMetre);
  ASSERT_EQ(b.pushes.size(), 1u);
  EXPECT_EQ(b.pushes[0].csv, "push/b.csv");
  EXPECT_EQ(b.pushes[0].start_frame, 12);
  EXPECT_EQ(b.initial_velocity, InitialVelocity::kFree);
  EXPECT_EQ(b.frames, 91);

  EXPECT_EQ(ResolvePath("M/manifest.json", b.motion[0]), "M/bvh/b0.bvh");
  EXPECT_EQ(ResolvePath("M/manifest.json", b.motion[1]), "/elsewhere/b1.bvh");
  EXPECT_EQ(ResolvePath("manifest.json", b.motion[0]), "bvh/b0.bvh");
}

TEST_F(ManifestTest, RewritingLosesNothing) {
  const Manifest read = Unwrapped(ReadManifest(WriteText("manifest.json", kGoodManifest)));
  ASSERT_FALSE(WriteManifest(Path("again.json"), read));
  auto expected = nlohmann::json::parse(kGoodManifest);
  expected["recordings"][1]["push_kind"] = "external";  // said, not left to the default
  // But for the old name of a key.
  expected["recordings"][1]["condition"] = "p";
  expected["recordings"][1].erase("condition_code");
  EXPECT_EQ(nlohmann::json::parse(ReadText(Path("again.json"))), expected);
}

TEST_F(ManifestTest, ChangesAreWritten) {
  Manifest manifest = Unwrapped(ReadManifest(WriteText("manifest.json", kGoodManifest)));
  manifest.length.length_unit = LengthUnit::kMillimetre;
  manifest.recordings[0].push_csv = "";
  manifest.recordings[0].initial_velocity = InitialVelocity::kEstimated;
  manifest.recordings[0].joints.Set(kBodyHip, JointReference{"Root", -1});
  manifest.recordings[0].joints.Set(kLeftKnee, JointReference{"LKneeJC", -1});
  manifest.recordings[0].length.length_scale = 0.0564;
  manifest.recordings[1].joints = {};
  manifest.recordings[1].up = "z";
  manifest.recordings[1].forward = "x";
  manifest.recordings[1].length.length_unit.reset();
  manifest.recordings[1].pushes[0].start_frame = 13;
  manifest.recordings[1].frames.reset();
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest));
  const auto json = nlohmann::json::parse(ReadText(Path("manifest.json")));
  EXPECT_EQ(json["units"]["bvh_length"], "mm");
  EXPECT_FALSE(json["recordings"][0].contains("push_csv"));
  EXPECT_FALSE(json["recordings"][1].contains("length_unit"));
  EXPECT_EQ(json["recordings"][1]["pushes"][0]["sensor"], "F1");
  EXPECT_EQ(json["recordings"][1]["condition"], "p");
  EXPECT_FALSE(json["recordings"][1].contains("condition_code"));
  const Manifest again = Unwrapped(ReadManifest(Path("manifest.json")));
  EXPECT_EQ(again.recordings[0].initial_velocity, InitialVelocity::kEstimated);
  EXPECT_EQ(again.recordings[0].joints.Of(kBodyHip)->name, "Root");
  EXPECT_EQ(json["recordings"][0]["joints"]["left_knee"], "LKneeJC");
  EXPECT_EQ(again.recordings[0].joints.Of(kLeftKnee)->name, "LKneeJC");
  EXPECT_FALSE(again.recordings[0].joints.Of(kRightKnee));
  EXPECT_EQ(again.recordings[0].length.length_scale, 0.0564);
  EXPECT_FALSE(again.recordings[1].joints.Of(kBodyHip));
  EXPECT_EQ(again.recordings[1].up, "z");
  EXPECT_EQ(again.recordings[1].pushes[0].start_frame, 13);
  EXPECT_FALSE(again.recordings[1].frames);
}

TEST_F(ManifestTest, WrittenFromScratch) {
  Manifest manifest;
  manifest.length.length_unit = LengthUnit::kMetre;
  ManifestRecording recording;
  recording.id = "x";
  recording.labels.Set(kSettingLabel, "single");
  recording.fps = 120.5;
  recording.subjects = {{"s", 80.0}};
  recording.motion = {"x.bvh"};
  recording.labels.Set(kMagnitudeLabel, "weak");
  recording.pushes = {{0, "x.csv", 4}};
  manifest.recordings.push_back(recording);
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest));
  const Manifest read = Unwrapped(ReadManifest(Path("manifest.json")));
  EXPECT_EQ(read.length.length_unit, LengthUnit::kMetre);
  EXPECT_EQ(read.recordings[0].fps, 120.5);
  EXPECT_EQ(read.recordings[0].pushes[0].csv, "x.csv");
}

TEST_F(ManifestTest, EveryDamageIsNamedWithItsLine) {
  const struct {
    const char* from;
    const char* to;
    const char* place;
    const char* says;
  } damages[] = {
      {"{\n \"name\"", "[\n \"name\"", ":2:", "not valid JSON"},
      {"\"fps\": 60,", "\"fps\": 60", ":10:18: ", "not valid JSON"},
      {"\"recordings\"", "\"recording\"", ":1:1: ", "manifest: recordings is missing"},
      {"\"bvh_length\": \"cm\"", "\"bvh_length\": \"inch\"",
       ":3:26: ", "'inch'; it must be mm, cm"},
      {"\"fps\": 60,", "\"fps\": \"60\",", ":9:11: ", "fps must be the frames per second, not"},
      {"\"fps\": 60,", "\"fps\": 0,", ":9:11: ", "fps is 0; accepted are 1 to 10000"},
      {"\"fps\": 60,", "\"fps\": -60,", ":9:11: ", "fps is -60"},
      {"\"fps\": 60,", "\"fps\": 1e9,", ":9:11: ", "fps is 1e+09"},
      {"\"fps\": 60,", "\"fps\": null,", ":9:11: ", "not 'null'"},
      {"\"id\": \"a\",", "", ":5:3: ", "recording 0: id is missing"},
      {"\"id\": \"a\"", "\"id\": 7", ":6:10: ", "recording 0: id must be text in quotes, not '7'"},
      {"\"id\": \"a\"", "\"id\": \"\"", ":6:10: ", "id is empty"},
      {"\"id\": \"a\"", "\"id\": \"a,b\"", ":6:10: ", "id must have no comma"},
      {"\"left_ankle\": 3", "\"leftankle\": 3", ":29:", "joints: leftankle is not known"},
      {"\"id\": \"b\"", "\"id\": \"a\"",
       ":18:10: ", "recording 'a': this id was given before, in line 5"},
      {"\"setting\": \"single\",", "", ":5:3: ", "recording 'a': setting is missing"},
      {"\"magnitude\": \"weak\"", "\"magnitude\": 3",
       ":14:17: ", "magnitude must be text in quotes, not '3'"},
      {"67.5, \"order\"", "0, \"order\"",
       ":8:41: ", "recording 'a', subject 0: mass_kg is 0; a mass"},
      {"67.5, \"order\"", "-5, \"order\"", ":8:41: ", "mass_kg is -5"},
      {"67.5, \"order\"", "67500, \"order\"",
       ":8:41: ", "mass_kg is 67500; a mass in kg is above 0"},
      {"\"mass_kg\": 67.5, \"order\"", "\"order\"", ":8:17: ", "subject 0: mass_kg is missing"},
      {"\"mass_kg\": 1e2", "\"mass_kg\": \"1e2\"",
       ":22:29: ", "recording 'b', subject 1: mass_kg must be"},
      {"[{\"id\": \"s1\", \"mass_kg\": 67.5, \"order\": 0}]", "[]", ":8:16: ", "subjects is empty"},
      {"[{\"id\": \"s1\", \"mass_kg\": 67.5, \"order\": 0}]", "[67]",
       ":8:17: ", "must be an object"},
      {"[{\"id\": \"s1\", \"mass_kg\": 67.5, \"order\": 0}]", "{}",
       ":8:16: ", "subjects must be a list"},
      {"\"pushed_person\": 0", "\"pushed_person\": 1",
       ":10:21: ", "pushed_person is '1'; it must be the index of the pushed subject, 0"},
      {"\"pushed_person\": 1", "\"pushed_person\": 2", ":25:21: ", "0 to 1"},
      {"\"pushed_person\": 0", "\"pushed_person\": 0.5", ":10:21: ", "pushed_person is '0.5'"},
      {"\"pushed_person\": 0", "\"pushed_person\": -1", ":10:21: ", "pushed_person is '-1'"},
      {"\"pushed_person\": 0,", "", ":5:3: ", "pushed_person is missing"},
      {"[\"bvh/a.bvh\"]", "[]", ":11:11: ", "bvh lists 0 files for 1 subjects"},
      {"[\"bvh/a.bvh\"]", "\"bvh/a.bvh\"", ":11:11: ", "bvh must be a list"},
      {"[\"bvh/a.bvh\"]", "[3]", ":11:12: ", "must be a file name"},
      {"\"push_kind\": \"net\"", "\"push_kind\": \"gross\"",
       ":13:17: ", "'gross'; it must be net, net_without_friction or external"},
      {"\"left_ankle\": 3", "\"left_ankle\": -3",
       ":29:", "joints: left_ankle must be a joint's name or its index"},
      {"{\"hip\": \"Hips\"", "[\"Hips\"], \"j\": {\"hip\": \"Hips\"",
       ":29:14: ", "must be an object"},
      {"\"up\": \"+y\"", "\"up\": \"up\"", ":30:10: ", "recording 'b': up is 'up', not an axis"},
      {"\"up\": \"+y\"", "\"up\": \"z\"", ":30:10: ", "same axis"},
      {"\"length_unit\": \"m\"", "\"length_unit\": \"km\"", ":32:19: ", "length_unit is 'km'"},
      {"\"length_unit\": \"m\"", "\"length_scale\": -1",
       ":32:20: ", "length_scale is -1; it must be the metres of one file unit"},
      {"\"length_unit\": \"m\"", "\"length_unit\": \"m\", \"length_scale\": 0.0564",
       ":32:40: ", "length_scale is given together with length_unit"},
      {"\"left_ankle\": 3", "\"left_anckle\": 3",
       ":29:", "left_anckle is not known; there may be hip, lower_spine,"},
      {"{\"person\": 0", "{\"person\": 2", ":33:26: ", "push 0: person is '2'"},
      {"\"csv\": \"push/b.csv\", ", "", ":33:15: ", "push 0: csv is missing"},
      {"\"start_frame\": 12", "\"start_frame\": -1", ":33:", "start_frame is '-1'"},
      {"\"initial_velocity\": \"free\"", "\"initial_velocity\": 0", ":34:24: ", "must be text"},
      {"\"initial_velocity\": \"free\"", "\"initial_velocity\": \"some\"",
       ":34:24: ", "zero, estimated or free"},
      {"\"frames\": 91", "\"frames\": \"91\"", ":35:14: ", "frames must be the number of frames"},
  };
  for (const auto& damage : damages) {
    SCOPED_TRACE(std::string(damage.from) + " -> " + damage.to);
    std::string text = kGoodManifest;
    const std::size_t at = text.find(damage.from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(damage.from).size(), damage.to);
    const std::string path = WriteText("manifest.json", text);
    const std::string read = ProblemOf(ReadManifest(path));
    EXPECT_TRUE(Contains(read, path + damage.place));
    EXPECT_TRUE(Contains(read, damage.says));
  }
}

TEST_F(ManifestTest, NothingInIt) {
  const auto message = [&](const char* text) {
    return ProblemOf(ReadManifest(WriteText("manifest.json", text)));
  };
  EXPECT_TRUE(Contains(message(""), "manifest.json: the file is empty"));
  EXPECT_TRUE(Contains(message("{}"), "recordings is missing"));
  EXPECT_TRUE(Contains(message(R"({"format": "pushid model"})"),
                       "this is a pushid model, no manifest of recordings"));
  EXPECT_TRUE(Contains(message("{\"recordings\": []}"), "the manifest lists no recordings"));
  EXPECT_TRUE(Contains(message("[]"), "must be an object"));
  EXPECT_TRUE(Contains(message("{\"recordings\": {}}"), "recordings must be a list"));
  EXPECT_TRUE(Contains(message("{\"recordings\": [5]}"), "recording 0: must be an object"));
  EXPECT_TRUE(Contains(message("{\"units\": {\"bvh_length\": \"mm\"}, \"length_scale\": 0.05, "
                               "\"recordings\": [{}]}"),
                       "length_scale is given together with units.bvh_length"));
  EXPECT_TRUE(Contains(ReadManifest(Path("none.json")).error().ToString(), "no such file"));
}

// A manifest written from memory: everything that is missing is told of at once.
TEST_F(ManifestTest, AllMissingKeysInOneError) {
  const auto message = [&](const std::string& recordings) {
    return ProblemOf(
        ReadManifest(WriteText("manifest.json", "{\"recordings\": [" + recordings + "]}")));
  };
  EXPECT_EQ(message("{\"id\": \"a\", \"setting\": \"single\", \"pushed_person\": 0,\n"
                    "\"subjects\": [{\"id\": \"s\"}], \"bvh\": [\"a.bvh\"]},\n"
                    "{\"id\": \"b\", \"subjects\": [{\"id\": \"s\"}], \"trc\": [\"b.trc\"]}"),
            Path("manifest.json") +
                ":2:14: recording 'a', subject 0: mass_kg is missing; it must be the person's mass "
                "in kg; recording 'b': setting and pushed_person are missing; setting must be "
                "text, for instance single; pushed_person must be the index of the pushed "
                "subject, 0; recording 'b', subject 0: mass_kg is missing");
  const std::string nothing = message("{}");
  EXPECT_TRUE(
      Contains(nothing, "recording 0: id, setting, subjects, pushed_person and bvh are missing"));
  EXPECT_TRUE(Contains(nothing, "under the key of their format: bvh, c3d, trc, csv, sto"));
  std::string many = "{}";
  for (int i = 0; i < 10; ++i) many += ", {}";
  EXPECT_TRUE(Contains(message(many), "; and 3 more lack keys"));
  // Until something is wrong that no list of keys can say.
  EXPECT_TRUE(Contains(message("{}, 7"), "recording 0: id"));
  EXPECT_TRUE(Contains(message("7"), "recording 0: must be an object"));
}

TEST_F(ManifestTest, TheRateMayBeLeftOut) {
  std::string text = kGoodManifest;
  text.replace(text.find("\"fps\": 60,"), 10, "");
  const Manifest read = Unwrapped(ReadManifest(WriteText("manifest.json", text)));
  EXPECT_EQ(read.recordings[0].fps, 0.0);
  ASSERT_FALSE(WriteManifest(Path("again.json"), read));
  EXPECT_FALSE(
      nlohmann::json::parse(ReadText(Path("again.json")))["recordings"][0].contains("fps"));
}

// JSON as people write it by hand, and what it says to do.
TEST_F(ManifestTest, WhatJsonHasNot) {
  const std::pair<const char*, const char*> cases[] = {
      {"// mine\n{}", ":1:1: this is not valid JSON"},
      {"// mine\n{}", "; JSON has no comments: take them out"},
      {"{\n # mine\n}", ":2:2: "},
      {"{\n # mine\n}", "JSON has no comments"},
      {"{\"recordings\": [] /* mine */}", "JSON has no comments"},
      {"{\"recordings\": [1,]}", ":1:19: "},
      {"{\"recordings\": [1,]}", "no comma may stand before it"},
      {"{\"recordings\": [],\n}", "no comma may stand before it"},
      {"{'recordings': []}", "texts are in \""},
      {"{\"a\": 'b'}", "texts are in \""},
      {"{\xE2\x80\x9Crecordings\xE2\x80\x9D: []}", "texts are in \""},
      {"{\"bvh\": [\"bvh\\S01.bvh\"]}", "in JSON a backslash is written \\\\"},
      {"{\"bvh\": [\"C:\\data\\S01.bvh\"]}", "folders are separated by / here"},
      {"[{\"id\": \"a\"}]", "manifest: must be an object { }, not a list"},
  };
  for (const auto& [text, says] : cases) {
    EXPECT_TRUE(Contains(ProblemOf(ReadManifest(WriteText("manifest.json", text))), says)) << text;
  }
}

TEST_F(ManifestTest, KeysInOtherLettersAreTold) {
  const std::pair<const char*, const char*> cases[] = {
      {"\"recordings\"", "\"Recordings\""},
      {"\"recordings\"", "\"recording\""},
      {"\"setting\"", "\"Setting\""},
      {"\"setting\"", "\"SETTING\""},
      {"\"mass_kg\"", "\"Mass_kg\""},
      {"\"mass_kg\"", "\"mass-kg\""},
      {"\"mass_kg\"", "\"mass kg\""},
      {"\"bvh\"", "\"BVH\""},
      {"\"id\"", "\"ID\""},
      {"\"pushed_person\"", "\"pushedPerson\""},
      {"\"subjects\"", "\"subject\""},
  };
  for (const auto& [from, to] : cases) {
    std::string text = kGoodManifest;
    text.replace(text.find(from), std::string(from).size(), to);
    const std::string key(to + 1, std::string(to).size() - 2);
    EXPECT_TRUE(Contains(ProblemOf(ReadManifest(WriteText("manifest.json", text))),
                         " (here it is spelt '" + key + "')"))
        << to;
  }
}

TEST_F(ManifestTest, ANewerSchemaIsRefused) {
  auto json = nlohmann::ordered_json::parse(kGoodManifest);
  const auto problem = [&](const char* schema) {
    json["schema"] = schema;
    return ProblemOf(ReadManifest(WriteText("manifest.json", json.dump(1))));
  };
  for (const char* known : {"pushid-manifest/1", "https://example.org/ours"}) {
    EXPECT_EQ(problem(known), "no error");
  }
  EXPECT_TRUE(Contains(problem("pushid-manifest/2"), "'pushid-manifest/2' is newer; update"));
}

// Reading must not take time that grows with the square of the list.
TEST_F(ManifestTest, ManyRecordings) {
  nlohmann::json recording = nlohmann::json::parse(kGoodManifest)["recordings"][0];
  nlohmann::json manifest;
  for (int i = 0; i < 5000; ++i) {
    recording["id"] = std::to_string(i);
    manifest["recordings"].push_back(recording);
  }
  const Manifest read = Unwrapped(ReadManifest(WriteText("manifest.json", manifest.dump(1))));
  EXPECT_EQ(read.recordings.size(), 5000u);
  EXPECT_GT(read.recordings[4999].line, read.recordings[4998].line);
}

}  // namespace
}  // namespace pushid
