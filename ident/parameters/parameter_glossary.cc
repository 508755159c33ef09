// ident: the glossary of parameters.
#include "ident/parameters/parameter_glossary.h"

#include "datasets/files/number_text.h"
#include "models/parameters.h"

namespace pushid {

TextTable ParameterGlossary() {
  TextTable table(
      {"name", "symbol", "unit", "without preset", "bounds", "meaning", "when to free it"},
      {true, true, true, false, true, true, true});
  for (const ParameterFacts& facts : AllParameterFacts()) {
    table.Add({std::string(facts.name), std::string(facts.symbol), std::string(facts.unit),
               Rounded(facts.nominal), Rounded(facts.lower) + " to " + Rounded(facts.upper),
               std::string(facts.meaning), std::string(facts.when_to_free)});
  }
  return table;
}

std::string ParameterGlossaryMarkdown() {
  const TextTable table = ParameterGlossary();
  std::string text;
  for (size_t i = 0; i < table.rows().size(); ++i) {
    for (const std::string& cell : table.rows()[i]) text += "| " + cell + " ";
    text += "|\n";
    if (i > 0) continue;
    for (size_t column = 0; column < table.rows()[0].size(); ++column) {
      text += table.IsWords(column) ? "|---" : "|--:";
    }
    text += "|\n";
  }
  return text;
}

}  // namespace pushid
