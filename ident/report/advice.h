// ident: a command line that repeats a fit, with some flags changed: what advice consists of.
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
  // One more item of a comma-separated list: the flag given twice would lose the first list. What
  // is fixed is neither free nor pooled any more.
  FitCommand& Append(const std::string& flag, const std::string& item);
  // The list that Append would make.
  std::string Appended(const std::string& flag, const std::string& item) const;

  // Values are quoted for a shell where they need it.
  std::string ToString() const;

 private:
  explicit FitCommand(std::string program) : program_(std::move(program)) {}
  // Takes a parameter out of a list; without any left the list says none, or is gone.
  void TakeOut(const std::string& flag, const std::string& name, const char* without);
  std::string program_;
  nlohmann::ordered_map<std::string, std::string> flags_;  // in the order they are printed
};

// An advised command as it is printed: with the model's file instead of FILE, where one keeps it.
std::string CommandFor(const Provenance& provenance, std::string command);
// True for commands of pushid-check, which need the model's file.
bool NamesModel(const std::string& command);

// Rules from findings to next steps in plain words, the most pressing first: a pure function of a
// fitted model. Commands repeat the settings of the fit.
std::vector<Advice> Advise(const FittedModel& model);

}  // namespace pushid
