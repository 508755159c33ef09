// Manifests from folders: patterns, groups, masses, rates; and what cannot be made.
#include "datasets/inspection/manifest_maker.h"

#include <gtest/gtest.h>

#include "datasets/files/names.h"
#include "datasets/loading/load_recordings.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/datasets/recording_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

std::string Matched(const std::string& pattern, const std::string& path) {
  const Result<NamePattern> parsed = NamePattern::Parse(pattern);
  if (!parsed.ok()) return parsed.error().ToString();
  const auto values = parsed.value().Match(path);
  if (!values) return "no";
  std::string text;
  for (const auto& [name, value] : *values) text += name + "=" + value + " ";
  return text;
}

TEST(NamePatternTest, Matches) {
  EXPECT_EQ(Matched("{subject}_{take}.bvh", "anna_01.bvh"), "subject=anna take=01 ");
  EXPECT_EQ(Matched("{subject}_{take}.bvh", "anna_b_01.bvh"), "subject=anna take=b_01 ");
  EXPECT_EQ(Matched("{a}/{b}/x{c}.c3d", "p/q/xr.c3d"), "a=p b=q c=r ");
  EXPECT_EQ(Matched("{a}.c3d", "p/q.c3d"), "no") << "a name stays within a folder";
  EXPECT_EQ(Matched("*/{a}_*.c3d", "p/q_77.c3d"), "a=q ");
  EXPECT_EQ(Matched("{a}/{a}_{b}.c3d", "p/p_1.c3d"), "a=p b=1 ");
  EXPECT_EQ(Matched("{a}/{a}_{b}.c3d", "p/q_1.c3d"), "no");
  EXPECT_EQ(Matched("{a}.c3d", ".c3d"), "no") << "a name is not empty";
  EXPECT_EQ(Matched("{a}.c3d", "x.c3d.bak"), "no");
  // Very many ways to fit, none of which does: an answer all the same.
  EXPECT_EQ(Matched("{a}{b}{c}{d}{e}{f}{g}{h}!", std::string(200, 'x')), "no");
}

TEST(NamePatternTest, BadPatternsAndFilling) {
  EXPECT_TRUE(Contains(Matched("{a", ""), "{ without a name"));
  EXPECT_TRUE(Contains(Matched("{}", ""), "{ without a name"));
  EXPECT_TRUE(Contains(Matched("{a{b}}", ""), "{ without a name"));
  EXPECT_TRUE(Contains(Matched("a}", ""), "} without a {"));
  EXPECT_TRUE(Contains(Matched("*.bvh", ""), "contains no names"));
  const NamePattern pattern = NamePattern::Parse("push/{a}_{b}.csv").value();
  EXPECT_EQ(pattern.Fill({{"a", "x"}, {"b", "y"}, {"c", "z"}}), "push/x_y.csv");
  EXPECT_FALSE(pattern.Fill({{"a", "x"}}));
  EXPECT_FALSE(NamePattern::Parse("{a}*").value().Fill({{"a", "x"}}));
}

class ManifestMakerTest : public RecordingFolderTest {
 protected:
  void SetUp() override {
    RecordingFolderTest::SetUp();
    std::filesystem::create_directories(folder_ / "data" / "push");
    for (const char* name : {"ben_strong_1", "anna_weak_10", "anna_weak_2"}) {
      WriteBvhFile(std::string("data/") + name + ".bvh", Walker(20));
    }
    WriteText("data/notes.txt", "hello");
    WritePush("data/push/anna_2.csv", 5);
    WritePush("data/push/ben_1.csv", 5);
    options_.folder = Path("data");
    options_.pattern = "{subject}_{magnitude}_{take}.bvh";
    options_.push_pattern = "push/{subject}_{take}.csv";
    options_.manifest_path = Path("m/manifest.json");
    options_.people["anna"] = {"anna", 62.0};
    options_.mass_kg = 80.0;
    std::filesystem::create_directories(folder_ / "m");
  }
  std::string MakingMessage() { return ProblemOf(MakeManifest(options_)); }

  ManifestOptions options_;
};

