// datasets: what looks unusual but can be lived with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pushid {

struct Warning {
  std::string text;            // the sentence
  std::string recording = {};  // id, where it is of one
  std::string of_many = {};    // what it says of several: "the file has gaps"

  Warning() = default;
  // A warning about no single recording.
  Warning(std::string sentence)
      : text(std::move(sentence)) {}                 // NOLINT(google-explicit-constructor)
  Warning(const char* sentence) : text(sentence) {}  // NOLINT(google-explicit-constructor)
  Warning(std::string sentence, std::string id, std::string same)
      : text(std::move(sentence)), recording(std::move(id)), of_many(std::move(same)) {}
};
using Warnings = std::vector<Warning>;

// Warnings that say the same of several recordings become one: "in 32 recordings (a, b, c, ...):
// the file has gaps". Equal ones become one with how often. In the order of their first.
std::vector<std::string> GroupedWarnings(const Warnings& warnings);

}  // namespace pushid
