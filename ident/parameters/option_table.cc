// ident: the rows of weights, solver and table.
#include "ident/parameters/option_table.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/option_row_makers.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
using Row = FitOptionRow;

constexpr std::int64_t kLongestHorizon = 1000000;  // frames

MaybeError ReadHorizons(const std::string& text, FitOptions* o) {
  o->horizons.clear();
  for (const std::string& part : SplitList(text)) {
    std::int64_t frames = 0;
    if (!ParseInteger(part, &frames) || frames < 2 || frames > kLongestHorizon) {
      return Error{"--horizons: '" + part + "' is not a number of frames of at least 2"};
    }
    o->horizons.push_back(static_cast<int>(frames));
  }
  o->horizons.push_back(0);
  return std::nullopt;
}

Row HorizonsRow() {
  Row row =
      WordsRow("horizons", OptionStage::kModel,
               "frames of the stages before all frames, from the first push on, comma-separated",
               ReadHorizons);
  row.text = [](const FitOptions& o) {
    std::string text;
    for (int frames : o.horizons) {
      if (frames > 0) text += (text.empty() ? "" : ",") + std::to_string(frames);
    }
    return text;
  };
  row.violation = [](const FitOptions& o) {
    const bool sound = std::all_of(o.horizons.begin(), o.horizons.end(),
                                   [](int frames) { return frames == 0 || frames >= 2; });
    return sound ? "" : "must be numbers of frames of at least 2";
  };
  row.json = "/horizons";
  row.write = [](const FitOptions& o) { return Json(o.horizons); };
  row.read = [](const Json& json, FitOptions* o) { o->horizons = json.get<std::vector<int>>(); };
  return row;
}

Row LossRow() {
  Row row = NameRow<FrameLoss>(
      "loss", "/sigmas/loss", &ResidualSigmas::loss,
      "what is minimized: hip (positions of the hip, velocities, angles and rates, robust by "
      "frame), or ldp (LDP's Eq. 6: absolute errors of all states and velocities, but for the rate "
      "of phi, which is itself held small)");
  row.apply = [](const std::string& text, FitOptions* o) -> MaybeError {
    FrameLoss loss;
    if (MaybeError error = ParseName("--loss", text, &loss)) return error;
    if (loss == o->sigmas.loss) return std::nullopt;
    o->sigmas = loss == FrameLoss::kLdp ? kLdpSigmas : ResidualSigmas();
    // Estimated, they would no longer be those of LDP.
    o->sigma_source = loss == FrameLoss::kLdp ? SigmaSource::kFixed : FitOptions().sigma_source;
    return std::nullopt;
  };
  return MayBeAbsent(row);
}

Row SeedRow() {
  Row row = WordsRow("seed", OptionStage::kModel, "seed of all random numbers",
                     [](const std::string& text, FitOptions* o) -> MaybeError {
                       const char* const end = text.data() + text.size();
                       const auto read = std::from_chars(text.data(), end, o->seed);
                       if (read.ec != std::errc() || read.ptr != end) {
                         return BadOption("seed", text, "must be a whole number of at least 0");
                       }
                       return std::nullopt;
                     });
  row.text = [](const FitOptions& o) { return std::to_string(o.seed); };
  row.json = "/seed";
  row.write = [](const FitOptions& o) { return Json(o.seed); };
  row.read = [](const Json& json, FitOptions* o) { o->seed = json; };
  return row;
}

constexpr char kEstimate[] = "estimate";

Row PoolingSigmaRow() {
  const auto text = [](const FitOptions& o) {
    return o.pooling_sigma ? DoubleText(*o.pooling_sigma) : std::string(kEstimate);
  };
  const auto apply = [](const std::string& given, FitOptions* o) -> MaybeError {
    double sigma = 0.0;
    o->pooling_sigma.reset();
    if (given == kEstimate) return std::nullopt;
    if (!ParseDouble(given, &sigma) || !(sigma > 0.0)) {
      return BadOption("pooling_sigma", given, "must be positive, or estimate");
    }
    o->pooling_sigma = sigma;
    return std::nullopt;
  };
  Row row = WordsRow("pooling_sigma", OptionStage::kModel,
                     "how far a unit may deviate from the shared value: a standard deviation on "
                     "the fitted scale (0.2 is about 20 % for a positive parameter), or estimate",
                     apply);
  row.text = text;
  row.json = "/pooling_sigma";
  row.write = [](const FitOptions& o) {
    return o.pooling_sigma ? Json(*o.pooling_sigma) : Json(kEstimate);
  };
  row.read = [](const Json& json, FitOptions* o) {
    o->pooling_sigma.reset();
    if (json != kEstimate) o->pooling_sigma = json.get<double>();
  };
  row.preset_decides = true;
  return row;
}

Row PoolByRow() {
  Row row = WordsRow("pool_by", OptionStage::kModel,
                     "what pooled parameters may differ by: subject, setting, condition or any "
                     "other label of the manifest; a recording without the label takes its setting",
                     [](const std::string& given, FitOptions* o) -> MaybeError {
                       if (given.empty()) {
                         return BadOption("pool_by", given, "must be subject or a label");
                       }
                       o->pool_by = given;
                       return std::nullopt;
                     });
  row.text = [](const FitOptions& o) { return o.pool_by; };
  row.json = "/pool_by";
  row.write = [](const FitOptions& o) { return Json(o.pool_by); };
  row.read = [](const Json& json, FitOptions* o) { o->pool_by = json.get<std::string>(); };
  return row;
}

