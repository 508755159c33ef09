// Tables and TRC files as instruments write them.
#include "tests/simulators/table_files.h"

#include <cmath>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"

namespace pushid {

MaybeError WriteNumericTable(const std::string& path, TableFormat format,
                             const NumericTable& table) {
  const bool storage = format == TableFormat::kStorage;
  const char separator = storage ? '\t' : ',';
  if (table.chosen.size() != table.names.size() || table.num_rows() == 0) {
    return Error{"a table without rows, or with columns left out, is not written", path};
  }
  std::string text;
  if (storage) {
    text = StrCat("pushid\nversion=1\nnRows=", table.num_rows(), "\nnColumns=", table.names.size(),
                  "\ninDegrees=no\nendheader\n");
  }
  const std::size_t columns = table.names.size();
  for (std::size_t i = 0; i < columns; ++i) {
    text += table.names[i] + (i + 1 < columns ? separator : '\n');
  }
  for (int row = 0; row < table.num_rows(); ++row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const double value = table.data[i][row];
      if (std::isfinite(value)) {
        AppendDouble(value, &text);
      } else if (storage) {
        text += "nan";
      }
      text += i + 1 < columns ? separator : '\n';
    }
  }
  return WriteFileAtomically(path, text);
}

MaybeError WriteTrc(const std::string& path, const PointMotion& motion) {
  const std::size_t markers = motion.positions.size();
  if (markers == 0 || markers != motion.names.size() || motion.num_frames() == 0 ||
      !(motion.rate_hz > 0.0)) {
    return Error{"a motion without points, frames or rate is not written", path};
  }
  const std::string rate = DoubleText(motion.rate_hz), frames = std::to_string(motion.num_frames());
  std::string text = "PathFileType\t4\t(X/Y/Z)\tpushid.trc\n";
  text +=
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n";
  text += StrCat(rate, '\t', rate, '\t', frames, '\t', markers, '\t',
                 NameOf(motion.unit.value_or(LengthUnit::kMillimetre)), '\t', rate, "\t1\t", frames,
                 "\nFrame#\tTime");
  for (const std::string& name : motion.names) text += '\t' + name + "\t\t";
  text += "\n\t";
  for (std::size_t i = 1; i <= markers; ++i) {
    for (const char* axis : {"\tX", "\tY", "\tZ"}) text += StrCat(axis, i);
  }
  text += "\n\n";
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    text += StrCat(frame + 1, '\t', DoubleText(frame / motion.rate_hz));
    for (const auto& track : motion.positions) {
      for (int i = 0; i < 3; ++i) {
        text += '\t';
        if (track[frame].allFinite()) AppendDouble(track[frame][i], &text);
      }
    }
    text += '\n';
  }
  return WriteFileAtomically(path, text);
}

}  // namespace pushid
