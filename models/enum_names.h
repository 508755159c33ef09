// models: names of choices, one table beside each enum: what flags, files and messages call them.
//
//   enum class Posture { kUpright, kInitial };
//   constexpr EnumNames<Posture, 2> Names(Posture) {
//     return {{{"upright", Posture::kUpright}, {"initial", Posture::kInitial}}};
//   }
//   NameOf(Posture::kUpright) == "upright"
#pragma once

#include <array>
#include <cstddef>
#include <string>

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
  for (const EnumName<E>& row : Names(value)) {
    if (row.value == value) return row.name;
  }
  return "";
}

}  // namespace pushid
