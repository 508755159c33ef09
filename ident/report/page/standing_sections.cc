// ident: people who stand: the identified loop, its frequency response, and how they sway.
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr double kDegrees = 180.0 / M_PI;

BodePlot PlotOf(const FrequencyResponse& response) {
  BodePlot plot;
  plot.gain_unit = response.OutputUnit() + "/" + response.InputUnit();
  for (const FrequencyBin& bin : response.bins) {
    const double lower = bin.log_gain - bin.log_gain_error;
    const double upper = bin.log_gain + bin.log_gain_error;
    plot.measured.push_back({bin.hz, std::exp(bin.log_gain), std::exp(lower), std::exp(upper),
                             kDegrees * bin.phase, kDegrees * bin.phase_error, bin.coherence});
  }
  plot.hz = response.model.hz;
  for (double gain : response.model.log_gain) plot.gain.push_back(std::exp(gain));
  for (double phase : response.model.phase) plot.phase.push_back(kDegrees * phase);
  Unwrap(&plot);
  return plot;
}

std::string CaptionOf(const FrequencyResponse& response) {
  const size_t people = response.people.size();
  std::string text = response.Name() + ": " + std::to_string(response.recordings) +
                     (response.recordings == 1 ? " recording of " : " recordings of ") +
                     std::to_string(people) + (people == 1 ? " person" : " people") + "; ";
  text += response.periodic
              ? "the excited frequencies, in periods of " + Rounded(response.segment_s, 3) + " s"
              : "Welch's method, segments of " + Rounded(response.segment_s, 3) + " s";
  if (response.output == LoopOutput::kTorque) {
    text += response.by_plates ? "; torque by force platforms" : "; torque by inverse dynamics";
  }
  return text + (people == 1 ? "; errors by the coherence." : "; errors from person to person.");
}

// A panel for each measure, a row for each person.
Figure SwayFigure(const std::vector<PersonSway>& people) {
  Figure figure;
  for (int i = 0; i < kNumSwayMeasures; ++i) {
    Chart chart{kSwayMeasures[i].name, kSwayMeasures[i].unit};
    ChartLine measured{{}, kMeasuredLook, true};
    for (size_t n = 0; n < people.size(); ++n) {
      const double row = static_cast<double>(n);
      chart.y_categories.push_back(people[n].person);
      measured.points.emplace_back(people[n].measured[i], row);
      if (people[n].repeats == 0) continue;
      const double from = people[n].simulated[i] - people[n].spread[i];
      const double to = people[n].simulated[i] + people[n].spread[i];
      chart.lines.push_back({{{from, row}, {to, row}}, kPredictedLook});
    }
    chart.lines.push_back(measured);
    figure.panels.push_back(chart);
  }
  return figure;
}

// "0.12 +- 0.02"
std::string SimulatedText(const PersonSway& one, int measure) {
  return one.repeats > 0 ? WithError(one.simulated[measure], one.spread[measure]) : "-";
}

}  // namespace

ReportSection LoopSection(const ReportSource& source) {
  ReportSection section;
  section.Say(LoopText(source.fit));
  if (section.paragraphs.empty()) return section;
  section.Say(
      "Of the linearized model of a person of 85 kg with a rod of 0.95 m at rest. Phase and delay "
      "margin: how much later feedback may come; the last column: between which factors its gains "
      "may change.");
  section.Show("", LoopTable(source.fit));
  return section;
}

ReportSection FrequencySection(const ReportSource& source) {
  ReportSection section;
  const std::vector<FrequencyResponse>& responses = source.frequency;
  if (responses.empty()) return section;
  section.paragraphs = {
      "How people answer what disturbs them on and on, frequency by frequency: the cross spectrum "
      "of the answer and the disturbance over the spectrum of the disturbance, of each person "
      "first, then the mean of log gain and phase over people. Frequencies whose coherence could "
      "be chance are left out. The model's curve is the closed form of its linearized loop, with "
      "the same people's parameters."};
  section.Say(WithoutLinearLoop(source.fit.options.model).empty()
                  ? ""
                  : "There is no curve: " + WithoutLinearLoop(source.fit.options.model) + ".");
  for (const FrequencyResponse& response : responses) {
    section.figures.push_back({"frequency_" + response.Key(), CaptionOf(response),
                               BodeFigure(PlotOf(response)), FrequencyTable({response})});
  }
  return section;
}

ReportSection SwaySection(const ReportSource& source) {
  ReportSection section;
  const std::vector<PersonSway>& people = source.sway;
  if (people.empty()) return section;
  const bool simulated = source.fit.options.model.process_noise != ProcessNoise::kNone;
  section.paragraphs = {
      std::string("Recordings in which nobody is pushed and the ground rests: path, root mean "
                  "square, mean power frequency (0.15 to 5 Hz) and 95 % ellipse of the centre of "
                  "pressure where platforms measured, else of the hip (Prieto et al. 1996), below "
                  "5 Hz. ") +
      (simulated ? "Simulated: mean and standard deviation of rollouts that the identified process "
                   "noise drives."
                 : "The model has no process noise to simulate them with "
                   "(--likelihood=innovation).")};
  std::vector<std::string> header = {"person", "of", ""};
  for (const Metric& measure : kSwayMeasures) header.push_back(measure.Title());
  std::vector<bool> left(header.size(), false);
  left[0] = left[1] = left[2] = true;
  TextTable table(header, left);
  for (const PersonSway& one : people) {
    std::vector<std::string> measured = {one.person, one.by_plates ? "pressure" : "hip",
                                         "measured"};
    std::vector<std::string> model = {"", "", "simulated"};
    for (int i = 0; i < kNumSwayMeasures; ++i) {
      measured.push_back(Rounded(one.measured[i], 3));
      model.push_back(SimulatedText(one, i));
    }
    table.Add(measured);
    if (one.repeats > 0) table.Add(model);
  }
  section.figures.push_back({"sway",
                             simulated ? "Measured (dots) and simulated, one standard deviation "
                                         "about the mean (lines)."
                                       : "Measured.",
                             SwayFigure(people), SwayTable(people)});
  section.Show("sway of quiet stance", table);
  return section;
}

}  // namespace pushid
