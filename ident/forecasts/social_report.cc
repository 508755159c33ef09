// ident: recorded groups beside forecast ones.
#include "ident/forecasts/social_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/parameters/json_archive.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
using Groups = std::vector<GroupMotion>;

constexpr size_t kMostStatesDrawn = 12;
constexpr double kFramesAMinute = 60.0 * kWordRate;

// Symbols that count: of everybody, and of every whole group.
struct CountedStates {
  std::vector<Symbols> people, groups;
};
CountedStates StatesOfAll(const Groups& groups, const StateFunction& states,
                          const GroupVocabulary& vocabulary) {
  CountedStates all;
  for (const GroupMotion& group : groups) {
    for (const Symbols& person : StatesOfPeople(group, states)) {
      all.people.push_back(Counted(group, person));
    }
    all.groups.push_back(Counted(group, vocabulary.Of(group, states)));
  }
  return all;
}

size_t LongestOf(const std::vector<Symbols>& all) {
  size_t longest = 0;
  for (const Symbols& symbols : all) longest = std::max(longest, symbols.size());
  return longest;
}

// Into frame k, of those who last so long.
std::vector<Symbols> StepsInto(const std::vector<Symbols>& all, size_t k) {
  std::vector<Symbols> steps;
  for (const Symbols& symbols : all) {
    if (k < symbols.size()) steps.push_back({symbols[k - 1], symbols[k]});
  }
  return steps;
}

ByFrame SscpByFrame(const Eigen::MatrixXd& recorded, const std::vector<Symbols>& all) {
  ByFrame by_frame;
  for (size_t k = 1; k < LongestOf(all); ++k) {
    by_frame.push_back(JensenShannon(
        recorded,
        CountTransitions(StepsInto(all, k), static_cast<int>(recorded.rows()), Transitions::kAll)));
  }
  return by_frame;
}

void AddWords(const MotionWords& words, const Groups& groups, SocialRow* row) {
  if (words.size() == 0) return;
  std::vector<double> sums, counts;
  double sum = 0.0, count = 0.0;
  for (const BodyMotion& person : CountedMotions(groups)) {
    const std::vector<double> scores = words.Scores(person);
    sums.resize(std::max(sums.size(), scores.size()));
    counts.resize(sums.size());
    double of_person = 0.0;
    for (size_t k = 0; k < scores.size(); ++k) {
      sums[k] += scores[k];
      counts[k] += 1.0;
      of_person += scores[k];
    }
    sum += of_person;
    count += static_cast<double>(scores.size());
  }
  if (count > 0.0) row->ndms = sum / count;
  for (size_t k = 0; k < sums.size(); ++k) row->ndms_by_frame.push_back(sums[k] / counts[k]);
}

// words: null where recorded motion meets itself.
SocialRow Compared(const std::string& name, const Groups& groups, const SocialReport& report,
                   const GroupVocabulary& vocabulary, const MotionWords* words) {
  const CountedStates counted = StatesOfAll(groups, report.cues.states, vocabulary);
  const auto transitions = [](const std::vector<Symbols>& all, const Eigen::MatrixXd& like) {
    return CountTransitions(all, static_cast<int>(like.rows()), Transitions::kAll);
  };
  SocialRow row;
  row.name = name;
  row.transitions = transitions(counted.people, report.transitions);
  row.group_transitions = transitions(counted.groups, report.group_transitions);
  row.sscp = JensenShannon(report.transitions, row.transitions);
  row.group_sscp = JensenShannon(report.group_transitions, row.group_transitions);
  Eigen::MatrixXd recorded = report.transitions, changes = row.transitions;
  recorded.diagonal().setZero();
  changes.diagonal().setZero();
  row.sscp_changes = JensenShannon(recorded, changes);
  row.sscp_by_frame = SscpByFrame(report.transitions, counted.people);
  row.group_sscp_by_frame = SscpByFrame(report.group_transitions, counted.groups);
  for (size_t k = 1; k < LongestOf(counted.people); ++k) {
    row.people.push_back(static_cast<int>(StepsInto(counted.people, k).size()));
  }
  if (words != nullptr) AddWords(*words, groups, &row);
  return row;
}

}  // namespace

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
  const GroupVocabulary vocabulary(annotated, cues.states);
  report.group_names = vocabulary.names();
  const CountedStates counted = StatesOfAll(annotated, cues.states, vocabulary);
  report.transitions =
      CountTransitions(counted.people, cues.states.num_symbols(), Transitions::kAll);
  report.group_transitions = CountTransitions(
      counted.groups, static_cast<int>(report.group_names.size()), Transitions::kAll);
  report.rows.push_back(
      Compared("recorded", groups_from(first_frame, false), report, vocabulary, nullptr));
  const MotionWords words(CountedMotions(annotated));
  for (auto& [name, summary] : *evaluation) {
    Groups groups;
    for (size_t i = 0; i < recordings.size(); ++i) {
      const BodyScore& score = summary.recordings[i];
      // Scores over all frames are no other forecast.
      if (score.predicted.empty() || score.first_frame != first_frame) continue;
      const PendulumRecording& pendulum = recordings[i].pendulum;
      groups.push_back({score.predicted, pendulum.scene.dt, pendulum.pushed_person, first_frame});
    }
    if (groups.empty()) continue;
    report.rows.push_back(Compared(name, groups, report, vocabulary, &words));
    if (!summary.groups) continue;
    const SocialRow& row = report.rows.back();
    summary.groups->social = {row.sscp, row.sscp_changes, row.ndms};
  }
  return report;
}

