// apps: ground that moves and force platforms, from arrays.
#include "apps/python/bindings.h"
#include "datasets/loading/recording_from_tracks.h"
#include "datasets/sensors/force_platform.h"

namespace pushid {

Error WrongShape(const std::string& what, const Array& array, const std::string& must) {
  std::string shape;
  for (int i = 0; i < array.ndim(); ++i) {
    shape += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return Error{what + " has the shape (" + shape + "); it must be " + must};
}

namespace {

// (frames, 2) of shifts in m, or (frames, 4) with tilts in rad.
std::vector<GroundPose> GroundFrom(const py::object& given) {
  if (given.is_none()) return {};
  const Array array = py::cast<Array>(given);
  if (array.ndim() != 2 || (array.shape(1) != 2 && array.shape(1) != 4)) {
    Raise(Fault::kData, WrongShape("ground", array,
                                   "(frames, 2) of x and y in m, or (frames, 4) with theta and phi "
                                   "in rad"));
  }
  std::vector<GroundPose> poses(array.shape(0), GroundPose::Zero());
  for (py::ssize_t t = 0; t < array.shape(0); ++t) {
    for (py::ssize_t i = 0; i < array.shape(1); ++i) poses[t][i] = array.at(t, i);
  }
  return poses;
}

// (frames, 5) or (frames, people, 5) of fx, fy, fz in N and px, py in m; NaN: not measured.
void AddPlates(const py::object& given, std::vector<TrackedPerson>* people) {
  if (given.is_none()) return;
  const Array array = py::cast<Array>(given);
  const bool alone = array.ndim() == 2 && array.shape(1) == 5 && people->size() == 1;
  if (!alone && !(array.ndim() == 3 && array.shape(2) == 5 &&
                  array.shape(1) == static_cast<py::ssize_t>(people->size()))) {
    Raise(Fault::kData,
          WrongShape("plates", array,
                     "(frames, 5), or (frames, people, 5), of fx, fy, fz in N and px, "
                     "py in m"));
  }
  for (size_t n = 0; n < people->size(); ++n) {
    std::vector<PlateSample>& plates = (*people)[n].plates;
    bool measured = false;
    for (py::ssize_t t = 0; t < array.shape(0); ++t) {
      Eigen::Matrix<double, 5, 1> row;
      for (py::ssize_t i = 0; i < 5; ++i) row[i] = alone ? array.at(t, i) : array.at(t, n, i);
      PlateSample sample;
      if (!row.hasNaN()) {
        sample.force = row.head<3>();
        sample.centre = {row[3], row[4], 0.0};
        sample.weight = row[2] >= kPressed ? 1.0 : 0.0;
      }
      measured = measured || sample.weight > 0.0;
      plates.push_back(sample);
    }
    if (!measured) plates.clear();
  }
}

}  // namespace

void TakeLaboratory(const py::object& ground, const py::object& plates, TrackedRecording* tracks) {
  tracks->ground = GroundFrom(ground);
  AddPlates(plates, &tracks->people);
}

}  // namespace pushid
