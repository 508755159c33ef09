// Do default fits recover truths that nobody put beside the priors?
//
//   pushid-known-truth-study --studies=200 --num_threads=2
//   pushid-known-truth-study --groups --studies=20 --num_threads=2
//
// Every study is a set of synthetic recordings of its own truth: each parameter of the preset drawn
// log-uniformly within a factor of two of the priors' centre (a_x within [-18, -4]), 4 to 12 people
// who differ by 10 %, 4 to 8 pushes each, net or external, 1 to 5 mm of noise in every frame, 60 or
// 120 Hz. It is fitted with default flags, and every estimate is compared with what the people were
// drawn around. A person who would fall, or whose recording leaves the domain, makes a new draw.
//
// --groups: rows of four whose feet step. Few truths within a factor of two let a row stand, so
// each parameter is drawn from its prior: coverage tells of errors and pooling, not of priors that
// are wrong.
//
// A run of many minutes, not a unit test; tests/studies/known_truth.py makes a table of what it
// found.
#include <gflags/gflags.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/parameters/presets.h"
#include "ident/problem/parallel.h"
#include "tests/studies/study.h"

DEFINE_int32(studies, 200, "synthetic studies");
DEFINE_bool(groups, false, "rows of four people who touch and whose feet step");
DEFINE_int32(only, -1, "the one study to run");
DEFINE_uint64(seed, 1, "of the first study; the others follow");
DEFINE_double(people_spread, 0.1, "of the gains between people, on a log scale");
DEFINE_bool(noise_at_first_frame, true,
            "whether frame 0, which sets rod and posture, is noisy too");
DEFINE_double(noise, -1.0, "of hip and ankles, m; negative: 1 to 5 mm");
DEFINE_string(options, "", "of the fits, as in '--settling_weight=0'; empty: the defaults");
DEFINE_bool(details, false, "a line for every estimate, on stderr");
DEFINE_int32(num_threads, 2, "threads");

