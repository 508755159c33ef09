// ident: a report as sections of sentences, tables and figures, whatever it is shown on: a page
// of HTML, a terminal or a folder of numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"

namespace pushid {

struct ReportTable {
  std::string caption;  // the page folds the table under it; empty: no fold
  TextTable table;
};

struct ReportFigure {
  std::string name;     // of its files
  std::string caption;  // says what to see in it
  Figure figure;
  TextTable numbers;  // behind it, at full precision, units in the header
};

// One recording's figures, which unfold on demand.
struct ReportFold {
  std::string title;
  std::vector<ReportFigure> figures;
};

struct ReportSection {
  std::string id, title = {};
  std::vector<std::string> paragraphs = {};  // line breaks are kept
  std::vector<std::pair<std::string, std::string>> advice =
      {};  // a sentence, and what to type next
  std::vector<ReportTable> tables = {};
  std::vector<ReportFigure> figures = {};
  std::vector<ReportFold> folds = {};
  std::string widget = {};     // HTML that only a page can show; empty elsewhere
  std::string alarm = {};      // before everything else, and in red
  bool verdict_first = false;  // the first paragraph stands before the figures

  bool empty() const {
    return alarm.empty() && paragraphs.empty() && advice.empty() && tables.empty() &&
           figures.empty() && folds.empty() && widget.empty();
  }
  // A further paragraph or table, unless there is nothing in it.
  void Say(const std::string& text) {
    if (!text.empty()) paragraphs.push_back(text);
  }
  void Show(const std::string& caption, const TextTable& table) {
    if (!table.empty()) tables.push_back({caption, table});
  }
};

struct Report {
  std::string title, subtitle;
  std::vector<ReportSection> sections;
};

// A report for a terminal: all sentences and tables, in lines of at most 100 columns. Figures,
// flags and hashes are for the page and for files.
std::string ToText(const Report& report);

// Rows of a table; fields with a comma or a quote are quoted.
std::string CsvOf(const TextTable& table);

// All figures, those of folds too.
std::vector<const ReportFigure*> FiguresOf(const Report& report);

// A file's name and content.
using NamedText = std::pair<std::string, std::string>;

// Every figure as <name>.svg; what it draws and every table as <name>.csv; captions.md.
std::vector<NamedText> FigureFiles(const Report& report);
inline constexpr char kCaptionsFile[] = "captions.md";

// A report as one HTML page that needs nothing else: no network, no other file. Sections
// without anything in them are left out.

std::string ToPage(const Report& report);

// Error: the path (of --flag) names another kind of file than a page, as report.pdf does.
MaybeError CheckPageName(const std::string& flag, const std::string& path);

}  // namespace pushid
