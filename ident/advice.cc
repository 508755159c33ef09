// ident: rules from findings to the next command.
#include "ident/advice.h"

#include <algorithm>
#include <cmath>

#include "ident/confidence.h"
#include "ident/report_text.h"

namespace pushid {
namespace {

constexpr double kStrongCorrelation = 0.95;
constexpr double kStrongLeverage = 1.0;  // standard errors that one recording moves
constexpr double kDisagreement = 1.5;    // of interval widths
constexpr int kFewRecordings = 10;
constexpr double kPushDependence = 0.15;  // mean correlation that is more than a detail

// The flags of the fit that are not at their defaults and decide what it finds.
std::string SameFlags(const FitResult& result) {
  std::string command = " --recordings=M/manifest.json";
  for (const char* flag : {"setting", "ids", "preset", "self_force", "posture", "push", "push_tail",
                           "friction", "interaction", "fix", "free", "prior", "pool"}) {
    const auto at = result.configuration.find(flag);
    if (at == result.configuration.end()) continue;
    const std::string& value = at->second;
    const bool is_default = value.empty() || value == "all" || value == "none" ||
                            (std::string(flag) == "preset" && value == "tail");
    if (!is_default) command += " --" + std::string(flag) + "=" + value;
  }
  return command;
}

std::string SameFit(const FitResult& result) { return "pushid-fit" + SameFlags(result); }

// --fix given again would replace the first one: one list holds both.
std::string WithFixed(const FitResult& result, const std::string& assignment) {
  FitResult fixed = result;
  std::string& list = fixed.configuration["fix"];
  list += (list.empty() ? "" : ",") + assignment;
  return SameFit(fixed);
}

class Adviser {
 public:
  explicit Adviser(const FitResult& result) : result_(result), same_(SameFit(result)) {}

  std::vector<Advice> Run() {
    Solver();
    Identifiability();
    Person();
    Recordings();
    Intervals();
    Residuals();
    return advice_;
  }

 private:
  void Add(const std::string& sentence, const std::string& command) {
    advice_.push_back({sentence, command});
  }
  void Solver();
  void Identifiability();
  void Person();
  void Recordings();
  void Intervals();
  void Residuals();

  const FitResult& result_;
  const std::string same_;
  std::vector<Advice> advice_;
};

void Adviser::Solver() {
  if (!result_.converged) {
    Add("The solver stopped before it converged; give it more iterations and more starts.",
        same_ + " --max_iterations=1000 --starts=8");
  }
}

void Adviser::Identifiability() {
  for (const NullDirection& n : result_.uncertainty.null_directions) {
    Add("The data cannot say: " + n.sentence + ". Hold one of them.",
        WithFixed(result_, n.parameters.back()));
  }
  for (const Estimate& e : result_.estimates) {
    if (e.status == EstimateStatus::kAtBound) {
      Add(e.name +
              " stands at its bound, so its error is unknown; see whether the data mind its "
              "being held there.",
          WithFixed(result_, e.name + "=" + Significant(e.value)));
    }
    if (e.status == EstimateStatus::kWeak) {
      Add(e.name + " is only weakly known; ask which further push would tell most about it.",
          same_ + " --design=" + e.name);
    }
  }
  const Uncertainty& u = result_.uncertainty;
  const int shared = static_cast<int>(result_.options.table.Free().size());
  for (int i = 0; i < std::min<int>(shared, u.correlation.rows()); ++i) {
    for (int j = i + 1; j < std::min<int>(shared, u.correlation.cols()); ++j) {
      if (std::abs(u.correlation(i, j)) < kStrongCorrelation) continue;
      const Estimate& second = u.estimates[j];
      Add(u.estimates[i].name + " and " + second.name + " trade off (correlation " +
              Significant(u.correlation(i, j), 2) +
              "); hold one, and see whether the errors of prediction grow.",
          "pushid-crossvalidate" + SameFlags(result_) + " --compare='held: --fix=" + second.name +
              "=" + Significant(second.value) + "'");
    }
  }
}

void Adviser::Person() {
  if (result_.behaviour.self_propelling) {
    Add("The fitted person drives herself; hold the fit to people who stand again, or let a push "
        "tail carry what the recorded push leaves out.",
        same_ + (result_.options.model.push_tail == PushTail::kNone ? " --preset=tail"
                                                                    : " --settling_weight=30"));
  } else if (!result_.behaviour.settles) {
    Add("The fitted person is slow to stand again; see what holding it to settle costs.",
        same_ + " --settling_weight=10");
  }
}

void Adviser::Recordings() {
  const Leverage& l = result_.diagnostics.leverage;
  double most = 0.0;
  size_t recording = 0, parameter = 0;
  for (size_t g = 0; g < l.in_errors.size(); ++g) {
    for (size_t p = 0; p < l.in_errors[g].size(); ++p) {
      if (std::abs(l.in_errors[g][p]) <= most) continue;
      most = std::abs(l.in_errors[g][p]);
      recording = g;
      parameter = p;
    }
  }
  if (most > kStrongLeverage) {
    Add("Recording " + l.recordings[recording] + " alone moves " + l.parameters[parameter] +
            " by " + Significant(most, 2) + " standard errors; look at it, and fit without it.",
        same_ + " --leave_out=" + l.recordings[recording]);
  }
  if (result_.uncertainty.num_clusters < kFewRecordings) {
    Add("With " + std::to_string(result_.uncertainty.num_clusters) +
            " recordings the clustered errors are themselves uncertain; record more, where the "
            "design says it helps.",
        same_ + " --design=" + (l.parameters.empty() ? std::string("all") : l.parameters.front()));
  }
}

void Adviser::Intervals() {
  if (result_.profiles.empty()) {
    Add("The intervals take the cost for quadratic; profiles show its true shape.",
        same_ + " --profile --num_threads=2");
  }
  if (!result_.bootstrap) {
    Add("Resampling the recordings checks the standard errors without any formula.",
        same_ + " --bootstrap=199 --num_threads=2");
  }
  for (const Agreement& row : CompareIntervals(result_)) {
    if (row.ratio <= kDisagreement || !std::isfinite(row.ratio)) continue;
    Add("The intervals of " + row.name + " differ by a factor of " + Significant(row.ratio, 2) +
            " in width: its cost is far from quadratic; quote the widest, and more replicas.",
        same_ + " --bootstrap=999 --num_threads=2");
    break;  // one command serves all
  }
}

void Adviser::Residuals() {
  for (const Whiteness& w : result_.diagnostics.whiteness) {
    for (size_t k = 0; k < w.push.size(); ++k) {
      const double limit = std::max(kPushDependence, 2.0 * w.push_error[k]);
      if (std::abs(w.push[k]) < limit) continue;
      Add("The errors of " + w.channel + " follow the push (correlation " +
              Significant(w.push[k], 2) + " at lag " + std::to_string(k) +
              "): the model misses part of the answer to it; try more terms.",
          same_ + " --self_force=linear");
      return;
    }
  }
}

}  // namespace

std::vector<Advice> Advise(const FitResult& result) { return Adviser(result).Run(); }

}  // namespace pushid
