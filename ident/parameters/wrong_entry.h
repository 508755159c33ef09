// ident: what is wrong with an entry of JSON, and where it stands.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

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

}  // namespace pushid
