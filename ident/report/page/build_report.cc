#include "ident/report/page/build_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/animation.h"
#include "ident/figures/svg.h"
#include "ident/prediction/prediction.h"
#include "ident/report/fit_sections.h"
#include "ident/report/parameter_sections.h"
#include "ident/report/report_text.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

constexpr int kBandSamples = 100;

// The recordings must outlive the views.
std::vector<RecordingView> ViewRecordings(const FitResult& result,
                                          const std::vector<Recording>& recordings, int num_threads,
                                          const JobProgress& progress) {
  const IdentifiedModel model = ModelOf(result);
  std::vector<RecordingView> views(recordings.size());
  std::vector<PendulumRecording> fitted;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingView& view = views[i];
    view.recording = &recordings[i];
    view.run.recording = MakePendulumRecording(recordings[i]);
    view.run.prediction = Predict(model, view.run.recording);
    const auto known =
        std::find_if(result.recordings.begin(), result.recordings.end(),
                     [&](const FittedRecording& r) { return r.id == view.run.recording.id; });
    if (known == result.recordings.end()) {
      view.note = "not among the recordings that were fitted";
    } else if (known->content_hash != view.run.recording.content_hash) {
      view.note = "its files have changed since the fit";
    }
    const RolloutStatus& status = view.run.prediction.status;
    if (!status.ok) {
      view.note += (view.note.empty() ? "" : "; ") + OutsideText(status);
    }
    if (view.note.empty()) fitted.push_back(view.run.recording);
  }
  BandOptions options;
  options.samples = kBandSamples;
  const std::vector<ParameterSet<double>> samples = SampleParameters(result, options);
  const std::vector<ErrorPath> errors = ErrorPaths(result, fitted);
  ParallelFor(
      static_cast<int>(views.size()), num_threads,
      [&](int i) {
        if (!views[i].run.prediction.status.ok) return;
        views[i].bands =
            ComputeBands(result, samples, errors, views[i].run.recording, options.seed);
      },
      progress);
  for (RecordingView& view : views) {
    ToLaboratory(view.run.recording.scene, &view.bands);
    view.run.prediction = InLaboratory(view.run.recording, std::move(view.run.prediction));
    view.run.recording = InLaboratory(std::move(view.run.recording));
    if (!view.run.prediction.status.ok) continue;
    view.score = ScoreHip(view.run.recording, view.run.prediction.hip);
    AddContactFigures(model, view.run.prediction, &view.score.propagation);
  }
  return views;
}

// Sampling of the figure, seconds; many skeletons make a large file, so they are sampled less
// often.
constexpr double kSampleSeconds = 1.0 / 30.0, kSeldomSeconds = 1.0 / 6.0;
constexpr int kManySkeletons = 100;

// A page as the value of an attribute; line breaks stay.
std::string ForAttribute(const std::string& page) {
  std::string quoted;
  for (const char c : page) quoted += c == '\n' ? "\n" : EscapeXml({&c, 1});
  return quoted;
}

// An animation of what was measured, with skeletons where they were recorded, and predicted.
Animation AnimationOf(const RecordingView& view) {
  const PendulumRecording& recording = view.run.recording;
  Animation animation;
  animation.title = recording.id;
  animation.dt = recording.scene.dt;
  auto bodies = MakeBodyRecording(*view.recording);
  if (bodies.ok()) {
    ToLaboratory(recording.scene, &bodies.value().bodies);
    AddRecorded(recording, bodies.value().bodies, &animation);
  } else {
    AddRecorded(recording, {}, &animation);
    for (size_t n = 0; n < animation.people.size(); ++n) {  // files may lack joints of a body
      const RecordedPerson& recorded = view.recording->people[n];
      AnimatedPerson& person = animation.people[n];
      person.parents = recorded.joint_parents;
      for (const auto& places : recorded.joints) {
        if (person.parents.empty()) break;
        person.joints.emplace_back(3, places.size());
        for (size_t j = 0; j < places.size(); ++j) {
          person.joints.back().col(static_cast<Eigen::Index>(j)) = places[j];
        }
      }
    }
  }
  if (view.run.prediction.status.ok) AddPrediction(recording, view.run.prediction, {}, &animation);
  AddPushes(recording, &animation);
  return animation;
}

