// ident: whether predicted groups do what groups do.
#include "ident/bodies/body_recording.h"
#include "ident/prediction/evaluation.h"
#include "ident/report/page/sections.h"
#include "ident/validation/scores_text.h"

namespace pushid {
namespace {

// Hips of the recordings of more than one person that the model predicts, by the model and by a
// baseline that sees the recording until the last push ends.
struct ShownGroups {
  std::vector<PendulumRecording> recordings;
  std::vector<Recording> with_bodies;
  std::vector<PredictedGroup> by_model, by_velocity;
};

ShownGroups GroupsOf(const std::vector<RecordingView>& views) {
  ShownGroups groups;
  for (const RecordingView& view : views) {
    const PendulumRecording& recording = view.run.recording;
    if (recording.num_people() < 2 || !view.run.prediction.status.ok) continue;
    const int index = static_cast<int>(groups.recordings.size());
    groups.recordings.push_back(recording);
    groups.with_bodies.push_back(*view.recording);
    groups.by_model.push_back({index, view.run.prediction.hip});
    groups.by_velocity.push_back({index, ConstantVelocityBaseline(recording)});
  }
  return groups;
}

}  // namespace

ReportSection GroupSection(const std::vector<RecordingView>& views,
                           const PropagationSummary& propagation) {
  ReportSection section{"groups", "Groups", {}, {}, {}, {}, {}, ""};
  const ShownGroups groups = GroupsOf(views);
  const RecordedBodies bodies = BodiesOfGroups(groups.with_bodies);
  const auto model = CompareHips(groups.recordings, bodies, groups.by_model);
  if (!model) return section;
  const auto velocity = CompareHips(groups.recordings, bodies, groups.by_velocity);
  section.paragraphs = {
      bodies.empty()
          ? "The recordings have no whole bodies, so only onsets are scored."
          : "Bodies are rigid here: the first poses move with the predicted hips and never step.",
      GroupMetricsLegend()};
  section.tables.push_back(
      {"the recordings shown here; pushid-crossvalidate scores recordings that were not fitted",
       GroupMetricsTable({{"predicted", &*model}, {"constant velocity", &*velocity}})});
  section.tables.push_back(
      {"how the push travels through them, +- a standard error over recordings",
       PropagationTable({{"predicted and measured", &propagation}})});
  return section;
}

}  // namespace pushid
