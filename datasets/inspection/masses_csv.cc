// datasets: masses of subjects from a CSV file.
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "datasets/inspection/manifest_maker.h"

namespace pushid {

Result<std::map<std::string, double>> ReadMasses(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  std::map<std::string, double> masses;
  std::string_view line;
  bool head = true;
  while (reader.NextNonBlank(&line)) {
    const std::size_t comma = line.find(',');
    const std::string_view id = Trimmed(line.substr(0, comma));
    const std::string_view mass =
        comma == std::string_view::npos ? "" : Trimmed(line.substr(comma + 1));
    if (head) {
      if (id != "id" || mass != "mass_kg") {
        return reader.ErrorHere("the first line must be id,mass_kg, not " + Quoted(line));
      }
      head = false;
      continue;
    }
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
