// ident: one list of fields for the writing and the reading of JSON.
//
//   template <class Archive>
//   void Fields(Archive& a, SolveStage& stage) {
//     PUSHID_FIELDS(a, stage, horizon, iterations, cost);  // keys are the members' names
//     a("initial_cost", stage.first_cost);
//     if (a.Has("people")) a("people", stage.people);  // older files have none
//   }
//   Json json = JsonOf(stage);   SolveStage same = FromJson<SolveStage>(json);
//
// Keys are written in the order of the list, and nothing that is written is changed. Numbers,
// texts, enums with a table of names, vectors, maps by text, matrices by rows, and everything that
// has a list of fields itself. Readers throw what nlohmann's JSON throws for what is missing or of
// another type, and std::runtime_error for unknown names and what Check() finds.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "datasets/files/names.h"

// At most sixty, by the macros with which nlohmann's JSON goes through members.
#define PUSHID_FIELDS(archive, object, ...)                              \
  do {                                                                   \
    auto& fields_of = archive;                                           \
    auto& has_fields = object;                                           \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(PUSHID_FIELD, __VA_ARGS__)) \
  } while (false)
#define PUSHID_FIELD(name) fields_of(#name, has_fields.name);
// The whole list of a type whose keys are its members' names.
#define PUSHID_FIELDS_OF(Type, ...)       \
  template <class Archive>                \
  void Fields(Archive& a, Type& value) {  \
    PUSHID_FIELDS(a, value, __VA_ARGS__); \
  }

namespace pushid {

// What is wrong with an entry, whose path it gives.
class WrongEntry : public std::runtime_error {
 public:
  WrongEntry(std::string path, const std::string& what)
      : std::runtime_error(what), path_(std::move(path)) {}
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// What an exception says for people: without nlohmann's "[json.exception.type_error.302] ".
inline std::string ReasonOf(const std::exception& exception) {
  const std::string text = exception.what();
  const size_t end = text.rfind("[json.exception", 0) == 0 ? text.find("] ") : std::string::npos;
  return end == std::string::npos ? text : text.substr(end + 2);
}

// What `read` gives; what it throws is said of that path.
template <typename Read>
auto ReadAt(const std::string& path, Read read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::exception& exception) {
    throw WrongEntry(path, ReasonOf(exception));
  }
}

// JSON knows neither infinity nor NaN, and would have a null that no reader takes: they are written
// as the texts "infinity", "-infinity" and "nan". NumberFrom throws on any other text.
inline nlohmann::ordered_json NumberJson(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return "nan";
  return value > 0 ? "infinity" : "-infinity";
}

inline double NumberFrom(const nlohmann::ordered_json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string text = json.get<std::string>();
  if (text == "infinity") return std::numeric_limits<double>::infinity();
  if (text == "-infinity") return -std::numeric_limits<double>::infinity();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  throw std::runtime_error("'" + text + "' is not a number");
}

inline nlohmann::ordered_json NumberOrNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// The value of an option by its name in names.h.
template <typename E>
E EnumFrom(const nlohmann::ordered_json& json, const char* key) {
  E value{};
  if (MaybeError error = ParseName(key, json.at(key).get<std::string>(), &value)) {
    throw std::runtime_error(error->ToString());
  }
  return value;
}

template <typename T>
nlohmann::ordered_json JsonOf(const T& value);
template <typename T>
void ReadJson(const nlohmann::ordered_json& json, T* value);

template <typename T>
T FromJson(const nlohmann::ordered_json& json) {
  T value{};
  ReadJson(json, &value);
  return value;
}

class JsonWriter {
 public:
  static constexpr bool kReads = false;
  explicit JsonWriter(nlohmann::ordered_json* object) : json_(*object) {}

  // Whether an entry is to be written; and whether there is one to be read.
  bool Has(const char*, bool present = true) const { return present; }

  template <typename T>
  void operator()(const char* key, const T& value) {
    json_[key] = JsonOf(value);
  }
  // No entry where there is no value.
  template <typename T>
  void Optional(const char* key, const std::optional<T>& value) {
    if (value) json_[key] = JsonOf(*value);
  }
  template <typename T>
  void OrNull(const char* key, const std::optional<T>& value) {
    json_[key] = value ? JsonOf(*value) : nlohmann::ordered_json(nullptr);
  }
  // [first, second]
  template <typename T>
  void Pair(const char* key, const T& first, const T& second) {
    json_[key] = {JsonOf(first), JsonOf(second)};
  }
  // An object whose fields the function lists.
  template <typename Function>
  void Group(const char* key, Function fields) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    JsonWriter inner(&object);
    fields(inner);
    json_[key] = std::move(object);
  }
  // Vectors of one length side by side as rows: fields(archive, i).
  template <typename Function, typename First, typename... Columns>
  void Rows(const char* key, std::tuple<First&, Columns&...> columns, Function fields) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (size_t i = 0; i < std::get<0>(columns).size(); ++i) {
      nlohmann::ordered_json row = nlohmann::ordered_json::object();
      JsonWriter inner(&row);
      fields(inner, i);
      rows.push_back(std::move(row));
    }
    json_[key] = std::move(rows);
  }
  // What is stored in another form: get() -> T, set(T).
  template <typename Get, typename Set>
  void Via(const char* key, Get get, Set) {
    json_[key] = JsonOf(get());
  }
  // For other readers than ours.
  template <typename Get>
  void Written(const char* key, Get get) {
    json_[key] = JsonOf(get());
  }
  void Check(bool, const char*) const {}

 private:
  nlohmann::ordered_json& json_;
};