namespace {

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const auto& row : matrix.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

// Of many states few follow each other: [from, to, count].
Json SparseJson(const Eigen::MatrixXd& matrix) {
  Json cells = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (matrix(i, j) != 0.0) cells.push_back({i, j, matrix(i, j)});
    }
  }
  return cells;
}

Json FramesJson(const ByFrame& by_frame) {
  Json values = Json::array();
  for (const auto& value : by_frame) values.push_back(NumberOrNull(value));
  return values;
}

}  // namespace

Json ToJson(const SocialReport& report) {
  Json json = {{"states", report.cues.source},
               {"names", report.cues.states.names},
               {"group_names", report.group_names},
               {"first_frame", report.first_frame},
               {"rate_hz", kWordRate}};
  if (report.cues.share_found) {
    json["classifier"] = {{"found", *report.cues.share_found},
                          {"most_frequent", *report.cues.share_of_most_frequent}};
  }
  json["transitions"] = MatrixJson(report.transitions);
  json["group_transitions"] = SparseJson(report.group_transitions);
  for (const SocialRow& row : report.rows) {
    json["by"][row.name] = {{"sscp", NumberOrNull(row.sscp)},
                            {"group_sscp", NumberOrNull(row.group_sscp)},
                            {"ndms", NumberOrNull(row.ndms)},
                            {"transitions", MatrixJson(row.transitions)},
                            {"group_transitions", SparseJson(row.group_transitions)},
                            {"by_frame",
                             {{"people", row.people},
                              {"sscp", FramesJson(row.sscp_by_frame)},
                              {"group_sscp", FramesJson(row.group_sscp_by_frame)},
                              {"ndms", FramesJson(row.ndms_by_frame)}}}};
  }
  return json;
}

std::string SocialText(const SocialReport& report) {
  TextTable table = TextTable::OfNumbers({"states " + report.cues.source, "SSCP", "of groups"});
  const auto cell = [](const std::optional<double>& value) {
    return value ? Rounded(*value, 3) : std::string("none");
  };
  for (const SocialRow& row : report.rows) {
    table.Add({row.name, cell(row.sscp), cell(row.group_sscp)});
  }
  std::string text = table.ToString();
  if (!report.cues.share_found) return text;
  return text + "states of motion are found by a classifier: " +
         Rounded(100.0 * *report.cues.share_found, 3) +
         " % of those of recordings left out (the most frequent one has " +
         Rounded(100.0 * *report.cues.share_of_most_frequent, 3) + " %)\n";
}

namespace {

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

// The row "recorded" in ink, the predictor in colour.
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

std::vector<std::string> SocialFigures(const SocialReport& report, const std::string& predictor) {
  const auto found = std::find_if(report.rows.begin(), report.rows.end(),
                                  [&](const SocialRow& row) { return row.name == predictor; });
  if (found == report.rows.end()) return {};
  const std::vector<Chart> by_frame = {
      FrameChart("SSCP by frame", report, *found, &SocialRow::sscp_by_frame),
      FrameChart("SSCP of groups", report, *found, &SocialRow::group_sscp_by_frame),
      FrameChart("NDMS by frame", report, *found, &SocialRow::ndms_by_frame)};
  std::vector<std::string> figures = {
      DrawFigure({{}, by_frame}, kFiguresWidth, "forecasts and recorded motion").ToInline()};
  const auto add = [&](const Eigen::MatrixXd& recorded, const Eigen::MatrixXd& forecast,
                       const std::vector<std::string>& names, const std::string& title) {
    if (names.size() > kMostStatesDrawn) return;
    Chart left = ChangesChart("recorded", recorded, names);
    Chart right = ChangesChart(predictor, forecast, names);
    left.full_cell = right.full_cell = std::max(left.full_cell, right.full_cell);
    figures.push_back(DrawFigure({{}, {left, right}, title}, kFiguresWidth, title).ToInline());
  };
  add(report.transitions, found->transitions, report.cues.states.names,
      "people: changes of state a minute");
  add(report.group_transitions, found->group_transitions, report.group_names,
      "groups: changes of state a minute");
  return figures;
}

}  // namespace pushid
