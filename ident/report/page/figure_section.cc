// ident: the moving figure: pendulums measured and predicted, skeletons where they were recorded,
// as numbers that the page's script draws (page_parts.h).
//
// Positions are millimetres as whole numbers, each the difference from the sample before: small,
// and exact enough for a picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "ident/report/page/sections.h"

namespace pushid {
namespace {

// Skeletons weigh: many of them are drawn more seldom.
constexpr double kSampleSeconds = 1.0 / 30.0, kSeldomSeconds = 1.0 / 6.0;
constexpr int kManySkeletons = 100;

class Track {
 public:
  void Add(const Vector3<double>& position, size_t channel) {
    if (last_.size() <= channel) last_.resize(channel + 1, {0, 0, 0});
    for (int axis = 0; axis < 3; ++axis) {
      const long now = std::lround(1000.0 * position[axis]);
      json.push_back(now - last_[channel][axis]);
      last_[channel][axis] = now;
    }
  }
  nlohmann::json json = nlohmann::json::array();

 private:
  std::vector<std::array<long, 3>> last_;
};

Vector3<double> Cart(const PendulumState<double>& state, const Body& body) {
  return {state.q[0], state.q[1], body.cart_height};
}

nlohmann::json PersonJson(const RecordingView& view, int person, int every) {
  const FormationRun& run = view.run;
  const PendulumRecording& recording = run.recording;
  const Body& body = recording.scene.people[person].body;
  const RecordedPerson& recorded = view.recording->people[person];
  const int predicted_frames = run.prediction.status.ok ? recording.num_frames() : 0;
  Track measured, predicted, joints;
  for (int t = 0; t < recording.num_frames(); t += every) {
    measured.Add(Cart(recording.states[person][t], body), 0);
    measured.Add(recording.hip[person][t], 1);
    if (t < predicted_frames) {
      predicted.Add(Cart(run.prediction.path.At(t, person), body), 0);
      predicted.Add(run.prediction.hip[person][t], 1);
    }
    if (recorded.joints.empty()) continue;
    for (size_t j = 0; j < recorded.joints[t].size(); ++j) joints.Add(recorded.joints[t][j], j);
  }
  nlohmann::json bones = nlohmann::json::array();
  for (size_t j = 0; j < recorded.joint_parents.size(); ++j) {
    if (recorded.joint_parents[j] >= 0) bones.push_back({recorded.joint_parents[j], j});
  }
  return {{"name", recording.subject_ids[person]},
          {"m", std::move(measured.json)},
          {"p", std::move(predicted.json)},
          {"j", std::move(joints.json)},
          {"bones", std::move(bones)}};
}

// [person, sample of its start, force along x and y at each sample (N)]; a push that is shorter
// than a sample has one.
nlohmann::json PushJson(const ScenePush& push, int every) {
  nlohmann::json force = nlohmann::json::array();
  for (size_t row = 0; row < push.force.size(); row += static_cast<size_t>(every)) {
    force.push_back({std::lround(push.force[row][0]), std::lround(push.force[row][1])});
  }
  return {push.person, push.start_frame / every, std::move(force)};
}

nlohmann::json ViewJson(const RecordingView& view, double sample_seconds) {
  const PendulumRecording& recording = view.run.recording;
  const int every = std::max(1, static_cast<int>(std::lround(sample_seconds / recording.scene.dt)));
  nlohmann::json people = nlohmann::json::array(), pushes = nlohmann::json::array();
  for (int n = 0; n < recording.num_people(); ++n) people.push_back(PersonJson(view, n, every));
  for (const ScenePush& push : recording.scene.pushes) pushes.push_back(PushJson(push, every));
  return {{"id", recording.id},
          {"step", every * recording.scene.dt},
          {"people", std::move(people)},
          {"pushes", std::move(pushes)}};
}

// Ids come from files: nothing in them may end the script element.
std::string ForElement(const nlohmann::json& json) {
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

constexpr char kControls[] = R"html(
<div class="moving">
<div class="controls">
<label>recording <select id="fig-recording"></select></label>
<button id="fig-play" type="button" aria-pressed="false">play</button>
<label>time <input id="fig-time" type="range" min="0" max="1" step="1" value="0"></label>
<output id="fig-clock">0.00 s</output>
<label>turn <input id="fig-turn" type="range" min="-90" max="90" step="5" value="0"></label>
</div>
<svg id="fig-stage" viewBox="0 0 900 420" role="img"
 aria-label="pendulums and skeletons at the chosen time"></svg>
)html";

// What is drawn, and no more.
std::string KeyHtml(const std::vector<RecordingView>& views) {
  bool predicted = false, bodies = false, pushed = false;
  for (const RecordingView& view : views) {
    predicted = predicted || view.run.prediction.status.ok;
    pushed = pushed || !view.run.recording.scene.pushes.empty();
    for (const RecordedPerson& person : view.recording->people) {
      bodies = bodies || !person.joints.empty();
    }
  }
  std::string key = "<p class=\"key\"><span class=\"measured\">measured</span>";
  if (predicted) key += " <span class=\"predicted\">predicted</span>";
  if (bodies) key += " <span class=\"body\">recorded skeleton</span>";
  if (pushed) key += " <span class=\"pushed\">pushed person and push</span>";
  return key +
         "</p>\n</div>\n<noscript><p>The moving figure needs JavaScript; everything else on this "
         "page does not.</p></noscript>\n";
}

}  // namespace

ReportSection FigureSection(const ReportSource& source) {
  ReportSection section;
  if (source.views.empty()) return section;
  section.paragraphs = {
      "Every recording with the model's prediction from its first frame and the push. The slider "
      "and the list can be operated with the arrow keys."};
  int skeletons = 0;
  for (const RecordingView& view : source.views) skeletons += view.run.num_people();
  const double seconds = skeletons > kManySkeletons ? kSeldomSeconds : kSampleSeconds;
  nlohmann::json data = nlohmann::json::array();
  for (const RecordingView& view : source.views) data.push_back(ViewJson(view, seconds));
  section.widget = kControls + KeyHtml(source.views) +
                   "<script type=\"application/json\" id=\"fig-data\">" + ForElement(data) +
                   "</script>\n";
  return section;
}

}  // namespace pushid
