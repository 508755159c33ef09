// datasets: numbers in the bytes of a C3D file, as the three processors store them.
//
// Intel: little-endian integers and IEEE floats. MIPS: the same, big-endian. DEC: little-endian
// integers, VAX F floats: two little-endian words, the upper one first, value
// (0x800000 | fraction) 2^(exponent - 152), zero when the exponent is zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "datasets/formats/c3d.h"

namespace pushid {

inline constexpr std::size_t kC3dBlock = 512;  // bytes; the sections of a file begin with one

class C3dBytes {
 public:
  C3dBytes() = default;
  C3dBytes(std::string_view bytes, C3dProcessor processor) : bytes_(bytes), processor_(processor) {}

  std::size_t size() const { return bytes_.size(); }
  bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  // Only where Has().
  std::uint8_t Byte(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  std::int8_t Signed(std::size_t at) const { return static_cast<std::int8_t>(bytes_[at]); }
  std::uint16_t Word(std::size_t at) const;
  std::int16_t Integer(std::size_t at) const { return static_cast<std::int16_t>(Word(at)); }
  double Real(std::size_t at) const;
  std::string_view Text(std::size_t at, std::size_t count) const {
    return bytes_.substr(at, count);
  }

 private:
  std::string_view bytes_;
  C3dProcessor processor_ = C3dProcessor::kIntel;
};

void AppendC3dWord(std::uint16_t value, C3dProcessor processor, std::string* out);
// Rounded to the 24 bits that every processor keeps; DEC has no infinity and no NaN, so the caller
// writes none.
void AppendC3dReal(double value, C3dProcessor processor, std::string* out);

}  // namespace pushid
