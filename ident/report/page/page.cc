// ident: writing the page.
#include "ident/report/page/page.h"

#include <cctype>

#include "ident/figures/svg.h"
#include "ident/report/page/page_parts.h"

namespace pushid {
namespace {

std::string Element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + EscapeXml(text) + "</" + name + ">\n";
}

std::string TableHtml(const ReportTable& table) {
  const auto& rows = table.table.rows();
  if (rows.size() < 2) return "";
  std::string html = "<div class=\"scroll\" tabindex=\"0\"><table>\n";
  if (!table.caption.empty()) html += Element("caption", table.caption);
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
  return html + "</table></div>\n";
}

std::string FigureHtml(const ReportFigure& figure) {
  std::string html = "<figure><div class=\"scroll\" tabindex=\"0\">" + figure.svg + "</div>";
  if (!figure.caption.empty()) html += Element("figcaption", figure.caption);
  return html + "</figure>\n";
}

bool IsEmpty(const ReportSection& s) {
  return s.paragraphs.empty() && s.advice.empty() && s.tables.empty() && s.figures.empty() &&
         s.folds.empty() && s.widget.empty();
}

// Lines that belong together stay one paragraph.
std::string Paragraph(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.empty()) return "";
  std::string html = "<p>";
  size_t from = 0;
  for (size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', from)) {
    html += EscapeXml(text.substr(from, end - from)) + "<br>";
    from = end + 1;
  }
  return html + EscapeXml(text.substr(from)) + "</p>\n";
}

std::string SectionHtml(const ReportSection& section) {
  std::string html = "<section id=\"" + section.id + "\">\n" + Element("h2", section.title);
  for (const std::string& text : section.paragraphs) html += Paragraph(text);
  for (const auto& [sentence, command] : section.advice) {
    html += Paragraph(sentence);
    if (!command.empty()) html += "<pre>" + EscapeXml(command) + "</pre>\n";
  }
  html += section.widget;
  for (const ReportTable& table : section.tables) html += TableHtml(table);
  for (const ReportFigure& figure : section.figures) html += FigureHtml(figure);
  for (const ReportFold& fold : section.folds) {
    html += "<details><summary>" + EscapeXml(fold.title) + "</summary>\n";
    for (const ReportFigure& figure : fold.figures) html += FigureHtml(figure);
    html += "</details>\n";
  }
  return html + "</section>\n";
}

}  // namespace

std::string ToPage(const Report& report) {
  std::string nav, body, script;
  for (const ReportSection& section : report.sections) {
    if (IsEmpty(section)) continue;
    nav += "<li><a href=\"#" + section.id + "\">" + EscapeXml(section.title) + "</a></li>\n";
    body += SectionHtml(section);
    if (!section.widget.empty()) script = kPageScript;
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n" +
         Element("title", report.title) + "<style>" + std::string(SvgStyle()) + kPageStyle +
         "</style>\n</head>\n<body>\n<header>" + Element("h1", report.title) +
         Element("p", report.subtitle) + "</header>\n<nav aria-label=\"sections\"><ul>\n" + nav +
         "</ul></nav>\n<main>\n" + body + "</main>\n" +
         (script.empty() ? "" : "<script>" + script + "</script>\n") + "</body>\n</html>\n";
}

}  // namespace pushid
