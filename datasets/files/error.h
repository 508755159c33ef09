// datasets: errors and warnings as values. A reader returns Result<T>: either the thing it read, or
// an Error that says what is wrong, where, and what to do. User input never aborts the program.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pushid {

struct Error {
  std::string message;  // what is wrong and what to do about it
  std::string file{};   // empty when no file is to blame
  int line = 0;         // 1-based; 0 when the whole file is meant
  int column = 0;       // 1-based; 0 when the whole line is meant

  // "push.csv:7: fx is 'abc', not a number; ..." - the one line that reaches the user.
  std::string ToString() const {
    if (file.empty()) return message;
    std::string where = file;
    if (line > 0) where += ":" + std::to_string(line);
    if (line > 0 && column > 0) where += ":" + std::to_string(column);
    return where + ": " + message;
  }
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return std::holds_alternative<T>(content_); }
  const T& value() const& { return std::get<T>(content_); }
  T& value() & { return std::get<T>(content_); }
  T value() && { return std::get<T>(std::move(content_)); }  // by value: safe in a range-for
  const Error& error() const { return std::get<Error>(content_); }

 private:
  std::variant<T, Error> content_;
};

// The outcome of something that yields nothing but may fail: nullopt means done.
using MaybeError = std::optional<Error>;

// Inside of a reader an error is thrown; its public function returns it:
//
//   Result<Manifest> ReadManifest(const std::string& path) {
//     return Caught([&] { return ManifestOf(OrThrow(ReadJsonDocument(path))); });
//   }
template <typename T>
T OrThrow(Result<T> result) {
  if (!result.ok()) throw result.error();
  return std::move(result).value();
}
inline void OrThrow(const MaybeError& error) {
  if (error) throw *error;
}

// The Result of read(), or a MaybeError where it yields nothing.
template <typename Read>
auto Caught(const Read& read) {
  using T = decltype(read());
  if constexpr (std::is_void_v<T>) {
    try {
      read();
      return MaybeError();
    } catch (Error& error) {
      return MaybeError(std::move(error));
    }
  } else {
    try {
      return Result<T>(read());
    } catch (Error& error) {
      return Result<T>(std::move(error));
    }
  }
}

// An unusual finding that does not stop the work.
struct Warning {
  std::string text;            // the sentence
  std::string recording = {};  // id, where it is of one
  std::string of_many = {};    // the sentence about several: "the file has gaps"

  Warning() = default;
  // A warning about no single recording.
  Warning(std::string sentence)
      : text(std::move(sentence)) {}                 // NOLINT(google-explicit-constructor)
  Warning(const char* sentence) : text(sentence) {}  // NOLINT(google-explicit-constructor)
  Warning(std::string sentence, std::string id, std::string same)
      : text(std::move(sentence)), recording(std::move(id)), of_many(std::move(same)) {}
};
using Warnings = std::vector<Warning>;

// Warnings of which several recordings share the sentence become one: "in 32 recordings (a, b, c,
// ...): the file has gaps"; equal ones become one with their number. In the order of their first.
std::vector<std::string> GroupedWarnings(const Warnings& warnings);

}  // namespace pushid
