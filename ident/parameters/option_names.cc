// ident: names of the interaction terms.
#include "ident/parameters/option_names.h"

#include <sstream>
#include <utility>
#include <vector>

namespace pushid {

namespace {

using TermNames = std::vector<std::pair<const char*, bool InteractionTerms::*>>;
const TermNames& Terms() {
  static const TermNames names = {{"spring", &InteractionTerms::spring},
                                  {"damping", &InteractionTerms::damping},
                                  {"potential", &InteractionTerms::potential},
                                  {"lean", &InteractionTerms::lean},
                                  {"ldp_discrete", &InteractionTerms::ldp_discrete},
                                  {"network", &InteractionTerms::network},
                                  {"drive", &InteractionTerms::drive}};
  return names;
}

// Empty for an unknown name.
std::vector<bool InteractionTerms::*> TermsOf(const std::string& name) {
  if (name == "contact") return {&InteractionTerms::spring, &InteractionTerms::damping};
  if (name == "ldp") return {&InteractionTerms::potential, &InteractionTerms::lean};
  for (const auto& [known, member] : Terms()) {
    if (name == known) return {member};
  }
  return {};
}

}  // namespace

std::string NameOf(const InteractionTerms& terms) {
  std::string text;
  for (const auto& [name, member] : Terms()) {
    if (terms.*member) text += (text.empty() ? "" : ",") + std::string(name);
  }
  return text.empty() ? "none" : text;
}

MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms) {
  *terms = {};
  if (text == "none") return std::nullopt;
  std::stringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    const std::vector<bool InteractionTerms::*> members = TermsOf(part);
    if (part == "none") return Error{flag + ": none stands alone; leave it or the others out"};
    if (members.empty()) {
      return Error{flag + " names '" + part +
                   "'; it must be none, or some of contact (spring,damping), ldp "
                   "(potential,lean), spring, damping, potential, lean, ldp_discrete, network, "
                   "drive"};
    }
    for (bool InteractionTerms::*member : members) {
      if (terms->*member) {
        return Error{flag + " names '" + part +
                     "' twice (contact is spring,damping; ldp is potential,lean)"};
      }
      terms->*member = true;
    }
  }
  if (terms->drive && !terms->Any()) {
    return Error{flag + ": drive acts on what people receive from others; add contact or ldp"};
  }
  return std::nullopt;
}

}  // namespace pushid
