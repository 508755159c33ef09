// ident: from named options, as flags or keywords give them, to what a fit is asked to do.
//
//   MakeFitOptions({{"preset", "tail"}, {"self_force", "linear"}, {"fix", "mu=40"}})
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/model/identified_model.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Names of rows of the option table with their values in words.
using GivenOptions = std::vector<std::pair<std::string, std::string>>;

// `more` over `given`: what both name has the value of `more`, and what it fixes is not free.
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

// MakeFitOptions in two steps: before recordings are read, and for them.
class FitSetup {
 public:
  static Result<FitSetup> Make(GivenOptions given, GivenOptions must_act = {});

  // The options as far as they do not depend on the recordings: how these are loaded.
  const FitOptions& roughly() const { return roughly_; }
  Result<FitOptions> For(const std::vector<PendulumRecording>& recordings) const {
    return MakeFitOptions(given_, &recordings, must_act_);
  }
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

// Makes options fit for these recordings: holds what can have no effect on any of them (the tail,
// where every push is measured whole), pools nothing where all belong to one unit, and adds the
// slopes of covariates and contrasts to the table (covariates.h). Errors: invalid options, nothing
// left to fit, a free parameter without effect, those of AddCovariates and CheckLaboratory.
// warnings (may be null): people who touch without any term between them; masses, rods, pushes and
// motions that no person has. Every fit begins with it: of the programs, of cross-validation, of
// users of the library.
MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      Warnings* warnings = nullptr);

// Whether a model with a delay, moving ground, platforms or other bodies fits recordings. Errors
// name the recording, what does not go together and what to do: a delay beyond a recording, masses
// from the table where feet stand, platforms under people who touch, anything of it with networks
// that are trained by their gradient.
MaybeError CheckLaboratory(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options);

// The model that recordings of synthetic people are made from: the tail preset, or that of groups
// where people stand in rows, with the feet and the process noise of study.model: what it fits has
// values near those identified from the published recordings, what it holds keeps its value. set:
// values that replace these ("mu=20,a_x=-5").
Result<IdentifiedModel> SyntheticTruth(const SyntheticOptions& study, const std::string& set);

}  // namespace pushid
