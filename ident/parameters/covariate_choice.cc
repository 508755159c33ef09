// ident: parameters and their covariates from words.
#include "ident/parameters/covariate_choice.h"

#include <set>

#include "datasets/files/names.h"

namespace pushid {
namespace {

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

Error Misspelt(const std::string& part) {
  return Error{"--covariate: " + Quoted(part) +
               " is not PARAMETER ~ KEY + KEY, as in 'Kp_theta ~ age + height; Kd_theta ~ age'"};
}

}  // namespace

Result<std::vector<CovariatesOfParameter>> ParseCovariates(const std::string& text) {
  std::vector<CovariatesOfParameter> all;
  std::set<std::string> seen;
  for (const std::string& entry : SplitList(text, ';')) {
    const std::string part = Trimmed(entry);
    if (part.empty()) continue;
    const size_t tilde = part.find('~');
    if (tilde == std::string::npos || part.find('~', tilde + 1) != std::string::npos) {
      return Misspelt(part);
    }
    CovariatesOfParameter one{Trimmed(part.substr(0, tilde)), {}};
    const std::string keys = Trimmed(part.substr(tilde + 1));
    if (one.parameter.empty() || keys.empty() || keys.back() == '+') return Misspelt(part);
    for (const std::string& word : SplitList(keys, '+')) {
      one.keys.push_back(Trimmed(word));
      if (one.keys.back().empty()) return Misspelt(part);
      if (!seen.insert(one.parameter + "~" + one.keys.back()).second) {
        return Error{"--covariate names " + one.keys.back() + " of " + one.parameter + " twice"};
      }
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace pushid
