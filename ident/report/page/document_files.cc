// ident: reports as text and as CSV.
#include "ident/report/page/document_files.h"

#include <filesystem>
#include <system_error>

#include "datasets/files/atomic_file.h"
#include "datasets/files/folders.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr size_t kMostRowsInText = 60;

// Numbers as people read them; words stay.
std::string ForReading(const std::string& cell) {
  double value = 0.0;
  return ParseDouble(cell, &value) ? Rounded(value, 4) : cell;
}

// Its numbers where they fit on a terminal; otherwise the file they go to.
std::string FigureText(const ReportFigure& figure) {
  const auto& rows = figure.numbers.rows();
  std::string text = figure.caption + (figure.caption.empty() ? "" : "\n");
  if (rows.size() > kMostRowsInText) {
    return text + "  (" + std::to_string(rows.size() - 1) + " rows: --csv_dir writes them to " +
           figure.name + ".csv)\n";
  }
  TextTable table(rows[0], AllWords(rows[0].size()));
  for (size_t i = 1; i < rows.size(); ++i) {
    std::vector<std::string> cells;
    for (const std::string& cell : rows[i]) cells.push_back(ForReading(cell));
    table.Add(cells);
  }
  return text + table.ToString();
}

std::string SectionText(const ReportSection& section) {
  std::string text;
  for (std::string paragraph : section.paragraphs) {
    while (!paragraph.empty() && paragraph.back() == '\n') paragraph.pop_back();
    if (!paragraph.empty()) text += paragraph + "\n";
  }
  for (const auto& [sentence, command] : section.advice) {
    text += "advice: " + sentence + "\n";
    if (!command.empty()) text += "  " + command + "\n";
  }
  for (const ReportTable& table : section.tables) {
    if (table.table.rows().size() < 2) continue;
    text += (text.empty() ? "" : "\n") + (table.caption.empty() ? "" : table.caption + "\n") +
            table.table.ToString();
  }
  for (const ReportFigure& figure : section.figures) text += "\n" + FigureText(figure);
  for (const ReportFold& fold : section.folds) text += fold.title + "\n";
  if (text.empty()) return "";
  return section.title + "\n" + std::string(section.title.size(), '=') + "\n" + text + "\n";
}

// A comma or a quote in a name must not shift the columns.
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// Names hold ids of recordings and parameters.
std::string FileName(const std::string& name) {
  std::string file = name;
  for (char& c : file) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
    if (!plain) c = '_';
  }
  return file + ".csv";
}

}  // namespace

std::string CsvOf(const TextTable& table) {
  std::string csv;
  for (const auto& row : table.rows()) {
    for (size_t i = 0; i < row.size(); ++i) csv += (i > 0 ? "," : "") + Field(row[i]);
    csv += "\n";
  }
  return csv;
}

std::string ToText(const Report& report) {
  std::string text = report.title + "\n" + report.subtitle + "\n\n";
  for (const ReportSection& section : report.sections) text += SectionText(section);
  return text;
}

MaybeError WriteNumbers(const Report& report, const std::string& folder) {
  if (MaybeError failed = MakeFolder(folder)) return failed;
  const auto write = [&folder](const ReportFigure& figure) {
    return WriteFileAtomically((std::filesystem::path(folder) / FileName(figure.name)).string(),
                               CsvOf(figure.numbers));
  };
  for (const ReportSection& section : report.sections) {
    for (const ReportFigure& figure : section.figures) {
      if (MaybeError failed = write(figure)) return failed;
    }
    for (const ReportFold& fold : section.folds) {
      for (const ReportFigure& figure : fold.figures) {
        if (MaybeError failed = write(figure)) return failed;
      }
    }
  }
  return std::nullopt;
}

}  // namespace pushid
