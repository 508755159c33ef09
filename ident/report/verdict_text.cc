#include "ident/report/verdict_text.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/uncertainty/assumptions.h"

namespace pushid {
namespace {

constexpr double kFar = 0.5;  // shares beyond it are no more than a direction: tests are linear

constexpr double kLargestFactor = 10.0;

constexpr size_t kNamedSuspects = 3;

struct Remedy {
  const char* name;  // of an assumption
  const char* key;   // among stated_errors
  const char* text;
};
constexpr Remedy kRemedies[] = {
    {"scale of the pushes", "push_scale",
     "check the unit and the calibration of the force, and the masses"},
    {"lag of the pushes", "push_lag_frames", "check the clocks of forces and cameras"},
    {"height of the pushes", "push_height_m", "check at which height the pushes act"},
    {"zero of the pushes", "push_zero_N", "check what the sensor reads before the push"},
    {"masses", "mass", "check the masses, and the unit of the force"},
    {"frame rate", "frame_rate", "check the frame rate"},
    {"drift of the cameras", "drift_m",
     "check whether positions drift, or people walk before the push"},
    {kReactionDelayName, "reaction_delay_s", "try --delay=one"}};

// The remedy for a quantity of the laboratory; null where the model has it as a parameter.
const Remedy* FindRemedy(const AssumptionTest& test) {
  const auto found = std::find_if(std::begin(kRemedies), std::end(kRemedies),
                                  [&test](const Remedy& r) { return r.name == test.name; });
  return found == std::end(kRemedies) ? nullptr : found;
}

// A value without a unit is a share, or for a held gain the logarithm of a factor.
bool IsLogarithm(const AssumptionTest& test) {
  return test.unit.empty() && FindRemedy(test) == nullptr;
}

// "0.6 +- 0.2 frames", "-3 +- 1 %", "factor 0.74 (0.6 to 0.91)". One Newton step is linear, so a
// factor beyond kLargestFactor is no more than a direction.
std::string ValueText(const AssumptionTest& test) {
  if (IsLogarithm(test)) {
    if (std::abs(test.wanted) > std::log(kLargestFactor)) {
      return test.wanted > 0.0 ? "much larger" : "much smaller";
    }
    return "factor " + Rounded(std::exp(test.wanted), 2) + " (" +
           Rounded(std::exp(test.wanted - test.error), 2) + " to " +
           Rounded(std::exp(test.wanted + test.error), 2) + ")";
  }
  const double factor = test.unit.empty() ? 100.0 : 1.0;
  return Rounded(factor * test.wanted, 2) + " +- " + Rounded(factor * test.error, 2) + " " +
         (test.unit.empty() ? "%" : test.unit);
}

// "+- 3 %", "factor 2".
std::string StatedText(const AssumptionTest& test) {
  if (!(test.stated > 0.0)) return "-";
  if (IsLogarithm(test) && test.stated > std::log(kLargestFactor)) return "any factor";
  if (IsLogarithm(test)) return "factor " + Rounded(std::exp(test.stated), 2);
  return test.unit.empty() ? "+- " + Rounded(100.0 * test.stated, 2) + " %"
                           : "+- " + Rounded(test.stated, 2) + " " + test.unit;
}

// "the lag of the pushes 0.6 +- 0.2 frames larger", "Kd_theta 40 % smaller".
std::string WantedText(const AssumptionTest& test) {
  const bool share = test.unit.empty();
  const double size = std::abs(IsLogarithm(test) ? std::expm1(test.wanted) : test.wanted);
  const double factor = share ? 100.0 : 1.0;
  const std::string how_much = share && size > kFar ? "more than a half"
                                                    : Rounded(factor * size, 2) + " +- " +
                                                          Rounded(factor * test.error, 2) +
                                                          (share              ? " %"
                                                           : test.unit == "1" ? ""
                                                                              : " " + test.unit);
  return test.name + " " + how_much + (test.wanted > 0.0 ? " larger" : " smaller");
}

template <typename Test>
const Test* Surest(const std::vector<Test>& tests) {
  const auto least = std::min_element(tests.begin(), tests.end(),
                                      [](const Test& a, const Test& b) { return a.p < b.p; });
  return least == tests.end() ? nullptr : &*least;
}

// Assumptions that the recordings contradict, the surest first: measured ones; without any, held
// gains; without any, terms that are left out, which can imitate all others.
std::vector<const AssumptionTest*> Suspects(const ModelVerdict& v) {
  if (v.p_assumptions >= kVerdictLevel) return {};
  const double tests = static_cast<double>(v.NumTested());
  std::vector<const AssumptionTest*> kinds[3];
  for (const AssumptionTest& test : v.assumptions) {
    if (test.p * tests >= kVerdictLevel) continue;
    kinds[FindRemedy(test) != nullptr ? 0 : test.stated > 0.0 ? 1 : 2].push_back(&test);
  }
  for (auto& kind : kinds) {
    if (kind.empty()) continue;
    std::sort(kind.begin(), kind.end(),
              [](const AssumptionTest* a, const AssumptionTest* b) { return a->p < b->p; });
    kind.resize(std::min(kind.size(), kNamedSuspects));
    return kind;
  }
  return {};
}

std::string FailureText(const ModelVerdict& v) {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  for (const std::string& finding : v.of_pushes) add(finding);
  const std::vector<const AssumptionTest*> wanted = Suspects(v);
  if (!wanted.empty()) {
    const Remedy* const remedy = FindRemedy(*wanted.front());
    std::string all;
    for (const AssumptionTest* test : wanted)
      all += (all.empty() ? "" : ", or ") + WantedText(*test);
    add("of what is taken as known, the recordings want " + all +
        " (p = " + Rounded(v.p_assumptions, 2) + " after " + std::to_string(v.NumTested()) +
        " tests); " + (remedy != nullptr ? remedy->text : "try --free=" + wanted.front()->name));
  }
  const PartTest* part = Surest(v.parts);
  if (part != nullptr && v.p_parts < kVerdictLevel) {
    add(part->part + " ask for another " + part->parameter + " than all of them (p = " +
        Rounded(v.p_parts, 2) + " after " + std::to_string(v.parts.size()) + " tests)");
    if (part->part == kFromTheSide) text += "; try --directions=body";
  }
  const MotionTest* motion = Surest(v.motion.tests);
  if (motion != nullptr && v.p_motion < kVerdictLevel) {
    const std::string unit = motion->unit.empty() ? "" : " " + motion->unit;
    add(std::string("the recorded ") + motion->quantity + " differs from the predicted one by " +
        Rounded(motion->difference, 2) + " +- " + Rounded(motion->error, 2) + unit + " (p = " +
        Rounded(v.p_motion, 2) + " after " + std::to_string(v.motion.tests.size()) + " tests)");
  }
  if (v.motion.explained < kLeastExplained) {
    add("it explains " + Rounded(100.0 * v.motion.explained, 2) +
        " % of the hip's squared displacement in the median recording");
  }
  return text;
}

std::string CheckText(const ModelVerdict& v, bool more) {
  if (!v.checked()) return "The model was not checked: " + v.not_checked + ".";
  if (v.fails()) {
    return "The model does not fit these recordings: " + FailureText(v) +
           ". Nothing is called identified.";
  }
  return std::string("The model check found no ") + (more ? "other " : "") +
         "contradiction: " + std::to_string(v.NumTested()) +
         " quantities that are taken as known (p = " + Rounded(v.p_assumptions, 2) + "), " +
         CountText(v.parts.size(), "score") +
         " of parts of the data (p = " + Rounded(v.p_parts, 2) + ") and " +
         CountText(v.motion.tests.size(), "measure") +
         " of feet and hips (p = " + Rounded(v.p_motion, 2) + "; each after all tests, " +
         std::to_string(v.freedom) + " degrees of freedom; less than " + Rounded(kVerdictLevel, 2) +
         " contradicts)" +
         (std::isnan(v.motion.explained)
              ? std::string("; the motion was not recorded.")
              : "; it explains " + Rounded(100.0 * v.motion.explained, 3) +
                    " % of the hip's squared displacement in the median "
                    "recording.");
}

}  // namespace

std::string ModelVerdictText(const ModelVerdict& v, bool more) {
  const std::string none =
      v.none_identified.empty() ? "" : "Nothing is identified: " + v.none_identified + ". ";
  return none + CheckText(v, more);
}

std::string StatedErrorKey(const AssumptionTest& test) {
  const Remedy* const remedy = FindRemedy(test);
  return remedy == nullptr ? "" : remedy->key;
}

TextTable AssumptionTable(const FitResult& result) {
  TextTable table({"taken as known", ">stated", ">recordings want", ">t (stated in it)", ">p",
                   "by itself moves most"});
  for (const AssumptionTest& test : result.verdict.assumptions) {
    std::string moves = test.moves.empty() ? "" : "nothing";
    double most = 1e-6;  // standard errors: differences of rollouts round by that
    const size_t known = std::min(test.moves.size(), result.uncertainty.estimates.size());
    for (size_t i = 0; i < known; ++i) {
      const Estimate& e = result.uncertainty.estimates[i];
      if (e.standard_error <= 0.0 || std::abs(test.moves[i]) < most * e.standard_error) continue;
      most = std::abs(test.moves[i]) / e.standard_error;
      // One Newton step is linear: a move beyond the value itself is no more than a direction.
      const ParameterSpec* const spec = result.options.table.Find(e.name);
      const double far = std::max(std::abs(e.value), spec != nullptr ? spec->scale : 0.0);
      moves = e.name + (std::abs(test.moves[i]) > far ? std::string(" by more than its size")
                                                      : " by " + Rounded(test.moves[i], 2) +
                                                            (e.unit == "1" ? "" : " " + e.unit));
    }
    const bool tells = test.error > 0.0;
    table.Add({test.name, StatedText(test), tells ? ValueText(test) : "-",
               tells ? Rounded(test.t, 2) : "-", tells ? Rounded(test.p, 2) : "-", moves});
  }
  return table;
}

}  // namespace pushid