// Positions of five people are one group, not a recording of one of them.
TEST_F(ManifestMakerTest, TrajectoriesAreNoRecordings) {
  WriteText("data/crowd_1.txt", "# framerate: 8\n1 0 0 0\n2 0 1 0\n");
  options_.pattern = "crowd_{take}.txt";
  EXPECT_TRUE(Contains(MakingMessage(), "one point for each person of a group"));
}

TEST_F(ManifestMakerTest, WhatIsMadeCanBeLoaded) {
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  EXPECT_EQ(made.files, 3);
  EXPECT_EQ(made.others, 3);
  EXPECT_EQ(made.without_push, std::vector<std::string>{"anna_weak_10"});
  ASSERT_FALSE(WriteManifest(options_.manifest_path, made.manifest));
  const auto loaded = Unwrapped(LoadRecordings(options_.manifest_path));
  ASSERT_EQ(loaded.size(), 3u);
  const Recording& second = loaded[1];
  EXPECT_EQ(second.id, "anna_weak_2");
  EXPECT_EQ(second.people[0].subject_id, "anna");
  EXPECT_EQ(second.people[0].mass_kg, 62.0);
  EXPECT_EQ(second.labels.magnitude(), "weak");
  EXPECT_EQ(second.labels.setting(), "single");
  EXPECT_EQ(second.fps, 60.0);  // 0.016667 s
  EXPECT_EQ(second.pushes.size(), 1u);
  EXPECT_EQ(loaded[2].people[0].mass_kg, 80.0);
}

// Plates, ground and groups without editing JSON; wrong ones are refused by the manifest's reader.
TEST_F(ManifestMakerTest, SetsAnyKeyOfAllRecordings) {
  options_.set = {"force_plates.file=plates/{id}.csv",
                  "force_plates.plates=[\"left\"]",
                  "ground.csv=ground/{subject}.csv",
                  "group=older",
                  "initial_velocity=free",
                  "first_frame=3"};
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_FALSE(WriteManifest(options_.manifest_path, made.manifest));
  const Manifest read = Unwrapped(ReadManifest(options_.manifest_path));
  ASSERT_EQ(read.recordings.size(), 3u);
  const ManifestRecording& second = read.recordings[1];
  ASSERT_EQ(second.plates.size(), 1u);
  EXPECT_EQ(second.plates[0].file, "plates/anna_weak_2.csv");
  EXPECT_EQ(second.plates[0].plates, std::vector<std::string>{"left"});
  EXPECT_EQ(second.plates[0].use, PlateUse::kMeasure);
  EXPECT_EQ(second.ground.csv, "ground/anna.csv");
  EXPECT_EQ(second.labels.Of("group"), "older");
  EXPECT_EQ(second.initial_velocity, InitialVelocity::kFree);
  EXPECT_EQ(second.first_frame, 3);
  EXPECT_EQ(second.subjects[0].mass_kg, 62.0);
  const auto message = [&](const char* set) {
    options_.set = {set};
    return MakingMessage();
  };
  EXPECT_TRUE(Contains(message("group"), "--set is 'group'; it must be KEY=VALUE"));
  EXPECT_TRUE(Contains(message("group={age}"), "names of the pattern"));
  EXPECT_TRUE(Contains(message("force_plates.height=2"), "--set=force_plates.height=2: "));
  EXPECT_TRUE(Contains(message("initial_velocity=fast"), "it must be zero, estimated or free"));
}

// A manifest without the rates that were written means the same.
TEST_F(ManifestMakerTest, WritesTheRatesThatLoadingTakes) {
  MadeManifest made = Unwrapped(MakeManifest(options_));
  for (ManifestRecording& recording : made.manifest.recordings) {
    EXPECT_EQ(recording.fps, 60.0);
    recording.fps = 0.0;
  }
  ASSERT_FALSE(WriteManifest(options_.manifest_path, made.manifest));
  const auto loaded = Unwrapped(LoadRecordings(options_.manifest_path));
  for (const Recording& recording : loaded) EXPECT_EQ(recording.fps, 60.0);
}

TEST_F(ManifestMakerTest, FilesThatCannotBeReadAreLeftOut) {
  WriteText("data/anna_weak_2.bvh", "no motion");
  options_.people.clear();  // no mass is asked for of a person left out
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  EXPECT_EQ(made.manifest.recordings.size(), 2u);
  ASSERT_EQ(made.unreadable.size(), 1u);
  EXPECT_TRUE(Contains(made.unreadable[0].ToString(), "data/anna_weak_2.bvh:1"));
  for (const char* name : {"ben_strong_1", "anna_weak_10"}) {
    WriteText(std::string("data/") + name + ".bvh", "no motion");
  }
  EXPECT_TRUE(Contains(MakingMessage(), "no other file can be read either"));
}