class JsonReader {
 public:
  static constexpr bool kReads = true;
  explicit JsonReader(const nlohmann::ordered_json& json) : json_(json) {}

  bool Has(const char* key, bool = true) const { return json_.contains(key); }
  // The entry that was read last.
  const std::string& part() const { return part_; }
  const nlohmann::ordered_json& At(const char* key) {
    part_ = key;
    return json_.at(key);
  }

  template <typename T>
  void operator()(const char* key, T& value) {
    const nlohmann::ordered_json& json = At(key);
    if constexpr (std::is_enum_v<T>) {
      value = EnumFrom<T>(json_, key);
    } else {
      ReadJson(json, &value);
    }
  }
  template <typename T>
  void Optional(const char* key, std::optional<T>& value) {
    if (Has(key)) (*this)(key, value.emplace());
  }
  template <typename T>
  void OrNull(const char* key, std::optional<T>& value) {
    if (Has(key) && !json_.at(key).is_null()) Optional(key, value);
  }
  template <typename T>
  void Pair(const char* key, T& first, T& second) {
    ReadJson(At(key).at(0), &first);
    ReadJson(At(key).at(1), &second);
  }
  template <typename Function>
  void Group(const char* key, Function fields) {
    JsonReader inner(At(key));
    fields(inner);
  }
  template <typename Function, typename... Columns>
  void Rows(const char* key, std::tuple<Columns&...> columns, Function fields) {
    const nlohmann::ordered_json& rows = At(key);
    std::apply([&rows](auto&... column) { (column.resize(rows.size()), ...); }, columns);
    for (size_t i = 0; i < rows.size(); ++i) {
      JsonReader inner(rows.at(i));
      fields(inner, i);
    }
  }
  template <typename Get, typename Set>
  void Via(const char* key, Get get, Set set) {
    set(FromJson<decltype(get())>(At(key)));
  }
  template <typename Get>
  void Written(const char*, Get) const {}
  void Check(bool ok, const char* otherwise) const {
    if (!ok) throw std::runtime_error(otherwise);
  }

 private:
  const nlohmann::ordered_json& json_;
  std::string part_;
};

namespace json_archive {

template <typename T>
inline constexpr bool kIsVector = false;
template <typename T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <typename T>
inline constexpr bool kIsMap = false;
template <typename T>
inline constexpr bool kIsMap<std::map<std::string, T>> = true;
template <typename T>
inline constexpr bool kIsMatrix = std::is_base_of_v<Eigen::MatrixBase<T>, T>;
template <typename T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_same_v<T, std::string> ||
                                 std::is_same_v<T, nlohmann::ordered_json>;

inline void Expect(bool ok, const char* type, const nlohmann::ordered_json& json) {
  if (!ok) {
    throw std::runtime_error(std::string("type must be ") + type + ", but is " + json.type_name());
  }
}

}  // namespace json_archive

template <typename T>
nlohmann::ordered_json JsonOf(const T& value) {
  using Json = nlohmann::ordered_json;
  if constexpr (std::is_same_v<T, double>) {
    return NumberJson(value);
  } else if constexpr (json_archive::kIsPlain<T>) {
    return value;
  } else if constexpr (std::is_enum_v<T>) {
    return NameOf(value);
  } else if constexpr (json_archive::kIsVector<T>) {
    Json array = Json::array();
    for (const auto& element : value) array.push_back(JsonOf(element));
    return array;
  } else if constexpr (json_archive::kIsMap<T>) {
    Json object = Json::object();
    for (const auto& [key, element] : value) object[key] = JsonOf(element);
    return object;
  } else if constexpr (json_archive::kIsMatrix<T>) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      Json row = Json::array();
      for (Eigen::Index j = 0; j < value.cols(); ++j) row.push_back(NumberJson(value(i, j)));
      rows.push_back(T::ColsAtCompileTime == 1 ? row.front() : row);
    }
    return rows;
  } else {
    Json object = Json::object();
    JsonWriter writer(&object);
    Fields(writer, const_cast<T&>(value));
    return object;
  }
}

template <typename T>
void ReadJson(const nlohmann::ordered_json& json, T* value) {
  if constexpr (std::is_same_v<T, double>) {
    *value = NumberFrom(json);
  } else if constexpr (json_archive::kIsPlain<T>) {
    *value = json.get<T>();
  } else if constexpr (json_archive::kIsVector<T>) {
    json_archive::Expect(json.is_array(), "array", json);
    value->clear();
    value->resize(json.size());
    for (size_t i = 0; i < json.size(); ++i) ReadJson(json[i], &(*value)[i]);
  } else if constexpr (json_archive::kIsMap<T>) {
    json_archive::Expect(json.is_object(), "object", json);
    value->clear();
    for (const auto& [key, element] : json.items()) ReadJson(element, &(*value)[key]);
  } else if constexpr (json_archive::kIsMatrix<T>) {
    const bool column = T::ColsAtCompileTime == 1;
    json_archive::Expect(json.is_array(), "array", json);
    if (T::SizeAtCompileTime == Eigen::Dynamic) {
      value->resize(json.size(), json.empty() ? 0 : column ? 1 : json[0].size());
    }
    for (Eigen::Index i = 0; i < value->rows(); ++i) {
      for (Eigen::Index j = 0; j < value->cols(); ++j) {
        (*value)(i, j) = NumberFrom(column ? json.at(i) : json.at(i).at(j));
      }
    }
  } else {
    JsonReader reader(json);
    Fields(reader, *value);
  }
}

}  // namespace pushid
