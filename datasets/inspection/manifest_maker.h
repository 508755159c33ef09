// datasets: a manifest from a folder of recordings whose names follow a pattern.
//
//   ManifestOptions options;
//   options.folder = "data";
//   options.pattern = "{setting}/{subject}_{magnitude}_{take}.c3d";
//   options.push_pattern = "push/{subject}_{take}.csv";
//   options.people["anna"].mass_kg = 62.0;
//   Result<MadeManifest> made = MakeManifest(options);
//
// Names that mean something: subject (the person's id), setting, magnitude, condition, and
// person: files that differ in person and subject only are the people of one recording, in the
// order of `person`. Every other name just tells recordings apart. A recording's id is all values
// but those of person (and of subject where there is a person), joined by _.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

struct ManifestOptions {
  std::string folder;         // looked through with all folders below it
  std::string pattern;        // of paths relative to the folder; its ending says the format
  std::string push_pattern;   // of push CSV files, with names of `pattern`; empty: none
  std::string manifest_path;  // where the manifest will stand: its paths are relative to that
  std::map<std::string, ManifestSubject> people;  // by id: masses, and facts under other keys
  double mass_kg = 0.0;                           // of everybody else; 0: not known, an Error
  double fps = 0.0;                               // 0: as each file says, whole where it nearly is
  // The setting of recordings whose pattern does not say.
  std::string setting = "single";
  std::string magnitude = "unknown";
  PushKind push_kind = PushKind::kExternal;
  // Written into every recording; empty: left out.
  std::string mapping, up, forward;
  GivenLength length{};
  // Other keys of every recording, "force_plates.file=plates/{id}.csv": {id} is the recording's,
  // other names are those of `pattern`.
  std::vector<std::string> set;
};

struct MadeManifest {
  Manifest manifest;
  int files = 0;                          // that fitted the pattern
  int others = 0;                         // that did not
  std::vector<std::string> without_push;  // recordings for which push_pattern named no file
  std::vector<std::string> warnings;      // doubts about the pattern, or the axes
  std::vector<Error> unreadable;          // of the files of recordings left out
};

// Errors: no folder, a pattern that is none or fits no file, an ending of no known format, a push
// pattern with a * or a name that the pattern has not, no mapping file, people without mass (all
// are named), a key to set that the manifest's reader refuses, a rate that no file and no option
// says, two recordings of one id, no file that can be read. A recording with a file that cannot be
// read is left out.
Result<MadeManifest> MakeManifest(const ManifestOptions& options);

// People from a CSV file with the columns id and mass_kg (0 where a cell is empty or n/a), and any
// others: numbers and texts that are known of people, as group and height (datasets/README.md).
Result<std::map<std::string, ManifestSubject>> ReadPeople(const std::string& path);

}  // namespace pushid
