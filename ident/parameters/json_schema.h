// ident: the JSON Schema (draft 2020-12) of a list of fields (json_archive.h), so that it cannot
// say anything else than what is written.
//
//   Ordered definitions, object;
//   SchemaArchive archive(&object, &definitions);
//   Fields(archive, value);  // a default value: nothing of it is read
//
// What the writer always writes is required. Types with a list of fields stand once, in
// definitions, under their own names.
#pragma once

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>

#include "ident/parameters/json_archive.h"
#include "models/enum_names.h"

namespace pushid {

template <typename T>
nlohmann::ordered_json SchemaOf(nlohmann::ordered_json* definitions);

class SchemaArchive {
 public:
  using Ordered = nlohmann::ordered_json;
  static constexpr bool kReads = false;

  SchemaArchive(Ordered* object, Ordered* definitions)
      : object_(*object), definitions_(*definitions) {
    object_ = {
        {"type", "object"}, {"required", Ordered::array()}, {"properties", Ordered::object()}};
  }

  // An entry that the writer of a default value would leave out is optional.
  bool Has(const char* key, bool present = true) {
    if (!present) optional_.insert(key);
    return true;
  }
  void Add(const char* key, const Ordered& schema) {
    object_["properties"][key] = schema;
    if (optional_.count(key) == 0) object_["required"].push_back(key);
  }
  template <typename T>
  void operator()(const char* key, const T&) {
    Add(key, SchemaOf<T>(&definitions_));
  }
  template <typename T>
  void Optional(const char* key, const std::optional<T>&) {
    Has(key, false);
    Add(key, SchemaOf<T>(&definitions_));
  }
  template <typename T>
  void OrNull(const char* key, const std::optional<T>&) {
    Add(key, {{"anyOf", {SchemaOf<T>(&definitions_), {{"type", "null"}}}}});
  }
  template <typename T>
  void Pair(const char* key, const T&, const T&) {
    Add(key, {{"type", "array"},
              {"items", SchemaOf<T>(&definitions_)},
              {"minItems", 2},
              {"maxItems", 2}});
  }
  template <typename Function>
  void Group(const char* key, Function fields) {
    Ordered inner;
    SchemaArchive archive(&inner, &definitions_);
    fields(archive);
    Add(key, inner);
  }
  template <typename Function, typename... Columns>
  void Rows(const char* key, std::tuple<Columns&...> columns, Function fields) {
    std::apply([](auto&... column) { (column.resize(1), ...); }, columns);
    Ordered row;
    SchemaArchive archive(&row, &definitions_);
    fields(archive, size_t{0});
    Add(key, {{"type", "array"}, {"items", row}});
  }
  template <typename Get, typename Set>
  void Via(const char* key, Get, Set) {
    Add(key, SchemaOf<std::decay_t<decltype(std::declval<Get>()())>>(&definitions_));
  }
  template <typename Get>
  void Written(const char* key, Get) {
    Add(key, SchemaOf<std::decay_t<decltype(std::declval<Get>()())>>(&definitions_));
  }
  void Check(bool, const char*) const {}

 private:
  Ordered& object_;
  Ordered& definitions_;
  std::set<std::string> optional_;
};

namespace json_schema {

// "Estimate" of pushid::Estimate.
template <typename T>
std::string TypeName() {
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(typeid(T).name(), nullptr, nullptr, nullptr), std::free);
  const std::string whole = name.get();
  const size_t colon = whole.rfind(':');
  return colon == std::string::npos ? whole : whole.substr(colon + 1);
}

inline nlohmann::ordered_json Reference(const std::string& name) {
  return {{"$ref", "#/$defs/" + name}};
}

inline nlohmann::ordered_json ListOf(const nlohmann::ordered_json& items) {
  return {{"type", "array"}, {"items", items}};
}

}  // namespace json_schema

template <typename T>
nlohmann::ordered_json SchemaOf(nlohmann::ordered_json* definitions) {
  using Ordered = nlohmann::ordered_json;
  if constexpr (std::is_same_v<T, double>) {
    (*definitions)["number"] = {
        {"anyOf", {{{"type", "number"}}, {{"enum", {"infinity", "-infinity", "nan"}}}}}};
    return json_schema::Reference("number");
  } else if constexpr (std::is_same_v<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (std::is_arithmetic_v<T>) {
    return {{"type", "integer"}};
  } else if constexpr (std::is_same_v<T, std::string>) {
    return {{"type", "string"}};
  } else if constexpr (std::is_same_v<T, Ordered>) {
    return Ordered::object();
  } else if constexpr (std::is_enum_v<T>) {
    return {{"enum", AllNames<T>()}};
  } else if constexpr (json_archive::kIsVector<T>) {
    return json_schema::ListOf(SchemaOf<typename T::value_type>(definitions));
  } else if constexpr (json_archive::kIsMap<T>) {
    return {{"type", "object"},
            {"additionalProperties", SchemaOf<typename T::mapped_type>(definitions)}};
  } else if constexpr (json_archive::kIsMatrix<T>) {
    const Ordered row = json_schema::ListOf(SchemaOf<double>(definitions));
    return T::ColsAtCompileTime == 1 ? row : json_schema::ListOf(row);
  } else {
    const std::string name = json_schema::TypeName<T>();
    if (!definitions->contains(name)) {
      (*definitions)[name] = Ordered::object();  // for types that hold themselves
      T value{};
      Ordered object;
      SchemaArchive archive(&object, definitions);
      Fields(archive, value);
      (*definitions)[name] = object;
    }
    return json_schema::Reference(name);
  }
}

}  // namespace pushid
