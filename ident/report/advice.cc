#include "ident/report/advice.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/behaviour.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

// Stands for the recordings where the provenance does not know their place.
constexpr char kSomeManifest[] = "M/manifest.json";
// Stands for the model's file in every command: the same fit in another file has the same advice.
constexpr char kModelFlag[] = "--model=FILE";

bool Holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string ManifestOf(const Provenance& provenance) {
  return provenance.manifest.empty() ? kSomeManifest : provenance.manifest;
}

constexpr double kStrongCorrelation = 0.95;
constexpr double kStrongLeverage = 1.0;  // standard errors that one recording moves
constexpr int kFewRecordings = 10;
constexpr double kTermLevel = 0.001;  // of a score test: seven terms are tested at once
constexpr double kSomeSettling = 10.0, kMuchSettling = 30.0;  // weights to try
constexpr int kManyIterations = 1000;

class Adviser {
 public:
  explicit Adviser(const FittedModel& model) : model_(model), result_(model.fit) {}

  std::vector<Advice> Run() {
    Solver();
    if (const std::string lag = LagText(result_); !lag.empty())
      Add(lag, Same().Set("delay", "one"));
    Identifiability();
    Person();
    People();
    Recordings();
    Intervals();
    Terms();
    return advice_;
  }

 private:
  // A command that was given already says no more.
  void Add(const std::string& sentence, const FitCommand& command) {
    const std::string text = command.ToString();
    const bool given = std::any_of(advice_.begin(), advice_.end(),
                                   [&text](const Advice& a) { return a.command == text; });
    if (!given) advice_.push_back({sentence, text});
  }
  FitCommand Same() const { return FitCommand("pushid-fit", model_.provenance); }
  FitCommand Check() const { return FitCommand::Check(model_.provenance); }
  // A design is printed and kept in no model, but its flag is.
  bool DesignKnown() const { return Holds(model_.provenance.changed_flags, "design"); }
  void Solver() {
    if (!result_.converged) {
      Add("The solver stopped before it converged; allow more iterations.",
          Same().Set("max_iterations", std::to_string(std::max(
                                           kManyIterations, 2 * result_.options.max_iterations))));
    }
  }

  void Identifiability() {
    for (const NullDirection& n : result_.uncertainty.null_directions) {
      Add("Not identifiable: " + n.sentence + ". Fix one of them.",
          Same().Append("fix", n.parameters.back()));
    }
    std::string weak;
    for (const Estimate& e : result_.estimates) {
      if (e.status == EstimateStatus::kAtBound &&
          !IsMeasurementError(result_.options.table.Find(e.name)->id)) {
        Add(e.name +
                " is at its bound, so its error is unknown; check whether the fit gets worse when "
                "it "
                "is fixed there.",
            Same().Append("fix", e.name + "=" + Rounded(e.value, 4)));
      }
      if (e.status == EstimateStatus::kWeak && weak.empty()) weak = e.name;
    }
    if (!weak.empty() && !DesignKnown()) {
      Add(weak +
              " is only weakly identified; find out which pushes, people or sensor would reduce "
              "its "
              "error most.",
          Check().Set("design", weak));
    }
    const Uncertainty& u = result_.uncertainty;
    const int shared = static_cast<int>(result_.options.table.Free().size());
    for (int i = 0; i < std::min<int>(shared, u.correlation.rows()); ++i) {
      for (int j = i + 1; j < std::min<int>(shared, u.correlation.cols()); ++j) {
        if (std::abs(u.correlation(i, j)) < kStrongCorrelation) continue;
        const Estimate& second = u.estimates[j];
        const std::string held = second.name + "=" + Rounded(second.value, 4);
        FitCommand compare("pushid-crossvalidate", model_.provenance);
        compare.Set("compare", "held: --fix=" + compare.Appended("fix", held));
        Add(u.estimates[i].name + " and " + second.name + " trade off (correlation " +
                Rounded(u.correlation(i, j), 2) +
                "); fix one and check whether the prediction errors increase.",
            compare);
      }
    }
  }

