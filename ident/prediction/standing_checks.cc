// ident: each person's own parameters.
#include "ident/prediction/standing_checks.h"

#include "ident/model/model_rollout.h"

namespace pushid {
namespace {

std::vector<std::vector<ParameterSet<double>>> OfEverybody(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::vector<std::vector<ParameterSet<double>>> sets;
  for (const PendulumRecording& recording : recordings) {
    sets.push_back(PeoplesParameters(model, recording));
  }
  return sets;
}

}  // namespace

std::vector<FrequencyResponse> FrequencyResponses(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  return FrequencyResponses(recordings, model.options, OfEverybody(model, recordings));
}

std::vector<PersonSway> SwayOfPeople(const IdentifiedModel& model,
                                     const std::vector<PendulumRecording>& recordings, int repeats,
                                     uint64_t seed) {
  return SwayOfPeople(recordings, model.options, OfEverybody(model, recordings), repeats, seed);
}

}  // namespace pushid
