// ident: the push that the sensors of a recording measured, added up.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/push/push_from_sensor.h"

namespace pushid {
namespace {

constexpr double kCutShort = 0.2;    // of the peak
constexpr double kOddGain = 3.0;     // beyond what friction and recovery blur
constexpr double kNoisePeaks = 4.0;  // standard deviations

// Rows of several pushes on one person, added frame by frame.
void AddPush(const Push& more, Push* sum) {
  if (sum->force.empty()) {
    *sum = more;
    return;
  }
  const int start = std::min(sum->start_frame, more.start_frame);
  const int end = std::max(sum->EndFrame(), more.EndFrame());
  std::vector<Eigen::Vector4d> force(end - start, Eigen::Vector4d::Zero());
  for (const Push* push : {static_cast<const Push*>(sum), &more}) {
    for (std::size_t i = 0; i < push->force.size(); ++i) {
      force[push->start_frame - start + i] += push->force[i];
    }
  }
  sum->force = std::move(force);
  sum->start_frame = start;
}

// As PushFromSensor takes it, but for the offset: vectors along the direction.
TimedRecord AsVectors(const SensorRecord& record, const SensorChoice& sensor) {
  TimedRecord timed{record, sensor.start_s.value_or(0.0)};
  if (record.is_vector) return timed;
  const Eigen::Vector3d along = sensor.direction.normalized();
  for (Eigen::Vector3d& force : timed.record.force) force = force.x() * along;
  return timed;
}

// A warning for a record that begins or ends while it measures a push: the rest of it is lost.
std::string CutShort(const SensorRecord& record) {
  double peak = 0.0;
  for (const Eigen::Vector3d& force : record.force) peak = std::max(peak, force.norm());
  for (const bool first : {true, false}) {
    const double force = (first ? record.force.front() : record.force.back()).norm();
    if (!(force > kCutShort * peak)) continue;
    return record.file + ": the record " + (first ? "begins" : "ends") + " with " +
           Rounded(force, 3) + " N, with a maximum of " + Rounded(peak, 3) +
           " N: part of the push is missing, or the sensor has an offset (--sensor_zero)";
  }
  return "";
}

struct ReadSensors {
  std::vector<SensorChoice> choices;  // with what the motion's file says of them
  std::vector<SensorRecord> records;
  std::string how;
};

// The clock at frame 0 of a sensor in a file of its own, when nothing is said of it: the motion's,
// where the record holds at least half of the recording by it; otherwise both began at once. So a
// motion that is cut (first_frame) keeps its push.
double ClockBeside(const SensorRecord& record, const RecordedPerson& person, double seconds) {
  const double begin = person.file_clock_s, end = begin + seconds;
  const double shared =
      std::min(end, record.time_s.back()) - std::max(begin, record.time_s.front());
  return shared >= 0.5 * seconds ? begin : record.time_s.front() + person.skipped_s;
}

Result<ReadSensors> ReadAll(const SensorSetup& setup, const Recording& recorded, int person) {
  ReadSensors read;
  const std::size_t count = setup.sensors.size();
  read.how = count == 1
                 ? "from the sensor, averaged over the frames"
                 : "from " + std::to_string(count) + " sensors together, averaged over the frames";
  for (SensorChoice sensor : setup.sensors) {
    const bool said = sensor.start_s.has_value();
    for (const RecordedPerson& one : recorded.people) FillFromMotion(one, &sensor);
    Result<SensorRecord> record = ReadSensor(sensor);
    if (!record.ok()) return record.error();
    const bool together = sensor.start_s.has_value();
    if (!together) {
      sensor.start_s = ClockBeside(record.value(), recorded.people[person],
                                   (recorded.num_frames() - 1) / recorded.fps);
    }
    if (!said && (together || *sensor.start_s != 0.0)) {
      read.how += std::string(together ? "; recorded with the motion, its clock"
                                       : "; by the motion's times, its clock") +
                  " at frame 0 is " + Rounded(*sensor.start_s, 4) + " s" +
                  (together ? "" : " (--sensor_start changes it)");
    }
    const Vector3<double>& rest = record.value().subtracted;
    if (rest.norm() > 0.0) {
      const double size = record.value().is_vector ? rest.norm() : rest.x();
      read.how +=
          "; " + Rounded(size, 3) + " N before the pull subtracted (--sensor_zero=0 keeps them)";
    }
    read.choices.push_back(sensor);
    read.records.push_back(std::move(record.value()));
  }
  return read;
}

// What the noise of a sensor at rest makes of the mean over a frame, N.
double IdleForce(const SensorRecord& record, double dt) {
  const double step = (record.time_s.back() - record.time_s.front()) / (record.num_samples() - 1);
  return kNoisePeaks * record.noise * std::sqrt(std::min(1.0, step / dt));
}

// The error of an estimated offset: that of noise, and half a frame, which its fit cannot tell.
double ClockError(const SensorOffset& offset, const PendulumRecording& recording) {
  return 0.5 * recording.scene.dt + 2.0 * offset.standard_error_s;
}

// How far the sensors' clocks are off by the motion; zero unless that is asked for, and where the
// motion does not contradict it.
Result<SensorOffset> Offset(const SensorSetup& setup, const ReadSensors& read,
                            const PendulumRecording& recording, int person, SensorPush* result) {
  if (!setup.estimate_offset) return SensorOffset();
  std::vector<TimedRecord> timed;
  for (std::size_t i = 0; i < read.records.size(); ++i) {
    timed.push_back(AsVectors(read.records[i], read.choices[i]));
  }
  Result<SensorOffset> offset = EstimateSensorOffset(timed, recording, person, setup.max_offset_s);
  if (!offset.ok()) return offset;
  const double gain = offset.value().gain;
  if (gain < 1.0 / kOddGain || gain > kOddGain) {
    result->warnings.push_back("the motion fits best with " + Rounded(gain, 2) +
                               " times the force: check its unit and gain, and the mass");
  }
  const std::string estimate = Rounded(offset.value().offset_s, 4) + " +- " +
                               Rounded(offset.value().standard_error_s, 2) + " s";
  if (std::abs(offset.value().offset_s) <= ClockError(offset.value(), recording)) {
    result->how += "; the clocks agree (offset by the motion " + estimate + "): not moved";
    offset.value().offset_s = 0.0;
  } else {
    result->how += "; clock at frame 0 moved by " + estimate + " (estimated)";
  }
  return offset;
}

}  // namespace

Result<SensorPush> PushFromSensors(const SensorSetup& setup, const Recording& recorded,
                                   const PendulumRecording& recording, int person) {
  if (person < 0 || person >= recording.num_people()) {
    return Error{"recording " + recording.id + ": there is no person " + std::to_string(person)};
  }
  const Result<ReadSensors> read = ReadAll(setup, recorded, person);
  if (!read.ok()) return read.error();
  SensorPush result;
  result.how = read.value().how;
  const Result<SensorOffset> offset = Offset(setup, read.value(), recording, person, &result);
  if (!offset.ok()) return offset.error();
  SensorPushOptions options;
  options.person = person;
  if (setup.estimate_offset) {
    options.clock_error_s = ClockError(offset.value(), recording);
  }
  for (std::size_t i = 0; i < read.value().records.size(); ++i) {
    const SensorChoice& sensor = read.value().choices[i];
    const SensorRecord& record = read.value().records[i];
    options.direction = sensor.direction;
    options.height_fraction = sensor.height_fraction;
    options.height_m = sensor.height_m ? sensor.height_m : record.height_m;
    options.frame_zero_time_s = sensor.start_s.value_or(0.0) + offset.value().offset_s;
    options.idle_force =
        sensor.idle_force > 0.0 ? sensor.idle_force : IdleForce(record, recording.scene.dt);
    if (!options.height_m && options.height_fraction == SensorChoice{}.height_fraction) {
      result.how += "; contact at the hip's height (--height and --height_m change it)";
    }
    const Result<Push> push = PushFromSensor(record, recording, options);
    if (!push.ok()) return push.error();
    const std::string cut_short = CutShort(record);
    if (!cut_short.empty()) result.warnings.push_back(cut_short);
    if (record.height_m && *record.height_m < 0.1) {
      result.warnings.push_back(sensor.file + ": " + sensor.column +
                                " lies on the floor: it measures the ground reaction force of the "
                                "person standing there, not a push");
    }
    AddPush(push.value(), &result.push);
  }
  return result;
}

}  // namespace pushid
