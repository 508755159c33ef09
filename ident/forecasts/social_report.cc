// ident: annotated states and those found in other motion; recorded groups beside forecast ones.
#include "ident/forecasts/social_report.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/parameters/json_archive.h"

namespace pushid {
namespace {

MaybeError FindByClassifier(const StateTable& table, const std::vector<BodyRecording>& recordings,
                            SocialCues* cues) {
  std::vector<StateClassifier::Annotated> samples;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (cues->annotated[i].people.empty()) continue;
    const GroupMotion group = RecordedGroup(recordings[i], *cues, i, 1);
    samples.push_back(
        {StateFeaturesOf(AtWordRate(group), 1.0 / kWordRate), StatesOfPeople(group, cues->states)});
  }
  if (samples.size() < 2 || cues->states.names.size() < 2) {
    return Error{
        "the states of people are not the built-in ones, so that a classifier has to find "
        "them in forecasts: it needs two of these recordings with states of their people, "
        "and two different states",
        table.path};
  }
  std::vector<const StateClassifier::Annotated*> groups;
  for (const StateClassifier::Annotated& group : samples) groups.push_back(&group);
  const auto classifier = std::make_shared<StateClassifier>(groups, cues->states.num_symbols());
  cues->states.of = [classifier](const std::vector<BodyMotion>& people, double dt) {
    return classifier->Of(StateFeaturesOf(people, dt));
  };
  return std::nullopt;
}

using Json = nlohmann::ordered_json;
using Groups = std::vector<GroupMotion>;

constexpr size_t kMostStatesDrawn = 12;
constexpr double kFramesAMinute = 60.0 * kWordRate;

// The transitions into frame k of all people with that many frames.
std::vector<Symbols> StepsInto(const std::vector<Symbols>& all, size_t k) {
  std::vector<Symbols> steps;
  for (const Symbols& symbols : all) {
    if (k < symbols.size()) steps.push_back({symbols[k - 1], symbols[k]});
  }
  return steps;
}

void AddWords(const MotionWords& words, const Groups& groups, SocialRow* row) {
  if (words.size() == 0) return;
  std::vector<double> sums, counts;
  double sum = 0.0, count = 0.0;
  for (const BodyMotion& person : CountedMotions(groups)) {
    const std::vector<double> scores = words.Scores(person);
    sums.resize(std::max(sums.size(), scores.size()));
    counts.resize(sums.size());
    for (size_t k = 0; k < scores.size(); ++k) sums[k] += scores[k], counts[k] += 1.0;
    sum += std::accumulate(scores.begin(), scores.end(), 0.0);
    count += static_cast<double>(scores.size());
  }
  if (count > 0.0) row->ndms = sum / count;
  for (size_t k = 0; k < sums.size(); ++k) row->ndms_by_frame.push_back(sums[k] / counts[k]);
}

// words: null for recorded motion, which is not compared with its own words.
SocialRow Compared(const std::string& name, const Groups& groups, const SocialReport& report,
                   const MotionWords* words) {
  const std::vector<Symbols> counted = CountedStates(groups, report.cues.states);
  SocialRow row;
  row.name = name;
  row.transitions = CountTransitions(counted, report.cues.states.num_symbols(), Transitions::kAll);
  row.sscp = JensenShannon(report.transitions, row.transitions);
  Eigen::MatrixXd recorded = report.transitions, changes = row.transitions;
  recorded.diagonal().setZero();
  changes.diagonal().setZero();
  row.sscp_changes = JensenShannon(recorded, changes);
  size_t longest = 0;
  for (const Symbols& symbols : counted) longest = std::max(longest, symbols.size());
  for (size_t k = 1; k < longest; ++k) {
    const std::vector<Symbols> steps = StepsInto(counted, k);
    row.people.push_back(static_cast<int>(steps.size()));
    row.sscp_by_frame.push_back(JensenShannon(
        report.transitions,
        CountTransitions(steps, report.cues.states.num_symbols(), Transitions::kAll)));
  }
  if (words != nullptr) AddWords(*words, groups, &row);
  return row;
}

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const auto& row : matrix.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

Json FramesJson(const ByFrame& by_frame) {
  Json values = Json::array();
  for (const auto& value : by_frame) values.push_back(NumberOrNull(value));
  return values;
}

constexpr double kFiguresWidth = 1000;
// Changes of state per person and minute.
Chart ChangesChart(const std::string& title, const Eigen::MatrixXd& counts,
                   const std::vector<std::string>& names) {
  Chart chart{title};
  chart.x_categories = chart.y_categories = names;
  chart.full_cell = 1e-9;
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    chart.cells.emplace_back();
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      const double a_minute = kFramesAMinute * counts(i, j) / std::max(1.0, counts.sum());
      chart.cells.back().push_back(i == j ? 0.0 : std::round(10.0 * a_minute) / 10.0);
      chart.full_cell = std::max(chart.full_cell, chart.cells.back().back());
    }
  }
  return chart;
}

