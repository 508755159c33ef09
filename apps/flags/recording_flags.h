// apps: the flags by which every executable takes recordings.
#pragma once

#include "apps/flags/command_line.h"
#include "datasets/loading/load_recordings.h"
#include "ident/model/fitted_model.h"

DECLARE_string(recordings);
DECLARE_string(setting);

namespace pushid {

// The manifest of --recordings, merged where there are several; read once in a run.
const Result<Manifest>& FlaggedManifest();

// Ids of the recordings that --setting, --ids and --leave_out select.
std::vector<std::string> SelectedIds();

// The recordings of --recordings, --setting, --ids and --leave_out; warnings go to stderr, and to
// `warnings` too. Other ids than the flags' may be asked for, all joints instead of hip and ankles,
// and people whom force plates alone measured.
std::vector<Recording> LoadFlaggedRecordings(const std::vector<std::string>& ids = {},
                                             bool keep_all_joints = false,
                                             Warnings* warnings = nullptr,
                                             bool plates_alone = false);

// Flags that decide how files are read.
inline constexpr const char* kLoadFlags[] = {"length_unit", "length_scale", "max_gap_s",
                                             "lowpass_hz", "resample_fps"};
// Sets those that are not given to their values in another program's run.
void LoadAs(const std::map<std::string, std::string>& configuration);

// The recordings that a model was fitted to, or those that --setting, --ids or --leave_out choose.
std::vector<Recording> LoadFittedRecordings(const FitResult& fit, bool keep_all_joints);

// Throws where flags of recordings are wrong, before any file is read.
void CheckRecordingFlags();

// Loads recordings of another --setting, with whole bodies.
std::vector<Recording> LoadBodiesOfSetting(const std::string& setting);

// Version, flags and manifest of this program's run, as a model keeps them.
Provenance ProvenanceOfRun();

// Throws where a recording has no push: without one there is nothing to learn from.
void CheckPushed(const std::vector<Recording>& recordings);

}  // namespace pushid