  // A settling constraint that is stronger than the fit's.
  FitCommand SettleHarder(double weight) const {
    const double more = std::max(weight, 2.0 * result_.options.settling_weight);
    return Same().Set("settling_weight", Rounded(more, 6));
  }

  FitCommand DecayingModes() const {
    const FitOptions& o = result_.options;
    if (LearnsAlone(o.model)) {
      const double prior =
          o.network_prior > 0.0 ? 0.5 * o.network_prior : FitOptions{}.network_prior;
      return Same().Set("network_prior", Rounded(prior, 6));
    }
    if (o.self_force == SelfForceKind::kLinear) return Same().Set("self_force", "none");
    return Same().Append("prior", "Kp_theta:2000:300");
  }

  void Person() {
    const FitOptions& o = result_.options;
    if (o.likelihood != Likelihood::kTrajectory || IsLarge(o)) return;  // nothing holds them
    const Verdict verdict = VerdictOf(result_.behaviour);
    const std::string sentence = Capitalized(VerdictSentence(verdict, result_.behaviour, o.model));
    const bool tail = o.model.push_tail == PushTail::kExponential;
    switch (verdict) {
      case Verdict::kSettles:
        return;
      case Verdict::kSlowToSettle:
        if (result_.uncertainty.settling.dropped()) return;  // it was held, and let go
        return Add(sentence + "; check the cost of a stronger settling constraint.",
                   SettleHarder(kSomeSettling));
      case Verdict::kSelfPropelling:
        if (result_.uncertainty.settling.dropped()) return;
        if (tail) {
          return Add(sentence + "; strengthen the settling constraint.",
                     SettleHarder(kMuchSettling));
        }
        break;
      case Verdict::kUnstableThoughSettled:
        if (tail) return Add(sentence + "; fit again without what drives it.", DecayingModes());
        break;
      case Verdict::kNegativeDrag:
        if (tail) {
          return Add(sentence + "; check how much accuracy is lost without it.",
                     Same().Append("fix", "mu=0"));
        }
        break;
    }
    Add(sentence + "; add a push tail for the part of the push that was not recorded.",
        Same().Set("push_tail", "exponential"));
  }

  void People() {
    const bool groups = std::any_of(result_.recordings.begin(), result_.recordings.end(),
                                    [](const FittedRecording& r) { return r.people > 1; });
    if (!groups || result_.options.model.interaction.Any()) return;
    Add("Recordings contain several people, but the model has no interaction between them; add "
        "contact.",
        Same().Set("interaction", "contact"));
  }

  void Recordings() {
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
    // A single recording cannot be left out.
    if (most > kStrongLeverage && l.recordings.size() > 1) {
      Add("Recording " + l.recordings[recording] + " alone changes " + l.parameters[parameter] +
              " by " + Rounded(most, 2) + " standard errors; inspect it, and fit without it.",
          Same().Append("leave_out", l.recordings[recording]));
    }
    if (result_.uncertainty.num_clusters < kFewRecordings && !DesignKnown()) {
      const bool people = result_.uncertainty.clustered_by == ClusterBy::kSubject;
      Add("With " + std::to_string(result_.uncertainty.num_clusters) +
              (people ? " people" : " recordings") +
              " the clustered errors are themselves uncertain; record more, as the design "
              "suggests.",
          Check().Set("design", l.parameters.empty() ? std::string("all") : l.parameters.front()));
    }
  }

  void Intervals() {
    if (model_.profiles.empty()) {
      const bool late = Acts(kReactionDelay, result_.options.model);
      Add(late ? "A profile shows how well the data distinguish the delay from damping."
               : "The intervals assume a quadratic cost; profiles show its true shape.",
          Check().Set("profile", late ? "reaction_delay" : "all").Set("num_threads", "2"));
    }
    const bool several = result_.recordings.size() > 1;  // a single one is its only resample
    if (!model_.bootstrap && several) {
      Add("A bootstrap checks the standard errors by resampling the recordings.",
          Check().Set("bootstrap", "199").Set("num_threads", "2"));
    }
  }