// The values of the row "recorded" and of the predictor, by frame.
Chart FrameChart(const std::string& title, const SocialReport& report, const SocialRow& predictor,
                 ByFrame SocialRow::*values) {
  Chart chart{title, "s"};
  chart.y_from = 0.0;
  for (const SocialRow* row : {&report.rows.front(), &predictor}) {
    ChartLine line;
    line.look = row == &predictor ? kPredictedLook : kMeasuredLook;
    const ByFrame& by_frame = row->*values;
    for (size_t k = 0; k < by_frame.size(); ++k) {
      if (!by_frame[k]) continue;
      line.points.emplace_back((report.first_frame + static_cast<double>(k)) / kWordRate,
                               *by_frame[k]);
    }
    if (!line.points.empty()) chart.lines.push_back(line);
  }
  return chart;
}

}  // namespace

Result<SocialCues> SocialCuesOf(const StateTable& table, const std::vector<std::string>& ids,
                                const std::vector<BodyRecording>& recordings) {
  if (MaybeError error = CheckRecordings(table, ids)) return *error;
  SocialCues cues;
  cues.source = table.path;
  std::set<std::string> names;
  for (const BodyRecording& recording : recordings) {
    const PendulumRecording& pendulum = recording.pendulum;
    Result<RecordedStates> states =
        StatesOf(table, pendulum.id, pendulum.subject_ids, recording.num_frames());
    if (!states.ok()) return states.error();
    for (const auto& person : states.value().people) names.insert(person.begin(), person.end());
    cues.annotated.push_back(std::move(states.value()));
  }
  const auto is_built_in = [](const std::string& name) {
    return FromName<SocialState>(name).has_value();
  };
  if (std::all_of(names.begin(), names.end(), is_built_in)) return cues;
  cues.states.names.assign(names.begin(), names.end());
  if (MaybeError error = FindByClassifier(table, recordings, &cues)) return *error;
  return cues;
}

GroupMotion RecordedGroup(const BodyRecording& recording, const SocialCues& cues, size_t index,
                          int first_frame, bool annotated) {
  const PendulumRecording& pendulum = recording.pendulum;
  GroupMotion group{recording.bodies, pendulum.scene.dt, pendulum.pushed_person, first_frame};
  if (!annotated || cues.annotated.empty()) return group;
  const std::vector<std::string>& names = cues.states.names;
  for (const std::vector<std::string>& person : cues.annotated[index].people) {
    Symbols& states = group.states.emplace_back();
    for (const std::string& name : person) {
      const auto found = std::find(names.begin(), names.end(), name);
      states.push_back(static_cast<int>(found - names.begin()));
    }
  }
  return group;
}

std::vector<RecordedStates> StatesInUse(const std::vector<BodyRecording>& recordings,
                                        const SocialCues& cues) {
  std::vector<RecordedStates> all;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& pendulum = recordings[i].pendulum;
    RecordedStates states{pendulum.id, pendulum.subject_ids};
    const GroupMotion group = RecordedGroup(recordings[i], cues, i, 1);
    for (const Symbols& person : StatesOfPeople(group, cues.states)) {
      states.people.emplace_back();
      for (int t = 0; t < recordings[i].num_frames(); ++t) {
        const auto at = static_cast<size_t>(std::lround(t * pendulum.scene.dt * kWordRate));
        states.people.back().push_back(cues.states.names[person[std::min(at, person.size() - 1)]]);
      }
    }
    all.push_back(std::move(states));
  }
  return all;
}

