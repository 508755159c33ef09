// ident: columns of text, padded; numbers to the right.
#pragma once

#include <string>
#include <vector>

namespace pushid {

class TextTable {
 public:
  // left: which columns are words.
  TextTable(std::vector<std::string> header, std::vector<bool> left);
  void Add(std::vector<std::string> row);
  // A blank line between groups.
  void AddGap();
  std::string ToString() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::vector<bool> left_;
};

}  // namespace pushid