TEST_F(ManifestMakerTest, PushPatternsNameOneFileEach) {
  options_.push_pattern = "push/{subject}_{tkae}.csv";
  EXPECT_TRUE(
      Contains(MakingMessage(), "{tkae}, but the pattern has only subject, magnitude, take"));
  options_.push_pattern = "push/{subject}_*.csv";
  EXPECT_TRUE(Contains(MakingMessage(), "has a *"));
}

TEST_F(ManifestMakerTest, MisspeltNamesAreToldOf) {
  options_.push_pattern = "";
  options_.pattern = "{subjct}_{magnitude}_{take}.bvh";
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_EQ(made.warnings.size(), 2u) << "the masses are of nobody then";
  EXPECT_TRUE(Contains(made.warnings[0],
                       "{subjct}, which only distinguishes recordings; did you mean {subject}?"));
}

TEST_F(ManifestMakerTest, PushesThatAreNoneAndMassesOfNobodyAreToldOf) {
  WriteText("data/push/ben_1.csv", "time,force\n0,1\n0.1,90\n");
  options_.people["bem"] = {"bem", 81.0};
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_EQ(made.warnings.size(), 2u);
  EXPECT_TRUE(Contains(made.warnings[0], "push/ben_1.csv:1"));
  EXPECT_TRUE(Contains(made.warnings[0], "pushid-push --sensor"));
  EXPECT_TRUE(Contains(made.warnings[1], "the masses list bem, who is in no recording"));
}

TEST_F(ManifestMakerTest, MappingsAndIdsAreCheckedAtOnce) {
  options_.mapping = Path("none.json");
  EXPECT_TRUE(Contains(MakingMessage(), "none.json: there is no such file"));
  options_.mapping = "";
  WriteBvhFile("data/ann,e_weak_1.bvh", Walker(20));
  EXPECT_TRUE(Contains(MakingMessage(), "'ann,e_weak_1', but commas separate ids"));
}

TEST_F(ManifestMakerTest, PeopleOfOneRecording) {
  std::filesystem::create_directories(folder_ / "rows");
  for (const char* name : {"r1_p10_x", "r1_p2_y", "r2_p1_x"}) {
    WriteBvhFile(std::string("rows/") + name + ".bvh", Walker(20));
  }
  options_.folder = Path("rows");
  options_.pattern = "{take}_p{person}_{subject}.bvh";
  options_.push_pattern = "";
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_EQ(made.manifest.recordings.size(), 2u);
  const ManifestRecording& r1 = made.manifest.recordings[0];
  EXPECT_EQ(r1.id, "r1");
  ASSERT_EQ(r1.subjects.size(), 2u);
  EXPECT_EQ(r1.subjects[0].id, "y") << "person 2 before person 10";
  EXPECT_EQ(r1.motion[0], "../rows/r1_p2_y.bvh");
}

// Two takes that the pattern does not tell apart are no neighbours in one.
TEST_F(ManifestMakerTest, PeopleOfTwoRecordingsStayApart) {
  options_.folder = Path("rows");
  options_.push_pattern = "";
  const auto make = [this](const std::vector<std::string>& names, const std::string& pattern) {
    std::filesystem::remove_all(folder_ / "rows");
    std::filesystem::create_directories(folder_ / "rows");
    for (const std::string& name : names) WriteBvhFile("rows/" + name, Walker(20));
    options_.pattern = pattern;
    return MakingMessage();
  };
  EXPECT_EQ(make({"r1_a_p1.bvh", "r1_b_p2.bvh"}, "{take}_*_p{person}.bvh"), "no error");
  EXPECT_TRUE(
      Contains(make({"r1_a_p1.bvh", "r1_a_p2.bvh", "r1_b_p1.bvh"}, "{take}_*_p{person}.bvh"),
               "r1_a_p1.bvh and r1_b_p1.bvh are both person '1' of recording 'r1'; replace the "));
  EXPECT_TRUE(Contains(make({"g_1-2,1.bvh", "g-1_2,2.bvh"}, "{take}-{more},{person}.bvh"),
                       "both recording 'g_1_2'; give one of them another name"));
}

