// datasets: the labels of a recording: texts by which recordings are chosen, grouped and pooled.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pushid {

// Keys that programs know; a manifest may give a recording any others.
inline constexpr char kSettingLabel[] = "setting";      // the arrangement: single, row_1, ...
inline constexpr char kMagnitudeLabel[] = "magnitude";  // strength of the push: weak, strong, ...
inline constexpr char kConditionLabel[] = "condition";  // of the protocol

class RecordingLabels {
 public:
  // Empty where the recording has no such label.
  const std::string& Of(const std::string& key) const {
    static const std::string kNone;
    const auto found = labels_.find(key);
    return found == labels_.end() ? kNone : found->second;
  }
  const std::string& setting() const { return Of(kSettingLabel); }
  const std::string& magnitude() const { return Of(kMagnitudeLabel); }
  const std::string& condition() const { return Of(kConditionLabel); }

  // An empty text takes the label away.
  void Set(const std::string& key, std::string text) {
    if (text.empty()) {
      labels_.erase(key);
    } else {
      labels_[key] = std::move(text);
    }
  }

  std::vector<std::string> Keys() const {
    std::vector<std::string> keys;
    for (const auto& [key, text] : labels_) keys.push_back(key);
    return keys;
  }

 private:
  std::map<std::string, std::string> labels_;
};

}  // namespace pushid
