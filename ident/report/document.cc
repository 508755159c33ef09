#include "ident/report/document.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "datasets/files/names.h"
#include "ident/figures/svg.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

// The page's style sheet and its one script.
constexpr char kPageStyle[] = R"css(
:root{--paper:#fff;--ink:#222;--faint:#666;--line:#ddd;--link:#0b57d0;--box:#f5f6f8;color-scheme:light dark}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--faint:#a0a0a0;--line:#3a3f46;--link:#8ab4f8;--box:#1e2328}}
*{box-sizing:border-box}
body{margin:0;padding:0 .8rem 4rem;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
header,main{max-width:1400px;margin:0 auto}
h1{margin:1rem 0 .2rem;font-size:1.5rem}
h2{margin:2.6rem 0 .6rem;font-size:1.25rem;border-bottom:1px solid var(--line);padding-bottom:.2rem}
section{scroll-margin-top:1rem}
main>section:first-child h2{margin-top:1rem}
header p{color:var(--faint);margin:.2rem 0 1rem}
nav ul{display:flex;flex-wrap:wrap;gap:.1rem 1rem;margin:0;padding:.5rem 0;list-style:none;font-size:.8rem}
@media(min-width:1196px){body{padding-left:172px}
nav{position:fixed;left:0;top:0;bottom:0;width:160px;padding:.7rem .8rem;overflow-y:auto;border-right:1px solid var(--line)}
nav ul{display:block}nav li{margin-bottom:.4rem}}
a{color:var(--link)}
p,figcaption{max-width:110ch}
pre{background:var(--box);padding:.5rem .7rem;overflow-x:auto;font-size:.85rem;border-radius:4px}
.panels{display:flex;flex-wrap:wrap;align-items:flex-start}
.scroll{overflow-x:auto}  /* pictures keep their size, so that labels stay readable */
table{border-collapse:collapse;margin:1rem 0;font-size:.8rem;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .6rem .2rem 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}
td:last-child{white-space:normal;min-width:6rem}
th{font-weight:600;white-space:normal;vertical-align:bottom}
.number{text-align:right}
.alarm{border-left:5px solid #c62828;background:var(--box);padding:.5rem .8rem}
figure{margin:1rem 0;break-inside:avoid}
figcaption{color:var(--faint);font-size:.85rem}
.panels svg{display:block;flex:none}
@media(max-width:1000px){table{font-size:.7rem}td{white-space:normal}#short figure:first-of-type .scroll{flex-wrap:nowrap}}
details{border-bottom:1px solid var(--line);padding:.3rem 0}
summary{cursor:pointer}
.moving{width:100%;height:34rem;border:1px solid var(--line);border-radius:4px}
:focus-visible{outline:2px solid var(--link);outline-offset:2px}
@media print{:root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--box:#fff}
nav{display:none}body{padding:0}header,main{max-width:none}h2{break-after:avoid}svg{max-width:100%;height:auto}
pre{white-space:pre-wrap;overflow-wrap:anywhere}.scroll{overflow:visible}summary{break-after:avoid}
table{font-size:.62rem}th,td{white-space:normal;padding-right:.35rem}td:last-child{min-width:0}
svg .paper{fill:#fff}svg .ink,svg .axis{fill:#222}svg .faint{fill:#666}svg line.axis,svg path.axis,svg path.ink{stroke:#222;fill:none}svg line.grid,svg path.grid{stroke:#ddd}}
)css";

// Folds are open on paper.
constexpr char kPageScript[] = R"js(
(function () {
  let closed = [];
  addEventListener('beforeprint', () => {
    closed = [...document.querySelectorAll('details:not([open])')];
    for (const fold of closed) fold.open = true;
  });
  addEventListener('afterprint', () => {
    for (const fold of closed) fold.open = false;
  });
})();
)js";

std::string SectionText(const ReportSection& section) {
  std::string text = TextLines(section.alarm);
  for (const std::string& paragraph : section.paragraphs) text += TextLines(paragraph);
  for (const auto& [sentence, command] : section.advice) {
    text += TextLines("advice: " + sentence) + CommandLines(command);
  }
  for (const ReportTable& table : section.tables) {
    if (table.table.empty()) continue;
    text += (text.empty() ? "" : "\n") + TextLines(table.caption) + table.table.ToString();
  }
  for (const ReportFold& fold : section.folds) text += TextLines(fold.title);
  if (text.empty()) return "";
  return section.title + "\n" + std::string(section.title.size(), '=') + "\n" + text + "\n";
}

std::string Element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + EscapeXml(text) + "</" + name + ">\n";
}

std::string Folded(const std::string& title, const std::string& html) {
  return "<details><summary>" + EscapeXml(title) + "</summary>\n" + html + "</details>\n";
}

// A table with a caption unfolds on demand.
std::string TableHtml(const ReportTable& table) {
  const auto& rows = table.table.rows();
  if (rows.size() < 2) return "";
  std::string html = "<div class=\"scroll\" tabindex=\"0\"><table>\n";
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].empty()) continue;  // a gap
    html += "<tr>";
    for (size_t j = 0; j < rows[i].size(); ++j) {
      const std::string cell = i == 0 ? "th" : "td";
      html += "<" + cell + (i == 0 ? " scope=\"col\"" : "") +
              (table.table.IsWords(j) ? "" : " class=\"number\"") + ">" + EscapeXml(rows[i][j]) +
              "</" + cell + ">";
    }
    html += "</tr>\n";
  }
  html += "</table></div>\n";
  return table.caption.empty() ? html : Folded(table.caption, html);
}

