// datasets: what goes with "motion": "none", and what does not.
#include "datasets/manifest/plates_alone.h"

#include <string>
#include <vector>

#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"

namespace pushid {

bool ReadPlatesAlone(JsonFields* fields) {
  const std::string motion = fields->OptionalText("motion", "");
  if (motion.empty()) return false;
  if (motion != "none") {
    fields->Fail("motion", "is " + Quoted(motion) +
                               "; it may be \"none\", for a person on force plates without "
                               "markers; motion files stand under " +
                               MotionKeys());
    return false;
  }
  std::vector<std::string> refused = {"joints", "mapping",   "push_csv",   "pushes",
                                      "frames", "end_frame", "first_frame"};
  for (const MotionFormatRow& row : kMotionFormats) refused.emplace_back(row.name);
  for (const std::string& key : refused) {
    if (fields->Has(key.c_str())) {
      fields->Fail(key,
                   "is given together with \"motion\": \"none\", a person who stands on force "
                   "plates and is seen by nothing else; leave one of them out");
    }
  }
  return true;
}

void CheckPlatesAlone(const ManifestRecording& recording, JsonFields* fields) {
  if (!recording.plates_alone) return;
  const std::string alone = "\"motion\": \"none\" ";
  if (recording.subjects.size() > 1) {
    fields->Fail("subjects", "names " + std::to_string(recording.subjects.size()) + " people; " +
                                 alone + "is for one person on force plates");
  }
  if (!fields->Require("force_plates", "{\"use\": \"measure\", \"file\": ...}, without which " +
                                           alone + "leaves nothing that was measured")) {
    return;
  }
  const bool measured = recording.plates.size() == 1 &&
                        recording.plates[0].use == PlateUse::kMeasure &&
                        !recording.plates[0].file.empty();
  if (!measured) {
    fields->Fail("force_plates", "needs \"use\": \"measure\" and \"file\", once: with " + alone +
                                     "nothing else was measured");
  }
  if (!recording.ground.markers.empty()) {
    fields->Fail("ground", "names markers, of which " + alone + "says there are none; give a csv");
  }
}

}  // namespace pushid
