// datasets: JSON files in and out, with errors that name line and column, and typed values taken
// out of their objects.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "models/enum_names.h"

namespace pushid {

// A JSON file with its text at hand, so that a wrong value can be pointed at.
struct JsonDocument {
  std::string path;
  std::string text;  // without a byte order mark
  nlohmann::ordered_json content;

  // An Error at the place of the value that `pointer` names ("/recordings/3/fps"); at the innermost
  // existing container around it when there is no such value.
  Error ErrorAt(const std::string& pointer, std::string message) const;

  // The line each element of the list at `pointer` starts in, found in one pass over the text.
  std::vector<int> ElementLines(const std::string& pointer) const;
};

// A required key that an object lacks.
struct MissingKey {
  std::string label, pointer;  // of the object: "recording 'a'", "/recordings/0"
  std::string key, what;       // "fps", "the frames per second"
};

// "recording 'a': fps and id are missing; fps must be ...; id must be ...; recording 'b': ..."
std::string MissingText(const std::vector<MissingKey>& missing);

// " (here it is spelt 'Mass_kg')" for mass_kg, where the object has a key so like it; or nothing.
std::string SpeltOtherwise(const nlohmann::ordered_json& object, const std::string& key);

// Errors: unreadable file, JSON syntax (line, column), nesting deeper than 200.
Result<JsonDocument> ReadJsonDocument(const std::string& path);

// Writes atomically, indented by `indent` spaces, with a newline at the end. Doubles are written so
// that they read back the same. NaN and infinity have no JSON and come out as null: say them in
// words instead. Bytes that are not UTF-8 are replaced.
MaybeError WriteJson(const std::string& path, const nlohmann::ordered_json& content,
                     int indent = 2);

// "60", "\"abc\"", "[...]": a value as a message shows it.
inline std::string Shown(const nlohmann::ordered_json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list";
  return Quoted(value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

// A list of texts, whole numbers or numbers; nullopt: the value is none.
template <typename T>
std::optional<std::vector<T>> ListOf(const nlohmann::ordered_json& value) {
  const auto fits = [](const nlohmann::ordered_json& item) {
    return std::is_same_v<T, std::string> ? item.is_string()
           : std::is_integral_v<T>        ? item.is_number_integer()
                                          : item.is_number();
  };
  if (!value.is_array() || !std::all_of(value.begin(), value.end(), fits)) return std::nullopt;
  return value.get<std::vector<T>>();
}

// Takes typed values out of one JSON object and remembers every required key that is missing and
// the first other thing that is wrong, so that a reader lists its keys one after the other and asks
// once at the end.
class JsonFields {
 public:
  // `label` begins every message: "recording 'single_X05_00'".
  JsonFields(const JsonDocument& document, const nlohmann::ordered_json& object,
             std::string pointer, std::string label)
      : document_(document),
        object_(object),
        pointer_(std::move(pointer)),
        label_(std::move(label)) {
    if (!object_.is_object()) Fail("", "must be an object { }, not " + Shown(object_));
  }

  bool Has(const char* key) const {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
    return object_.is_object() && object_.contains(key);
  }
  const nlohmann::ordered_json& At(const char* key) const { return object_.at(key); }
  std::string Pointer(const std::string& key) const {
    return key.empty() ? pointer_ : pointer_ + "/" + key;
  }
  const std::string& label() const { return label_; }
  void set_label(std::string label) { label_ = std::move(label); }
  // One error that lists all missing keys; otherwise the first other mistake.
  MaybeError error() const {
    if (missing_.empty()) return error_;
    const MissingKey& first = missing_.front();
    return document_.ErrorAt(first.pointer + "/" + first.key, MissingText(missing_));
  }
  bool failed() const { return error_ || !missing_.empty(); }
  bool is_wrong() const { return error_.has_value(); }  // by more than missing keys

  void Fail(const std::string& key, const std::string& problem) {
    if (error_) return;
    error_ = document_.ErrorAt(Pointer(key),
                               label_ + ": " + (key.empty() ? problem : key + " " + problem));
  }
  void Fail(const MaybeError& error) {
    if (!error_) error_ = error;
  }
  // Takes over the mistakes of an object inside this one.
  void Add(const JsonFields& inner) {
    missing_.insert(missing_.end(), inner.missing_.begin(), inner.missing_.end());
    Fail(inner.error_);
  }

  // The fields of a value that stands at `place` ("ground", "pushes/0") inside this object.
  JsonFields Inside(const nlohmann::ordered_json& value, const std::string& place,
                    const std::string& label) const {
    return {document_, value, Pointer(place), label_ + ", " + label};
  }

  // The keys that were asked for, which are those that its reader knows.
  const std::vector<std::string>& asked() const { return asked_; }

  // Called after all keys were read: unknown keys are mistakes, and are reported before all others,
  // since they would be ignored silently.
  void OnlyAsked() {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items()) {
      if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
      error_.reset();
      Fail(key, "is not known; there may be " + ListOfNames(asked_));
      return;
    }
  }

  bool Require(const char* key, const std::string& what) {
    if (Has(key)) return true;
    if (object_.is_object()) {
      missing_.push_back({label_, pointer_, key, what + SpeltOtherwise(object_, key)});
    }
    return false;
  }

  std::string Text(const char* key, const std::string& what) {
    return Require(key, what) ? OptionalText(key, "") : "";
  }

  std::string OptionalText(const char* key, const std::string& fallback) {
    if (!Has(key)) return fallback;
    if (!At(key).is_string()) {
      Fail(key, "must be text in quotes, not " + Shown(At(key)));
      return fallback;
    }
    return At(key).get<std::string>();
  }

  double Number(const char* key, const std::string& what) {
    if (!Require(key, what)) return 0.0;
    if (!At(key).is_number()) {
      Fail(key, "must be " + what + ", not " + Shown(At(key)));
      return 0.0;
    }
    return At(key).get<double>();
  }

  double OptionalNumber(const char* key, const std::string& what, double fallback) {
    return Has(key) ? Number(key, what) : fallback;
  }
  std::optional<double> NumberIfAny(const char* key, const std::string& what) {
    return Has(key) ? std::optional(Number(key, what)) : std::nullopt;
  }
  // A whole number in [lowest, highest].
  int Whole(const char* key, const std::string& what, int lowest, int highest) {
    const double value = Number(key, what);
    if (failed()) return lowest;
    if (std::floor(value) != value || value < lowest || value > highest) {
      Fail(key, "is " + Shown(At(key)) + "; it must be " + what);
      return lowest;
    }
    return static_cast<int>(value);
  }

  int OptionalWhole(const char* key, const std::string& what, int lowest, int highest,
                    int fallback) {
    return Has(key) ? Whole(key, what, lowest, highest) : fallback;
  }

  // The list under `key`, or an empty one.
  const nlohmann::ordered_json& List(const char* key) {
    static const nlohmann::ordered_json kEmpty = nlohmann::ordered_json::array();
    if (!Has(key)) return kEmpty;
    if (At(key).is_array()) return At(key);
    Fail(key, "must be a list [ ], not " + Shown(At(key)));
    return kEmpty;
  }

  // A choice by its name (models/enum_names.h).
  template <typename E>
  E Choice(const char* key, E fallback) {
    if (!Has(key)) return fallback;
    const std::string name = OptionalText(key, "");
    const std::optional<E> choice = FromName<E>(name);
    if (!choice) Fail(key, "is " + Quoted(name) + "; it must be " + AnyName<E>());
    return choice.value_or(fallback);
  }

 private:
  const JsonDocument& document_;
  const nlohmann::ordered_json& object_;
  std::string pointer_;
  std::string label_;
  mutable std::vector<std::string> asked_;
  std::vector<MissingKey> missing_;
  MaybeError error_;
};

}  // namespace pushid
