// datasets: from a manifest to recordings in SI units, checked.
//
//   Warnings warnings;
//   LoadOptions options;
//   options.setting = "single";
//   const auto recordings = LoadRecordings("M/manifest.json", options, &warnings);
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/input_file.h"  // HashFile
#include "datasets/formats/units.h"
#include "datasets/loading/motion_tracks.h"
#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

namespace pushid {

struct LoadOptions {
  // The files' lengths, whatever they and the manifest say (--length_unit, --length_scale). Without
  // it: the recording's, else the manifest's, the mapping's, the file's own, else mm.
  GivenLength length{};
  // The recordings that are read, as SelectRecordings takes them.
  std::string setting = "all";
  // Only these ids are loaded; empty: all of the setting.
  std::vector<std::string> ids;
  // These ids are left out.
  std::vector<std::string> leave_out;
  // Whether the positions of all joints are kept (RecordedPerson::joints), for full-body work;
  // otherwise only hip and ankles stay in memory.
  bool keep_all_joints = false;
  // Whether people may be loaded whom force plates alone measured ("motion": "none"): they stand
  // still in what is returned, with no weight, and only a fit and an inspection know them.
  // Otherwise they are errors.
  bool plates_alone = false;
  // Gaps, filter, frame rate.
  PreparationOptions preparation{};
};

// Reads and checks the selected recordings of a manifest, or of several ("a.json,b.json"), in their
// order. Unusual things that are no error (a BVH frame time that differs from fps by
// more than 0.1 %) are appended to `warnings`.
//
// Besides what the readers of the single files refuse: no frame rate in manifest, mapping or file,
// fewer than three frames, a number of frames other than the manifest's `frames`, people with
// different numbers of frames, a push longer than the motion or starting after it, hip heights that
// show wrong units, joints not found.
Result<std::vector<Recording>> LoadRecordings(const std::string& manifests,
                                              const LoadOptions& options = {},
                                              Warnings* warnings = nullptr);

// Recordings of a manifest that was read already; or one recording of it.
Result<std::vector<Recording>> LoadRecordings(const Manifest& manifest, const LoadOptions& options,
                                              Warnings* warnings = nullptr);
Result<Recording> LoadRecording(const Manifest& manifest, const ManifestRecording& entry,
                                const LoadOptions& options = {}, Warnings* warnings = nullptr);

}  // namespace pushid