// A row of BandPoint of one person over time, relative to `from`: measured, predicted and with
// bands where there are some.
void AddPerson(const RecordingView& view, int person, int row, double from, Chart* chart) {
  const FormationRun& run = view.run;
  const auto points = [&](int frames, const auto& value) {
    ChartPoints placed;
    for (int t = 0; t < frames; ++t) placed.emplace_back(run.Seconds(t), value(t) - from);
    return placed;
  };
  if (!view.bands.people.empty()) {
    const PathBand& band = view.bands.people[person];
    const auto edges = [&](const std::vector<BandPoint>& ends) {
      return points(static_cast<int>(ends.size()), [&](int t) { return ends[t][row]; });
    };
    chart->bands.push_back({edges(band.lower90), edges(band.upper90), kWideBandLook});
    chart->bands.push_back({edges(band.lower50), edges(band.upper50), kNarrowBandLook});
  }
  const RolloutStatus& status = run.prediction.status;
  const bool hip = row < 3;  // empty after a failed rollout
  const int frames = run.recording.num_frames(), valid = hip ? 0 : status.frame;
  const ChartPoints predicted = points(status.ok ? frames : valid, [&](int t) {
    return hip ? run.prediction.hip[person][t][row] : run.prediction.path.At(t, person).q[row - 1];
  });
  if (!predicted.empty()) chart->lines.push_back({predicted, kPredictedLook});
  const auto measured = [&](int t) {
    return hip ? run.recording.hip[person][t][row] : run.recording.states[person][t].q[row - 1];
  };
  chart->lines.push_back({points(frames, measured), kMeasuredLook});
}

// A panel of AddPerson; of hips with bars where a foot is off the ground.
Chart PersonChart(const RecordingView& view, int person, int row, const std::string& title) {
  const FormationRun& run = view.run;
  Chart chart{title, "time, s"};
  chart.Shrink();
  AddPerson(view, person, row, row < 3 ? run.recording.hip[person][0][row] : 0.0, &chart);
  for (Foot foot : kFeet) {
    if (row >= 3) break;
    ChartLane& lane = chart.lanes.emplace_back(ChartLane{NameOf(foot), {}, kLiftedLook});
    for (const FootStep& step : run.recording.steps[person].steps) {
      const int end = std::min(step.landing, run.recording.num_frames() - 1);
      if (step.foot == foot) lane.bars.emplace_back(run.Seconds(step.lift_off), run.Seconds(end));
    }
  }
  return chart;
}

TextTable PathNumbers(const RecordingView& view) {
  TextTable table(SplitList(
      "person,frame,time_s,measured_x_m,measured_y_m,predicted_x_m,predicted_y_m,lower90_x_m,"
      "upper90_x_m,lower90_y_m,upper90_y_m,lower50_x_m,upper50_x_m,lower50_y_m,upper50_y_m,"
      "measured_theta_rad,predicted_theta_rad,measured_phi_rad,predicted_phi_rad,left_foot_stands,"
      "right_foot_stands"));
  const FormationRun& run = view.run;
  for (int n = 0; n < run.recording.num_people(); ++n) {
    for (int t = 0; t < run.recording.num_frames(); ++t) {
      std::vector<std::string> cells = {run.recording.subject_ids[n], std::to_string(t),
                                        DoubleText(run.Seconds(t))};
      const auto add = [&](bool known, double value) {
        cells.push_back(known ? DoubleText(value) : "");
      };
      const bool ok = run.prediction.status.ok, bands = !view.bands.people.empty();
      for (int axis : {0, 1}) add(true, run.recording.hip[n][t][axis]);
      for (int axis : {0, 1}) add(ok, ok ? run.prediction.hip[n][t][axis] : 0.0);
      for (const auto& [lower, upper] : {std::pair(&PathBand::lower90, &PathBand::upper90),
                                         {&PathBand::lower50, &PathBand::upper50}}) {
        for (int axis : {0, 1}) {
          for (auto edge : {lower, upper}) {
            add(bands, bands ? (view.bands.people[n].*edge)[t][axis] : 0.0);
          }
        }
      }
      for (int row : {2, 3}) {
        add(true, run.recording.states[n][t].q[row]);
        add(ok, ok ? run.prediction.path.At(t, n).q[row] : 0.0);
      }
      for (Foot foot : kFeet) add(true, run.recording.steps[n].Stands(foot, t) ? 1.0 : 0.0);
      table.Add(cells);
    }
  }
  return table;
}

