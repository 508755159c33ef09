// ident: sampled groups against what they did.
#include "ident/forecasts/group_forecasts.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

void AddSpread(const MotionGenerator& generator, const BodyRecording& recording,
               const GroupHips& hips, int observed, const NormalSource& normal,
               GroupSpread* spread) {
  const std::vector<ObservedMotion> whole = GroupOf(recording, hips);
  std::vector<ObservedMotion> people = whole;
  for (ObservedMotion& person : people) {
    person.frames = Trajectories(person.frames.leftCols(observed));
  }
  const int after = recording.num_frames() - observed;
  const auto futures = generator.Sample(people, after, spread->samples, normal);
  for (size_t n = 0; n < people.size(); ++n) {
    for (int t = 0; t < after; ++t) {
      float low = futures[n].front().motion(0, t), high = low;
      for (const SampledFuture& future : futures[n]) {
        low = std::min(low, future.motion(0, t));
        high = std::max(high, future.motion(0, t));
      }
      const float recorded = whole[n].frames(0, observed + t);
      spread->inside_sum += recorded >= low && recorded <= high ? 1.0 : 0.0;
      spread->width_sum += high - low;
      spread->frames += 1.0;
    }
  }
}

nlohmann::ordered_json ToJson(const GroupSpread& spread) {
  return {{"samples", spread.samples},
          {"hip_x_inside", spread.Inside()},
          {"hip_x_width_m", spread.Width()}};
}

std::string SpreadText(const GroupSpread& spread) {
  const double ideal = (spread.samples - 1.0) / (spread.samples + 1.0);
  return "the recorded hip lies among " + std::to_string(spread.samples) + " sampled futures in " +
         Rounded(100.0 * spread.Inside(), 3) + " % of frames (" + Rounded(100.0 * ideal, 3) +
         " % if their spread is correct); they are " + Rounded(spread.Width(), 3) + " m wide\n";
}

namespace {

int FramesOfSecond(const GroupMotion& group) {
  return static_cast<int>(std::lround(1.0 / group.dt));
}

// As long as the shortest forecast.
int WholeSeconds(const std::vector<GroupMotion>& groups) {
  int seconds = groups.empty() ? 0 : INT_MAX;
  for (const GroupMotion& group : groups) {
    const int frames = static_cast<int>(group.people.front().size()) - group.first_frame;
    seconds = std::min(seconds, frames / FramesOfSecond(group));
  }
  return seconds;
}

// Sums over people and frames of the hips' speed, and over people of their way.
struct Hips {
  double speed = 0.0, way = 0.0, frames = 0.0, people = 0.0;
};
void AddHips(const GroupMotion& group, int second, Hips* hips) {
  const int of_second = FramesOfSecond(group);
  const int known = group.first_frame - 1, begin = known + second * of_second;
  const auto at = [](const Pose& pose) -> Eigen::Vector2d { return pose.col(kBodyHip).head<2>(); };
  for (const BodyMotion& person : group.people) {
    for (int t = begin + 1; t <= begin + of_second; ++t) {
      hips->speed += (at(person[t]) - at(person[t - 1])).norm() / group.dt;
      hips->frames += 1.0;
    }
    hips->way += (at(person[begin + of_second]) - at(person[known])).norm();
    hips->people += 1.0;
  }
}

}  // namespace

std::vector<ForecastSecond> BySecond(const std::vector<GroupMotion>& recorded,
                                     const std::vector<GroupMotion>& forecast,
                                     const StateFunction& states) {
  std::vector<ForecastSecond> seconds(WholeSeconds(forecast));
  const std::vector<SecondOfStates> by_second =
      CompareStatesBySecond(recorded, forecast, static_cast<int>(seconds.size()), states);
  for (size_t s = 0; s < seconds.size(); ++s) {
    Hips hips;
    for (const GroupMotion& group : forecast) AddHips(group, static_cast<int>(s), &hips);
    seconds[s] = {hips.speed / hips.frames, hips.way / hips.people, by_second[s].standing,
                  by_second[s].sscp};
  }
  return seconds;
}

nlohmann::ordered_json ToJson(const std::vector<ForecastSecond>& seconds) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (size_t s = 0; s < seconds.size(); ++s) {
    const ForecastSecond& second = seconds[s];
    rows.push_back({{"second", s + 1},
                    {"hip_speed_m_s", second.hip_speed},
                    {"hip_way_m", second.hip_way},
                    {"standing", NumberOrNull(second.standing)},
                    {"sscp", NumberOrNull(second.sscp)}});
  }
  return rows;
}

std::string SecondsText(const std::string& name, const std::vector<ForecastSecond>& seconds) {
  TextTable table({name + ", second", "hip speed m/s", "hip way m", "standing", "SSCP"},
                  {false, false, false, false, false});
  for (size_t s = 0; s < seconds.size(); ++s) {
    const ForecastSecond& second = seconds[s];
    const auto cell = [](const std::optional<double>& value) {
      return value ? Rounded(*value, 3) : std::string("none");
    };
    table.Add({std::to_string(s + 1), Rounded(second.hip_speed, 3), Rounded(second.hip_way, 3),
               cell(second.standing), cell(second.sscp)});
  }
  return table.ToString();
}

}  // namespace pushid
