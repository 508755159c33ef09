// datasets: names in messages, and naming patterns of files.
#include "datasets/files/names.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "datasets/files/number_text.h"

namespace pushid {
std::string ListOfNames(const std::vector<std::string>& names, std::size_t most,
                        const std::string& plural) {
  if (names.size() <= most) return Joined(names);
  const std::string text = Joined({names.begin(), names.begin() + most});
  return StrCat(text, ", ... (", names.size(), plural.empty() ? "" : " ", plural, ")");
}

Error UnknownNameError(const std::string& path, const std::string& noun,
                       const std::vector<std::string>& names, const std::string& name) {
  return {"there is no " + noun + " " + Quoted(name) + "; it has " +
              ListOfNames(names, kNamesInErrors, noun + "s") + Suggestion(name, names),
          path};
}

namespace {

// Letters to put in, take out or replace (Levenshtein), hyphens and capitals aside.
std::size_t Distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, row[k] + 1, row[k + 1] + 1});
    }
  }
  return row.back();
}

std::string Plain(std::string key) {
  for (char& c : key) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(c));
  return key;
}

}  // namespace

std::string ClosestName(const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return "";
  std::string nearest;
  const std::string plain = Plain(word);
  std::size_t least = 3;
  for (const std::string& one : known) {
    // Short words are near to too much.
    const std::size_t most = one.size() < 5 ? 0 : 2;
    if (one.size() > word.size() + most || word.size() > one.size() + most) continue;
    const std::size_t distance = Distance(plain, Plain(one));
    if (distance > most || distance >= least) continue;
    nearest = one;
    least = distance;
  }
  return nearest;
}

std::string Suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string meant = ClosestName(word, known);
  return meant.empty() ? "" : "; did you mean " + meant + "?";
}

std::string Joined(const std::vector<std::string>& texts, const std::string& between) {
  std::string joined;
  for (const std::string& text : texts) joined += (&text == texts.data() ? "" : between) + text;
  return joined;
}

std::string CountText(std::size_t number, const std::string& noun, const std::string& plural) {
  const std::string several = plural.empty() ? noun + "s" : plural;
  return StrCat(number, " ", number == 1 ? noun : several);
}

std::vector<std::string> SplitList(const std::string& text, char separator) {
  std::vector<std::string> words;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, separator);) words.push_back(word);
  return words;
}

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
                            NameValues* values, int* tries) const {
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

std::optional<NameValues> NamePattern::Match(const std::string& path) const {
  NameValues values;
  int tries = 0;
  if (!MatchFrom(0, path, 0, &values, &tries)) return std::nullopt;
  return values;
}

std::optional<std::string> NamePattern::Fill(const NameValues& values) const {
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

namespace fs = std::filesystem;

Result<std::vector<std::string>> FilesBelow(const std::string& folder) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) return Error{"there is no such folder", folder};
  std::vector<std::string> files;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied,
                                      failed);
  for (; !failed && it != fs::recursive_directory_iterator(); it.increment(failed)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored)) {
      files.push_back(it->path().lexically_relative(folder).generic_string());
    }
  }
  if (failed) return Error{"cannot look through it: " + failed.message(), folder};
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace pushid