// A mapping says y is up; the maker is told z, which happens to be the default.
TEST_F(ManifestMakerTest, AxesGivenWinOverAMapping) {
  WriteText("map.json", "{\"up\": \"y\", \"forward\": \"z\"}");
  options_.mapping = Path("map.json");
  options_.up = "z";
  options_.forward = "x";
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_FALSE(WriteManifest(options_.manifest_path, made.manifest));
  const auto loaded = Unwrapped(LoadRecordings(options_.manifest_path));
  EXPECT_EQ(loaded[0].people[0].file_up, "z");
}

TEST_F(ManifestMakerTest, RateOfC3d) {
  std::filesystem::create_directories(folder_ / "c3d");
  ASSERT_FALSE(WriteC3d(Path("c3d/anna_1.C3D"), SampleC3d()));
  options_.folder = Path("c3d");
  options_.pattern = "{subject}_{take}.C3D";
  options_.up = "z";
  options_.mapping = Path("map.json");
  WriteText("map.json", "{\"joints\": {\"hip\": \"HIP\"}}");
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  const ManifestRecording& recording = made.manifest.recordings[0];
  EXPECT_EQ(recording.fps, 100.0);
  EXPECT_EQ(recording.motion_format, MotionFormat::kC3d);
  EXPECT_EQ(recording.mapping, "../map.json");
  ASSERT_FALSE(WriteManifest(options_.manifest_path, made.manifest));
  EXPECT_TRUE(LoadRecordings(options_.manifest_path).ok());
}

TEST_F(ManifestMakerTest, WhatCannotBeMade) {
  options_.people = {};
  options_.mass_kg = 0.0;
  EXPECT_TRUE(Contains(MakingMessage(), "no mass is given for anna, ben"));
  EXPECT_TRUE(Contains(MakingMessage(), "(--masses)"));
  options_.mass_kg = 70.0;
  options_.push_pattern = "";
  options_.pattern = "{subject}_*.bvh";
  EXPECT_TRUE(Contains(MakingMessage(), "are both recording 'anna'"));
  options_.pattern = "{subject}.c3d";
  EXPECT_TRUE(Contains(MakingMessage(), "none of its 6 files fits"));
  options_.pattern = "{subject}.md";
  EXPECT_TRUE(Contains(MakingMessage(), "must end like its files"));
  options_.pattern = "{subject}.bvh";
  std::filesystem::create_directory(Path("empty"));
  options_.folder = Path("empty");
  EXPECT_TRUE(Contains(MakingMessage(), "there is no file in it"));
  options_.folder = Path("nowhere");
  EXPECT_TRUE(Contains(MakingMessage(), "no such folder"));
  options_.up = "x";
  EXPECT_TRUE(Contains(MakingMessage(), "lie along the same axis"));
}

// Facts about people stay with them, and are there for --contrast and --covariate.
TEST_F(ManifestMakerTest, FurtherColumnsAreKnownOfPeople) {
  options_.people = Unwrapped(ReadPeople(
      WriteText("m.csv", "id,mass_kg,group,height\nanna,62,patients,1.7\nben,80.5,controls,\n")));
  ASSERT_FALSE(WriteManifest(options_.manifest_path, Unwrapped(MakeManifest(options_)).manifest));
  const auto loaded = Unwrapped(LoadRecordings(options_.manifest_path));
  const PersonFacts &anna = loaded[1].people[0].known, &ben = loaded[2].people[0].known;
  EXPECT_EQ(anna.texts.at("group"), "patients");
  EXPECT_EQ(anna.numbers.at("height"), 1.7);
  EXPECT_EQ(ben.texts.at("group"), "controls");
  EXPECT_TRUE(ben.numbers.empty()) << "an empty cell is nothing known";
  EXPECT_TRUE(Contains(ProblemOf(ReadPeople(WriteText("m.csv", "id,mass_kg,group\na,60,b,c\n"))),
                       ":2: the row has 4 values for 3 columns"));
}

