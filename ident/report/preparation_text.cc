// ident: what was done to recordings.
#include "ident/report/preparation_text.h"

#include "datasets/files/number_text.h"

namespace pushid {

std::string PreparationText(const std::map<std::string, std::string>& configuration) {
  const auto flag = [&configuration](const char* name) {
    const auto found = configuration.find(name);
    double value = 0.0;
    return found != configuration.end() && ParseDouble(found->second, &value) ? value : 0.0;
  };
  std::string text;
  const double cutoff = flag("lowpass_hz"), rate = flag("resample_fps");
  if (cutoff > 0.0) text = "low-pass at " + Rounded(cutoff) + " Hz (zero-phase Butterworth)";
  if (rate > 0.0) {
    text += (text.empty() ? "" : ", ") + std::string("resampled to ") + Rounded(rate) +
            " frames per second";
  }
  if (!text.empty()) text = "motion: " + text + "\n";
  const double replica = flag("resample");
  if (replica > 0.0) {
    text += "recordings: drawn with replacement, as replica " + Rounded(replica) +
            " of a bootstrap (--resample; --resample_fps changes the frame rate)\n";
  }
  return text;
}

}  // namespace pushid