TextTable ForceNumbers(const FormationRun& run) {
  TextTable table({"person", "frame", "part", "fx_N", "fy_N", "ftheta_Nm", "fphi_Nm"});
  const std::vector<ForcePart> parts = ActingParts(run);
  for (int n = 0; n < run.num_people(); ++n) {
    for (int t = 0; t < run.num_frames(); ++t) {
      const auto add = [&](std::string_view part, const Vector4<double>& f) {
        table.Add({run.recording.subject_ids[n], t, std::string(part), f[0], f[1], f[2], f[3]});
      };
      add("net", run.Force(n, t).Total());
      for (ForcePart part : parts) add(NameOf(part), run.Force(n, t)[part]);
    }
  }
  return table;
}

constexpr int kRows[] = {0, 2};  // of the generalized force: along x, about y
constexpr const char* kForceHeads[] = {"force along the push, N", "torque about y, N m"};

// Colours after Okabe and Ito: the colour-blind can tell them apart, on light and on dark paper. A
// part without a colour of its own is grey and dotted.
std::string PartLook(ForcePart part) {
  static const std::map<ForcePart, const char*> colours = {
      {ForcePart::kPush, "#d55e00"},
      {ForcePart::kTail, "#cc79a7"},
      {ForcePart::kFriction, "#e69f00"},
      {ForcePart::kBalance, "#56b4e9"},
      {ForcePart::kLinear, "#009e73"},
      {ForcePart::kInteraction, "#9333ea"},
      {ForcePart::kNetwork, "#6b7280;stroke-dasharray:7 2"}};
  const auto found = colours.find(part);
  return std::string("fill:none;stroke-width:1.5;stroke:") +
         (found == colours.end() ? "#999999;stroke-dasharray:2 2" : found->second);
}

constexpr char kNetLook[] = "ink net";
constexpr double kSmallestRange = 10.0;  // N or N m, so that little is not blown up
constexpr double kNoForce = 1e-6;        // N or N m

// Two panels for each person: the net force along the push (N) and the torque about y (N m) over
// time with their parts, all on one scale, so that heights compare.
Figure ForcesFigure(const FormationRun& run) {
  const std::vector<ForcePart> parts = ActingParts(run);
  Figure figure;
  figure.legend = {{"net (the sum)", kNetLook}};
  for (ForcePart part : parts) figure.legend.push_back({std::string(NameOf(part)), PartLook(part)});
  std::pair<double, double> shared[2];
  for (int n = 0; n < run.num_people(); ++n) {
    for (int column : {0, 1}) {
      Chart chart{"", "time, s"};
      double lowest = 0.0, highest = 0.0;
      const auto line = [&](auto force_at, const std::string& look) {
        ChartLine drawn{{}, look};
        bool acts = false;
        for (int t = 0; t < run.num_frames(); ++t) {
          const double force = force_at(run.Force(n, t))[kRows[column]];
          acts = acts || force != 0.0;
          lowest = std::min(lowest, force), highest = std::max(highest, force);
          drawn.points.emplace_back(run.Seconds(t), force);
        }
        if (acts) chart.lines.push_back(drawn);
      };
      // The net force is drawn first and thick, so that a part that equals it shows on top.
      line([](const NetForce<double>& force) { return force.Total(); }, kNetLook);
      for (ForcePart part : parts) {
        line([part](const NetForce<double>& force) { return force[part]; }, PartLook(part));
      }
      auto& [from, to] = shared[column];
      from = std::min(from, lowest), to = std::max(to, highest);
      chart.title = kForceHeads[column];
      if (run.num_people() > 1) chart.title = "person " + std::to_string(n) + ": " + chart.title;
      if (highest - lowest < kNoForce) chart.y_label = "nothing";
      figure.panels.push_back(chart);
    }
  }
  for (size_t i = 0; i < figure.panels.size(); ++i) {
    const auto& [from, to] = shared[i % 2];
    const double air = 0.1 * std::max(kSmallestRange, to - from);
    figure.panels[i].y_from = from - air;
    figure.panels[i].y_to = to + air;
  }
  return figure;
}

// The legend of what this picture draws.
std::vector<LegendEntry> LegendOf(const RecordingView& view) {
  std::vector<LegendEntry> legend = {{"measured", kMeasuredLook}};
  if (view.run.prediction.status.ok) legend.push_back({"predicted", kPredictedLook});
  if (!view.bands.people.empty()) {
    legend.push_back({"50 %", kNarrowBandLook});
    legend.push_back({"90 %", kWideBandLook});
  }
  const auto& steps = view.run.recording.steps;
  if (std::any_of(steps.begin(), steps.end(), [](const auto& s) { return !s.steps.empty(); })) {
    legend.push_back({"foot off the ground", kLiftedLook});
  }
  return legend;
}

