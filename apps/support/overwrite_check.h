// apps: no program replaces what it reads, nor one of its outputs by another.
//
// Outputs are known by their flags' names (out, *_out, bootstrap_file), inputs by the list in
// overwrite_check.cc; so the check holds for every program at once.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/names.h"

namespace pushid {

// Whether a flag of this name says where to write. Here, so that plans are read without flags.
inline bool IsOutputFlag(const std::string& name) {
  return name == "out" || name == "bootstrap_file" ||
         (EndsWith(name, "_out") && name != "leave_out" && name != "held_out");
}

// Whether the outputs that are named (not empty) can be written, before a long run.
MaybeError CheckOutputFiles(std::initializer_list<std::string> files);

// Between the flags, as they are given. RunApp asks for it before anything is done.
MaybeError CheckOutputs();

// The files that the output flags name.
class OutputFiles {
 public:
  OutputFiles();

  // For an input that no flag names: `reader` says what does ("--sensors", "the command line").
  MaybeError CheckNotRead(const std::string& reader, const std::string& path) const;

 private:
  friend MaybeError CheckOutputs();
  struct NamedPath {
    std::string name, path;
    std::string help;  // of the flag
  };
  std::vector<NamedPath> files_;
};

}  // namespace pushid
