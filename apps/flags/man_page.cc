// apps: pages of the manual.
#include <algorithm>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/support/app_support.h"

namespace pushid {
namespace {

// Backslashes, and the minus of flags, which is no hyphen; a control character at the start of a
// line is text.
std::string Roff(const std::string& text) {
  std::string roff;
  for (const char c : text) {
    const bool first = roff.empty() || roff.back() == '\n';
    if (first && (c == '.' || c == '\'')) roff += "\\&";
    roff += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  }
  return roff;
}

// Paragraphs are filled, indented lines are kept as they are.
std::string Description(const std::string& usage) {
  std::string text;
  bool example = false;
  std::istringstream lines(usage);
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.rfind("  ", 0) == 0;
    if (indented != example) text += indented ? ".PP\n.EX\n" : ".EE\n";
    example = indented;
    text += line.empty() ? (example ? "\n" : ".PP\n") : Roff(line) + "\n";
  }
  if (example) text += ".EE\n";
  // An empty paragraph before an example is a warning of groff.
  for (size_t at; (at = text.find(".PP\n.PP\n")) != std::string::npos;) text.erase(at, 4);
  return text;
}

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), ::toupper);
  return text;
}

}  // namespace

std::string ManPage(const std::string& usage, const std::string& words, const std::string& heading,
                    const std::vector<HelpSection>& sections) {
  const std::string name = ProgramName();
  std::string does = usage.substr(0, std::min(usage.find(".\n"), usage.find(". ")));
  std::replace(does.begin(), does.end(), '\n', ' ');
  if (does.rfind(name + " ", 0) == 0) does.erase(0, name.size() + 1);
  std::string page = ".TH " + Roff(Upper(name)) + " 1 \"\" \"pushid " + Version() +
                     "\" \"User Commands\"\n.SH NAME\n" + Roff(name) + " \\- " + Roff(does) +
                     "\n.SH SYNOPSIS\n.B " + Roff(name) + "\n" + Roff(words) +
                     "\n.SH DESCRIPTION\n" + Description(usage) + ".SH " + heading + "\n";
  for (const HelpSection& section : sections) {
    page += ".SS " + Roff(section.title) + "\n";
    for (const HelpEntry& entry : section.entries) {
      page += ".TP\n.B " + Roff(entry.name) + "\n" + Roff(entry.text) + "\n";
    }
  }
  return page +
         ".SH EXIT STATUS\n0: done; 1: bad usage or data; 2: a fit failed or did not converge, or "
         "a job of a batch\nfailed; 130: interrupted.\n.SH SEE ALSO\n.BR pushid (1)\n";
}

}  // namespace pushid
