// datasets: a manifest from a folder.
#include "datasets/inspection/manifest_maker.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/trajectories.h"
#include "datasets/formats/units.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/manifest/joint_mapping.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

// Names in a pattern that mean something; others tell recordings apart.
const std::vector<std::string> kUnderstood = {"setting",   "subject",        "magnitude",
                                              "condition", kOldConditionKey, "person"};

struct FoundFile {
  std::string path;  // relative to the folder
  NameValues values;
};

// "7" before "10", and both before "a".
bool PersonBefore(const FoundFile& a, const FoundFile& b) {
  std::int64_t x = 0, y = 0;
  const std::string &p = a.values.at("person"), &q = b.values.at("person");
  const bool numbers = ParseInteger(p, &x) && ParseInteger(q, &y);
  return numbers && x != y ? x < y : p < q;
}

// The id of the recording that a file belongs to: its values without the person's.
std::string IdOf(const NamePattern& pattern, const NameValues& values) {
  const bool several = pattern.Has("person");
  std::string id;
  for (const std::string& name : pattern.names()) {
    if (name == "person" || (several && name == "subject")) continue;
    id += (id.empty() ? "" : "_") + values.at(name);
  }
  return id.empty() ? "recording" : id;
}

class Maker {
 public:
  explicit Maker(const ManifestOptions& options) : options_(options), folder_(options.folder) {}

  // Throws an Error.
  MadeManifest Make() {
    ReadOptions();
    WarnOfNames();
    Find();
    const std::string path = recordings_.begin()->second.front().path;
    if (format_ == MotionFormat::kCsv && IsCrowdCsv((folder_ / path).string())) {
      throw Error{path + ": " + kCrowdIsNoRecording};
    }
    for (auto& [id, files] : recordings_) AddRecording(id, &files);
    if (made_.manifest.recordings.empty()) {
      Error first = made_.unreadable.front();
      first.message += "; no other file can be read either";
      throw first;
    }
    const std::string unused = UnusedMasses();
    if (!massless_.empty()) {
      throw Error{"no mass is given for " + ListOfNames({massless_.begin(), massless_.end()}) +
                  (pattern_.Has("subject") || pattern_.Has("person")
                       ? ""
                       : ", as everybody is called where the pattern has no {subject}") +
                  "; list them in a file with the columns id,mass_kg (--masses)" +
                  (unused.empty() ? "" : "; " + unused)};
    }
    if (!unused.empty()) made_.warnings.push_back(unused);
    CheckFirst();
    return std::move(made_);
  }

 private:
  void ReadOptions() {
    pattern_ = OrThrow(NamePattern::Parse(options_.pattern));
    const std::optional<MotionFormat> format = MotionFormatOfFile(options_.pattern);
    if (!format) {
      throw Error{"the pattern " + Quoted(options_.pattern) +
                  " must end like its files: " + MotionFileEndings()};
    }
    format_ = *format;
    if (HoldsCrowd(format_) && options_.mapping.empty()) {
      throw Error{"the pattern " + Quoted(options_.pattern) + " names trajectories; " +
                  kCrowdIsNoRecording};
    }
    AxesGiven(options_.up, options_.forward);
    if (!options_.mapping.empty()) mapping_ = OrThrow(ReadColumnMapping(options_.mapping));
    if (options_.push_pattern.empty()) return;
    // The push pattern must name one file for each recording.
    push_pattern_ = OrThrow(NamePattern::Parse(options_.push_pattern));
    const std::string what = "the push pattern " + Quoted(options_.push_pattern);
    if (push_pattern_->HasStar()) {
      throw Error{what + " has a *; it names one file of each recording, by names of the pattern"};
    }
    for (const std::string& name : push_pattern_->names()) {
      if (pattern_.Has(name)) continue;
      throw Error{what + " has the name {" + name + "}, but the pattern has only " +
                  ListOfNames(pattern_.names())};
    }
  }

  // Files of one recording differ in their person, and besides in the subject alone; where the
  // pattern names no persons, a recording is one file.
  void CheckTogether(const std::string& id, const std::vector<FoundFile>& files) const {
    const bool people = pattern_.Has("person");
    const auto rest = [](NameValues values) {
      values.erase("person");
      values.erase("subject");
      return values;
    };
    for (std::size_t i = 1; i < files.size(); ++i) {
      const FoundFile &a = files[i - 1], &b = files[i];
      const bool same = !people || a.values.at("person") == b.values.at("person");
      const bool alike = rest(a.values) == rest(b.values);
      if (!same && alike) continue;
      throw Error{a.path + " and " + b.path + " are both " +
                      (people && same ? "person " + Quoted(a.values.at("person")) + " of " : "") +
                      "recording " + Quoted(id) +
                      (alike ? "; replace the * that differs by a name in the pattern"
                             : "; give one of them another name"),
                  options_.folder};
    }
    if (id.find(',') == std::string::npos) return;
    throw Error{files[0].path + " would be recording " + Quoted(id) +
                    ", but commas separate ids in lists; give the file another name",
                options_.folder};
  }

