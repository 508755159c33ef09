// apps: what the library says for a command line, in the words of Python: options and calls.
#include <algorithm>
#include <map>
#include <regex>

#include "apps/python/bindings.h"
#include "datasets/files/names.h"

namespace pushid {
namespace {

// Programs as calls, with their first argument.
struct Call {
  const char *name, *first;
};
const std::map<std::string, Call> kCalls = {
    {"fit", {"pushid.fit", "recordings"}},
    {"crossvalidate", {"pushid.crossvalidate", "recordings"}},
    {"evaluate", {"result.evaluate", "recordings"}},
    {"predict", {"result.predict", "recording"}},
    {"report", {"result.report", ""}},
    {"push", {"pushid.estimate_push", "recording"}},
    {"simulate", {"pushid.simulate", ""}},
    {"formation", {"pushid.simulate_formation", "result"}},
};

// Flags of pushid-check that are methods of a result, and flags whose values are names.
constexpr const char* kMethods[] = {"profile", "bootstrap", "design", "horizon_check", "learn_forecasts"};
constexpr const char* kLists[] = {"fix", "free", "set", "leave_out", "ids"};

template <size_t N>
bool IsOf(const char* const (&names)[N], const std::string& name) {
  return std::find(names, names + N, name) != names + N;
}

std::string Value(const std::string& text) {
  static const std::regex number(R"([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)");
  if (text == "true") return "True";
  if (text == "false") return "False";
  return std::regex_match(text, number) ? text : "\"" + text + "\"";
}

// "mu=30,Kp_x" -> {"mu": 30, "Kp_x": None}; without values ["mu", "Kp_x"].
std::string NamesOf(const std::string& text) {
  const bool dict = text.find('=') != std::string::npos;
  std::string items;
  for (const std::string& part : SplitList(text)) {
    const size_t sign = part.find('=');
    items += (items.empty() ? "" : ", ") + ("\"" + part.substr(0, sign) + "\"");
    if (dict) items += sign == std::string::npos ? ": None" : ": " + Value(part.substr(sign + 1));
  }
  return dict ? "{" + items + "}" : "[" + items + "]";
}

// A flag and its value; values end where the sentence goes on: with a space, a bracket, or a stop
// before one of them.
const std::string kFlag = R"re(--[a-z][a-z0-9_]*(?:=[^\s()"';:]*[^\s()"';:.,])?)re";

std::string Option(const std::string& flag) {
  const size_t sign = flag.find('=');
  const std::string name = flag.substr(2, sign - 2);
  const std::string value = sign == std::string::npos ? "" : flag.substr(sign + 1);
  if (IsOf(kMethods, name)) {
    const bool plain = value.empty() || value == "true" || value == "all";
    return "result." + name + "(" + (plain ? "" : Value(value)) + ")";
  }
  if (sign == std::string::npos) return name;
  return name + "=" + (IsOf(kLists, name) ? NamesOf(value) : Value(value));
}

// pushid-fit --a=1 --b=2 -> pushid.fit(recordings, a=1, b=2); a program without a call stays.
std::string CallOf(const std::string& program, const std::string& flags) {
  static const std::regex flag(kFlag);
  const auto call = kCalls.find(program);
  std::string arguments = call == kCalls.end() ? "" : call->second.first;
  for (std::sregex_iterator it(flags.begin(), flags.end(), flag), end; it != end; ++it) {
    const std::string option = Option(it->str());
    if (option.rfind("result.", 0) == 0) return option;
    arguments += (arguments.empty() ? "" : ", ") + option;
  }
  if (call == kCalls.end()) return "pushid-" + program + flags;
  return call->second.name + (flags.empty() ? std::string() : "(" + arguments + ")");
}

template <typename Replace>
std::string Replaced(const std::string& text, const std::regex& what, Replace replace) {
  std::string result;
  auto from = text.cbegin();
  for (std::sregex_iterator it(text.begin(), text.end(), what), end; it != end; ++it) {
    result.append(from, text.cbegin() + it->position());
    result += replace(*it);
    from = text.cbegin() + it->position() + it->length();
  }
  return result.append(from, text.cend());
}

}  // namespace

std::string InPython(const std::string& text) {
  static const std::regex saving("pushid-fit --model_out");
  static const std::regex axes("set \"up\" and \"forward\" in the manifest");
  static const std::regex program("pushid-([a-z]+)((?: " + kFlag + ")*)");
  static const std::regex flag("(^|[^A-Za-z0-9_-])(" + kFlag + ")");
  const std::string calls =
      Replaced(std::regex_replace(std::regex_replace(text, saving, "result.save"), axes,
                                  "$& (or turn arrays: z up, x forward)"),
               program, [](const std::smatch& m) { return CallOf(m[1], m[2]); });
  return Replaced(calls, flag, [](const std::smatch& m) { return m[1].str() + Option(m[2]); });
}

std::vector<std::string> InPython(const Warnings& warnings) {
  std::vector<std::string> words = GroupedWarnings(warnings);
  for (std::string& text : words) text = InPython(text);
  return words;
}

}  // namespace pushid
