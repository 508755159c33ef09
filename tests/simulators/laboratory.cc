// Two-link people of a laboratory, simulated and written.
#include "tests/simulators/laboratory.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "tests/simulators/table_files.h"

namespace pushid {
namespace {

constexpr double kG = 9.81;          // m/s^2
constexpr double kReaction = 0.15;   // s, from the loss of balance to lift-off
constexpr double kSwing = 0.3;       // s
constexpr double kClearance = 0.06;  // m
constexpr double kSwayMemory = 0.3;  // s, of the noise at the ankles

// Winter's table for both sides: the legs are shanks and thighs; feet have mass but do not move.
struct WinterSegments {
  explicit WinterSegments(const LaboratoryPerson& person)
      : m1(0.293 * person.mass_kg),
        m2(0.678 * person.mass_kg),
        c1(0.307 * person.height_m),
        c2(0.180 * person.height_m),
        l(person.RodLength()),
        i1(0.0056 * person.mass_kg * person.height_m * person.height_m),
        i2(0.0138 * person.mass_kg * person.height_m * person.height_m),
        ankle(0.039 * person.height_m),
        heel(0.030 * person.height_m),
        toe(0.090 * person.height_m),
        weight(person.mass_kg * kG) {}
  double m1, m2, c1, c2, l, i1, i2;  // kg, m, kg m^2
  double ankle;                      // height, m
  double heel, toe;                  // how far the centre of pressure goes from the ankle, m
  double weight;                     // N
};

// Angles of legs and trunk, rad, and their rates; or the slopes of all of them.
using Moving = Eigen::Vector4d;

struct Swing {
  double from = 0.0, to = 0.0, begin = -1.0;  // m, s
  bool Now(double t) const { return begin >= 0.0 && t < begin + kSwing; }
  double Phase(double t) const { return std::clamp((t - begin) / kSwing, 0.0, 1.0); }
  double Place(double t) const {
    const double u = Phase(t);
    return from + (to - from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
  }
  double Acceleration(double t) const {
    if (!Now(t)) return 0.0;
    const double u = Phase(t);
    return (to - from) / (kSwing * kSwing) * u * (60.0 - 180.0 * u + 120.0 * u * u);
  }
};

class Walker {
 public:
  Walker(const LaboratoryPerson& person, const LaboratoryPush& push, int substeps)
      : person_(person), body_(person), push_(push), h_(1.0 / (kLaboratoryHz * substeps)) {
    now_ = {person.lean_rad, 0.0, 0.0, 0.0};
    tonic_ = -(body_.m1 * body_.c1 + body_.m2 * body_.l) * kG * std::sin(person.lean_rad);
  }

  double time() const { return h_ * static_cast<double>(history_.size()); }
  bool Falls() const { return std::abs(now_[0]) > 0.7 || std::abs(now_[1]) > 1.2; }
  void SetSway(double torque) { sway_ = torque; }

  void Advance() {
    history_.push_back(now_);
    const Moving a = Slope(0.0, now_), b = Slope(0.5, now_ + 0.5 * h_ * a),
                 c = Slope(0.5, now_ + 0.5 * h_ * b), d = Slope(1.0, now_ + h_ * c);
    now_ = now_ + h_ / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }

  // Called once per sample: lifts the hind foot if balance was lost a reaction time ago.
  void Decide(LaboratoryTrial* trial) {
    const double t = time();
    const auto [back, front] = Support(t);
    const double mass = body_.m1 + body_.m2, x = Middle(t), place = CentreOfMass(now_.head<2>(), x);
    const double speed = (CentreOfMass(now_.head<2>() + 1e-6 * now_.tail<2>(), x) - place) / 1e-6;
    const double height = (body_.m1 * body_.c1 + body_.m2 * (body_.l + body_.c2)) / mass;
    const double rate = std::sqrt(kG / height), beyond = place + speed / rate;
    lost_.push_back(beyond > front);
    const size_t late = static_cast<size_t>(kReaction * kLaboratoryHz);
    const bool swings = swing_[0].Now(t) || swing_[1].Now(t);
    if (swings || lost_.size() <= late || !lost_.back() || !lost_[lost_.size() - 1 - late]) return;
    const int foot = Foot(1, t) < Foot(0, t) ? 1 : 0;
    const double stand = Foot(1 - foot, t) + body_.toe;
    // The foot lands beyond the extrapolated centre of mass at landing.
    const double landing = stand + (beyond - stand) * std::exp(rate * kSwing);
    swing_[foot] = {Foot(foot, t), std::max(landing - 0.2 * body_.toe, stand), t};
    trial->steps.push_back({foot, t, t + kSwing, swing_[foot].to - swing_[foot].from});
  }