Figure PathFigure(const RecordingView& view) {
  const int people = view.run.recording.num_people();
  Figure figure{LegendOf(view), {}};
  for (int n = 0; n < people; ++n) {
    const std::string who = people == 1 ? "" : view.run.recording.subject_ids[n] + ": ";
    figure.panels.push_back(PersonChart(view, n, 0, who + "hip forward, m"));
    figure.panels.push_back(PersonChart(view, n, 1, "hip to the left, m"));
    figure.panels.push_back(PersonChart(view, n, 3, "theta, rad"));
    figure.panels.push_back(PersonChart(view, n, 4, "phi, rad"));
  }
  return figure;
}

// Hips of the recordings that are predicted in the middle, best and worst; none without recordings.
std::optional<ReportFigure> TypicalFigure(const ReportSource& source) {
  std::vector<std::pair<double, const RecordingView*>> ranked;
  for (const RecordingView& view : source.views) {
    if (!view.run.prediction.status.ok) continue;
    ranked.emplace_back(view.score.value[kHipAde], &view);
  }
  if (ranked.empty()) return std::nullopt;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::string, size_t>> shown;  // a telephone shows the first at once
  if (ranked.size() > 2) shown.emplace_back("median", (ranked.size() - 1) / 2);
  shown.emplace_back("best", 0);
  if (ranked.size() > 1) shown.emplace_back("worst", ranked.size() - 1);
  std::vector<LegendEntry> legend;
  std::vector<Chart> panels;
  std::vector<std::string> header = PathNumbers(*ranked[0].second).rows()[0];
  header.insert(header.begin(), {"which", "recording"});
  TextTable numbers(header);
  for (const auto& [which, place] : shown) {
    const auto& [error, view] = ranked[place];
    const PendulumRecording& recording = view->run.recording;
    const Eigen::Vector2d along = PushDirection(recording);
    const int axis = std::abs(along[0]) >= std::abs(along[1]) ? 0 : 1;
    const double from = recording.hip[std::max(0, recording.pushed_person)][0][axis];
    Chart& chart = panels.emplace_back(Chart{which + ": " + recording.id,
                                             "time, s (" + kMetrics[kHipAde].Text(error, 2) + ")",
                                             axis == 0 ? "hip forward, m" : "hip to the left, m"});
    for (int n = 0; n < recording.num_people(); ++n) AddPerson(*view, n, axis, from, &chart);
    if (legend.empty()) legend = LegendOf(*view);
    const TextTable path = PathNumbers(*view);
    for (size_t i = 1; i < path.rows().size(); ++i) {
      std::vector<std::string> row = path.rows()[i];
      row.insert(row.begin(), {which, recording.id});
      numbers.Add(row);
    }
  }
  legend.erase(std::remove_if(legend.begin(), legend.end(),
                              [](const LegendEntry& e) { return e.look == kLiftedLook; }),
               legend.end());
  return ReportFigure{
      "typical",
      "Hips along the push, from where the pushed person starts, in those of " +
          CountText(ranked.size(), "recording") +
          " whose mean error is the median, the smallest and the largest: measured, and predicted "
          "from the first frame and the push alone.",
      {legend, panels},
      numbers};
}

ReportSection FigureSection(const ReportSource& source) {
  ReportSection section{"figure", "Moving figure"};
  if (source.views.empty()) return section;
  section.paragraphs = {
      "Every recording with the model's prediction from its first frame and the push. The slider "
      "and the list can be operated with the arrow keys."};
  std::vector<Animation> animations;
  int skeletons = 0;
  for (const RecordingView& view : source.views) {
    animations.push_back(AnimationOf(view));
    skeletons += view.run.num_people();
  }
  const double seconds = skeletons > kManySkeletons ? kSeldomSeconds : kSampleSeconds;
  section.widget = "<iframe class=\"moving\" title=\"moving figure\" srcdoc=\"" +
                   ForAttribute(AnimationHtml(animations, seconds)) +
                   "\"></iframe>\n<noscript><p>The moving figure needs JavaScript; everything else "
                   "on this page does not.</p></noscript>\n";
  return section;
}

