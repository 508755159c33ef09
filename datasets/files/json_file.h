// datasets: JSON files in and out, with errors that name line and column.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// A JSON file with its text at hand, so that a wrong value can be pointed at.
struct JsonDocument {
  std::string path;
  std::string text;  // without a byte order mark
  nlohmann::ordered_json content;

  // An Error at the place of the value that `pointer` names ("/recordings/3/fps"); at the innermost
  // existing container around it when there is no such value.
  Error ErrorAt(const std::string& pointer, std::string message) const;

  // The line each element of the list at `pointer` starts in, found in one pass over the text.
  std::vector<int> ElementLines(const std::string& pointer) const;
};

// A required key that an object lacks.
struct MissingKey {
  std::string label, pointer;  // of the object: "recording 'a'", "/recordings/0"
  std::string key, what;       // "fps", "the frames per second"
};

// "recording 'a': fps and id are missing; fps must be ...; id must be ...; recording 'b': ..."
std::string MissingText(const std::vector<MissingKey>& missing);

// Errors: unreadable file, JSON syntax (line, column), nesting deeper than 200.
Result<JsonDocument> ReadJsonDocument(const std::string& path);

// Writes atomically, indented by `indent` spaces, with a newline at the end. Doubles are written so
// that they read back the same. NaN and infinity have no JSON and come out as null: say them in
// words instead. Bytes that are not UTF-8 are replaced.
MaybeError WriteJson(const std::string& path, const nlohmann::json& content, int indent = 2);
MaybeError WriteJson(const std::string& path, const nlohmann::ordered_json& content,
                     int indent = 2);

}  // namespace pushid
