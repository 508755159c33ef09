// ident: margins in words.
#include <cmath>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/problem/linear_loop.h"
#include "ident/problem/statistics.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/assumptions.h"

namespace pushid {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kAlike = 1e-6;  // relative

struct NamedLoop {
  std::string name;
  LoopNumbers numbers;
};

bool Alike(const LoopNumbers& a, const LoopNumbers& b) {
  const auto same = [](double x, double y) {
    return std::abs(x - y) <= kAlike * (std::abs(x) + std::abs(y));
  };
  return same(a.stiffness_ratio, b.stiffness_ratio) &&
         same(a.damping_ratio.value_or(0.0), b.damping_ratio.value_or(0.0)) &&
         same(a.natural_hz.value_or(0.0), b.natural_hz.value_or(0.0)) &&
         same(a.delay_margin.value_or(0.0), b.delay_margin.value_or(0.0));
}

std::vector<NamedLoop> LoopsOf(const FitResult& result) {
  const ModelOptions& options = result.options.model;
  if (options.stance == Stance::kSlide || !WithoutLinearLoop(options).empty()) return {};
  const Body person;  // 85 kg, 0.95 m
  const LoopNumbers along = LinearLoop(options, person, result.parameters, 0).Numbers();
  const LoopNumbers across = LinearLoop(options, person, result.parameters, 1).Numbers();
  if (Alike(along, across)) return {{"both directions", along}};
  return {{"forwards (theta)", along}, {"sideways (phi)", across}};
}

std::string OrDash(const std::optional<double>& value, int digits, double unit = 1.0) {
  return value ? Rounded(unit * *value, digits) : "-";
}

std::string GainRange(const LoopNumbers& numbers) {
  if (!numbers.gain_down && !numbers.gain_up) return "-";
  return (numbers.gain_down ? Rounded(*numbers.gain_down, 2) : "0") + " - " +
         (numbers.gain_up ? Rounded(*numbers.gain_up, 2) : "any");
}

std::string Sentence(const NamedLoop& loop) {
  const LoopNumbers& n = loop.numbers;
  std::string text =
      "The loop, " + loop.name + ": stiffness " + Rounded(n.stiffness_ratio, 3) + " times m g l";
  if (!n.stable) {
    return text + "; UNSTABLE at rest, it grows at " + Rounded(n.fastest_growth, 2) +
           " 1/s: there are no margins.";
  }
  if (n.damping_ratio) {
    text += ", damping ratio " + Rounded(*n.damping_ratio, 2) + " of the oscillation at " +
            Rounded(*n.natural_hz, 2) + " Hz that dies out last";
  } else {
    text += ", no oscillation";
  }
  if (n.phase_margin) {
    text += "; phase margin " + Rounded(kDegrees * *n.phase_margin, 2) + " degrees at " +
            Rounded(*n.crossover_hz, 2) + " Hz";
  }
  if (n.delay_margin) {
    text += "; feedback that comes another " + Rounded(*n.delay_margin, 2) +
            " s later (delay margin) is unstable";
  }
  if (n.gain_down || n.gain_up) {
    text += "; so is feedback " +
            (n.gain_down ? Rounded(*n.gain_down, 2) + " times as strong or less" : std::string()) +
            (n.gain_down && n.gain_up ? ", or " : "") +
            (n.gain_up ? Rounded(*n.gain_up, 2) + " times as strong or more" : std::string());
  }
  return text + ".";
}

}  // namespace

TextTable LoopTable(const FitResult& result) {
  TextTable table({"loop", "stiffness/(m g l)", "damping ratio", "oscillates at, Hz",
                   "phase margin, deg", "delay margin, s", "gains stable at, times"},
                  {true, false, false, false, false, false, true});
  for (const NamedLoop& loop : LoopsOf(result)) {
    const LoopNumbers& n = loop.numbers;
    const auto if_stable = [&n](const std::string& text) { return n.stable ? text : "-"; };
    table.Add({loop.name + (n.stable ? "" : ": UNSTABLE"), Rounded(n.stiffness_ratio, 3),
               if_stable(OrDash(n.damping_ratio, 2)), if_stable(OrDash(n.natural_hz, 2)),
               OrDash(n.phase_margin, 3, kDegrees), OrDash(n.delay_margin, 2), GainRange(n)});
  }
  return table;
}

std::string LoopText(const FitResult& result) {
  std::string text;
  for (const NamedLoop& loop : LoopsOf(result)) text += Sentence(loop) + "\n";
  return text;
}

std::string LagText(const FitResult& result) {
  constexpr double kLeastDelay = 0.01, kLevel = 0.05;  // s; of a one-sided test
  for (const AssumptionTest& test : result.verdict.assumptions) {
    if (test.name != kReactionDelayName || test.error <= 0.0) continue;
    // One-sided: nobody reacts before they are pushed.
    const double p = 0.5 * StudentTail(test.wanted / test.error, result.verdict.freedom);
    if (test.wanted < kLeastDelay || p > kLevel) continue;
    return "The response lags (the residuals ask for a reaction delay of " +
           Rounded(test.wanted, 2) + " +- " + Rounded(test.error, 1) +
           " s), and damping comes out too low without it; try --delay=one.";
  }
  return "";
}

}  // namespace pushid
