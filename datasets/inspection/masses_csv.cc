// datasets: masses of subjects from a CSV file, or from Motion-BIDS's participants.tsv.
#include <algorithm>

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "datasets/inspection/manifest_maker.h"

namespace pushid {
namespace {

constexpr char kBidsPrefix[] = "sub-";  // of participants

// Which cells hold who and how heavy.
struct MassColumns {
  char separator = ',';
  std::size_t id = 0, mass = 1, count = 2;
};

Result<MassColumns> ReadHead(const LineReader& reader, std::string_view line) {
  MassColumns columns;
  if (line.find('\t') == std::string_view::npos) {
    if (CellsOf(line, ',') == std::vector<std::string_view>{"id", "mass_kg"}) return columns;
    return reader.ErrorHere("the first line must be id,mass_kg, not " + Quoted(line));
  }
  const std::vector<std::string_view> names = CellsOf(line, '\t');
  const auto place = [&names](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  columns = {'\t', place("participant_id"), std::min(place("mass_kg"), place("weight")),
             names.size()};
  if (columns.id < names.size() && columns.mass < names.size()) return columns;
  return reader.ErrorHere("participants need the columns participant_id and mass_kg, not " +
                          Quoted(line));
}

}  // namespace

Result<std::map<std::string, double>> ReadMasses(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  std::map<std::string, double> masses;
  std::string_view line;
  if (!reader.NextNonBlank(&line)) {
    return reader.error() ? *reader.error() : Error{"the file lists no masses", path};
  }
  const Result<MassColumns> columns = ReadHead(reader, line);
  if (!columns.ok()) return columns.error();
  while (reader.NextNonBlank(&line)) {
    std::vector<std::string_view> cells = CellsOf(line, columns.value().separator);
    cells.resize(std::max(cells.size(), columns.value().count));
    std::string id(cells[columns.value().id]);
    if (id.rfind(kBidsPrefix, 0) == 0 && columns.value().separator == '\t') id.erase(0, 4);
    const std::string_view mass = cells[columns.value().mass];
    double value = 0.0;
    if (!ParseDouble(mass, &value)) return reader.ErrorHere("mass_kg: " + NumberProblem(mass));
    if (!(value > 0.0 && value <= kHeaviestPerson)) {
      return reader.ErrorHere("a mass in kg is above 0 and at most " + Rounded(kHeaviestPerson) +
                              ", not " + Rounded(value));
    }
    if (!masses.emplace(id, value).second) {
      return reader.ErrorHere("the mass of " + Quoted(id) + " was given before");
    }
  }
  if (reader.error()) return *reader.error();
  if (masses.empty()) return reader.ErrorHere("the file lists no masses");
  return masses;
}

}  // namespace pushid