Row Rare(Row row) {
  row.heading = kRarelyChanged;
  return row;
}

// How the recordings, the priors and the demands on the person weigh.
std::vector<Row> WeightRows() {
  using O = FitOptions;
  return {
      LossRow(),
      Rare(NumberRow("sigma_hip", "/sigmas/hip_m", &ResidualSigmas::hip, kPositive,
                     "standard deviation of the hip's position, m")),
      Rare(NumberRow("sigma_velocity", "/sigmas/velocity_m_s", &ResidualSigmas::velocity, kPositive,
                     "standard deviation of the cart's velocity, m/s")),
      Rare(NumberRow("sigma_angle", "/sigmas/angle_rad", &ResidualSigmas::angle, kPositive,
                     "standard deviation of the angles, rad")),
      Rare(NumberRow("sigma_rate", "/sigmas/rate_rad_s", &ResidualSigmas::rate, kPositive,
                     "standard deviation of the angular rates, rad/s")),
      MayBeAbsent(NameRow<SigmaSource>(
          "sigmas", "/sigmas/source", &O::sigma_source,
          "the residuals' standard deviations: estimate (from the residuals, starting at "
          "--sigma_*), or fixed (at --sigma_*)")),
      Rare(MayBeAbsent(NumberRow(
          "marker_noise", "/sigmas/marker_noise_m", &O::marker_noise, kPositive,
          "standard deviation of a marker's position, m: lower limit of estimated sigmas"))),
      NumberRow("robust", "/sigmas/robust", &ResidualSigmas::robust, kNotNegative,
                "pseudo-Huber scale of a frame in sigmas; 0: plain least squares"),
      NameRow<RecordingWeight>(
          "recording_weight", "/recording_weight", &O::recording_weight,
          "weight of a recording: effective (its number of independent frames), frame (every frame "
          "counts as one) or recording (every recording counts as one frame)"),
      Rare(MayBeAbsent(NumberRow(
          "effective_weight", "/effective_weight", &O::effective_weight,
          {0.0, 1e6, false, "must be a number from 0 to 1e6"},
          "--recording_weight=effective: independent frames per frame at the start of their "
          "estimation; 0: one frame per recording"))),
      MayBeAbsent(NameRow<ClusterBy>(
          "cluster", "/cluster", &O::cluster,
          "unit with independent errors: subject, recording, or auto (subject where people were "
          "recorded more than once)")),
      Decided(
          NumberRow("settling_weight", "/settling_weight", &O::settling_weight, kNotNegative,
                    "weight of the settling constraint (pushed people must settle in the settling "
                    "simulations); 0: off")),
      Decided(NumberRow("mode_weight", "/mode_weight", &O::mode_weight, kNotNegative,
                        "weight of the hinge penalty that makes a person's free modes at rest "
                        "decay by 0.2 1/s (it "
                        "ignores networks); 0: off; set with a linear self force")),
      Decided(PoolByRow()),
      PoolingSigmaRow(),
  };
}

// Where the solve starts and ends.
std::vector<Row> SolverRows() {
  using O = FitOptions;
  return {
      HorizonsRow(),
      CountRow("starts", "/num_starts", &O::num_starts, "number of starts; the best one is used"),
      NumberRow("start_spread", "/start_spread", &O::start_spread,
                {1.0, 1000.0, false, "must lie between 1 and 1000"},
                "random starts multiply or divide every gain by up to this"),
      SeedRow(),
      CountRow("num_threads", "", &O::num_threads, "threads"),
      CountRow("max_iterations", "/max_iterations", &O::max_iterations, "iterations of each stage"),
      Decided(NumberRow("function_tolerance", "/function_tolerance", &O::function_tolerance,
                        kNotNegative, "relative change of the cost that ends a stage")),
      NumberRow("gradient_tolerance", "/gradient_tolerance", &O::gradient_tolerance, kNotNegative,
                "gradient that ends a stage"),
      NumberRow("parameter_tolerance", "/parameter_tolerance", &O::parameter_tolerance,
                kNotNegative, "relative step that ends a stage"),
  };
}

}  // namespace

const std::vector<FitOptionRow>& FitOptionRows() {
  static const std::vector<FitOptionRow> rows = [] {
    std::vector<FitOptionRow> all;
    const auto add = [&all](const std::string& heading, const std::vector<FitOptionRow>& part) {
      for (const FitOptionRow& row : part) {
        all.push_back(row);
        if (row.heading.empty()) all.back().heading = heading;
      }
    };
    add("model", ModelOptionRows());
    add("fit", WeightRows());
    add("fit", NetworkOptionRows());
    add(kRarelyChanged, SolverRows());
    add("model", TableOptionRows());
    return all;
  }();
  return rows;
}

const FitOptionRow* FindFitOption(const std::string& name) {
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

}  // namespace pushid
