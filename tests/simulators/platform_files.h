// Synthetic recordings of people on ground that moves and on force platforms, as files.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {

// Writes a table of a row for each frame: its time, then the numbers. Returns its name.
template <typename Row>
std::string WriteTimed(const std::string& folder, const std::string& file, const std::string& names,
                       const Recording& recording, const Row& row) {
  OrThrow(MakeFolderOf(folder + "/" + file));
  std::string text = "time," + names + "\n";
  for (int t = 0; t < recording.num_frames(); ++t) {
    text += DoubleText(t / recording.fps);
    for (double value : row(t)) text += "," + DoubleText(value);
    text += "\n";
  }
  OrThrow(WriteFileAtomically(folder + "/" + file, text));
  return file;
}

// WriteSyntheticRecordings, with the ground's and the platforms' files and their keys.
inline MaybeError WriteOnPlatforms(const std::string& folder, const SyntheticOptions& options,
                                   const std::vector<SyntheticRecording>& made) {
  return Caught([&] {
    OrThrow(WriteSyntheticRecordings(folder, options, made));
    nlohmann::ordered_json manifest = OrThrow(ReadJsonDocument(folder + "/manifest.json")).content;
    for (size_t i = 0; i < made.size(); ++i) {
      const Recording& recording = made[i].recording;
      nlohmann::ordered_json& entry = manifest["recordings"][i];
      if (!recording.ground.empty()) {
        entry["ground"]["csv"] =
            WriteTimed(folder, "ground/" + recording.id + ".csv", "x,y,theta,phi", recording,
                       [&](int t) { return recording.ground[t]; });
      }
      const size_t people = recording.people.size();
      for (size_t n = 0; n < people; ++n) {
        const std::vector<PlateSample>& samples = recording.people[n].plates;
        if (samples.empty()) continue;
        const std::string name = recording.id + (people > 1 ? StrCat("_", n) : "") + ".csv";
        nlohmann::ordered_json plates = {
            {"use", "measure"},
            {"file", WriteTimed(folder, "plates/" + name, "fx,fy,fz,px,py", recording, [&](int t) {
               const PlateSample& s = samples[t];
               return std::array{s.force[0], s.force[1], s.force[2], s.centre[0], s.centre[1]};
             })}};
        if (people > 1) plates["person"] = n;
        if (people > 1) {
          entry["force_plates"].push_back(plates);
        } else {
          entry["force_plates"] = plates;
        }
      }
    }
    OrThrow(WriteJson(folder + "/manifest.json", manifest, 1));
  });
}

}  // namespace pushid
