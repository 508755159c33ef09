// datasets: what a misspelt name was meant to be.
#pragma once

#include <string>
#include <vector>

namespace pushid {

// The known word that another one is most likely a misspelling of; empty where it is known itself
// or like none of them.
std::string MeantBy(const std::string& word, const std::vector<std::string>& known);

// "; is hip meant?", or nothing.
std::string MeantText(const std::string& word, const std::vector<std::string>& known);

}  // namespace pushid
