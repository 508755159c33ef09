// datasets: NumPy's array format.
#include "datasets/files/npy.h"

#include <cstdint>
#include <cstring>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr char kMagic[] = "\x93NUMPY\x01\x00";
constexpr size_t kMagicSize = 8, kPrefix = 10;  // magic, then the header's length in two bytes

Error NotNpy(const std::string& path, const std::string& problem) {
  return {problem +
              "; expected is a one-dimensional little-endian float32 array as numpy.save "
              "writes it",
          path};
}

}  // namespace

std::string NpyBytes(const std::vector<float>& values) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(values.size()) + ",), }";
  header.append(64 - (kPrefix + header.size() + 1) % 64, ' ');
  header += '\n';
  std::string bytes(kMagic, kMagicSize);
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  const size_t at = bytes.size();
  bytes.resize(at + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(&bytes[at], values.data(), values.size() * sizeof(float));
  return bytes;
}

MaybeError WriteNpy(const std::string& path, const std::vector<float>& values) {
  return WriteFileAtomically(path, NpyBytes(values));
}

Result<std::vector<float>> ReadNpy(const std::string& path) {
  const Result<std::string> file = ReadWholeFile(path);
  if (!file.ok()) return file.error();
  const std::string& bytes = file.value();
  if (bytes.size() < kPrefix || bytes.compare(0, kMagicSize, kMagic, kMagicSize) != 0) {
    return NotNpy(path, "this is not a .npy file of version 1.0");
  }
  const size_t length = static_cast<uint8_t>(bytes[8]) + 256u * static_cast<uint8_t>(bytes[9]);
  if (bytes.size() < kPrefix + length) return NotNpy(path, "the file is cut off in its header");
  const std::string header = bytes.substr(kPrefix, length);
  if (header.find("'<f4'") == std::string::npos || header.find("False") == std::string::npos) {
    return NotNpy(path, "the header is " + Quoted(header));
  }
  const size_t open = header.find('('), comma = header.find(",)");
  int64_t count = 0;
  if (open == std::string::npos || comma == std::string::npos || comma < open ||
      !ParseInteger(header.substr(open + 1, comma - open - 1), &count) || count < 0) {
    return NotNpy(path, "the header is " + Quoted(header));
  }
  const size_t data = bytes.size() - kPrefix - length;
  if (data != static_cast<uint64_t>(count) * sizeof(float)) {
    return NotNpy(path, "the file contains " + std::to_string(data) +
                            " bytes of numbers, but its " + "header declares " +
                            std::to_string(count) + " numbers");
  }
  std::vector<float> values(static_cast<size_t>(count));
  if (count > 0) std::memcpy(values.data(), bytes.data() + kPrefix + length, data);
  return values;
}

}  // namespace pushid
