// models: the foot-skate error of the lower body's frames.
#include <algorithm>

#include "models/restoration/body.h"
#include "models/restoration/cvae_stages_torch.h"

namespace pushid {
namespace {

constexpr double kTouch = 0.025;          // m: H
constexpr double kCentimetresOf = 100.0;  // per m
// Rows of a pendulum's frame (cvae_features.h).
constexpr int kEndHeight = 6, kEndWay = 12;

torch::Tensor RowsOf(const Eigen::MatrixXd& columns) {
  return torch::from_blob(const_cast<double*>(columns.data()), {columns.cols(), columns.rows()},
                          torch::kFloat64)
      .clone();
}

}  // namespace

torch::Tensor FootSkateOf(const CvaeLayout& layout, const SkateTensors& frames) {
  const bool tip = layout.Origin() == CvaeCoordinates::kTip;
  const std::vector<int>& joints = layout.LowerJoints();
  torch::Tensor sum = torch::zeros({1}, frames.output.options());
  torch::Tensor contacts = torch::zeros({1}, frames.output.options());
  for (const int joint : {kRightAnkle, kLeftAnkle}) {
    const int64_t row = 3 + 3 * (std::find(joints.begin(), joints.end(), joint) - joints.begin());
    torch::Tensor way = frames.output.slice(1, row, row + 2) - frames.before.slice(1, row, row + 2);
    torch::Tensor height = frames.output.select(1, row + 2) - frames.first.select(1, row + 2);
    if (tip) {
      way = way + frames.pendulum.slice(1, kEndWay, kEndWay + 2);
      height = height + frames.pendulum.select(1, kEndHeight) -
               frames.first_pendulum.select(1, kEndHeight);
    }
    const torch::Tensor low = (height < kTouch).to(height.dtype());
    const torch::Tensor weight = 2.0 - torch::exp2(height.clamp(0.0, kTouch) / kTouch);
    sum = sum + (low * way.norm(2, 1) * weight).sum();
    contacts = contacts + low.sum();
  }
  return kCentimetresOf * sum / contacts.clamp_min(1.0);
}

double CvaeFootSkate(const CvaeLayout& layout, const CvaeSkateFrames& frames,
                     Eigen::MatrixXd* by_output) {
  SkateTensors rows = {RowsOf(frames.output), RowsOf(frames.before), RowsOf(frames.first),
                       RowsOf(frames.pendulum), RowsOf(frames.first_pendulum)};
  rows.output.set_requires_grad(true);
  const torch::Tensor skate = FootSkateOf(layout, rows);
  skate.sum().backward();
  const torch::Tensor gradient = rows.output.grad().contiguous();
  *by_output = Eigen::Map<const Eigen::MatrixXd>(gradient.data_ptr<double>(), frames.output.rows(),
                                                 frames.output.cols());
  return skate.item<double>();
}

}  // namespace pushid