  void Terms() {
    const auto explained = [](const Estimate& e) {
      return e.status != EstimateStatus::kIdentified && e.status != EstimateStatus::kFixed;
    };
    const std::vector<Estimate>& all = result_.estimates;
    if (result_.uncertainty.settling.holds() || std::any_of(all.begin(), all.end(), explained))
      return;
    const AssumptionTest* surest = nullptr;  // among the terms that are left out
    for (const AssumptionTest& test : result_.verdict.assumptions) {
      if (test.stated > 0.0 || test.error <= 0.0 || test.p >= kTermLevel) continue;
      if (result_.options.table.Find(test.name) == nullptr) continue;  // no parameter
      if (surest == nullptr || test.p < surest->p) surest = &test;
    }
    if (surest == nullptr) return;
    FitCommand compare("pushid-crossvalidate", model_.provenance);
    compare.Set("compare", "more: --free=" + compare.Appended("free", surest->name));
    Add("The residuals suggest freeing " + surest->name + " (score test: t = " +
            Rounded(surest->t, 2) + " with " + std::to_string(result_.verdict.freedom) +
            " degrees of freedom); check whether it improves predictions.",
        compare);
  }

  const FittedModel& model_;
  const FitResult& result_;
  std::vector<Advice> advice_;
};

}  // namespace

const std::vector<std::string>& CheckFlagNames() {
  static const std::vector<std::string> names = {"profile", "bootstrap", "horizon_check", "design",
                                                 "learn_forecasts"};
  return names;
}

FitCommand FitCommand::Check(const Provenance& provenance) {
  FitCommand command(std::string("pushid-check ") + kModelFlag);
  return command.Set("recordings", ManifestOf(provenance));
}

FitCommand::FitCommand(std::string program, const Provenance& provenance)
    : program_(std::move(program)) {
  Set("recordings", ManifestOf(provenance));
  // The recordings and the model first, the rest by name.
  std::vector<std::string> names = {"setting", "ids", "leave_out", "preset"};
  const std::vector<std::string>& changed = provenance.changed_flags;
  for (const std::string& name : changed) {
    if (!Holds(names, name) && !Holds(CheckFlagNames(), name)) names.push_back(name);
  }
  for (const std::string& name : names) {
    const auto at = provenance.configuration.find(name);
    if (at != provenance.configuration.end() && Holds(changed, name)) Set(name, at->second);
  }
}

std::string FitCommand::Appended(const std::string& flag, const std::string& item) const {
  const auto found = flags_.find(flag);
  return found == flags_.end() || found->second.empty() ? item : found->second + "," + item;
}

void FitCommand::TakeOut(const std::string& flag, const std::string& name, const char* without) {
  const auto list = flags_.find(flag);
  if (list == flags_.end()) return;
  std::string kept;
  bool found = false;
  for (const std::string& item : SplitList(list->second)) {
    const bool it = item.substr(0, item.find('=')) == name;
    found = found || it;
    if (!it) kept += (kept.empty() ? "" : ",") + item;
  }
  if (found) list->second = kept.empty() ? without : kept;
}

FitCommand& FitCommand::Append(const std::string& flag, const std::string& item) {
  if (flag == "fix") {
    const std::string name = item.substr(0, item.find('='));
    TakeOut("fix", name, "");
    TakeOut("free", name, "");
    TakeOut("pool", name, "none");
  }
  return Set(flag, Appended(flag, item));
}

std::string FitCommand::ToString() const {
  std::string text = program_;
  for (const auto& [flag, value] : flags_) text += " --" + flag + "=" + ShellQuoted(value);
  return text;
}

bool NamesModel(const std::string& command) {
  return command.find(kModelFlag) != std::string::npos;
}

std::string CommandFor(const Provenance& provenance, std::string command) {
  const size_t at = command.find(kModelFlag);
  if (at == std::string::npos || provenance.model_file.empty()) return command;
  return command.replace(at, std::strlen(kModelFlag),
                         "--model=" + ShellQuoted(provenance.model_file));
}

std::vector<Advice> Advise(const FittedModel& model) { return Adviser(model).Run(); }

}  // namespace pushid
