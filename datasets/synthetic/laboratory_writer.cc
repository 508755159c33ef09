// datasets: what a laboratory measures of its people, as files.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/formats/table_writers.h"
#include "datasets/synthetic/laboratory.h"

namespace pushid {
namespace {

constexpr int kCameraHz = 100;
constexpr double kMarkerNoise = 0.001, kPlateNoise = 1.0, kCentreNoise = 0.0015, kCellNoise = 0.5;
constexpr double kSway = 1.0;                       // N m at the ankles
constexpr double kFootAside = 0.1, kPelvis = 0.12;  // m, to the side of the middle

// The reference person that gains are quoted for, as in the models' glossary.
constexpr double kQuotedMass = 85.0, kQuotedRod = 0.95;  // kg, m

struct Made {
  std::string id, setting, magnitude;
  int person = 0;
  LaboratoryPush push;
  LaboratoryTrial trial;
};

// Trials of the wanted kind: who steps where nobody should, or falls, is pulled anew.
Result<Made> DrawTrial(const LaboratoryPerson& person, bool steps, int number, double seconds,
                       Random* random) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    Made made;
    const double speed = steps ? random->Uniform(0.65, 0.9) : random->Uniform(0.08, 0.2);
    made.push.start_s = random->Uniform(0.4, 0.7);
    made.push.duration_s = random->Uniform(0.2, 0.4);
    made.push.peak_N = speed * person.mass_kg * M_PI / (2.0 * made.push.duration_s) *
                       (!steps && number % 2 == 1 ? -0.7 : 1.0);
    Result<LaboratoryTrial> trial =
        SimulateLaboratoryTrial(person, made.push, seconds, kSway, random->Fork());
    if (!trial.ok() || trial.value().steps.empty() == steps) continue;
    made.setting = steps ? "stepping" : "standing";
    made.magnitude = steps ? "strong" : "weak";
    made.trial = std::move(trial.value());
    return made;
  }
  return Error{"a person of these gains neither stands nor steps; try another seed"};
}

// Files need no more decimals than instruments give.
double ToDecimals(double value, double per_unit) { return std::round(per_unit * value) / per_unit; }

// Forward, up, right.
Eigen::Vector3d Point(double x, double up, double right) { return {x, up, right}; }