// Files whose y points up, and nobody said so.
TEST_F(ManifestMakerTest, AxesInWhichNobodyStandsAreToldOf) {
  options_.up = "y";
  options_.forward = "x";
  const MadeManifest made = Unwrapped(MakeManifest(options_));
  ASSERT_FALSE(made.warnings.empty());
  EXPECT_TRUE(Contains(made.warnings.back(), "recording 'anna_weak_10'")) << made.warnings.back();
  EXPECT_TRUE(Contains(made.warnings.back(), "up")) << made.warnings.back();
}

TEST_F(ManifestMakerTest, Masses) {
  const auto masses =
      Unwrapped(ReadPeople(WriteText("m.csv", "id,mass_kg\nanna,62\n ben , 80.5\n")));
  EXPECT_EQ(masses.at("ben").mass_kg, 80.5);
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"anna,62\n", ":1: the first line must be id,mass_kg"},
           {"id,mass_kg\nanna\n", ":2: mass_kg: a number is missing"},
           {"id,mass_kg\nanna,-1\n", ":2: a mass in kg is above 0"},
           {"id,mass_kg\nanna,60\nanna,61\n", ":3: the mass of 'anna' was given before"},
           {"id,mass_kg\n", "lists no masses"},
           {"id,weight\nanna,138\n", ":1: the first line must be id,mass_kg"},
           {"id;mass_kg\nanna;62,7\n", ":2: mass_kg: '62,7' is not a number"},
           {"id,mass_kg\nanna,138 lb\n", ":2: mass_kg: '138 lb' is not a number"}}) {
    EXPECT_TRUE(Contains(ReadPeople(WriteText("m.csv", text)).error().ToString(), says));
  }
}

// Masses in the forms that spreadsheets write.
TEST_F(ManifestMakerTest, MassesInOtherDialects) {
  for (const char* text : {"id,mass_kg\nanna,\"62.7\"\n", "\"id\",\"mass_kg\"\n\"anna\",\"62.7\"\n",
                           "ID,Mass_kg\nanna,62.7\n", "id;mass_kg\nanna;62.7\n",
                           "id\tmass_kg\nanna\t62.7\n", "\xEF\xBB\xBFid,mass_kg\r\nanna,62.7\r\n",
                           "id,mass_kg\nanna,62.7\nben,n/a\n", "id,mass_kg\nben,\nanna, 62.7 \n",
                           "id,mass_kg,note\nanna,62.7,\"a, b\"\n", "id,mass_kg\n\nanna,+62.7\n"}) {
    EXPECT_EQ(Unwrapped(ReadPeople(WriteText("m.csv", text))).at("anna").mass_kg, 62.7) << text;
  }
}

// A mass that is not known matters where the person is recorded and --mass says nothing.
TEST_F(ManifestMakerTest, MassesThatAreNotKnown) {
  const auto people = [this](const std::string& rows) {
    options_.people = Unwrapped(ReadPeople(WriteText("m.csv", "id,mass_kg,group\n" + rows)));
    return MakingMessage();
  };
  options_.mass_kg = 0.0;
  EXPECT_EQ(people("anna,62,a\nben,80,b\ncleo,n/a,a\n"), "no error");
  EXPECT_TRUE(Contains(people("anna,62,a\nben,n/a,b\n"), "no mass is given for ben; list"));
  EXPECT_TRUE(
      Contains(people("Anna,62,a\nben,80,b\n"),
               "no mass is given for anna; list them in a file with the columns id,mass_kg "
               "(--masses); the masses list Anna, who is in no recording: are the ids spelt"));
  const ManifestOptions named = options_;
  options_.pattern = "*_{magnitude}_{take}.bvh";
  options_.push_pattern = "";
  EXPECT_TRUE(Contains(people("anna,62,a\n"),
                       "no mass is given for person, as everybody is called where the pattern has "
                       "no {subject}; list"));
  options_ = named;
  options_.mass_kg = 70.0;
  EXPECT_EQ(people("anna,62,a\nben,n/a,b\n"), "no error");
  const ManifestSubject ben =
      Unwrapped(MakeManifest(options_)).manifest.recordings.back().subjects[0];
  EXPECT_EQ(ben.mass_kg, 70.0);
  EXPECT_EQ(ben.known.texts.at("group"), "b");
}

}  // namespace
}  // namespace pushid