  LaboratorySample Sample() const {
    const double t = time();
    const Moving slope = Slope(1.0, now_);  // the history ends a step before
    const double torque = AnkleTorque(1.0, now_);
    const auto part = [&](double arm, double angle, double rate, double turn) {
      return std::pair<double, double>(
          arm * (std::cos(angle) * turn - std::sin(angle) * rate * rate),
          -arm * (std::sin(angle) * turn + std::cos(angle) * rate * rate));
    };
    const auto legs = part(1.0, now_[0], now_[2], slope[2]);
    const auto trunk = part(body_.c2, now_[1], now_[3], slope[3]);
    const double ground = MiddleAcceleration(t);
    LaboratorySample s{now_[0], now_[1]};
    s.push_N = push_.ForceAt(t);
    for (int foot : {0, 1}) {
      s.foot[foot] = Foot(foot, t);
      const double u = swing_[foot].Now(t) ? swing_[foot].Phase(t) : 0.0;
      s.foot_lift[foot] = 16.0 * kClearance * u * u * (1.0 - u) * (1.0 - u);
    }
    const double first = body_.m1 * body_.c1 + body_.m2 * body_.l;
    s.shear_N =
        first * legs.first + body_.m2 * trunk.first + (body_.m1 + body_.m2) * ground - s.push_N;
    s.vertical_N = body_.weight + first * legs.second + body_.m2 * trunk.second;
    s.centre_m = Middle(t) - (torque + body_.ankle * s.shear_N) / s.vertical_N;
    return s;
  }

 private:
  double Foot(int foot, double t) const {
    return swing_[foot].begin < 0.0 ? 0.0 : swing_[foot].Place(t);
  }
  double Middle(double t) const { return 0.5 * (Foot(0, t) + Foot(1, t)); }
  double MiddleAcceleration(double t) const {
    return 0.5 * (swing_[0].Acceleration(t) + swing_[1].Acceleration(t));
  }
  double CentreOfMass(const Eigen::Vector2d& angles, double x) const {
    return x + ((body_.m1 * body_.c1 + body_.m2 * body_.l) * std::sin(angles[0]) +
                body_.m2 * body_.c2 * std::sin(angles[1])) /
                   (body_.m1 + body_.m2);
  }
  // Hindmost and foremost point of the standing feet.
  std::pair<double, double> Support(double t) const {
    double back = 1e9, front = -1e9;
    for (int foot : {0, 1}) {
      if (swing_[foot].Now(t)) continue;
      back = std::min(back, Foot(foot, t) - body_.heel);
      front = std::max(front, Foot(foot, t) + body_.toe);
    }
    return {back, front};
  }

  // The state `s` steps of h after the last one in the history, minus the delay; at rest before.
  Moving Late(double s) const {
    const double at = static_cast<double>(history_.size()) - 1.0 + s - person_.delay_s / h_;
    if (at <= 0.0) return {person_.lean_rad, 0.0, 0.0, 0.0};
    const size_t i = std::min(static_cast<size_t>(at), history_.size() - 1);
    const size_t next = std::min(i + 1, history_.size() - 1);
    const double f = at - static_cast<double>(i);
    return (1.0 - f) * history_[i] + f * history_[next];
  }

