#include "datasets/files/names.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>

namespace pushid {

std::string ListOfNames(const std::vector<std::string>& names, std::size_t most,
                        const std::string& plural) {
  if (names.size() <= most) return Joined(names);
  const std::string text = Joined({names.begin(), names.begin() + most});
  return text + ", ... (" + std::to_string(names.size()) + (plural.empty() ? "" : " ") + plural +
         ")";
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
  return std::to_string(number) + " " + (number == 1 ? noun : several);
}

std::vector<std::string> SplitList(const std::string& text, char separator) {
  std::vector<std::string> words;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, separator);) words.push_back(word);
  return words;
}

}  // namespace pushid