ReportSection MotionSection(const ReportSource& source) {
  ReportSection section{"motion", "Measured and predicted motion"};
  if (source.views.empty()) return section;
  section.paragraphs = {
      "Predicted from the first frame and the push alone. The bands include the uncertainty of the "
      "parameters and, for the pushed person, the variation between people with the same "
      "parameters; for others only the uncertainty of the parameters. Bars under the hip show when "
      "a foot was off the ground. The forces explain the motion: balance, friction, interaction, "
      "push and all others add up to the net force (thick)."};
  for (const RecordingView& view : source.views) {
    const PendulumRecording& recording = view.run.recording;
    const Prediction& prediction = view.run.prediction;
    const std::string& id = recording.id;
    ReportFold fold{id, {}};
    if (prediction.status.ok) {
      fold.title += ": predicted " + MetricsText(TableMetrics(0), view.score.value, 2);
    }
    if (!view.note.empty()) fold.title += " (" + view.note + ")";
    fold.figures.push_back({"motion_" + id, "Measured and predicted motion of " + id + ".",
                            PathFigure(view), PathNumbers(view)});
    if (prediction.status.ok) {
      const ForceStory story = RichestStory(recording, prediction);
      fold.figures.push_back({"forces_" + id,
                              "Forces in " + id + ". " + StoryText(recording, story),
                              ForcesFigure(view.run), ForceNumbers(view.run)});
    }
    section.folds.push_back(std::move(fold));
  }
  return section;
}

constexpr double kDegreesPerRadian = 180.0 / M_PI;
constexpr char kErrorLook[] = "fill:none;stroke:#8a8f98;stroke-width:1.2";

// Measured points with their errors over the model's line, over a logarithmic frequency. Phases go
// on without jumps: of the model from its lowest frequency on, of each point as near to the model
// as may be, or to the point before where there is no model.
Figure BodeFigure(const FrequencyResponse& response) {
  Chart gain{"gain, " + response.OutputUnit() + "/" + response.InputUnit(), "frequency, Hz"};
  gain.logarithmic_x = true;
  Chart phase = gain, coherence = gain;
  phase.title = "phase, degrees";
  coherence.title = "coherence";
  gain.logarithmic_y = true;
  coherence.y_from = 0.0, coherence.y_to = 1.05;
  double lowest = INFINITY, highest = -INFINITY;
  const auto add = [](double x, double value, double error, Chart* chart) {
    if (error > 0.0) chart->lines.push_back({{{x, value - error}, {x, value + error}}, kErrorLook});
    chart->lines.push_back({{{x, value}}, kMeasuredLook, true});
  };
  ChartLine gains{{}, kPredictedLook}, phases{{}, kPredictedLook};
  std::optional<double> beside;
  // The multiple of 360 degrees away that is nearest to what stands beside it.
  const auto nearest = [&beside](double angle) {
    return beside ? *beside + std::remainder(kDegreesPerRadian * angle - *beside, 360.0)
                  : kDegreesPerRadian * angle;
  };
  for (const FrequencyBin& bin : response.bins) {
    const double x = std::log10(bin.hz), log = bin.log_gain / M_LN10;
    const double model = (response.has_model ? bin.model_log_gain : bin.log_gain) / M_LN10;
    const double error = bin.log_gain_error / M_LN10;
    if (response.has_model) {
      beside = nearest(bin.model_phase);
      gains.points.emplace_back(x, model);
      phases.points.emplace_back(x, *beside);
    }
    const double measured = nearest(bin.phase);
    if (!response.has_model) beside = measured;
    add(x, log, error, &gain);
    add(x, measured, kDegreesPerRadian * bin.phase_error, &phase);
    add(x, bin.coherence, 0.0, &coherence);
    lowest = std::min({lowest, log - error, model}),
    highest = std::max({highest, log + error, model});
  }
  Figure figure;
  figure.legend = {{"measured, one standard error", kErrorLook}};
  if (response.has_model) {
    gain.lines.insert(gain.lines.begin(), gains), phase.lines.insert(phase.lines.begin(), phases);
    figure.legend.push_back({"model", kPredictedLook});
  }
  gain.y_from = std::floor(lowest);  // a power of ten at both ends
  gain.y_to = std::max(std::ceil(highest), *gain.y_from + 1.0);
  figure.panels = {gain, phase, coherence};
  return figure;
}

using RenderSection = ReportSection(const ReportSource& source);

template <ReportSection (*kRender)(const FittedModel&)>
ReportSection OfModel(const ReportSource& source) {
  return kRender(source.model);
}

