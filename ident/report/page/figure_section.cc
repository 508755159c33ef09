// ident: recordings as animations: measured, and as they are predicted.

#include "ident/bodies/animation.h"
#include "ident/figures/svg.h"
#include "ident/prediction/prediction.h"
#include "ident/report/page/sections.h"

namespace pushid {
namespace {

// Skeletons weigh: many of them are written more seldom.
constexpr double kSampleSeconds = 1.0 / 30.0, kSeldomSeconds = 1.0 / 6.0;
constexpr int kManySkeletons = 100;

// The skeleton of a file that has not all joints of a body.
void AddSkeleton(const RecordedPerson& recorded, AnimatedPerson* person) {
  person->parents = recorded.joint_parents;
  if (person->parents.empty()) return;
  for (const auto& places : recorded.joints) {
    person->joints.emplace_back(3, places.size());
    for (size_t j = 0; j < places.size(); ++j) {
      person->joints.back().col(static_cast<Eigen::Index>(j)) = places[j];
    }
  }
}

// A page as an attribute, which keeps its lines.
std::string ForAttribute(const std::string& page) {
  std::string quoted;
  for (const char c : page) quoted += c == '\n' ? "\n" : EscapeXml({&c, 1});
  return quoted;
}

}  // namespace

Animation AnimationOf(const RecordingView& view) {
  const PendulumRecording& recording = view.run.recording;
  Animation animation;
  animation.title = recording.id;
  animation.dt = recording.scene.dt;
  auto bodies = MakeBodyRecording(*view.recording);
  if (bodies.ok()) {
    ToLaboratory(recording.scene, &bodies.value().bodies);
    AddRecorded(recording, bodies.value().bodies, &animation);
  } else {
    AddRecorded(recording, {}, &animation);
    for (size_t n = 0; n < animation.people.size(); ++n) {
      AddSkeleton(view.recording->people[n], &animation.people[n]);
    }
  }
  if (view.run.prediction.status.ok) AddPrediction(recording, view.run.prediction, {}, &animation);
  AddPushes(recording, &animation);
  return animation;
}

ReportSection FigureSection(const ReportSource& source) {
  ReportSection section;
  if (source.views.empty()) return section;
  section.paragraphs = {
      "Every recording with the model's prediction from its first frame and the push. The slider "
      "and the list can be operated with the arrow keys."};
  std::vector<Animation> animations;
  int skeletons = 0;
  for (const RecordingView& view : source.views) {
    animations.push_back(AnimationOf(view));
    skeletons += view.run.num_people();
  }
  const double seconds = skeletons > kManySkeletons ? kSeldomSeconds : kSampleSeconds;
  section.widget = "<iframe class=\"moving\" title=\"moving figure\" srcdoc=\"" +
                   ForAttribute(AnimationHtml(animations, seconds)) +
                   "\"></iframe>\n<noscript><p>The moving figure needs JavaScript; everything else "
                   "on this page does not.</p></noscript>\n";
  return section;
}

}  // namespace pushid