// Entries and panels wrap where the window is narrow.
std::string FigureHtml(const ReportFigure& figure) {
  std::string html = "<figure><div class=\"panels\">";
  for (const LegendEntry& entry : figure.figure.legend) {
    SvgPicture picture(LegendWidth({entry}), 18, entry.name);
    DrawLegend({entry}, 2, 13, &picture);
    html += picture.ToInline();
  }
  html += "</div>\n<div class=\"panels scroll\" tabindex=\"0\">";
  for (const Chart& panel : figure.figure.panels) html += DrawPanel(panel).ToInline();
  html += "</div>\n";
  if (!figure.caption.empty()) html += Element("figcaption", figure.caption);
  return html + "</figure>\n";
}

// Lines that belong together stay one paragraph.
std::string Paragraph(std::string text, const char* opening = "<p>") {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.empty()) return "";
  std::vector<std::string> lines = SplitList(text, '\n');
  for (std::string& line : lines) line = EscapeXml(line);
  return opening + Joined(lines, "<br>") + "</p>\n";
}

std::string SectionHtml(const ReportSection& section) {
  std::string html = "<section id=\"" + section.id + "\">\n" + Element("h2", section.title);
  html += Paragraph(section.alarm, "<p class=\"alarm\">");
  const size_t before = std::min<size_t>(section.verdict_first ? 1 : 0, section.paragraphs.size());
  for (size_t i = 0; i < before; ++i) html += Paragraph(section.paragraphs[i]);
  for (const ReportFigure& figure : section.figures) html += FigureHtml(figure);
  for (size_t i = before; i < section.paragraphs.size(); ++i) {
    html += Paragraph(section.paragraphs[i]);
  }
  for (const auto& [sentence, command] : section.advice) {
    html += Paragraph(sentence);
    if (!command.empty()) html += "<pre>" + EscapeXml(command) + "</pre>\n";
  }
  html += section.widget;
  for (const ReportTable& table : section.tables) html += TableHtml(table);
  for (const ReportFold& fold : section.folds) {
    std::string in_fold;
    for (const ReportFigure& figure : fold.figures) in_fold += FigureHtml(figure);
    html += Folded(fold.title, in_fold);
  }
  return html + "</section>\n";
}

}  // namespace