  double AnkleTorque(double s, const Moving& m) const {
    const double t = time() + (s - 1.0) * h_;
    const Moving late = Late(s);
    const LaboratoryPerson::Joint& k = person_.ankle;
    const double torque = tonic_ + sway_ - k.active * (late[0] - person_.lean_rad) -
                          k.active_damping * late[2] - k.passive * (m[0] - person_.lean_rad) -
                          k.passive_damping * m[2];
    const auto [back, front] = Support(t);
    const double x = Middle(t);
    return std::clamp(torque, -body_.weight * (front - x), -body_.weight * (back - x));
  }

  Moving Slope(double s, const Moving& m) const {
    const double t = time() + (s - 1.0) * h_;
    const Moving late = Late(s);
    const LaboratoryPerson::Joint& k = person_.hip;
    const double hip = -k.active * late[1] - k.active_damping * late[3] -
                       k.passive * (m[1] - m[0] + person_.lean_rad) -
                       k.passive_damping * (m[3] - m[2]);
    const double ankle = AnkleTorque(s, m), force = push_.ForceAt(t),
                 ground = MiddleAcceleration(t);
    const double m1 = body_.m1, m2 = body_.m2, c1 = body_.c1, c2 = body_.c2, l = body_.l;
    const double apart = m[0] - m[1], across = m2 * l * c2;
    const double a = m1 * c1 * c1 + body_.i1 + m2 * l * l, b = across * std::cos(apart),
                 d = m2 * c2 * c2 + body_.i2;
    const double legs = (m1 * c1 + m2 * l) * (kG * std::sin(m[0]) - ground * std::cos(m[0])) +
                        ankle - hip + force * l * std::cos(m[0]) -
                        across * std::sin(apart) * m[3] * m[3];
    const double trunk = m2 * c2 * (kG * std::sin(m[1]) - ground * std::cos(m[1])) + hip +
                         across * std::sin(apart) * m[2] * m[2];
    const double det = a * d - b * b;
    return {m[2], m[3], (d * legs - b * trunk) / det, (a * trunk - b * legs) / det};
  }