std::optional<SocialReport> CompareSocially(const std::vector<BodyRecording>& recordings,
                                            const SocialCues& cues, BodyEvaluation* evaluation) {
  const auto groups_from = [&](int first_frame, bool annotated) {
    Groups groups;
    for (size_t i = 0; i < recordings.size(); ++i) {
      if (recordings[i].num_people() < 2) continue;
      groups.push_back(RecordedGroup(recordings[i], cues, i, first_frame, annotated));
    }
    return groups;
  };
  int first_frame = 0;
  for (const auto& [name, summary] : *evaluation) {
    for (const BodyScore& score : summary.recordings) {
      if (!score.predicted.empty()) first_frame = std::max(first_frame, score.first_frame);
    }
  }
  if (first_frame == 0) return std::nullopt;
  SocialReport report;
  report.cues = cues;
  const Groups annotated = groups_from(first_frame, true);
  report.first_frame = static_cast<int>(FirstStep(annotated.front())) + 1;
  report.transitions = CountTransitions(CountedStates(annotated, cues.states),
                                        cues.states.num_symbols(), Transitions::kAll);
  report.rows.push_back(Compared("recorded", groups_from(first_frame, false), report, nullptr));
  const MotionWords words(CountedMotions(annotated));
  for (auto& [name, summary] : *evaluation) {
    Groups groups;
    for (size_t i = 0; i < recordings.size(); ++i) {
      const BodyScore& score = summary.recordings[i];
      // Scores over all frames are of a forecast that is compared already.
      if (score.predicted.empty() || score.first_frame != first_frame) continue;
      const PendulumRecording& pendulum = recordings[i].pendulum;
      groups.push_back({score.predicted, pendulum.scene.dt, pendulum.pushed_person, first_frame});
    }
    if (groups.empty()) continue;
    report.rows.push_back(Compared(name, groups, report, &words));
    if (!summary.groups) continue;
    const SocialRow& row = report.rows.back();
    summary.groups->social = {row.sscp, row.sscp_changes, row.ndms};
  }
  return report;
}

Json ToJson(const SocialReport& report) {
  Json json = {{"states", report.cues.source},
               {"names", report.cues.states.names},
               {"first_frame", report.first_frame},
               {"rate_hz", kWordRate}};
  json["transitions"] = MatrixJson(report.transitions);
  for (const SocialRow& row : report.rows) {
    json["by"][row.name] = {{"sscp", NumberOrNull(row.sscp)},
                            {"ndms", NumberOrNull(row.ndms)},
                            {"transitions", MatrixJson(row.transitions)},
                            {"by_frame",
                             {{"people", row.people},
                              {"sscp", FramesJson(row.sscp_by_frame)},
                              {"ndms", FramesJson(row.ndms_by_frame)}}}};
  }
  return json;
}

std::string SocialText(const SocialReport& report) {
  TextTable table = TextTable::OfNumbers({"states " + report.cues.source, "SSCP"});
  for (const SocialRow& row : report.rows) {
    table.Add({row.name, row.sscp ? Rounded(*row.sscp, 3) : std::string("none")});
  }
  return table.ToString();
}

std::vector<std::string> SocialFigures(const SocialReport& report, const std::string& predictor) {
  const auto found = std::find_if(report.rows.begin(), report.rows.end(),
                                  [&](const SocialRow& row) { return row.name == predictor; });
  if (found == report.rows.end()) return {};
  const std::vector<Chart> by_frame = {
      FrameChart("SSCP by frame", report, *found, &SocialRow::sscp_by_frame),
      FrameChart("NDMS by frame", report, *found, &SocialRow::ndms_by_frame)};
  std::vector<std::string> figures = {
      DrawFigure({{}, by_frame}, kFiguresWidth, "forecasts and recorded motion").ToInline()};
  const std::vector<std::string>& names = report.cues.states.names;
  if (names.size() > kMostStatesDrawn) return figures;
  Chart left = ChangesChart("recorded", report.transitions, names);
  Chart right = ChangesChart(predictor, found->transitions, names);
  left.full_cell = right.full_cell = std::max(left.full_cell, right.full_cell);
  const std::string title = "people: changes of state a minute";
  figures.push_back(DrawFigure({{}, {left, right}, title}, kFiguresWidth, title).ToInline());
  return figures;
}

}  // namespace pushid
