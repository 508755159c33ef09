// datasets: forces as CSV files.
#include "datasets/formats/force_csv.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"

namespace pushid {
namespace {

constexpr char kHeader[] = "frame,fx,fy,ftheta,fphi";
constexpr int kNumColumns = 5, kWithoutTorques = 3, kMinSamples = 3;
constexpr int kFewestAtLimit = 5;  // samples

struct NamedColumn {
  const char *name, *with_unit;  // as PlainName has them
};
constexpr NamedColumn kPushColumns[] = {
    {"frame", "frame"}, {"fx", "fxn"}, {"fy", "fyn"}, {"ftheta", "fthetanm"}, {"fphi", "fphinm"}};
constexpr NamedColumn kAxisColumns[] = {{"force", "forcen"}};
constexpr NamedColumn kVectorColumns[] = {{"fx", "fxn"}, {"fy", "fyn"}, {"fz", "fzn"}};

// Whether these, in this order, are what the names from `first` on say.
template <std::size_t N>
bool AreCalled(const std::vector<std::string>& names, const NamedColumn (&columns)[N],
               std::size_t first, std::size_t count = N) {
  return names.size() == first + count &&
         std::equal(names.begin() + static_cast<std::ptrdiff_t>(first), names.end(), columns,
                    [](const std::string& name, const NamedColumn& column) {
                      const std::string plain = PlainName(name);
                      return plain == column.name || plain == column.with_unit;
                    });
}

// A table without gaps. columns: IsPush or IsSensor; expected: the rest of the error.
NumericTable ReadTable(const std::string& path,
                       bool (*columns)(const std::vector<std::string>& names),
                       const std::string& expected) {
  NumericTable table =
      OrThrow(ReadNumericTable(path, TableFormat::kCsv, [&](const std::vector<std::string>& names) {
        if (!columns(names)) {
          throw Error{"the header is " + Quoted(ListOfNames(names)) + ", " + expected +
                          (IsSensor(names) ? "; pushid-push --sensor makes such a push of it" : ""),
                      path};
        }
        std::vector<int> all(names.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
      }));
  for (int row = 0; row < table.num_rows(); ++row) {
    for (std::size_t i = 0; i < table.names.size(); ++i) {
      if (std::isfinite(table.data[i][row])) continue;
      throw Error{table.names[i] + " is missing; fill the gap or cut the record there", path,
                  table.lines[row]};
    }
  }
  return table;
}

// Throws at the first pause that is no sampling interval any more.
void CheckPauses(const SensorRecord& record, const std::vector<int>& lines) {
  std::vector<double> pauses;
  for (int i = 1; i < record.num_samples(); ++i) {
    pauses.push_back(record.time_s[i] - record.time_s[i - 1]);
  }
  const double usual = UpperMedian(pauses);
  for (size_t i = 0; i < pauses.size(); ++i) {
    if (pauses[i] <= kMaxSensorPause * usual) continue;
    throw Error{"no samples for " + Rounded(pauses[i]) + " s, from " + Rounded(record.time_s[i]) +
                    " s to " + Rounded(record.time_s[i + 1]) + " s, where " + Rounded(usual) +
                    " s is usual; fill the gap or cut the record there",
                record.file, lines[i + 1]};
  }
}

}  // namespace

bool IsPush(const std::vector<std::string>& names) {
  return AreCalled(names, kPushColumns, 0) || AreCalled(names, kPushColumns, 0, kWithoutTorques);
}

bool IsSensor(const std::vector<std::string>& names) {
  return FindTimeColumn(names, "") == 0 &&
         (AreCalled(names, kAxisColumns, 1) || AreCalled(names, kVectorColumns, 1));
}

Result<PushRows> ReadPushCsv(const std::string& path) {
  return Caught([&] {
    const NumericTable table = ReadTable(
        path, &IsPush,
        StrCat("not ", kHeader, " (or frame,fx,fy of a push at the manifest's push_height_m)"));
    PushRows push;
    push.has_torques = table.names.size() == kNumColumns;
    for (int row = 0; row < table.num_rows(); ++row) {
      if (table.data[0][row] != row) {
        throw Error{
            StrCat("frame is ", Rounded(table.data[0][row]), " where ", row,
                   " was expected; rows must count 0, 1, 2, ... without gaps (a late push is "
                   "given by start_frame in the manifest)"),
            path, table.lines[row]};
      }
      Eigen::Vector4d& force = push.force.emplace_back(Eigen::Vector4d::Zero());
      for (std::size_t i = 1; i < table.names.size(); ++i) force[i - 1] = table.data[i][row];
    }
    return push;
  });
}

MaybeError WritePushCsv(const std::string& path, const std::vector<Eigen::Vector4d>& force) {
  if (force.empty()) return Error{"a push without rows is not written", path, 0};
  std::string text = std::string(kHeader) + "\n";
  for (std::size_t frame = 0; frame < force.size(); ++frame) {
    if (!force[frame].allFinite()) {
      return Error{StrCat("row ", frame, " of the push to write is not finite"), path, 0};
    }
    text += std::to_string(frame);
    for (int i = 0; i < 4; ++i) {
      text += ',';
      AppendDouble(force[frame][i], &text);
    }
    text += '\n';
  }
  return WriteFileAtomically(path, text);
}

Result<SensorRecord> ReadSensorCsv(const std::string& path) {
  return Caught([&] {
    const NumericTable table = ReadTable(
        path, &IsSensor,
        "neither time,force nor time,fx,fy,fz (s or ms, N); select the push by --sensor_column (in "
        "a list of sensors by \"column\", with its \"gain\" if it is not in N)");
    SensorRecord record;
    record.file = path;
    record.is_vector = table.names.size() > 2;
    record.time_s = table.data[0];
    for (int row = 0; row < table.num_rows(); ++row) {
      Eigen::Vector3d& force = record.force.emplace_back(Eigen::Vector3d::Zero());
      for (std::size_t i = 1; i < table.names.size(); ++i) force[i - 1] = table.data[i][row];
      if (row == 0 || record.time_s[row] > record.time_s[row - 1]) continue;
      throw Error{"time " + Rounded(record.time_s[row], 9) + " s does not come after " +
                      Rounded(record.time_s[row - 1], 9) +
                      " s; samples must be in ascending order, each once",
                  path, table.lines[row]};
    }
    if (record.num_samples() < kMinSamples) {
      throw Error{StrCat("the record ends after ", record.num_samples(),
                         " samples; a push needs at least ", kMinSamples),
                  path, table.lines.back()};
    }
    CheckPauses(record, table.lines);
    return record;
  });
}

std::string ClippedText(const SensorRecord& record) {
  for (int axis = 0; axis < (record.is_vector ? 3 : 1); ++axis) {
    double limit = 0.0;
    for (const Eigen::Vector3d& force : record.force) {
      if (std::fabs(force[axis]) > std::fabs(limit)) limit = force[axis];
    }
    int run = 0, at_limit = 0, below = 0, outside = 0, changes = 0;  // runs of equal samples
    for (std::size_t i = 1; i < record.force.size(); ++i) {
      const double now = record.force[i][axis];
      const bool same = now == record.force[i - 1][axis];
      run = same ? run + 1 : 1;
      int& longest = now == limit ? at_limit : below;
      longest = std::max(longest, run);
      outside += now != limit;
      changes += now != limit && !same;
    }
    // A force that was computed, or held by a machine, stays the same elsewhere too.
    const bool noisy = 2 * changes > outside;
    if (!noisy || at_limit < std::max(kFewestAtLimit, 3 * below)) continue;
    return StrCat(
        record.file, ": ", at_limit, " samples on end read exactly the largest force, ",
        Rounded(limit, 3),
        " N: the sensor's range was exceeded, and the push was larger; leave the recording out "
        "(--leave_out)");
  }
  return "";
}

}  // namespace pushid
