// ident: one list of fields for the writing and the reading of JSON.
//
//   void Fields(JsonArchive& a, SolveStage& stage) {
//     PUSHID_FIELDS(a, stage, horizon, iterations, cost);  // keys are the members' names
//     a("initial_cost", stage.first_cost, "final_cost", stage.last_cost);
//   }
//   Json json = JsonOf(stage);   SolveStage same = FromJson<SolveStage>(json);
//
// Keys are written in the order of the list, and nothing that is written is changed. Values are
// numbers, texts, enums with a table of names, vectors, maps by text, matrices by rows, and all
// types that have a list of fields themselves. Reading throws nlohmann's exceptions for entries
// that are missing or of another type, and std::runtime_error for unknown names and where Check()
// fails.
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

// Members as fields, at most sixty: nlohmann's own macros go through the list.
#define PUSHID_FIELDS(archive, object, ...)                              \
  do {                                                                   \
    auto& fields_of = archive;                                           \
    auto& has_fields = object;                                           \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(PUSHID_FIELD, __VA_ARGS__)) \
  } while (false)
#define PUSHID_FIELD(name) fields_of(#name, has_fields.name);
// The whole list of a type whose keys are its members' names.
#define PUSHID_FIELDS_OF(Type, ...) \
  inline void Fields(JsonArchive& a, Type& value) { PUSHID_FIELDS(a, value, __VA_ARGS__); }

namespace pushid {

// An error in an entry, with the entry's path.
class WrongEntry : public std::runtime_error {
 public:
  WrongEntry(std::string path, const std::string& what)
      : std::runtime_error(what), path_(std::move(path)) {}
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// The message of an exception for people: without nlohmann's "[json.exception.type_error.302] ".
inline std::string ReasonOf(const std::exception& exception) {
  const std::string text = exception.what();
  const size_t end = text.rfind("[json.exception", 0) == 0 ? text.find("] ") : std::string::npos;
  return end == std::string::npos ? text : text.substr(end + 2);
}

// The result of `read`; an exception of it becomes an error at that path.
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

template <typename T>
nlohmann::ordered_json JsonOf(const T& value);
// name: of the entry, for errors.
template <typename T>
void ReadJson(const nlohmann::ordered_json& json, T* value, const char* name = "the entry");

template <typename T>
T FromJson(const nlohmann::ordered_json& json) {
  T value{};
  ReadJson(json, &value);
  return value;
}

// Goes through a list of fields and writes them into an object, or reads them from one.
class JsonArchive {
 public:
  using Json = nlohmann::ordered_json;
  explicit JsonArchive(Json* written) : out_(written), in_(*written) {}
  explicit JsonArchive(const Json& read) : in_(read) {}

  bool reads() const { return out_ == nullptr; }
  // Whether an entry is to be written; and whether there is one to be read.
  bool Has(const char* key, bool present = true) const {
    return reads() ? in_.contains(key) : present;
  }
  // An entry to read, and the name of the one that was read last.
  const Json& At(const char* key) {
    part_ = key;
    return in_.at(key);
  }
  const std::string& part() const { return part_; }

  // Keys and values in turn.
  template <typename T, typename... More>
  void operator()(const char* key, T& value, More&&... more) {
    if (!reads()) {
      (*out_)[key] = JsonOf(value);
    } else if constexpr (!std::is_const_v<T>) {
      ReadJson(At(key), &value, key);
    }
    if constexpr (sizeof...(more) > 0) (*this)(std::forward<More>(more)...);
  }
  // Keys and values in turn, of entries that a file may lack.
  template <typename T, typename... More>
  void Newer(const char* key, T& value, More&&... more) {
    if (Has(key)) (*this)(key, value);
    if constexpr (sizeof...(more) > 0) Newer(std::forward<More>(more)...);
  }
  // A container that has no entry while it is empty.
  template <typename T>
  void Filled(const char* key, T& values) {
    if (Has(key, !values.empty())) (*this)(key, values);
  }
  // No entry where there is no value.
  template <typename T>
  void Optional(const char* key, std::optional<T>& value) {
    if (Has(key, value.has_value())) (*this)(key, reads() ? value.emplace() : *value);
  }
  // Null where there is no value.
  template <typename T>
  void OrNull(const char* key, T&& value) {
    if (!reads()) {
      (*out_)[key] = value ? JsonOf(*value) : Json(nullptr);
    } else if (Has(key) && !in_.at(key).is_null()) {
      (*this)(key, value.emplace());
    }
  }
  // [first, second]
  template <typename T>
  void Pair(const char* key, T& first, T& second) {
    if (!reads()) {
      (*out_)[key] = {JsonOf(first), JsonOf(second)};
      return;
    }
    ReadJson(At(key).at(0), &first);
    ReadJson(At(key).at(1), &second);
  }
  // An object whose fields the function lists.
  template <typename Function>
  void Group(const char* key, Function fields) {
    JsonArchive inner =
        reads() ? JsonArchive(At(key)) : JsonArchive(&((*out_)[key] = Json::object()));
    fields(inner);
  }
  // Vectors of one length side by side as rows: fields(archive, i).
  template <typename Function, typename... Columns>
  void Rows(const char* key, std::tuple<Columns&...> columns, Function fields) {
    if (!reads()) (*out_)[key] = Json(std::get<0>(columns).size(), Json::object());
    const Json& rows = reads() ? At(key) : in_.at(key);
    std::apply([&rows](auto&... column) { (column.resize(rows.size()), ...); }, columns);
    for (size_t i = 0; i < rows.size(); ++i) {
      JsonArchive inner = reads() ? JsonArchive(rows.at(i)) : JsonArchive(&(*out_)[key].at(i));
      fields(inner, i);
    }
  }
  // A value that is stored in another form: get() -> T, set(T).
  template <typename Get, typename Set>
  void Via(const char* key, Get get, Set set) {
    if (reads()) set(FromJson<decltype(get())>(At(key)));
    if (!reads()) (*out_)[key] = JsonOf(get());
  }
  // An entry for other readers than ours.
  template <typename Get>
  void Written(const char* key, Get get) {
    if (!reads()) (*out_)[key] = JsonOf(get());
  }
  void Check(bool ok, const char* otherwise) const {
    if (reads() && !ok) throw std::runtime_error(otherwise);
  }

 private:
  Json* out_ = nullptr;
  const Json& in_;
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
    JsonArchive archive(&object);
    Fields(archive, const_cast<T&>(value));
    return object;
  }
}

template <typename T>
void ReadJson(const nlohmann::ordered_json& json, T* value, [[maybe_unused]] const char* name) {
  if constexpr (std::is_same_v<T, double>) {
    *value = NumberFrom(json);
  } else if constexpr (std::is_enum_v<T>) {
    if (MaybeError error = ParseName(name, json.get<std::string>(), value)) {
      throw std::runtime_error(error->ToString());
    }
  } else if constexpr (json_archive::kIsPlain<T>) {
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
      json_archive::Expect(json.is_number_integer(), "whole number", json);
    }
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
    JsonArchive archive(json);
    Fields(archive, *value);
  }
}

}  // namespace pushid