PointMotion Markers(const LaboratoryPerson& person, const LaboratoryTrial& trial, Random* noise) {
  PointMotion motion;
  motion.rate_hz = kCameraHz;
  motion.unit = LengthUnit::kMillimetre;
  motion.names = {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK", "LTOE", "RTOE", "LHEE", "RHEE"};
  motion.positions.resize(motion.names.size());
  const double ankle = 0.039 * person.height_m, toe = 0.114 * person.height_m,
               heel = 0.038 * person.height_m;
  for (size_t i = 0; i < trial.samples.size(); i += kLaboratoryHz / kCameraHz) {
    const LaboratorySample& s = trial.samples[i];
    const double hip_x = 0.5 * (s.foot[0] + s.foot[1]) + person.RodLength() * std::sin(s.legs);
    const double hip_up = ankle + person.RodLength() * std::cos(s.legs);
    std::vector<Eigen::Vector3d> at;
    for (double ahead : {0.1, -0.1}) {  // the pelvis turns with the trunk
      for (double side : {-kPelvis, kPelvis}) {
        at.push_back(
            Point(hip_x + ahead * std::cos(s.trunk), hip_up - ahead * std::sin(s.trunk), side));
      }
    }
    for (const auto& [ahead, up] : {std::pair{0.0, ankle}, {toe, 0.03}, {-heel, 0.03}}) {
      for (int foot : {0, 1}) {
        at.push_back(Point(s.foot[foot] + ahead, up + s.foot_lift[foot],
                           foot == 0 ? -kFootAside : kFootAside));
      }
    }
    for (size_t k = 0; k < at.size(); ++k) {
      for (double& value : at[k]) {
        value = ToDecimals(1000.0 * (value + kMarkerNoise * noise->Normal()), 1e3);
      }
      motion.positions[k].push_back(at[k]);
    }
  }
  return motion;
}

// How much of the weight is on the left foot.
double LeftShare(const LaboratorySample& s) {
  if (s.foot_lift[0] > 0.0) return 0.0;
  if (s.foot_lift[1] > 0.0) return 1.0;
  const double apart = s.foot[0] - s.foot[1];
  return std::abs(apart) < 0.05 ? 0.5 : std::clamp((s.centre_m - s.foot[1]) / apart, 0.0, 1.0);
}

// OpenSim's axes: x forward, y up, z to the right.
NumericTable Plates(const LaboratoryTrial& trial, Random* noise) {
  NumericTable table;
  table.names = {"time"};
  for (const char* side : {"left", "right"}) {
    for (const char* what : {"_vx", "_vy", "_vz", "_px", "_py", "_pz"}) {
      table.names.push_back(std::string(side) + what);
    }
  }
  table.data.resize(table.names.size());
  for (size_t i = 0; i < table.names.size(); ++i) table.chosen.push_back(static_cast<int>(i));
  for (size_t i = 0; i < trial.samples.size(); ++i) {
    const LaboratorySample& s = trial.samples[i];
    const double left = LeftShare(s);
    std::vector<double> row = {static_cast<double>(i) / kLaboratoryHz};
    // Where each foot presses, so that both together press at the centre.
    const double beyond = s.centre_m - left * s.foot[0] - (1.0 - left) * s.foot[1];
    for (int foot : {0, 1}) {
      const double share = foot == 0 ? left : 1.0 - left;
      const bool pressed = share * s.vertical_N > 20.0;
      const double side = foot == 0 ? -kFootAside : kFootAside;
      for (double force : {share * s.shear_N, share * s.vertical_N, 0.0}) {
        row.push_back(force + kPlateNoise * noise->Normal());
      }
      row.push_back(pressed ? s.foot[foot] + beyond + kCentreNoise * noise->Normal() : 0.0);
      row.push_back(0.0);
      row.push_back(pressed ? side + kCentreNoise * noise->Normal() : 0.0);
    }
    for (size_t k = 0; k < row.size(); ++k) table.data[k].push_back(ToDecimals(row[k], 1e5));
  }
  return table;
}

NumericTable LoadCell(const LaboratoryTrial& trial, Random* noise) {
  NumericTable table;
  table.names = {"time", "force"};
  table.chosen = {0, 1};
  table.data.resize(2);
  const double offset = noise->Uniform(-4.0, 4.0);  // N
  for (size_t i = 0; i < trial.samples.size(); ++i) {
    table.data[0].push_back(static_cast<double>(i) / kLaboratoryHz);
    table.data[1].push_back(
        ToDecimals(trial.samples[i].push_N + offset + kCellNoise * noise->Normal(), 1e3));
  }
  return table;
}

nlohmann::ordered_json TrialEntry(const Made& made, const LaboratoryPerson& person) {
  const std::string subject = made.id.substr(0, 3);
  return {{"id", made.id},
          {"setting", made.setting},
          {"magnitude", made.magnitude},
          {"subjects", {{{"id", subject}, {"mass_kg", std::round(10.0 * person.mass_kg) / 10.0}}}},
          {"pushed_person", 0},
          {"trc", {"motion/" + made.id + ".trc"}},
          {"up", "y"},
          {"forward", "x"},
          {"force_plates",
           {{"use", "measure"},
            {"file", "plates/" + made.id + ".mot"},
            {"plates", {"left", "right"}},
            {"up", "y"},
            {"forward", "x"}}}};
}

nlohmann::ordered_json TruthOf(const LaboratoryPerson& person) {
  const auto joint = [](const LaboratoryPerson::Joint& k) -> nlohmann::ordered_json {
    return {{"active_stiffness_Nm_per_rad", k.active},
            {"passive_stiffness_Nm_per_rad", k.passive},
            {"active_damping_Nms_per_rad", k.active_damping},
            {"passive_damping_Nms_per_rad", k.passive_damping}};
  };
  return {{"mass_kg", person.mass_kg},    {"height_m", person.height_m},
          {"ankle", joint(person.ankle)}, {"hip", joint(person.hip)},
          {"delay_s", person.delay_s},    {"lean_rad", person.lean_rad}};
}

// Sums of active and passive gains, for the person that the programs quote gains for: the mean.
nlohmann::ordered_json QuotedTruth(const std::vector<LaboratoryPerson>& people) {
  double stiffness = 0.0, damping = 0.0, delay = 0.0, share = 0.0;
  const double each = 1.0 / static_cast<double>(people.size());
  for (const LaboratoryPerson& p : people) {
    const double rod = p.RodLength() / kQuotedRod, scale = p.mass_kg / kQuotedMass * rod;
    stiffness += each * (p.ankle.active + p.ankle.passive) / scale;
    damping += each * (p.ankle.active_damping + p.ankle.passive_damping) / (scale * rod);
    delay += each * p.delay_s;
    share += each * p.ankle.passive / (p.ankle.active + p.ankle.passive);
  }
  return {{"Kp_theta", stiffness},
          {"Kd_theta", damping},
          {"reaction_delay", delay},
          {"passive_stiffness", share}};
}

MaybeError WriteTrial(const std::string& folder, const Made& made, const LaboratoryPerson& person,
                      Random* noise) {
  for (const MaybeError& failed :
       {WriteTrc(folder + "/motion/" + made.id + ".trc", Markers(person, made.trial, noise)),
        WriteNumericTable(folder + "/plates/" + made.id + ".mot", TableFormat::kStorage,
                          Plates(made.trial, noise)),
        WriteNumericTable(folder + "/force/" + made.id + ".csv", TableFormat::kCsv,
                          LoadCell(made.trial, noise))}) {
    if (failed) return failed;
  }
  return std::nullopt;
}

}  // namespace

