// datasets: the files beside a Motion-BIDS table.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_bids.h"
#include "datasets/formats/units.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

constexpr char kMotionEnd[] = "_motion.tsv";
constexpr int kMostLevels = 4;  // motion, session, subject, dataset

std::set<std::string> Entities(const std::string& stem) {
  std::set<std::string> entities;
  std::istringstream stream(stem);
  for (std::string part; std::getline(stream, part, '_');) entities.insert(part);
  return entities;
}

// The file of a folder whose name ends so and has the most of the motion's entities, and no others.
std::string SidecarIn(const fs::path& folder, const std::set<std::string>& entities,
                      const std::string& end) {
  std::string best;
  std::size_t most = 0;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (!EndsWith("_" + name, end)) continue;
    const std::string stem = ("_" + name).substr(0, name.size() + 1 - end.size());
    std::set<std::string> own = Entities(stem);
    own.erase("");
    const bool applies = std::includes(entities.begin(), entities.end(), own.begin(), own.end());
    if (applies && own.size() + 1 > most) {
      best = entry.path().string();
      most = own.size() + 1;
    }
  }
  return best;
}

// Those that apply to the motion, the nearest first.
std::vector<std::string> Sidecars(const std::string& motion_path, const std::string& end) {
  const fs::path path = fs::path(motion_path);
  const std::string name = path.filename().string();
  const std::set<std::string> entities =
      Entities(name.substr(0, name.size() - sizeof kMotionEnd + 1));
  std::vector<std::string> found;
  fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code failed;
  for (int level = 0; level < kMostLevels; ++level) {
    const std::string file = SidecarIn(folder, entities, end);
    if (!file.empty()) found.push_back(file);
    if (fs::exists(folder / "dataset_description.json", failed)) break;
    folder = folder / "..";
  }
  return found;
}

Error NoSidecar(const std::string& motion_path, const std::string& end) {
  const std::string stem = motion_path.substr(0, motion_path.size() - sizeof kMotionEnd + 1);
  return Error{"a Motion-BIDS file needs " + fs::path(stem + end).filename().string() +
                   " beside it, or one with fewer entities above it",
               motion_path};
}

// The keys of all files that apply, the nearest first.
Result<nlohmann::json> MergedJson(const std::vector<std::string>& files, ContentHash* hash) {
  nlohmann::json merged = nlohmann::json::object();
  for (const std::string& file : files) {
    const Result<nlohmann::json> one = ReadJson(file);
    if (!one.ok()) return one.error();
    if (!one.value().is_object()) return Error{"must be an object { }", file, 1};
    for (const auto& [key, value] : one.value().items()) {
      if (!merged.contains(key)) merged[key] = value;
    }
    const Result<std::string> one_hash = HashFile(file);
    if (!one_hash.ok()) return one_hash.error();
    hash->Add(one_hash.value());
  }
  return merged;
}

MaybeError ReadMotionJson(const std::vector<std::string>& files, ContentHash* hash,
                          BidsHeader* header) {
  const Result<nlohmann::json> read = MergedJson(files, hash);
  if (!read.ok()) return read.error();
  const nlohmann::json& json = read.value();
  const std::string& file = files.front();
  std::string missing;
  for (const char* key : {"TaskName", "SamplingFrequency"}) {
    if (!json.contains(key)) missing += (missing.empty() ? "" : " and ") + std::string(key);
  }
  if (!missing.empty()) return Error{missing + ", which Motion-BIDS requires, are missing", file};
  const nlohmann::json& rate = json.at("SamplingFrequency");
  header->rate_hz = rate.is_number() ? rate.get<double>() : 0.0;
  const std::string problem = FrameRateProblem(header->rate_hz);
  if (!problem.empty()) return Error{"SamplingFrequency " + problem, file};
  if (json.contains("MissingValues") && json.at("MissingValues").is_string()) {
    header->missing = json.at("MissingValues").get<std::string>();
  }
  return std::nullopt;
}

