// ident: from named options, as flags or keywords give them, to what a fit is asked to do.
//
//   MakeFitOptions({{"preset", "tail"}, {"self_force", "linear"}, {"fix", "mu=40"}})
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Names of rows of the option table with their values in words.
using GivenOptions = std::vector<std::pair<std::string, std::string>>;

// `more` over `given`: what both name has the value of `more`.
GivenOptions Merged(GivenOptions given, const GivenOptions& more);

// "--self_force=linear --push_tail=none". Errors: a word that is no option of a fit.
Result<GivenOptions> ParseOptionWords(const std::string& words);

// The preset, the given options over it, the parameters that the model's terms free, and the edits
// of the table. recordings: what `auto` of preset and stance looks at; null: none are known yet,
// and the preset is whichever of tail and group can take the options. must_act: those of the given
// options that must act on something. Errors name the option, its value and what it must be, or
// what is missing.
Result<FitOptions> MakeFitOptions(const GivenOptions& given,
                                  const std::vector<PendulumRecording>* recordings = nullptr,
                                  const GivenOptions& must_act = {});

// MakeFitOptions in two steps, of which the second builds again only where the recordings decide
// for another preset than the first took.
class FitSetup {
 public:
  static Result<FitSetup> Make(GivenOptions given, GivenOptions must_act = {});

  // What does not depend on the recordings: how they are loaded, whether bodies are fitted.
  const FitOptions& roughly() const { return roughly_; }
  Result<FitOptions> For(const std::vector<PendulumRecording>& recordings) const;
  // These options with each other stance that goes with what was given; none where a stance was
  // given, or the preset has its own.
  std::vector<FitOptions> OtherStances(const std::vector<PendulumRecording>& recordings,
                                       const FitOptions& taken) const;

 private:
  FitSetup(GivenOptions given, GivenOptions must_act, FitOptions roughly)
      : given_(std::move(given)), must_act_(std::move(must_act)), roughly_(std::move(roughly)) {}
  GivenOptions given_, must_act_;
  FitOptions roughly_;
};

// Options that are taken but do nothing, or not what they seem to.
std::vector<std::string> OptionWarnings(const GivenOptions& given, const FitOptions& options);

}  // namespace pushid