std::string CsvOf(const TextTable& table) {
  std::string csv;
  for (const auto& row : table.rows()) {
    for (size_t i = 0; i < row.size(); ++i) {
      // A comma or a quote in a name must not shift the columns.
      const bool quoted = row[i].find_first_of(",\"\n") != std::string::npos;
      csv += std::string(i > 0 ? "," : "") + (quoted ? "\"" : "");
      for (const char c : row[i]) csv += c == '"' ? std::string("\"\"") : std::string(1, c);
      if (quoted) csv += '"';
    }
    csv += "\n";
  }
  return csv;
}

std::string ToText(const Report& report) {
  std::string text = TextLines(report.title) + TextLines(report.subtitle) + "\n";
  for (const ReportSection& section : report.sections) {
    if (section.id != "provenance") text += SectionText(section);
  }
  return text;
}

std::vector<const ReportFigure*> FiguresOf(const Report& report) {
  std::vector<const ReportFigure*> figures;
  for (const ReportSection& section : report.sections) {
    for (const ReportFigure& figure : section.figures) figures.push_back(&figure);
    for (const ReportFold& fold : section.folds) {
      for (const ReportFigure& figure : fold.figures) figures.push_back(&figure);
    }
  }
  return figures;
}

std::vector<NamedText> FigureFiles(const Report& report) {
  constexpr double kWidth = 1000.0;  // pixels
  std::vector<NamedText> files;
  std::string captions = "# " + report.title + "\n";
  const auto caption = [&captions](const std::string& name, const std::string& text) {
    captions += "\n**" + name + "** " + text + "\n";
  };
  for (const ReportFigure* figure : FiguresOf(report)) {
    std::string name = figure->name;  // holds ids of recordings and parameters
    for (char& c : name) {
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    }
    files.emplace_back(name + ".svg", DrawFigure(figure->figure, kWidth, name).ToString());
    files.emplace_back(name + ".csv", CsvOf(figure->numbers));
    caption(name, figure->caption);
  }
  for (const ReportSection& section : report.sections) {
    int number = 0;
    for (const ReportTable& table : section.tables) {
      const std::string name = "table_" + section.id + "_" + std::to_string(++number);
      files.emplace_back(name + ".csv", CsvOf(table.table));
      caption(name, section.title + (table.caption.empty() ? "" : ": " + table.caption) + ".");
    }
  }
  files.emplace_back(kCaptionsFile, captions);
  return files;
}

// The links stand behind the first section, which is what most readers want.
std::string ToPage(const Report& report) {
  std::string nav, lead, body;
  bool scripted = false;
  for (const ReportSection& section : report.sections) {
    if (section.empty()) continue;
    scripted = scripted || !section.widget.empty();
    nav += "<li><a href=\"#" + section.id + "\">" + EscapeXml(section.title) + "</a></li>\n";
    (lead.empty() ? lead : body) += SectionHtml(section);
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n" +
         Element("title", report.title) + "<style>" + std::string(SvgStyle()) + kPageStyle +
         "</style>\n</head>\n<body>\n<header>" + Element("h1", report.title) +
         Element("p", report.subtitle) + "</header>\n<main>\n" + lead +
         "<nav aria-label=\"sections\"><ul>\n" + nav + "</ul></nav>\n" + body + "</main>\n" +
         (scripted ? std::string("<script>") + kPageScript + "</script>\n" : "") +
         "</body>\n</html>\n";
}

MaybeError CheckPageName(const std::string& flag, const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  if (path.empty() || name.find('.') == std::string::npos || EndsWith(name, ".html") ||
      EndsWith(name, ".htm")) {
    return std::nullopt;
  }
  return Error{flag + " is " + Quoted(path) +
               ": the report is one page of HTML; let its name end in .html, and print it to PDF "
               "from a browser"};
}

}  // namespace pushid
