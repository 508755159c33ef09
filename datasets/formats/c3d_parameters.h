// datasets: the parameter section of a C3D file, read and looked up; what it says of events and
// force platforms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/formats/c3d.h"

namespace pushid {

// Numbers in the bytes of a C3D file, as the three processors store them.
//
// Intel: little-endian integers and IEEE floats. MIPS: the same, big-endian. DEC: little-endian
// integers, VAX F floats: two little-endian words, the upper one first, value
// (0x800000 | fraction) 2^(exponent - 152), zero when the exponent is zero.

inline constexpr int kVaxBias = 128, kFractionBits = 24;
inline constexpr std::size_t kC3dBlock = 512;  // bytes; the sections of a file begin with one

class C3dBytes {
 public:
  C3dBytes() = default;
  C3dBytes(std::string_view bytes, C3dProcessor processor) : bytes_(bytes), processor_(processor) {}

  std::size_t size() const { return bytes_.size(); }
  bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  // The accessors below need Has().
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

// "at byte 1234: ..." of the file at `path`.
Error C3dError(const std::string& path, std::size_t at, const std::string& message);

// Reads the records from byte `begin` (behind the section's four head bytes). Errors: a record that
// leaves the section, a parameter of a group that never appears, an unknown type.
Result<C3dParameters> ReadC3dParameters(const std::string& path, const C3dBytes& bytes,
                                        std::size_t begin);

// The events of the group EVENT, otherwise those of the header at the start of `bytes`.
std::vector<C3dEvent> ReadC3dEvents(const C3dParameters& parameters, const C3dBytes& bytes);

// Fills file->platforms from its parameters; its analog channels are there already. Errors: an
// unknown type, too few channels, a channel that does not exist.
MaybeError ReadC3dPlatforms(C3dFile* file);

}  // namespace pushid
