// datasets: JSON files in and out.
#include "datasets/files/json_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/kept_json.h"
#include "models/enum_names.h"

namespace pushid {
namespace {

constexpr int kDeepestNesting = 200;  // copying and writing recurse

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Walks over text that is known to be valid JSON, without a byte order mark.
class JsonWalker {
 public:
  explicit JsonWalker(const std::string& text) : text_(text) { SkipSpace(); }

  // Goes from the container at the current place to its member or element `key`; false, and no
  // move, when there is none. Appends where the values start that it comes by, if wanted.
  bool Enter(const std::string& key, std::vector<std::size_t>* starts = nullptr) {
    const std::size_t start = at_;
    const bool object = At() == '{';
    if (!object && At() != '[') return false;
    std::size_t found = std::string::npos;
    ++at_;
    SkipSpace();
    for (std::size_t index = 0; At() != '}' && At() != ']' && At() != '\0'; ++index) {
      std::string name = std::to_string(index);
      if (object) {
        const std::size_t name_start = at_;
        SkipString();
        name = nlohmann::json::parse(text_.substr(name_start, at_ - name_start)).get<std::string>();
        SkipSpace();
        ++at_;  // the colon
        SkipSpace();
      }
      if (starts != nullptr) starts->push_back(at_);
      if (name == key) found = at_;  // of equal names the last one counts, as in the parser
      SkipValue();
      SkipSpace();
      if (At() == ',') ++at_;
      SkipSpace();
    }
    at_ = found == std::string::npos ? start : found;
    return found != std::string::npos;
  }

  // Follows "/recordings/3/fps" as far as it leads.
  void Follow(const std::string& pointer) {
    const std::vector<std::string> keys = SplitList(pointer, '/');
    for (std::size_t i = 1; i < keys.size() && Enter(keys[i]); ++i) continue;
  }

  std::size_t position() const { return at_; }

 private:
  char At() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void SkipSpace() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
  }
  void SkipString() {
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
  }
  void SkipValue() {
    int depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        SkipString();
        if (depth == 0) return;
        continue;
      }
      if (depth == 0 && (c == ',' || c == '}' || c == ']' || IsSpace(c))) return;
      ++at_;
      if (c == '{' || c == '[') ++depth;
      if ((c == '}' || c == ']') && --depth == 0) return;
    }
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

// The error at line and column (1-based, in bytes) of text[position].
Error ErrorIn(const std::string& text, std::size_t position, Error error) {
  position = std::min(position, text.size());
  error.line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + position, '\n'));
  const std::size_t newline = position == 0 ? std::string::npos : text.rfind('\n', position - 1);
  error.column = static_cast<int>(position - (newline == std::string::npos ? 0 : newline + 1)) + 1;
  return error;
}

// Position of the opening bracket that nests too deep; npos when none does.
std::size_t TooDeepAt(const std::string& text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepestNesting) return i;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return std::string::npos;
}

// Some of the parser's exceptions know no position; its events do.
struct ErrorFinder : nlohmann::detail::json_sax_acceptor<nlohmann::json> {
  std::size_t last_read = 0;  // the byte at which it could not go on: the end of the wrong token
  std::string message;

  bool parse_error(std::size_t bytes_read, const std::string&,
                   const nlohmann::json::exception& exception) {
    last_read = bytes_read > 0 ? bytes_read - 1 : 0;
    message = exception.what();
    return false;
  }
};

// A hint at syntax that people write by hand and JSON has not, where the parser could not go on.
std::string SyntaxHint(const std::string& text, std::size_t at) {
  if (at >= text.size()) return "";
  const std::string_view rest = std::string_view(text).substr(at);
  const std::size_t before = at == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", at - 1);
  if (rest[0] == '/' || rest[0] == '#') return "; JSON has no comments: take them out";
  if (at > 0 && text[at - 1] == '\\') {
    return "; in JSON a backslash is written \\\\, and folders are separated by / here";
  }
  if (rest[0] == '\'' || rest.substr(0, 2) == "\xE2\x80") return "; texts are in \"";
  if ((rest[0] == ']' || rest[0] == '}') && before != std::string::npos && text[before] == ',') {
    return "; no comma may stand before it";
  }
  return "";
}