std::vector<LaboratoryPerson> DrawLaboratoryPeople(const LaboratoryOptions& options) {
  Random random(options.seed);
  // Over the gravitational stiffness, as measured in quiet and perturbed standing: total 1.6
  // to 2.2, of which the passive one is 0.5 to 0.8 (Loram and Lakie, J. Physiol. 545, 2002).
  const double active = random.Uniform(1.1, 1.4), passive = random.Uniform(0.5, 0.8);
  const double damping = random.Uniform(0.3, 0.4), delay = random.Uniform(0.1, 0.14);
  std::vector<LaboratoryPerson> people;
  for (int i = 0; i < options.people; ++i) {
    LaboratoryPerson p;
    p.mass_kg = random.Uniform(55.0, 95.0);
    p.height_m = random.Uniform(1.6, 1.9);
    const double own = std::exp(0.05 * random.Normal());
    const double whole = own * p.mass_kg * 9.81 * 0.545 * p.height_m;  // N m/rad, of the body
    const double trunk = 0.678 * p.mass_kg * 9.81 * 0.18 * p.height_m;
    p.ankle = {active * whole, passive * whole, damping * whole, 0.04 * whole};
    p.hip = {trunk, 2.0 * trunk, 0.15 * trunk, 0.3 * trunk};
    p.delay_s = delay + 0.005 * random.Normal();
    p.lean_rad = random.Uniform(0.0, 0.03);
    people.push_back(p);
  }
  return people;
}

MaybeError WriteLaboratoryStudy(const std::string& folder, const LaboratoryOptions& options) {
  for (const char* sub : {"/motion", "/plates", "/force"}) {
    if (MaybeError failed = MakeFolder(folder + sub)) return failed;
  }
  const std::vector<LaboratoryPerson> people = DrawLaboratoryPeople(options);
  Random random(options.seed + 1), noise(options.seed + 2);
  nlohmann::ordered_json manifest, truth;
  manifest["schema"] = "pushid-manifest/1";
  truth["schema"] = "pushid-truth/1";
  truth["synthetic"]["truth"] = QuotedTruth(people);
  for (int i = 0; i < options.people; ++i) {
    const std::string subject = (i < 9 ? "S0" : "S") + std::to_string(i + 1);
    truth["people"][subject] = TruthOf(people[i]);
    for (int k = 0; k < options.standing + options.stepping; ++k) {
      Result<Made> made = DrawTrial(people[i], k >= options.standing, k, options.seconds, &random);
      if (!made.ok()) return made.error();
      made.value().id = subject + "_" + made.value().magnitude + "_" + std::to_string(k + 1);
      if (MaybeError failed = WriteTrial(folder, made.value(), people[i], &noise)) return failed;
      manifest["recordings"].push_back(TrialEntry(made.value(), people[i]));
      for (const LaboratoryStep& step : made.value().trial.steps) {
        truth["steps"][made.value().id].push_back({{"foot", step.foot == 0 ? "left" : "right"},
                                                   {"lift_off_s", step.lift_off_s},
                                                   {"landing_s", step.landing_s},
                                                   {"length_m", step.length_m}});
      }
    }
  }
  if (MaybeError failed = WriteFileAtomically(folder + "/truth.json", truth.dump(1) + "\n")) {
    return failed;
  }
  return WriteFileAtomically(folder + "/manifest.json", manifest.dump(1) + "\n");
}

}  // namespace pushid
