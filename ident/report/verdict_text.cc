// ident: sentences and tables of a verdict.
#include "ident/report/verdict_text.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

struct Remedy {
  const char* name;  // of an assumption
  const char* text;
};
constexpr Remedy kRemedies[] = {
    {"scale of the pushes", "check the unit and the calibration of the force, and the masses"},
    {"lag of the pushes", "check the clocks; pushid-push --estimate_offset estimates an offset"},
    {"height of the pushes", "check at which height the pushes act"},
    {"reaction delay", "see the delay that the literature gives, 0.1 to 0.2 s"},
    {"zero of the pushes", "check what the sensor reads before the push"},
    {"masses", "check the masses, and the unit of the force"},
    {"frame rate", "check the frame rate"},
    {"drift of the cameras", "check whether positions drift, or people walk before the push"}};

std::string RemedyOf(const std::string& name) {
  const auto found = std::find_if(std::begin(kRemedies), std::end(kRemedies),
                                  [&name](const Remedy& r) { return r.name == name; });
  return found != std::end(kRemedies) ? found->text : "try --free=" + name;
}

// "the lag of the pushes 0.6 +- 0.2 frames larger", "Kd_theta 40 % smaller".
std::string WantedText(const AssumptionTest& test) {
  const bool share = test.unit.empty();
  // Of a held gain it is a logarithm, of the others a share: alike where they are small.
  const double size = std::abs(test.wanted), factor = share ? 100.0 : 1.0;
  return test.name + " " + Rounded(factor * size, 2) + " +- " + Rounded(factor * test.error, 2) +
         (share ? " %" : " " + test.unit) + (test.wanted > 0.0 ? " larger" : " smaller");
}

template <typename Test>
const Test* Surest(const std::vector<Test>& tests) {
  const auto least = std::min_element(tests.begin(), tests.end(),
                                      [](const Test& a, const Test& b) { return a.p < b.p; });
  return least == tests.end() ? nullptr : &*least;
}

std::string FailureText(const ModelVerdict& v) {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  const AssumptionTest* known = Surest(v.assumptions);
  if (known != nullptr && v.p_assumptions < kVerdictLevel) {
    text = "the recordings want " + WantedText(*known) +
           " than it was taken (p = " + Rounded(v.p_assumptions, 2) + " after " +
           std::to_string(v.assumptions.size()) + " tests); " + RemedyOf(known->name);
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
    add("it explains " + Rounded(100.0 * v.motion.explained, 2) + " % of the hips' squared way");
  }
  if (known != nullptr && v.p_assumptions >= kVerdictLevel) {
    text +=
        "; most likely of what was taken as known: " + known->name + ", " + RemedyOf(known->name);
  }
  return text;
}

}  // namespace

std::string ModelVerdictText(const ModelVerdict& v) {
  if (!v.checked()) return "The model was not checked: " + v.not_checked + ".";
  if (v.fails()) {
    return "The model does not fit these recordings: " + FailureText(v) +
           ". Estimates are model-dependent.";
  }
  return "The model check found nothing: " + std::to_string(v.assumptions.size()) +
         " quantities that are taken as known (p = " + Rounded(v.p_assumptions, 2) + "), " +
         std::to_string(v.parts.size()) +
         " scores of parts of the data (p = " + Rounded(v.p_parts, 2) + ") and " +
         std::to_string(v.motion.tests.size()) +
         " measures of feet and hips (p = " + Rounded(v.p_motion, 2) + "; each after all tests, " +
         std::to_string(v.freedom) + " degrees of freedom); it explains " +
         Rounded(100.0 * v.motion.explained, 3) + " % of the hips' squared way.";
}

TextTable AssumptionTable(const FitResult& result) {
  TextTable table({"taken as known", "stated", "recordings want", "t", "p", "moves most"},
                  {true, false, false, false, false, true});
  for (const AssumptionTest& test : result.verdict.assumptions) {
    const std::string unit = test.unit.empty() ? "" : " " + test.unit;
    std::string moves;
    double most = 0.0;
    for (size_t i = 0; i < test.moves.size(); ++i) {
      const Estimate& e = result.uncertainty.estimates[i];
      if (e.standard_error <= 0.0 || std::abs(test.moves[i]) < most * e.standard_error) continue;
      most = std::abs(test.moves[i]) / e.standard_error;
      moves = e.name + " by " + Rounded(test.moves[i], 2) + (e.unit == "1" ? "" : " " + e.unit);
    }
    const bool tells = test.error > 0.0;
    table.Add({test.name, test.stated > 0.0 ? "+- " + Rounded(test.stated, 2) + unit : "-",
               tells ? Rounded(test.wanted, 2) + " +- " + Rounded(test.error, 2) + unit : "-",
               tells ? Rounded(test.t, 2) : "-", tells ? Rounded(test.p, 2) : "-", moves});
  }
  return table;
}

}  // namespace pushid
