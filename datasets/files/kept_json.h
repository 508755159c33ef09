// datasets: JSON that is kept and passed on unread (json_file.cc).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace pushid {

// A JSON object that its holder keeps and passes on without reading it: a value like
// nlohmann::ordered_json itself, {} at first, whose holder need not include all of
// nlohmann/json.hpp. One that was moved from can only be assigned to.
class KeptJson {
 public:
  KeptJson();
  KeptJson(nlohmann::ordered_json json);  // NOLINT: a JSON value is kept as it is
  KeptJson(const KeptJson& other);
  KeptJson(KeptJson&& other) noexcept;
  KeptJson& operator=(const KeptJson& other);
  KeptJson& operator=(KeptJson&& other) noexcept;
  ~KeptJson();

  const nlohmann::ordered_json& operator*() const { return *json_; }
  nlohmann::ordered_json& operator*() { return *json_; }
  const nlohmann::ordered_json* operator->() const { return json_.get(); }
  nlohmann::ordered_json* operator->() { return json_.get(); }

 private:
  std::unique_ptr<nlohmann::ordered_json> json_;
};

}  // namespace pushid
