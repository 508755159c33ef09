// datasets: a person whom force plates alone measured.
//
// Nobody saw where they stood: they stand upright over the mean centre of pressure for as long as
// the platforms measured, and no frame of that counts. What counts are the platforms' rows.
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/loading/plate_record.h"

namespace pushid {
namespace {

constexpr double kUnseenStance = 0.1;  // m, of ankles that nobody saw

}  // namespace

Result<LoadedPerson> LoadPersonOnPlates(const ManifestRecording& entry) {
  const ManifestPlates& plates = entry.plates[0];
  const ManifestSubject& subject = entry.subjects[0];
  LoadedPerson loaded;
  RecordedPerson& person = loaded.person;
  const Result<PlateTracks> read = ReadPlates(entry, plates, person);
  if (!read.ok()) return read.error();
  const PlateTracks& tracks = read.value();
  person.subject_id = subject.id;
  person.mass_kg = subject.mass_kg;
  person.known = subject.known;
  person.file = tracks.file;
  person.file_clock_s = plates.start_s.value_or(tracks.first_s);
  person.skipped_s = person.file_clock_s - tracks.first_s;
  loaded.fps = entry.fps > 0.0 ? entry.fps : WholeFrameRate(tracks.rate_hz);
  const std::string problem = FrameRateProblem(loaded.fps);
  if (!problem.empty()) {
    return Error{"the platforms' rate " + problem + "; give fps in the manifest", tracks.file};
  }
  const double seconds = tracks.last_s() - person.file_clock_s;
  const int frames = 1 + static_cast<int>(std::floor(seconds * loaded.fps + 1e-6));
  if (!(seconds > 0.0) || frames < 3) {
    return Error{"the platforms were recorded from " + Rounded(tracks.first_s, 4) + " to " +
                     Rounded(tracks.last_s(), 4) + " s, which leaves nothing after \"start\" (" +
                     Rounded(person.file_clock_s, 4) + " s)",
                 tracks.file, tracks.last_line};
  }
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& row : tracks.moment) moment += row;
  Eigen::Vector3d ankles(0.0, 0.0, subject.ankle_height_m);
  if (moment.z() > 0.0) ankles.head<2>() = moment.head<2>() / moment.z();
  const auto stays = [frames](const Eigen::Vector3d& place) {
    return std::vector<Eigen::Vector3d>(static_cast<size_t>(frames), place);
  };
  person.hip = stays(ankles + Eigen::Vector3d(0.0, 0.0, subject.rod_m));
  person.left_ankle = stays(ankles + Eigen::Vector3d(0.0, kUnseenStance, 0.0));
  person.right_ankle = stays(ankles - Eigen::Vector3d(0.0, kUnseenStance, 0.0));
  person.weight.assign(static_cast<size_t>(frames), 0.0);
  const Result<std::string> hash = HashFile(tracks.file);
  if (!hash.ok()) return hash.error();
  loaded.file_hash = hash.value();
  if (MaybeError failed = CheckMotion(person, 1.0)) return *std::move(failed);
  return loaded;
}

}  // namespace pushid
