// datasets: naming patterns of recordings.
#include "datasets/files/name_pattern.h"

#include <algorithm>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Patterns with many names can be fitted in very many ways; a file name needs few.
constexpr int kMostTries = 100000;

}  // namespace

Result<NamePattern> NamePattern::Parse(const std::string& text) {
  NamePattern pattern;
  std::string plain;
  const auto end_plain = [&] {
    if (!plain.empty()) pattern.pieces_.push_back({Piece::kText, plain});
    plain.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '*') {
      end_plain();
      pattern.pieces_.push_back({Piece::kAnything, ""});
    } else if (text[i] == '{') {
      const std::size_t end = text.find_first_of("{}", i + 1);
      if (end == std::string::npos || text[end] != '}' || end == i + 1) {
        return Error{"the pattern " + Quoted(text) + " has a { without a name, as in {subject}"};
      }
      end_plain();
      const std::string name = text.substr(i + 1, end - i - 1);
      pattern.pieces_.push_back({Piece::kName, name});
      if (!pattern.Has(name)) pattern.names_.push_back(name);
      i = end;
    } else if (text[i] == '}') {
      return Error{"the pattern " + Quoted(text) + " has a } without a {"};
    } else {
      plain += text[i];
    }
  }
  end_plain();
  if (pattern.names_.empty()) {
    return Error{"the pattern " + Quoted(text) +
                 " contains no names; {subject}, for instance, stands for the person's id"};
  }
  return pattern;
}

bool NamePattern::Has(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

bool NamePattern::HasStar() const {
  return std::any_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& piece) { return piece.kind == Piece::kAnything; });
}

bool NamePattern::MatchFrom(std::size_t index, const std::string& path, std::size_t at,
                            std::map<std::string, std::string>* values, int* tries) const {
  if (++*tries > kMostTries) return false;
  if (index == pieces_.size()) return at == path.size();
  const Piece& piece = pieces_[index];
  if (piece.kind == Piece::kText) {
    return path.compare(at, piece.text.size(), piece.text) == 0 &&
           MatchFrom(index + 1, path, at + piece.text.size(), values, tries);
  }
  if (piece.kind == Piece::kName) {
    const auto known = values->find(piece.text);
    if (known != values->end()) {
      const std::string value = known->second;  // what follows may change the map
      return path.compare(at, value.size(), value) == 0 &&
             MatchFrom(index + 1, path, at + value.size(), values, tries);
    }
  }
  const std::size_t fewest = piece.kind == Piece::kName ? 1 : 0;
  for (std::size_t length = 0; at + length <= path.size(); ++length) {
    if (length > 0 && path[at + length - 1] == '/') return false;
    if (length < fewest) continue;
    if (piece.kind == Piece::kName) (*values)[piece.text] = path.substr(at, length);
    if (MatchFrom(index + 1, path, at + length, values, tries)) return true;
    if (piece.kind == Piece::kName) values->erase(piece.text);
  }
  return false;
}

std::optional<std::map<std::string, std::string>> NamePattern::Match(
    const std::string& path) const {
  std::map<std::string, std::string> values;
  int tries = 0;
  if (!MatchFrom(0, path, 0, &values, &tries)) return std::nullopt;
  return values;
}

std::optional<std::string> NamePattern::Fill(
    const std::map<std::string, std::string>& values) const {
  std::string text;
  for (const Piece& piece : pieces_) {
    if (piece.kind == Piece::kAnything) return std::nullopt;
    if (piece.kind == Piece::kText) {
      text += piece.text;
      continue;
    }
    const auto value = values.find(piece.text);
    if (value == values.end()) return std::nullopt;
    text += value->second;
  }
  return text;
}

}  // namespace pushid