  // A misspelt {subject} would make one person of everybody.
  void WarnOfNames() {
    for (const std::string& name : pattern_.names()) {
      const std::string meant = ClosestName(name, kUnderstood);
      if (meant.empty() || pattern_.Has(meant)) continue;
      made_.warnings.push_back("the pattern has {" + name +
                               "}, which only distinguishes recordings; did you mean {" + meant +
                               "}?");
    }
  }

  void Find() {
    const std::vector<std::string> files = OrThrow(FilesBelow(options_.folder));
    for (const std::string& path : files) {
      const std::optional<NameValues> values = pattern_.Match(path);
      ++(values ? made_.files : made_.others);
      if (values) recordings_[IdOf(pattern_, *values)].push_back({path, *values});
    }
    if (made_.files > 0) return;
    throw Error{files.empty() ? "there is no file in it"
                              : StrCat("none of its ", files.size(), " files fits the pattern ",
                                       Quoted(options_.pattern), "; the first is ", files[0]),
                options_.folder};
  }

  static std::string Value(const NameValues& values, const char* name,
                           const std::string& fallback) {
    const auto found = values.find(name);
    return found == values.end() ? fallback : found->second;
  }

  std::string BesideManifest(const fs::path& file) const {
    return PathFromManifest(options_.manifest_path, file.string());
  }

  void AddRecording(const std::string& id, std::vector<FoundFile>* files) {
    if (pattern_.Has("person")) std::sort(files->begin(), files->end(), &PersonBefore);
    CheckTogether(id, *files);
    const NameValues& values = files->front().values;
    ManifestRecording recording;
    recording.id = id;
    for (std::size_t i = files->size(); i-- > 0;) {
      const Result<double> rate = Rate((*files)[i].path);
      if (!rate.ok()) return made_.unreadable.push_back(rate.error());
      recording.fps = rate.value();  // in the end that of the first
    }
    if (!(recording.fps > 0.0)) {
      throw Error{"it does not give its frame rate; give --fps",
                  (folder_ / files->front().path).string()};
    }
    recording.labels.Set(kSettingLabel, Value(values, kSettingLabel, options_.setting));
    recording.labels.Set(kMagnitudeLabel, Value(values, kMagnitudeLabel, options_.magnitude));
    recording.labels.Set(kConditionLabel,
                         Value(values, kConditionLabel, Value(values, kOldConditionKey, "")));
    recording.push_kind = options_.push_kind;
    recording.motion_format = format_;
    for (const FoundFile& file : *files) {
      recording.subjects.push_back(
          SubjectOf(Value(file.values, "subject", Value(file.values, "person", "person"))));
      recording.motion.push_back(BesideManifest(folder_ / file.path));
    }
    SetPush(values, &recording);
    recording.mapping = options_.mapping.empty() ? "" : BesideManifest(options_.mapping);
    SetAxes(&recording);
    recording.length = options_.length;
    SetKeys(values, &recording);
    made_.manifest.recordings.push_back(recording);
  }

  // An entry without masses, which Make refuses, is not read again.
  void SetKeys(NameValues values, ManifestRecording* recording) const {
    if (!massless_.empty()) return;
    values["id"] = recording->id;
    for (const std::string& item : options_.set) {
      const std::size_t equals = item.find('=');
      const Error wrong{"--set is " + Quoted(item) +
                        "; it must be KEY=VALUE, as in force_plates.file=plates/{id}.csv, with "
                        "{id} and names of the pattern"};
      if (equals == std::string::npos || equals == 0) throw wrong;
      std::optional<std::string> value = item.substr(equals + 1);
      if (Holds(*value, "{")) {
        const Result<NamePattern> pattern = NamePattern::Parse(*value);
        value = pattern.ok() ? pattern.value().Fill(values) : std::nullopt;
      }
      if (!value) throw wrong;
      Result<ManifestRecording> set = WithKey(*recording, item.substr(0, equals), *value);
      if (!set.ok()) throw Error{"--set=" + item + ": " + set.error().ToString()};
      *recording = std::move(set.value());
    }
  }

  // Written even where they are the default, so that a mapping's do not win.
  void SetAxes(ManifestRecording* recording) const {
    if (options_.up.empty() && options_.forward.empty()) return;
    if (!options_.up.empty()) recording->up = options_.up;
    if (!options_.forward.empty()) recording->forward = options_.forward;
    *recording->json = {{"up", recording->up}, {"forward", recording->forward}};
  }

  ManifestSubject SubjectOf(const std::string& id) {
    const auto found = options_.people.find(id);
    ManifestSubject person = found != options_.people.end() ? found->second : ManifestSubject{id};
    if (person.mass_kg <= 0.0) person.mass_kg = options_.mass_kg;
    if (person.mass_kg <= 0.0) massless_.insert(id);
    return person;
  }