// The sections in the order of the page.
constexpr RenderSection* kSections[] = {LeadSection,
                                        OfModel<SummarySection>,
                                        OfModel<ParameterSection>,
                                        OfModel<ContrastSection>,
                                        OfModel<UnitSection>,
                                        OfModel<IdentifiabilitySection>,
                                        OfModel<ProfileSection>,
                                        OfModel<BehaviourSection>,
                                        OfModel<LoopSection>,
                                        FrequencySection,
                                        FigureSection,
                                        MotionSection,
                                        OfModel<RecordingSection>,
                                        OfModel<LeverageSection>,
                                        OfModel<ResidualSection>,
                                        OfModel<AdviceSection>,
                                        OfModel<ProvenanceSection>};

}  // namespace

Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   int num_threads, const JobProgress& progress) {
  const FitResult& result = model.fit;
  Report report;
  report.title = "pushid: " + std::to_string(result.recordings.size()) + " recordings (" +
                 model.provenance.setting + "), preset " + result.options.preset;
  report.subtitle =
      "parameters, their uncertainty and their predictions; pushid " + model.provenance.version;
  ReportSource source{model};
  source.views = ViewRecordings(result, recordings, num_threads, progress);
  source.frequency = FrequencyResponses(ModelOf(result), MakePendulumRecordings(recordings));
  std::vector<const PropagationScore*> scores;
  for (const RecordingView& view : source.views) scores.push_back(&view.score.propagation);
  source.propagation = SummarizePropagation(scores);
  for (RenderSection* const render : kSections) report.sections.push_back(render(source));
  return report;
}

std::string DetailsText(const FittedModel& model) { return ToText(BuildReport(model, {})); }

ReportSection LeadSection(const ReportSource& source) {
  ReportSection section{"short", "In short"};
  const std::string verdict = FirstSentences(source.fit, !source.fit.verdict.fails());
  section.verdict_first = !source.fit.verdict.fails() && source.fit.verdict.none_identified.empty();
  (section.verdict_first ? section.paragraphs.emplace_back() : section.alarm) = verdict;
  const std::vector<Advice>& advice = source.model.advice;
  section.Say("What to do next: " +
              (advice.empty() ? "predict a push that was not fitted." : advice.front().sentence));
  section.Say(DifferencesText(source.fit));
  section.Say(GainsText(source.fit));
  section.Say(BalanceText(source.fit));
  const std::string travels = TravelText(source.propagation);
  section.Say(travels.empty() ? "" : "How the push travels in the fitted recordings: " + travels);
  if (const std::optional<ReportFigure> typical = TypicalFigure(source))
    section.figures.push_back(*typical);
  const ReportFigure known = IntervalFigure(source.model, true);
  if (!known.numbers.empty()) section.figures.push_back(known);
  section.Show("", ShortTable(source.fit));
  TextTable legend({"name", "unit", "meaning"});
  for (const Estimate& e : source.fit.estimates) {
    const ParameterSpec* spec = source.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    legend.Add({e.name, e.unit == "1" ? "-" : e.unit, spec->meaning});
  }
  section.Show("what the names mean", legend);
  return section;
}

ReportSection FrequencySection(const ReportSource& source) {
  ReportSection section{"frequency", "Frequency response"};
  if (source.frequency.empty()) return section;
  section.Say(
      "The response of people to a continuous disturbance, by frequency: the cross spectrum of "
      "response and disturbance over the spectrum of the disturbance, computed for each person, "
      "then the mean of log gain and phase over people. Frequencies whose coherence could be "
      "chance are left out. The model's curve is the closed form of its linearized loop, with the "
      "same people's parameters.");
  const std::string without = WithoutLinearLoop(source.fit.options.model);
  section.Say(without.empty() ? "" : "There is no curve: " + without + ".");
  for (const FrequencyResponse& response : source.frequency) {
    const size_t people = response.people.size();
    const std::string caption =
        response.Name() + ": " + CountText(response.recordings, "recording") + " of " +
        CountText(people, "person", "people") + "; the excited frequencies, in periods of " +
        Rounded(response.segment_s, 3) + " s" +
        (response.output == LoopOutput::kAngle ? "" : "; torque by force platforms") +
        (people == 1 ? "; errors by the coherence." : "; errors from person to person.");
    section.figures.push_back(
        {"frequency_" + response.Key(), caption, BodeFigure(response), FrequencyTable({response})});
  }
  return section;
}

}  // namespace pushid
