// models: stepping a crowd.
#include "models/crowd.h"

#include <algorithm>
#include <thread>

namespace pushid {
namespace {

// Below this, starting a thread costs more than it saves.
constexpr int kPeoplePerThread = 500;

}  // namespace

Crowd::Crowd(Scene scene, const ModelOptions& options, std::vector<ParameterSet<double>> parameters,
             int num_threads)
    : scene_(std::move(scene)),
      options_(options),
      parameters_(std::move(parameters)),
      num_threads_(std::max(1, num_threads)),
      forces_(scene_, options_, parameters_) {
  for (const ScenePerson& person : scene_.people) now_.push_back(person.start);
  before_ = next_ = now_;
}

void Crowd::Advance(int person) {
  const NetForce<double> force = forces_.On(person, frame_, before_[person].qd);
  const Vector4<double> acceleration = forces_.AccelerationOf(person, force);
  next_[person] = forces_.Next(person, acceleration, force, before_[person].qd);
}

RolloutStatus Crowd::Advance() {
  // The forces have gone on to what was received at the failed frame: there is no way back.
  if (!status_.ok) return status_;
  forces_.Update(now_.data());
  const int people = scene_.num_people();
  const int threads = std::clamp(people / kPeoplePerThread, 1, num_threads_);
  const auto share = [&](int i) {
    return static_cast<int>(static_cast<long long>(people) * i / threads);
  };
  if (threads == 1) forces_.PrepareAll();
  const auto advance_share = [&](int i) {
    std::vector<int> scratch;
    for (int n = share(i); n < share(i + 1); ++n) {
      if (threads > 1) forces_.Prepare(n, &scratch);
      Advance(n);
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(advance_share, i);
  advance_share(0);
  for (std::thread& other : others) other.join();
  for (int n = 0; n < people; ++n) {
    const std::string_view outside = OutsideDomain(scene_.people[n].body, next_[n]);
    if (outside.empty()) continue;
    status_ = {false, frame_ + 1, n, outside};
    return status_;
  }
  std::swap(before_, now_);
  std::swap(now_, next_);
  ++frame_;
  return {};
}

}  // namespace pushid