// Where the columns of the line of names are; an Error names those that are missing.
MaybeError FindColumns(const LineReader& reader, const std::vector<std::string>& names,
                       std::vector<int>* columns) {
  std::string missing;
  for (const char* name :
       {"name", "component", "type", "tracked_point", "units", "reference_frame"}) {
    const auto found = std::find(names.begin(), names.end(), name);
    columns->push_back(found == names.end() ? -1 : static_cast<int>(found - names.begin()));
    const bool required = std::string_view(name) != "reference_frame";
    if (columns->back() < 0 && required)
      missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (missing.empty()) return std::nullopt;
  return reader.ErrorHere(
      "Motion-BIDS requires the columns name, component, type, tracked_point "
      "and units, separated by tabs; missing here: " +
      missing);
}

Result<std::vector<BidsChannel>> ReadChannels(const std::string& file, ContentHash* hash) {
  LineReader reader;
  if (MaybeError failed = reader.Open(file)) return *std::move(failed);
  std::string_view line;
  if (!reader.NextNonBlank(&line)) return Error{"the file is empty", file};
  const std::vector<std::string_view> head = CellsOf(line, '\t');
  const std::vector<std::string> names(head.begin(), head.end());
  std::vector<int> columns;
  if (MaybeError failed = FindColumns(reader, names, &columns)) return *std::move(failed);
  std::vector<BidsChannel> channels;
  std::set<std::string> seen;
  while (reader.NextNonBlank(&line)) {
    const std::vector<std::string_view> cells = CellsOf(line, '\t');
    if (cells.size() != names.size()) {
      return reader.ErrorHere("the row has " + std::to_string(cells.size()) + " cells, not " +
                              std::to_string(names.size()) + ", separated by tabs");
    }
    const auto cell = [&](int i) { return std::string(columns[i] < 0 ? "" : cells[columns[i]]); };
    channels.push_back({cell(0), cell(1), cell(2), cell(3), cell(4), cell(5)});
    if (!seen.insert(cell(0)).second) {
      return reader.ErrorHere("two channels are called " + Quoted(cell(0)));
    }
  }
  if (reader.error()) return *reader.error();
  if (channels.empty()) return reader.ErrorHere("the file lists no channels");
  hash->Add(reader.HashHex());
  return channels;
}

// "+y" where the second letter of "ARS" ... is S, of the positions' reference frame; empty where
// the files do not say it.
std::string UpOfReferenceFrame(const nlohmann::json& json,
                               const std::vector<BidsChannel>& channels) {
  const auto position = std::find_if(channels.begin(), channels.end(), [](const BidsChannel& one) {
    return EqualsIgnoringCase(one.type, "POS");
  });
  if (position == channels.end()) return "";
  const nlohmann::json levels =
      json.value(nlohmann::json::json_pointer("/reference_frame/Levels"), nlohmann::json::object());
  const auto frame = levels.find(position->reference_frame);
  if (frame == levels.end() || !frame->is_object() || !frame->contains("SpatialAxes") ||
      !frame->at("SpatialAxes").is_string()) {
    return "";
  }
  const std::string axes = frame->at("SpatialAxes").get<std::string>();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()); ++i) {
    if (axes[i] == 'S') return std::string("+") + "xyz"[i];
    if (axes[i] == 'I') return std::string("-") + "xyz"[i];
  }
  return "";
}

}  // namespace

Result<BidsHeader> ReadBidsHeader(const std::string& motion_path) {
  if (!EndsWith(motion_path, kMotionEnd)) {
    return Error{
        "a Motion-BIDS table is called sub-..._task-..._tracksys-..._motion.tsv; other "
        "tables of numbers with names above them are read as .csv",
        motion_path};
  }
  const std::vector<std::string> motion = Sidecars(motion_path, "_motion.json");
  if (motion.empty()) return NoSidecar(motion_path, "_motion.json");
  const std::vector<std::string> channels = Sidecars(motion_path, "_channels.tsv");
  if (channels.empty()) return NoSidecar(motion_path, "_channels.tsv");
  BidsHeader header;
  ContentHash hash;
  if (MaybeError failed = ReadMotionJson(motion, &hash, &header)) return *std::move(failed);
  Result<std::vector<BidsChannel>> read = ReadChannels(channels.front(), &hash);
  if (!read.ok()) return read.error();
  header.channels = std::move(read.value());
  const Result<nlohmann::json> frames = MergedJson(Sidecars(motion_path, "_channels.json"), &hash);
  if (!frames.ok()) return frames.error();
  header.up = UpOfReferenceFrame(frames.value(), header.channels);
  header.content_hash = hash.Hex();
  return header;
}

}  // namespace pushid
