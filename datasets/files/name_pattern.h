// datasets: naming patterns of recordings: "{setting}/{subject}_{magnitude}_{take}.c3d".
//
// A name in braces stands for one or more characters other than /, as few as make the whole fit;
// the same name twice means the same text. * stands for any characters other than /, that do not
// matter. Everything else stands for itself.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

class NamePattern {
 public:
  // Errors: a brace that is not closed or closes nothing, an empty name, no name at all.
  static Result<NamePattern> Parse(const std::string& text);

  const std::vector<std::string>& names() const { return names_; }  // each once, in order
  bool Has(const std::string& name) const;
  bool HasStar() const;

  // The values of all names where `path` fits entirely.
  std::optional<std::map<std::string, std::string>> Match(const std::string& path) const;

  // The pattern with its names replaced; nullopt where a value is missing or the pattern has a *.
  std::optional<std::string> Fill(const std::map<std::string, std::string>& values) const;

 private:
  struct Piece {
    enum Kind { kText, kName, kAnything } kind;
    std::string text;  // or the name
  };
  bool MatchFrom(std::size_t piece, const std::string& path, std::size_t at,
                 std::map<std::string, std::string>* values, int* tries) const;

  std::vector<Piece> pieces_;
  std::vector<std::string> names_;
};

}  // namespace pushid
