// Do contrasts cover the truth, and how often do they find a difference where there is none?
//
//   pushid-contrast-study --studies=200 --num_threads=2
//
// Every study is two sets of synthetic recordings with 1 mm of noise in every frame and pushes that
// are measured completely, fitted with --contrast and otherwise default flags (or --options).
// Between people: --people people with one value of the label and as many with the other, five
// pushes each. Paired: --people people, five pushes each with both values. The gains of people
// differ by 15 % (1 sigma), and what a condition changes of them by another 5 %, so that no two
// people answer alike. In half of the studies nothing differs on average; in the other half the
// drag, the stiffness and the cross term do, by 30 to 40 %, and the damping does not. The truth is
// that of the mean person. tests/studies/contrast.py makes a table of what it found.
#include <gflags/gflags.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <numeric>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/problem/parallel.h"
#include "ident/problem/statistics.h"
#include "tests/studies/study.h"

DEFINE_int32(studies, 200, "synthetic studies of each kind");
DEFINE_int32(people, 8, "in each group; paired: in both");
DEFINE_uint64(seed, 1, "of the first study; the others follow");
DEFINE_string(options, "",
              "of the fits, as in '--pool=all --pool_by=subject'; empty: the defaults");
DEFINE_int32(num_threads, 2, "threads");

