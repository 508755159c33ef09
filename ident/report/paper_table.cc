// ident: the identified parameters as a table for papers.
#include <cctype>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/report/report_text.h"
#include "models/parameters.h"

namespace pushid {
namespace {

constexpr const char* kGreek[] = {"theta", "phi", "mu", "kappa", "sigma"};

// "mu" as \mu, "thetax" as \theta x, "contact" as \mathrm{contact}.
std::string TexWord(const std::string& word) {
  for (const std::string letter : kGreek) {
    if (word.rfind(letter, 0) != 0) continue;
    const std::string rest = word.substr(letter.size());
    return "\\" + letter + (rest.empty() ? "" : " " + TexWord(rest));
  }
  return word.size() < 3 ? word : "\\mathrm{" + word + "}";
}

// "Kp_theta" as K_{p,\theta}.
std::string TexSymbol(const std::string& symbol) {
  std::vector<std::string> parts = SplitList(symbol, '_');
  std::string head = parts[0], below;
  if (head == "Kp" || head == "Kd") {
    below = head.substr(1);
    head = "K";
  }
  for (size_t i = 1; i < parts.size(); ++i) below += (below.empty() ? "" : ",") + TexWord(parts[i]);
  return "$" + TexWord(head) + (below.empty() ? "" : "_{" + below + "}") + "$";
}

// A slope or a deviation has no row of its own.
std::string SymbolOf(const std::string& name) {
  for (const ParameterFacts& facts : AllParameterFacts()) {
    if (facts.name == name) return TexSymbol(std::string(facts.symbol));
  }
  return "";
}

// "m/s^2": powers of units stand in mathematics.
std::string TexText(const std::string& cell) {
  if (!cell.empty() && cell[0] == '$') return cell;
  std::string text;
  for (size_t i = 0; i < cell.size(); ++i) {
    const char c = cell[i];
    if (c == '^') {
      size_t end = i + 1;
      while (end < cell.size() &&
             (std::isdigit(static_cast<unsigned char>(cell[end])) || cell[end] == '.'))
        ++end;
      text += "$^{" + cell.substr(i + 1, end - i - 1) + "}$";
      i = end - 1;
    } else if (Holds("_%&#", std::string(1, c))) {
      (text += '\\') += c;
    } else {
      const bool minus =
          c == '-' && i + 1 < cell.size() && std::isdigit(static_cast<unsigned char>(cell[i + 1]));
      text += minus ? std::string("$-$") : std::string(1, c);
    }
  }
  return text;
}

}  // namespace

TextTable PaperTable(const FitResult& result) {
  TextTable table({"symbol", "parameter", "unit", "estimate", "95 % interval", "verdict"},
                  {true, true, true, false, true, true});
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    const double lower = e.total ? e.total->lower95 : e.lower95;
    const double upper = e.total ? e.total->upper95 : e.upper95;
    table.Add({SymbolOf(e.name), e.name, e.unit, Rounded(e.value, 4),
               lower < upper ? IntervalText(e.value, lower, upper) : "-", NameOf(e.status)});
  }
  return table;
}

std::string LatexOf(const TextTable& table) {
  const auto& rows = table.rows();
  std::string text = "% \\usepackage{booktabs}\n\\begin{tabular}{";
  for (size_t j = 0; j < rows[0].size(); ++j) text += table.IsWords(j) ? 'l' : 'r';
  text += "}\n\\toprule\n";
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t j = 0; j < rows[i].size(); ++j) text += (j > 0 ? " & " : "") + TexText(rows[i][j]);
    text += i == 0 ? " \\\\\n\\midrule\n" : " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string MarkdownOf(const TextTable& table) {
  const auto& rows = table.rows();
  std::string text, line;
  for (size_t j = 0; j < rows[0].size(); ++j) line += table.IsWords(j) ? "| --- " : "| ---: ";
  for (size_t i = 0; i < rows.size(); ++i) {
    for (const std::string& cell : rows[i]) text += "| " + cell + " ";
    text += i == 0 ? "|\n" + line + "|\n" : "|\n";
  }
  return text;
}

}  // namespace pushid