Error SyntaxError(const std::string& path, const std::string& text) {
  ErrorFinder finder;
  nlohmann::json::sax_parse(text, &finder);
  // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error while ...": the
  // Error has the place itself.
  std::string message = finder.message;
  if (const std::size_t end = message.find("] "); end != std::string::npos) {
    message = message.substr(end + 2);
  }
  if (message.rfind("parse error at line", 0) == 0)
    message = message.substr(message.find(": ") + 2);
  return ErrorIn(text, finder.last_read,
                 {"this is not valid JSON: " + message + SyntaxHint(text, finder.last_read), path});
}

}  // namespace

Error JsonDocument::ErrorAt(const std::string& pointer, std::string message) const {
  JsonWalker walker(text);
  walker.Follow(pointer);
  return ErrorIn(text, walker.position(), {std::move(message), path});
}

std::vector<int> JsonDocument::ElementLines(const std::string& pointer) const {
  JsonWalker walker(text);
  walker.Follow(pointer);
  std::vector<std::size_t> starts;
  walker.Enter("", &starts);  // no element has this name: it comes by all of them
  std::vector<int> lines;
  std::size_t counted_to = 0;
  int line = 1;
  for (std::size_t start : starts) {
    line += static_cast<int>(std::count(text.begin() + counted_to, text.begin() + start, '\n'));
    counted_to = start;
    lines.push_back(line);
  }
  return lines;
}

Result<JsonDocument> ReadJsonDocument(const std::string& path) {
  return Caught([&] {
    const std::string bytes = OrThrow(ReadWholeFile(path));
    std::string_view text = bytes;
    OrThrow(CheckEncoding(path, &text));
    JsonDocument document{path, std::string(text), {}};
    if (std::all_of(text.begin(), text.end(), IsSpace)) throw Error{"the file is empty", path};
    if (const std::size_t deep = TooDeepAt(document.text); deep != std::string::npos) {
      throw ErrorIn(document.text, deep,
                    {StrCat("the JSON nests deeper than ", kDeepestNesting, " levels"), path});
    }
    try {
      document.content = nlohmann::ordered_json::parse(document.text);
    } catch (const nlohmann::json::exception&) {
      throw SyntaxError(path, document.text);
    }
    return document;
  });
}

MaybeError WriteJson(const std::string& path, const nlohmann::ordered_json& content, int indent) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  return WriteFileAtomically(path, content.dump(indent, ' ', false, kReplace) + '\n');
}

std::string SpeltOtherwise(const nlohmann::ordered_json& object, const std::string& key) {
  for (const auto& [other, value] : object.items()) {
    if (!ClosestName(other, {key}).empty()) return " (here it is spelt " + Quoted(other) + ")";
  }
  return "";
}

std::string MissingText(const std::vector<MissingKey>& missing) {
  constexpr std::size_t kMostObjects = 8;
  std::vector<std::vector<const MissingKey*>> objects;  // in the order of the first key they lack
  std::map<std::string, std::size_t> index;             // by label
  for (const MissingKey& key : missing) {
    const auto [at, is_new] = index.emplace(key.label, objects.size());
    if (is_new) objects.emplace_back();
    objects[at->second].push_back(&key);
  }
  std::string text;
  std::set<std::string> explained;  // each key once
  for (std::size_t i = 0; i < objects.size() && i < kMostObjects; ++i) {
    std::vector<std::string> names;
    std::string explanation;
    for (const MissingKey* key : objects[i]) {
      names.push_back(key->key);
      if (!explained.insert(key->key).second) continue;
      explanation += "; " + (objects[i].size() == 1 ? "it" : key->key) + " must be " + key->what;
    }
    text += (i == 0 ? "" : "; ") + objects[i][0]->label + ": " + Listed(names, "and") +
            (names.size() == 1 ? " is missing" : " are missing") + explanation;
  }
  if (objects.size() > kMostObjects) {
    text += StrCat("; and ", objects.size() - kMostObjects, " more lack keys");
  }
  return text;
}

KeptJson::KeptJson() : KeptJson(nlohmann::ordered_json::object()) {}
KeptJson::KeptJson(nlohmann::ordered_json json)
    : json_(std::make_unique<nlohmann::ordered_json>(std::move(json))) {}
KeptJson::KeptJson(const KeptJson& other) : KeptJson(*other) {}
KeptJson::KeptJson(KeptJson&& other) noexcept = default;
KeptJson& KeptJson::operator=(const KeptJson& other) {
  json_ = std::make_unique<nlohmann::ordered_json>(*other);
  return *this;
}
KeptJson& KeptJson::operator=(KeptJson&& other) noexcept = default;
KeptJson::~KeptJson() = default;

}  // namespace pushid
