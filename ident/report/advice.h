// ident: advice after a fit: a sentence, and a command that repeats the fit with some flags
// changed.
//
//   FitCommand("pushid-fit", model.provenance).Set("self_force", "linear").ToString()
//   -> pushid-fit --recordings=M/manifest.json --preset=ldp --self_force=linear
#pragma once

#include <nlohmann/ordered_map.hpp>
#include <string>
#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

// The flags of pushid-check that question a fit and are no part of it: profiles, bootstrap, design.
const std::vector<std::string>& CheckFlagNames();

class FitCommand {
 public:
  // Every flag of the fit that was not at its default, but for those of CheckFlagNames.
  FitCommand(std::string program, const Provenance& provenance);
  // pushid-check of the fitted model, with FILE for the model's file.
  static FitCommand Check(const Provenance& provenance);

  // Replaces the value that the fit had.
  FitCommand& Set(const std::string& flag, const std::string& value) {
    flags_[flag] = value;
    return *this;
  }
  // Appends an item to a comma-separated list, because a flag that is given twice loses the first
  // list. A parameter that becomes fixed is removed from the lists of free and pooled ones.
  FitCommand& Append(const std::string& flag, const std::string& item);
  // The list that Append would make.
  std::string Appended(const std::string& flag, const std::string& item) const;

  // Values are quoted for a shell where they need it.
  std::string ToString() const;

 private:
  explicit FitCommand(std::string program) : program_(std::move(program)) {}
  // Takes a parameter out of a list; `without` replaces an empty list.
  void TakeOut(const std::string& flag, const std::string& name, const char* without);
  std::string program_;
  nlohmann::ordered_map<std::string, std::string> flags_;  // in the order they are printed
};

// An advised command as it is printed: with the name of the model's file, if there is one, for
// FILE.
std::string CommandFor(const Provenance& provenance, std::string command);
// True for commands of pushid-check, which need the model's file.
bool NamesModel(const std::string& command);

// The next steps that the findings of a fit suggest, the most pressing first: a pure function of
// the fitted model. Commands repeat the settings of the fit.
std::vector<Advice> Advise(const FittedModel& model);

}  // namespace pushid
