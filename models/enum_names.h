// models: names of choices, one table beside each enum: what flags, files and messages call them.
//
//   enum class Posture { kUpright, kInitial };
//   constexpr EnumNames<Posture, 2> Names(Posture) {
//     return {{{"upright", Posture::kUpright}, {"initial", Posture::kInitial}}};
//   }
//   NameOf(Posture::kUpright) == "upright", *FromName<Posture>("initial") == Posture::kInitial
//   AnyName<Posture>() == "upright or initial"
//
// A table whose rows say more than a name is a constant array of structs with `name` and `value`
// among their members, and Names returns a reference to it; then RowOf gives a value's row. From
// flags and files names are read by ParseName (datasets/files/names.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pushid {

template <typename E>
struct EnumName {
  const char* name;
  E value;
};

template <typename E, size_t N>
using EnumNames = std::array<EnumName<E>, N>;

template <typename E>
std::string NameOf(E value) {
  for (const auto& row : Names(value)) {
    if (row.value == value) return row.name;
  }
  return "";
}

// nullopt: none of them.
template <typename E>
std::optional<E> FromName(std::string_view name) {
  for (const auto& row : Names(E{})) {
    if (name == row.name) return row.value;
  }
  return std::nullopt;
}

// "a, b or c"; last_word: "or", "and"; "," for "a, b, c".
inline std::string Listed(const std::vector<std::string>& names, const std::string& last_word) {
  const std::string last = last_word == "," ? ", " : " " + last_word + " ";
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  }
  return list;
}

// The names of the rows that `keep` takes.
template <typename E, typename Keep>
std::vector<std::string> AllNames(Keep keep) {
  std::vector<std::string> names;
  for (const auto& row : Names(E{})) {
    if (keep(row)) names.push_back(row.name);
  }
  return names;
}

template <typename E>
std::vector<std::string> AllNames() {
  return AllNames<E>([](const auto&) { return true; });
}

// The names in a sentence of a message: "a, b or c".
template <typename E, typename Keep>
std::string AnyName(Keep keep) {
  return Listed(AllNames<E>(keep), "or");
}

template <typename E>
std::string AnyName() {
  return Listed(AllNames<E>(), "or");
}

// The row of a value; the table is in the order of values, which
// static_assert(RowsAreInOrder(kTable)) checks.
template <typename E>
constexpr const auto& RowOf(E value) {
  return Names(value)[static_cast<size_t>(value)];
}

template <typename Rows>
constexpr bool RowsAreInOrder(const Rows& rows) {
  size_t value = 0;
  for (const auto& row : rows) {
    if (static_cast<size_t>(row.value) != value++) return false;
  }
  return true;
}

}  // namespace pushid