  // A rate is read from every file, and the motion of the first: whether its people stand upright
  // in the axes and units given, and are found by their joints.
  void CheckFirst() {
    ManifestRecording first = made_.manifest.recordings.front();
    first.manifest = options_.manifest_path;
    first.push_csv.clear();
    for (const std::string& misspelt : MisspeltKeys(first)) {
      made_.warnings.push_back("every recording " + misspelt);
    }
    const Result<Recording> read = LoadRecording(made_.manifest, first);
    if (!read.ok()) made_.warnings.push_back(read.error().ToString());
  }

  // Frames per second, whole where they nearly are; 0 where neither file nor option says.
  Result<double> Rate(const std::string& relative) const {
    if (options_.fps > 0.0) return options_.fps;
    if (mapping_.frame_rate > 0.0 && !HasSkeleton(format_)) return mapping_.frame_rate;
    PointReadOptions point_options;
    point_options.time_column = mapping_.time_column;
    point_options.columns = mapping_.columns;
    return ReadFrameRate((folder_ / relative).string(), format_, point_options);
  }

  // A sensor's own record, for one, is no push yet.
  void SetPush(const NameValues& values, ManifestRecording* recording) {
    if (!push_pattern_) return;
    const std::optional<std::string> path = push_pattern_->Fill(values);
    std::error_code ignored;
    if (!path || !fs::is_regular_file(folder_ / *path, ignored)) {
      return made_.without_push.push_back(recording->id);
    }
    recording->push_csv = BesideManifest(folder_ / *path);
    const auto push = ReadPushCsv((folder_ / *path).string());
    if (push.ok()) return;
    made_.warnings.push_back(push.error().ToString() +
                             "; if it is a sensor's record, convert it by pushid-push --sensor");
  }

  std::string UnusedMasses() const {
    std::set<std::string> used;
    for (const ManifestRecording& recording : made_.manifest.recordings) {
      for (const ManifestSubject& subject : recording.subjects) used.insert(subject.id);
    }
    std::vector<std::string> unused;
    for (const auto& [id, person] : options_.people) {
      if (used.count(id) == 0) unused.push_back(id);
    }
    if (unused.empty()) return "";
    return "the masses list " + ListOfNames(unused) +
           ", who is in no recording: are the ids spelt as in the file names?";
  }

  const ManifestOptions& options_;
  const fs::path folder_;
  NamePattern pattern_;
  std::optional<NamePattern> push_pattern_;
  ColumnMapping mapping_;
  MotionFormat format_ = MotionFormat::kBvh;
  std::map<std::string, std::vector<FoundFile>> recordings_;  // by id, which is their order
  std::set<std::string> massless_;
  MadeManifest made_;
};

}  // namespace

Result<MadeManifest> MakeManifest(const ManifestOptions& options) {
  return Caught([&] { return Maker(options).Make(); });
}

Result<std::map<std::string, ManifestSubject>> ReadPeople(const std::string& path) {
  return Caught([&] {
    LineReader reader(path);
    std::map<std::string, ManifestSubject> people;
    std::string_view line;
    if (!reader.NextNonBlank(&line)) throw Error{"the file lists no masses", path};
    std::vector<std::string> columns;
    const char separator = SeparatorOf(line);
    for (const std::string_view cell : CellsOf(line, separator)) columns.emplace_back(cell);
    if (columns.size() < 2 || !EqualsIgnoringCase(columns[0], "id") ||
        !EqualsIgnoringCase(columns[1], "mass_kg")) {
      throw reader.ErrorHere(
          "the first line must be id,mass_kg, perhaps with further columns of what is known of "
          "people (group, height, ...), not " +
          Quoted(line));
    }
    const auto unknown = [](std::string_view cell) {
      return cell.empty() || EqualsIgnoringCase(cell, "n/a");
    };
    while (reader.NextNonBlank(&line)) {
      std::vector<std::string_view> cells = CellsOf(line, separator);
      if (cells.size() > columns.size()) {
        throw reader.ErrorHere(
            StrCat("the row has ", cells.size(), " values for ", columns.size(), " columns"));
      }
      const bool cut = cells.size() < 2;
      cells.resize(columns.size());
      ManifestSubject person{std::string(cells[0])};
      if (cut || !unknown(cells[1])) {
        if (!ParseDouble(cells[1], &person.mass_kg)) {
          throw reader.ErrorHere("mass_kg: " + NumberProblem(cells[1]));
        }
        if (!(person.mass_kg > 0.0 && person.mass_kg <= kHeaviestPerson)) {
          throw reader.ErrorHere("a mass in kg is above 0 and at most " + Rounded(kHeaviestPerson) +
                                 ", not " + Rounded(person.mass_kg));
        }
      }
      for (std::size_t i = 2; i < cells.size(); ++i) {
        double number = 0.0;
        if (unknown(cells[i])) continue;
        if (ParseDouble(cells[i], &number)) {
          person.known.numbers[columns[i]] = number;
        } else {
          person.known.texts[columns[i]] = std::string(cells[i]);
        }
      }
      if (!people.emplace(person.id, person).second) {
        throw reader.ErrorHere("the mass of " + Quoted(person.id) + " was given before");
      }
    }
    if (people.empty()) throw reader.ErrorHere("the file lists no masses");
    return people;
  });
}

}  // namespace pushid
