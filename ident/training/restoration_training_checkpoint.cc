// ident: checkpoints of trainings: key, curve and state, each with its length in front.
#include "ident/training/restoration_training_checkpoint.h"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

void Append(const std::string& part, std::string* bytes) {
  const uint64_t size = part.size();
  bytes->append(reinterpret_cast<const char*>(&size), sizeof size);
  *bytes += part;
}

bool Take(const std::string& bytes, size_t* at, std::string* part) {
  uint64_t size = 0;
  if (bytes.size() < *at + sizeof size) return false;
  std::memcpy(&size, bytes.data() + *at, sizeof size);
  *at += sizeof size;
  if (bytes.size() - *at < size) return false;
  *part = bytes.substr(*at, size);
  *at += size;
  return true;
}

}  // namespace

Checkpoint::Checkpoint(std::string path, const std::string& key, double seconds)
    : path_(std::move(path)), key_(key), seconds_(seconds), last_(Now()) {}

bool Checkpoint::Load(std::string* state, std::vector<TrainingPoint>* curve) const {
  std::error_code ignored;
  if (path_.empty() || !std::filesystem::exists(path_, ignored)) return false;
  const Result<std::string> bytes = ReadWholeFile(path_);
  if (!bytes.ok()) return false;
  size_t at = 0;
  std::string key, points;
  if (!Take(bytes.value(), &at, &key) || key != key_) return false;
  if (!Take(bytes.value(), &at, &points) || !Take(bytes.value(), &at, state)) return false;
  const auto json = nlohmann::json::parse(points, nullptr, false);
  if (!json.is_array()) return false;
  curve->clear();
  for (const auto& p : json) {
    if (!p.is_array() || p.size() != 4) return false;
    curve->push_back(
        {p[0].get<int>(), p[1].get<double>(), p[2].get<double>(), p[3].get<std::string>()});
  }
  return true;
}

bool Checkpoint::Due() const { return !path_.empty() && Now() - last_ >= seconds_; }

MaybeError Checkpoint::Save(const std::string& state, const std::vector<TrainingPoint>& curve) {
  nlohmann::json points = nlohmann::json::array();
  for (const TrainingPoint& p : curve) {
    points.push_back({p.epoch, p.training_loss, p.validation_loss, p.stage});
  }
  std::string bytes;
  Append(key_, &bytes);
  Append(points.dump(), &bytes);
  Append(state, &bytes);
  last_ = Now();
  return WriteFileAtomically(path_, bytes);
}

void Checkpoint::Remove() const {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

std::string KeyOfTraining(const std::vector<RestorationSample>& training,
                          const std::vector<RestorationSample>& held,
                          const RestorationTrainingOptions& options) {
  return std::string("1 ") + Name(options.kind) + " " + Name(options.coordinates) + " " +
         NameOf(options.view) + (options.halves ? " halves " : " whole ") +
         NameOf(options.mrt_size) + " " + std::to_string(options.effort) + " " +
         std::to_string(options.seed) + " " + KeyOfSamples(training) + KeyOfSamples(held);
}

std::string KeyOfSamples(const std::vector<RestorationSample>& samples) {
  ContentHash hash;
  const auto add = [&hash](const auto& values) {
    hash.Add({reinterpret_cast<const char*>(values.data()),
              static_cast<size_t>(values.size()) * sizeof(double)});
  };
  for (const RestorationSample& sample : samples) {
    add(sample.person().first_pose);
    for (const auto& q : sample.person().q) add(q);
    add(sample.person().push.velocity);
    add(sample.person().push.place);
    for (const Pose& pose : sample.motion) add(pose);
  }
  return hash.Hex();
}

}  // namespace pushid
