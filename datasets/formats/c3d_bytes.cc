// datasets: numbers in the bytes of a C3D file.
#include "datasets/formats/c3d_bytes.h"

#include <cmath>
#include <cstring>

namespace pushid {
namespace {

constexpr int kVaxBias = 128, kFractionBits = 24;

double FromIeee(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double FromVax(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  if (exponent == 0) return 0.0;
  const double fraction = static_cast<double>((bits & 0x7fffff) | 0x800000);
  const double size = std::ldexp(fraction, exponent - kVaxBias - kFractionBits);
  return (bits >> 31) != 0 ? -size : size;
}

std::uint32_t ToVax(double value) {
  int exponent = 0;
  const double half = std::frexp(std::fabs(value), &exponent);  // in [0.5, 1)
  auto fraction = static_cast<std::uint32_t>(std::lround(std::ldexp(half, kFractionBits)));
  if (fraction >> kFractionBits != 0) {  // rounded up to 1
    fraction >>= 1;
    ++exponent;
  }
  if (value == 0.0 || exponent + kVaxBias < 1) return 0;
  return (std::signbit(value) ? 0x80000000u : 0u) |
         static_cast<std::uint32_t>(exponent + kVaxBias) << 23 | (fraction & 0x7fffff);
}

void AppendByte(std::uint32_t value, std::string* out) {
  out->push_back(static_cast<char>(value & 0xff));
}

}  // namespace

std::uint16_t C3dBytes::Word(std::size_t at) const {
  const std::uint16_t first = Byte(at), second = Byte(at + 1);
  return static_cast<std::uint16_t>(processor_ == C3dProcessor::kMips ? first << 8 | second
                                                                      : second << 8 | first);
}

double C3dBytes::Real(std::size_t at) const {
  const std::uint32_t first = Word(at), second = Word(at + 2);
  switch (processor_) {
    case C3dProcessor::kDec:
      return FromVax(first << 16 | second);
    case C3dProcessor::kMips:
      return FromIeee(first << 16 | second);
    case C3dProcessor::kIntel:
      break;
  }
  return FromIeee(second << 16 | first);
}

void AppendC3dWord(std::uint16_t value, C3dProcessor processor, std::string* out) {
  const bool big = processor == C3dProcessor::kMips;
  AppendByte(big ? value >> 8 : value, out);
  AppendByte(big ? value : value >> 8, out);
}

void AppendC3dReal(double value, C3dProcessor processor, std::string* out) {
  std::uint32_t bits = 0;
  if (processor == C3dProcessor::kDec) {
    bits = ToVax(value);
  } else {
    const float rounded = static_cast<float>(value);
    std::memcpy(&bits, &rounded, sizeof bits);
  }
  const bool upper_first = processor != C3dProcessor::kIntel;
  const auto upper = static_cast<std::uint16_t>(bits >> 16),
             lower = static_cast<std::uint16_t>(bits & 0xffff);
  AppendC3dWord(upper_first ? upper : lower, processor, out);
  AppendC3dWord(upper_first ? lower : upper, processor, out);
}

}  // namespace pushid
