// datasets: JSON that is kept and passed on unread.
#include "datasets/files/kept_json.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace pushid {

KeptJson::KeptJson() : KeptJson(nlohmann::ordered_json::object()) {}
KeptJson::KeptJson(nlohmann::ordered_json json)
    : json_(std::make_unique<nlohmann::ordered_json>(std::move(json))) {}
KeptJson::KeptJson(const KeptJson& other) : KeptJson(*other) {}
KeptJson::KeptJson(KeptJson&& other) noexcept = default;
KeptJson& KeptJson::operator=(const KeptJson& other) {
  json_ = std::make_unique<nlohmann::ordered_json>(*other);
  return *this;
}
KeptJson& KeptJson::operator=(KeptJson&& other) noexcept = default;
KeptJson::~KeptJson() = default;

}  // namespace pushid