  LaboratoryPerson person_;
  WinterSegments body_;
  LaboratoryPush push_;
  double h_, tonic_ = 0.0, sway_ = 0.0;
  Moving now_;
  std::vector<Moving> history_;  // of every step
  std::vector<bool> lost_;       // of every sample: balance
  Swing swing_[2];
};

constexpr int kCameraHz = 100;
constexpr double kMarkerNoise = 0.001, kPlateNoise = 1.0, kCentreNoise = 0.0015, kCellNoise = 0.5;
constexpr double kSway = 1.0;                       // N m at the ankles
constexpr double kFootAside = 0.1, kPelvis = 0.12;  // m, to the side of the middle

// The reference person that gains are quoted for, as in the models' glossary.
constexpr double kQuotedMass = 85.0, kQuotedRod = 0.95;  // kg, m

struct Made {
  std::string id, setting, magnitude;
  LaboratoryTrial trial;
};

// Trials with or without steps as wanted; a trial with a fall or an unwanted step is repeated.
Made DrawTrial(const LaboratoryPerson& person, bool steps, int number, double seconds,
               Random* random) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    const double speed = steps ? random->Uniform(0.65, 0.9) : random->Uniform(0.08, 0.2);
    LaboratoryPush push;
    push.start_s = random->Uniform(0.4, 0.7);
    push.duration_s = random->Uniform(0.2, 0.4);
    push.peak_N = speed * person.mass_kg * M_PI / (2.0 * push.duration_s) *
                  (!steps && number % 2 == 1 ? -0.7 : 1.0);
    Result<LaboratoryTrial> trial =
        SimulateLaboratoryTrial(person, push, seconds, kSway, random->Fork());
    if (!trial.ok() || trial.value().steps.empty() == steps) continue;
    return {"", steps ? "stepping" : "standing", steps ? "strong" : "weak",
            std::move(trial.value())};
  }
  throw Error{"a person of these gains neither stands nor steps; try another seed"};
}

// Rounds to the decimals that instruments have.
double ToDecimals(double value, double per_unit) { return std::round(per_unit * value) / per_unit; }

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
    std::vector<Eigen::Vector3d> at;    // forward, up, right
    for (double ahead : {0.1, -0.1}) {  // the pelvis turns with the trunk
      for (double side : {-kPelvis, kPelvis}) {
        at.emplace_back(hip_x + ahead * std::cos(s.trunk), hip_up - ahead * std::sin(s.trunk),
                        side);
      }
    }
    for (const auto& [ahead, up] : {std::pair{0.0, ankle}, {toe, 0.03}, {-heel, 0.03}}) {
      for (int foot : {0, 1}) {
        at.emplace_back(s.foot[foot] + ahead, up + s.foot_lift[foot],
                        foot == 0 ? -kFootAside : kFootAside);
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

// Share of the weight on the left foot.
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
    // The loads of the feet add up to one at the centre of pressure.
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

// Sums of active and passive gains, for the reference person.
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

}  // namespace

double LaboratoryPush::ForceAt(double t) const {
  const double u = (t - start_s) / duration_s;
  return u > 0.0 && u < 1.0 ? peak_N * std::sin(M_PI * u) : 0.0;
}

Result<LaboratoryTrial> SimulateLaboratoryTrial(const LaboratoryPerson& person,
                                                const LaboratoryPush& push, double seconds,
                                                double sway, uint64_t seed, int substeps) {
  LaboratoryTrial trial;
  Walker walker(person, push, substeps);
  Random random(seed);
  const int samples = static_cast<int>(std::lround(seconds * kLaboratoryHz)) + 1;
  const double memory = std::exp(-1.0 / (kSwayMemory * kLaboratoryHz));
  double noise = 0.0;
  for (int i = 0; i < samples; ++i) {
    noise = memory * noise + std::sqrt(1.0 - memory * memory) * sway * random.Normal();
    walker.SetSway(noise);
    walker.Decide(&trial);
    trial.samples.push_back(walker.Sample());
    if (walker.Falls()) {
      return Error{"the person falls after " + Rounded(walker.time(), 3) + " s, pushed by " +
                   Rounded(push.peak_N, 3) + " N"};
    }
    for (int k = 0; k < substeps; ++k) walker.Advance();
  }
  return trial;
}

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
  return Caught([&] {
    for (const char* sub : {"/motion", "/plates", "/force"}) OrThrow(MakeFolder(folder + sub));
    const std::vector<LaboratoryPerson> people = DrawLaboratoryPeople(options);
    Random random(options.seed + 1), noise(options.seed + 2);
    nlohmann::ordered_json manifest, truth;
    manifest["schema"] = "pushid-manifest/1";
    truth["schema"] = "pushid-truth/1";
    truth["synthetic"]["truth"] = QuotedTruth(people);
    for (int i = 0; i < options.people; ++i) {
      const std::string subject = StrCat(i < 9 ? "S0" : "S", i + 1);
      truth["people"][subject] = TruthOf(people[i]);
      for (int k = 0; k < options.standing + options.stepping; ++k) {
        Made made = DrawTrial(people[i], k >= options.standing, k, options.seconds, &random);
        const std::string& id = made.id = StrCat(subject, "_", made.magnitude, "_", k + 1);
        OrThrow(
            WriteTrc(folder + "/motion/" + id + ".trc", Markers(people[i], made.trial, &noise)));
        OrThrow(WriteNumericTable(folder + "/plates/" + id + ".mot", TableFormat::kStorage,
                                  Plates(made.trial, &noise)));
        OrThrow(WriteNumericTable(folder + "/force/" + id + ".csv", TableFormat::kCsv,
                                  LoadCell(made.trial, &noise)));
        manifest["recordings"].push_back(TrialEntry(made, people[i]));
        for (const LaboratoryStep& step : made.trial.steps) {
          truth["steps"][id].push_back({{"foot", step.foot == 0 ? "left" : "right"},
                                        {"lift_off_s", step.lift_off_s},
                                        {"landing_s", step.landing_s},
                                        {"length_m", step.length_m}});
        }
      }
    }
    OrThrow(WriteJson(folder + "/truth.json", truth, 1));
    OrThrow(WriteJson(folder + "/manifest.json", manifest, 1));
  });
}

}  // namespace pushid