namespace pushid {
namespace {

constexpr int kPushes = 5;  // of a person in a condition
constexpr double kPeopleSpread = 0.15, kResponseSpread = 0.05;
constexpr int kMostDraws = 20;
constexpr const char* kValues[] = {"a", "b"};

// Logarithms of the ratio of b to a.
const std::map<Parameter, double>& Differences() {
  static const std::map<Parameter, double> differences = {
      {kMu, std::log(1.4)}, {kKpTheta, std::log(1.3)}, {kAx, std::log(1.3)}};
  return differences;
}

struct Kind {
  const char* name;
  bool paired, differs;
};
constexpr Kind kKinds[] = {{"between people, no difference", false, false},
                           {"between people, a difference", false, true},
                           {"paired, no difference", true, false},
                           {"paired, a difference", true, true}};

ParameterSet<double> TruthOf(const Kind& kind, int value) {
  ParameterSet<double> truth = PublishedTailParameters();
  if (!kind.differs) return truth;
  for (const auto& [id, ratio] : Differences()) truth[id] *= std::exp((value - 0.5) * ratio);
  return truth;
}

ParameterSet<double> Varied(ParameterSet<double> p, double spread, Random* random) {
  for (double& value : p) value *= std::exp(spread * random->Normal());
  return p;
}

// Pushes of one person in one condition. Error: somebody falls.
Result<std::vector<Recording>> OfPerson(const Kind& kind, const std::string& person, int value,
                                        double mass, double rod, const ParameterSet<double>& own,
                                        Random* random) {
  SyntheticOptions study;
  study.subjects = 1;
  study.recordings_per_subject = kPushes;
  study.frames = 90;
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.001;
  study.min_mass_kg = study.max_mass_kg = mass;
  study.min_rod_m = study.max_rod_m = rod;
  study.seed = random->Fork();
  study.parameters = Varied(own, kResponseSpread, random);
  const ParameterSet<double> truth = TruthOf(kind, value), published = PublishedTailParameters();
  for (int i = 0; i < kNumParameters; ++i) {
    if (published[i] != 0.0) study.parameters[i] *= truth[i] / published[i];
  }
  const auto made = MakeSyntheticRecordings(study);
  if (!made.ok()) return made.error();
  std::vector<Recording> recordings = Recordings(made.value());
  for (Recording& recording : recordings) {
    recording.id = person + kValues[value] + "_" + recording.id;
    recording.people[0].subject_id = person;
    recording.labels.Set("group", kValues[value]);
  }
  return recordings;
}

Result<std::vector<PendulumRecording>> Draw(const Kind& kind, uint64_t seed) {
  Random random(seed);
  std::vector<Recording> all;
  const int people = kind.paired ? FLAGS_people : 2 * FLAGS_people;
  for (int s = 0; s < people; ++s) {
    const double mass = random.Uniform(55.0, 105.0), rod = random.Uniform(0.82, 1.02);
    const ParameterSet<double> own = Varied(PublishedTailParameters(), kPeopleSpread, &random);
    for (int value = 0; value < 2; ++value) {
      if (!kind.paired && value != s % 2) continue;
      auto made = OfPerson(kind, "P" + std::to_string(s), value, mass, rod, own, &random);
      if (!made.ok()) return made.error();
      for (Recording& recording : made.value()) all.push_back(std::move(recording));
    }
  }
  return MakePendulumRecordings(all);
}

struct Tally {
  int studies = 0, held = 0, below = 0;  // p < 0.05
  int two_stage = 0;                     // p < 0.05 by a t-test on people's own fits
};

// Everybody's own estimates by person and value: the first stage of a test in two stages.
using OwnFits = std::map<std::string, std::map<std::string, ParameterSet<double>>>;

Result<OwnFits> FitEverybody(const std::vector<PendulumRecording>& recordings) {
  std::map<std::pair<std::string, std::string>, std::vector<PendulumRecording>> apart;
  for (const PendulumRecording& r : recordings) {
    apart[{r.subject_ids[0], LabelOf(r, 0, "group")}].push_back(r);
  }
  OwnFits fits;
  for (const auto& [of, own] : apart) {
    FitOptions options = OrExit(MakeFitOptions(OrExit(ParseOptionWords("")), &own));
    if (MaybeError error = PrepareFit(own, &options)) return *error;
    const FitResult result = Fit(own, options);
    if (!result.ok()) return Error{"not fitted"};
    fits[of.first][of.second] = result.parameters;
  }
  return fits;
}

double VarianceOf(const std::vector<double>& values, double mean) {
  double sum = 0.0;
  for (double v : values) sum += (v - mean) * (v - mean);
  return sum / (static_cast<double>(values.size()) - 1.0);
}

double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The second stage: Student's t-test, paired where people have both values.
double TwoStageProbability(const OwnFits& fits, const ParameterSpec& spec, bool paired) {
  std::vector<double> a, b;
  for (const auto& [person, by_value] : fits) {
    const auto value = [&](const char* name) {
      return ToFitted(spec.transform, by_value.at(name)[spec.id]);
    };
    if (paired) {
      a.push_back(value("b") - value("a"));
    } else if (by_value.count("a") > 0) {
      a.push_back(value("a"));
    } else {
      b.push_back(value("b"));
    }
  }
  const double mean_a = MeanOf(a), n = static_cast<double>(a.size());
  const double var_a = VarianceOf(a, mean_a);
  if (paired) return StudentTail(std::abs(mean_a) / std::sqrt(var_a / n), n - 1.0);
  const double mean_b = MeanOf(b), m = static_cast<double>(b.size());
  const double pooled = ((n - 1.0) * var_a + (m - 1.0) * VarianceOf(b, mean_b)) / (n + m - 2.0);
  return StudentTail(std::abs(mean_b - mean_a) / std::sqrt(pooled * (1.0 / n + 1.0 / m)),
                     n + m - 2.0);
}

struct Found {
  std::map<std::string, Tally> by_parameter;
  // Rejections by Holm's p of what does not differ, and of what does.
  int studies = 0, failed = 0, false_families = 0, differing = 0, detected = 0;
};

GivenOptions Given() { return OrExit(ParseOptionWords("--contrast=group " + FLAGS_options)); }

void Judge(const Kind& kind, int index, std::mutex* mutex, Found* found) {
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const uint64_t seed = (FLAGS_seed * 100000 + static_cast<uint64_t>(index)) * kMostDraws + draw;
    const auto recordings = Draw(kind, seed);
    if (!recordings.ok()) continue;
    FitOptions options = OrExit(MakeFitOptions(Given(), &recordings.value()));
    const MaybeError unprepared = PrepareFit(recordings.value(), &options);
    const FitResult result = unprepared ? FitResult() : Fit(recordings.value(), options);
    const auto everybody = FitEverybody(recordings.value());
    const std::lock_guard<std::mutex> lock(*mutex);
    if (!result.ok() || !result.contrast || !everybody.ok()) break;
    ++found->studies;
    const ParameterSet<double> a = TruthOf(kind, 0), b = TruthOf(kind, 1);
    bool any_false = false;
    for (const ContrastRow& row : result.contrast->rows) {
      const Parameter id = result.options.table.Find(row.name)->id;
      const double truth = b[id] - a[id];
      Tally& tally = found->by_parameter[row.name];
      ++tally.studies;
      tally.held += row.lower95 <= truth && truth <= row.upper95;
      tally.below += row.p < 0.05;
      tally.two_stage +=
          TwoStageProbability(everybody.value(), result.options.table[id], kind.paired) < 0.05;
      any_false = any_false || (truth == 0.0 && row.p_holm < 0.05);
      found->differing += truth != 0.0;
      found->detected += truth != 0.0 && row.p_holm < 0.05;
    }
    found->false_families += any_false;
    return;
  }
  const std::lock_guard<std::mutex> lock(*mutex);
  ++found->failed;
}

int Run() {
  TextTable table({"study", "parameter", ">intervals that hold the truth, %", ">p < 0.05, %",
                   ">t-test on single fits: p < 0.05, %"});
  std::string told;
  int failed = 0;
  for (const Kind& kind : kKinds) {
    Found found;
    std::mutex mutex;
    ParallelFor(FLAGS_studies, FLAGS_num_threads, [&](int i) { Judge(kind, i, &mutex, &found); },
                {});
    Tally sum;
    const auto add = [&](const std::string& name, const Tally& t) {
      table.Add({kind.name, name, Percent(t.held, t.studies), Percent(t.below, t.studies),
                 Percent(t.two_stage, t.studies)});
    };
    for (const auto& [name, tally] : found.by_parameter) {
      add(name, tally);
      sum.studies += tally.studies;
      sum.held += tally.held;
      sum.below += tally.below;
      sum.two_stage += tally.two_stage;
    }
    add("all", sum);
    failed += found.failed;
    told += std::string(told.empty() ? "" : "; ") + kind.name +
            ": some false difference by Holm's p in " +
            Percent(found.false_families, found.studies) + " % of the studies";
    if (found.differing > 0) {
      told += ", true ones found in " + Percent(found.detected, found.differing) + " %";
    }
  }
  std::printf("%s%d studies of each kind, %d not fitted. %s\n", table.ToString().c_str(),
              FLAGS_studies, failed, told.c_str());
  return 0;
}

}  // namespace
}  // namespace pushid

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  return pushid::Run();
}
