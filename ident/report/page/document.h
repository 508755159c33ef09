// ident: a report as sections of sentences, tables and figures, whatever it is shown on: a page
// (page.h), a terminal (document_text.h) or a folder of numbers (document_csv.h).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ident/figures/text_table.h"

namespace pushid {

struct ReportTable {
  std::string caption;  // may be empty
  TextTable table;
};

struct ReportFigure {
  std::string name;     // of its file of numbers: letters, digits, _ and -
  std::string caption;  // what to see in it
  std::string svg;      // inline
  TextTable numbers;    // behind it, at full precision, units in the header
};

// What opens on demand: one recording's figures.
struct ReportFold {
  std::string title;
  std::vector<ReportFigure> figures;
};

struct ReportSection {
  std::string id, title;
  std::vector<std::string> paragraphs;                      // line breaks are kept
  std::vector<std::pair<std::string, std::string>> advice;  // a sentence, and what to type next
  std::vector<ReportTable> tables;
  std::vector<ReportFigure> figures;
  std::vector<ReportFold> folds;
  std::string widget;  // HTML that only a page can show; empty elsewhere
};

struct Report {
  std::string title, subtitle;
  std::vector<ReportSection> sections;
};

}  // namespace pushid
