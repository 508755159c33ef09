// ident: names of interaction terms, and covariates by parameter.
#include "ident/parameters/option_names.h"

#include <set>
#include <utility>
#include <vector>

#include "datasets/files/names.h"

namespace pushid {
namespace {

// Empty for an unknown name.
std::vector<bool InteractionTerms::*> TermsOf(const std::string& name) {
  if (name == "contact") return {&InteractionTerms::spring, &InteractionTerms::damping};
  for (const InteractionTermName& term : kInteractionTerms) {
    if (name == term.name) return {term.member};
  }
  return {};
}

}  // namespace

std::string NameOf(const InteractionTerms& terms) {
  std::string text;
  for (const InteractionTermName& row : kInteractionTerms) {
    if (terms.*row.member) text += (text.empty() ? "" : ",") + std::string(row.name);
  }
  return text.empty() ? "none" : text;
}

MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms) {
  *terms = {};
  if (text == "none") return std::nullopt;
  for (const std::string& part : SplitList(text)) {
    const std::vector<bool InteractionTerms::*> members = TermsOf(part);
    if (part == "none") return Error{flag + ": none stands alone; leave it or the others out"};
    if (members.empty()) {
      std::string known = "contact (spring,damping)";
      for (const auto& term : kInteractionTerms) known += ", " + std::string(term.name);
      return Error{flag + " names '" + part + "'; it must be none, or some of " + known};
    }
    for (bool InteractionTerms::*member : members) {
      if (terms->*member) {
        return Error{flag + " names '" + part + "' twice (contact is spring,damping)"};
      }
      terms->*member = true;
    }
  }
  return std::nullopt;
}

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