namespace pushid {
namespace {

constexpr double kLeastAx = -18.0, kMostAx = -4.0;
constexpr int kMostDraws = 50;

double LogUniform(Random* random, double low, double high) {
  return std::exp(random->Uniform(std::log(low), std::log(high)));
}

FitOptions Preset() {
  if (!FLAGS_groups) return MakePreset("tail").value();
  FitOptions options = StartPreset("group").value();
  SetStance(Stance::kSteps, &options);
  FreeTerms(&options);
  return options;
}

double DrawOne(const ParameterSpec& spec, Random* random) {
  if (!FLAGS_groups) return spec.nominal * LogUniform(random, 0.5, 2.0);
  return spec.nominal *
         std::exp(random->Normal() * std::min(0.5, spec.prior->sigma / spec.nominal));
}

SyntheticOptions Draw(uint64_t seed) {
  Random random(seed);
  const FitOptions preset = Preset();
  SyntheticOptions study;
  study.model = preset.model;
  for (const ParameterSpec& spec : preset.table.specs) {
    study.parameters[spec.id] = spec.free ? DrawOne(spec, &random) : spec.nominal;
  }
  if (!FLAGS_groups) study.parameters[kAx] = -LogUniform(&random, -kMostAx, -kLeastAx);
  study.push_kind = random.Uniform(0.0, 1.0) < 0.5 ? PushKind::kNet : PushKind::kExternal;
  study.subjects = 4 + static_cast<int>(random.Uniform(0.0, 9.0));
  study.recordings_per_subject = 4 + static_cast<int>(random.Uniform(0.0, 5.0));
  study.fps = random.Uniform(0.0, 1.0) < 0.5 ? 60.0 : 120.0;
  study.frames = static_cast<int>((FLAGS_groups ? 2.0 : 1.2) * study.fps);
  if (FLAGS_groups) study.people_in_row = 4;
  study.joint_noise_m = random.Uniform(0.001, 0.005);
  study.noise_at_first_frame = FLAGS_noise_at_first_frame;
  if (FLAGS_noise >= 0.0) study.joint_noise_m = FLAGS_noise;
  study.subject_spread = FLAGS_people_spread;
  study.seed = seed;
  return study;
}

// By status: how many, and how many intervals held the truth.
struct Tally {
  std::map<EstimateStatus, std::pair<int, int>> by_status;
};

struct Study {
  std::map<Parameter, Tally> tallies;
  int fitted = 0, failed = 0;
  double seconds = 0.0;
};

GivenOptions Given() {
  // Feet of synthetic people never leave the ground, so that nothing tells that they step.
  return OrExit(ParseOptionWords(FLAGS_options + (FLAGS_groups ? " --stance=steps" : "")));
}

void Judge(int index, std::mutex* mutex, Study* all) {
  const uint64_t first = (FLAGS_seed * 100000 + static_cast<uint64_t>(index)) * kMostDraws;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const SyntheticOptions study = Draw(first + static_cast<uint64_t>(draw));
    const auto made = MakeSyntheticRecordings(study);
    if (!made.ok()) continue;
    const std::vector<PendulumRecording> recordings =
        MakePendulumRecordings(Recordings(made.value()));
    FitOptions options = OrExit(MakeFitOptions(Given(), &recordings));
    const MaybeError unprepared = PrepareFit(recordings, &options);
    const FitResult result = unprepared ? FitResult() : Fit(recordings, options);
    const std::lock_guard<std::mutex> lock(*mutex);
    if (!result.ok()) {
      ++all->failed;
      return;
    }
    ++all->fitted;
    all->seconds += result.solve_seconds;
    if (FLAGS_details) {
      std::fprintf(
          stderr,
          "%d sigmas %.4g m, %.4g m/s, %.4g rad, %.4g rad/s; %.3g frames a frame; settles %d\n",
          index, result.options.sigmas.hip, result.options.sigmas.velocity,
          result.options.sigmas.angle, result.options.sigmas.rate, result.options.effective_weight,
          result.behaviour.settles);
    }
    for (const Estimate& e : result.estimates) {
      if (e.status == EstimateStatus::kFixed) continue;
      const Parameter id = result.options.table.Find(e.name)->id;
      const double truth = study.parameters[id];
      const bool holds = e.lower95 <= truth && truth <= e.upper95;
      auto& [count, held] = all->tallies[id].by_status[e.status];
      ++count;
      held += holds;
      if (!FLAGS_details) continue;
      std::fprintf(
          stderr,
          "%d %s people %d noise %.4f fps %.0f %s truth %.4g value %.4g error %.3g df %.1f "
          "data %.2f settling %.2f pull %.2f %s %s\n",
          index, study.push_kind == PushKind::kNet ? "net" : "ext", study.subjects,
          study.joint_noise_m, study.fps, e.name.c_str(), truth, e.value, e.standard_error,
          e.freedom, e.shares.data, e.shares.settling,
          (e.shares.prior_pull + e.shares.settling_pull) / e.standard_error,
          NameOf(e.status).c_str(), holds ? "held" : "MISSED");
    }
    return;
  }
  const std::lock_guard<std::mutex> lock(*mutex);
  ++all->failed;
}

std::string Cell(const Tally& tally, EstimateStatus status) {
  const auto found = tally.by_status.find(status);
  if (found == tally.by_status.end()) return "0";
  const auto& [count, held] = found->second;
  char text[48];
  std::snprintf(text, sizeof text, "%d: %.1f", count, 100.0 * held / count);
  return text;
}

int Run() {
  Study all;
  std::mutex mutex;
  ParallelFor(
      FLAGS_studies, FLAGS_num_threads,
      [&](int i) {
        if (FLAGS_only < 0 || FLAGS_only == i) Judge(i, &mutex, &all);
      },
      [](int done, int total) {
        if (done % 20 == 0) std::fprintf(stderr, "study %d of %d\n", done, total);
      });
  const std::vector<EstimateStatus> statuses = {
      EstimateStatus::kIdentified, EstimateStatus::kModelDependent, EstimateStatus::kWeak,
      EstimateStatus::kPriorHeld,  EstimateStatus::kUnidentifiable, EstimateStatus::kAtBound};
  std::vector<std::string> header = {"estimates: intervals that hold the truth, %"};
  for (EstimateStatus status : statuses) header.push_back(NameOf(status));
  TextTable table = TextTable::OfNumbers(header);
  Tally sum;
  for (const auto& [id, tally] : all.tallies) {
    std::vector<std::string> row = {std::string(kParameterNames[id])};
    for (EstimateStatus status : statuses) {
      row.push_back(Cell(tally, status));
      const auto found = tally.by_status.find(status);
      if (found == tally.by_status.end()) continue;
      sum.by_status[status].first += found->second.first;
      sum.by_status[status].second += found->second.second;
    }
    table.Add(row);
  }
  std::vector<std::string> row = {"all"};
  for (EstimateStatus status : statuses) row.push_back(Cell(sum, status));
  table.Add(row);
  std::printf("%s%d studies fitted, %d not; %.2f s of solving each; spread %g, seed %d\n",
              table.ToString().c_str(), all.fitted, all.failed,
              all.seconds / std::max(1, all.fitted), FLAGS_people_spread,
              static_cast<int>(FLAGS_seed));
  return 0;
}

}  // namespace
}  // namespace pushid

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  return pushid::Run();
}
