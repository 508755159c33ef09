// models: forward through MRT, and on from its own output.
#include "models/peers/mrt_network.h"

#include <cmath>

#include "models/particles.h"
#include "models/peers/peer.h"

namespace pushid {
namespace {

constexpr float kNormEpsilon = 1e-5f;  // LibTorch's

Eigen::MatrixXf Normalized(const MrtNorm& norm, const Eigen::MatrixXf& values) {
  const Eigen::RowVectorXf mean = values.colwise().mean();
  Eigen::MatrixXf centred = values.rowwise() - mean;
  const Eigen::RowVectorXf spread =
      (centred.array().square().colwise().mean() + kNormEpsilon).sqrt();
  centred.array().rowwise() /= spread.array();
  return (norm.scale.asDiagonal() * centred).colwise() + norm.shift;
}

// Each column becomes its softmax.
void ApplySoftmax(Eigen::MatrixXf* values) {
  const Eigen::RowVectorXf largest = values->colwise().maxCoeff();
  *values = (values->rowwise() - largest).array().exp();
  const Eigen::RowVectorXf sums = values->colwise().sum();
  values->array().rowwise() /= sums.array();
}

Eigen::MatrixXf Attention(const MrtLayer& layer, const MrtWidths& widths, const Eigen::MatrixXf& of,
                          const Eigen::MatrixXf& to) {
  const Eigen::MatrixXf queries = Applied(layer.query, of), keys = Applied(layer.key, to);
  const Eigen::MatrixXf values = Applied(layer.value, to);
  const float scale = 1.0f / std::sqrt(static_cast<float>(widths.head));
  Eigen::MatrixXf heads(widths.heads * widths.head, of.cols());
  for (int h = 0; h < widths.heads; ++h) {
    const auto rows = Eigen::seqN(h * widths.head, widths.head);
    Eigen::MatrixXf shares = scale * keys(rows, Eigen::all).transpose() * queries(rows, Eigen::all);
    ApplySoftmax(&shares);
    heads(rows, Eigen::all) = values(rows, Eigen::all) * shares;
  }
  return Applied(layer.join, heads);
}

Eigen::MatrixXf Layer(const MrtLayer& layer, const MrtWidths& widths, const Eigen::MatrixXf& of,
                      const Eigen::MatrixXf& to) {
  const Eigen::MatrixXf seen =
      Normalized(layer.after_attention, of + Attention(layer, widths, of, to));
  const Eigen::MatrixXf wide = Applied(layer.widen, seen).cwiseMax(0.0f);
  return Normalized(layer.after_dense, seen + Applied(layer.narrow, wide));
}

Eigen::MatrixXf Encoded(const std::vector<MrtLayer>& layers, const MrtWidths& widths,
                        Eigen::MatrixXf tokens) {
  for (const MrtLayer& layer : layers) tokens = Layer(layer, widths, tokens, tokens);
  return tokens;
}

// Tokens of everybody for the global encoder.
Eigen::MatrixXf GlobalTokens(const MrtWeights& weights, const MrtView& view) {
  Eigen::MatrixXf tokens = Applied(weights.global_token, view.tokens);
  const Eigen::MatrixXf places = Applied(weights.place, view.places);
  for (int n = 0; n < view.num_people(); ++n) {
    auto person = tokens.middleCols(kMrtTokens * n, kMrtTokens);
    person += weights.coefficients;
    person.colwise() += places.col(n);
  }
  return tokens;
}

}  // namespace

MrtWidths WidthsOf(MrtSize size) {
  if (size == MrtSize::kPublished) return {128, 1024, 3, 8, 64};
  return {64, 128, 2, 4, 16};
}

Eigen::VectorXf Evaluate(const MrtWeights& weights, const MrtView& view) {
  const MrtWidths widths = WidthsOf(weights.size);
  const Eigen::MatrixXf own = view.tokens.middleCols(kMrtTokens * view.person, kMrtTokens);
  const Eigen::MatrixXf local =
      Encoded(weights.local, widths, Applied(weights.local_token, own) + weights.coefficients);
  const Eigen::MatrixXf global = Encoded(weights.global, widths, GlobalTokens(weights, view));
  Eigen::MatrixXf both(widths.width, local.cols() + global.cols());
  both << local, global;
  Eigen::MatrixXf query = Applied(weights.query, view.query);
  for (const MrtLayer& layer : weights.decoder) query = Layer(layer, widths, query, both);
  return Applied(weights.output, query);
}

Eigen::MatrixXf PredictedWays(const MrtWeights& weights, const MrtView& view) {
  const MrtScalings& scalings = weights.scalings;
  const Eigen::MatrixXf outputs =
      scalings.outputs.Unscaled(Evaluate(weights, Scaled(scalings, view)));
  return MrtWaysOf(Eigen::Map<const Eigen::MatrixXf>(outputs.data(), kMrtPoseRows, kMrtFrames));
}

std::vector<BodyMotion> MrtPeer::Continue(const std::vector<BodyMotion>& people, int frames) const {
  std::vector<BodyMotion> motions;
  for (const BodyMotion& given : people) {
    motions.emplace_back(given.begin(), given.begin() + kMrtGiven);
  }
  for (int last = kMrtGiven - 1; last + 1 < frames; last += kMrtFrames) {
    const std::vector<BodyMotion> seen = motions;  // all go on from the same frames
    for (size_t n = 0; n < motions.size(); ++n) {
      const Eigen::MatrixXd ways =
          PredictedWays(weights_, MrtViewOf(seen, last, static_cast<int>(n))).cast<double>();
      const Pose from = seen[n][last];
      const Eigen::Matrix3d turn = TurnAboutZ(Heading(from));
      for (int t = 0; t < kMrtFrames && last + 1 + t < frames; ++t) {
        motions[n].push_back(from + turn * Eigen::Map<const Pose>(ways.col(t).data()));
      }
    }
  }
  return motions;
}

namespace {

void ListNorm(const std::string& name, int width, MrtNorm* norm, TensorFields* fields) {
  fields->Matrix(name + ".scale", width, 1, &norm->scale);
  fields->Matrix(name + ".shift", width, 1, &norm->shift);
}

void ListLayers(const std::string& name, const MrtWidths& widths, std::vector<MrtLayer>* layers,
                TensorFields* fields) {
  const int width = widths.width, all_heads = widths.heads * widths.head;
  layers->resize(widths.layers);
  for (int i = 0; i < widths.layers; ++i) {
    const std::string of_layer = name + "." + std::to_string(i);
    MrtLayer& layer = (*layers)[i];
    fields->Layer(of_layer + ".query", width, all_heads, &layer.query);
    fields->Layer(of_layer + ".key", width, all_heads, &layer.key);
    fields->Layer(of_layer + ".value", width, all_heads, &layer.value);
    fields->Layer(of_layer + ".join", all_heads, width, &layer.join);
    ListNorm(of_layer + ".after_attention", width, &layer.after_attention, fields);
    fields->Layer(of_layer + ".widen", width, widths.inner, &layer.widen);
    fields->Layer(of_layer + ".narrow", widths.inner, width, &layer.narrow);
    ListNorm(of_layer + ".after_dense", width, &layer.after_dense, fields);
  }
}

void ListTensors(MrtWeights* weights, TensorFields* fields) {
  const MrtWidths widths = WidthsOf(weights->size);
  constexpr int kOutputs = kMrtPoseRows * kMrtFrames;
  fields->Scales("scaling.tokens", kMrtPoseRows * kMrtTokens, &weights->scalings.tokens);
  fields->Scales("scaling.query", kMrtQueryRows, &weights->scalings.query);
  fields->Scales("scaling.outputs", kOutputs, &weights->scalings.outputs);
  fields->Layer("local_token", kMrtPoseRows, widths.width, &weights->local_token);
  fields->Layer("global_token", kMrtPoseRows, widths.width, &weights->global_token);
  fields->Layer("place", kMrtPlaceRows, widths.width, &weights->place);
  fields->Layer("query", kMrtQueryRows, widths.width, &weights->query);
  fields->Matrix("coefficients", widths.width, kMrtTokens, &weights->coefficients);
  ListLayers("local", widths, &weights->local, fields);
  ListLayers("global", widths, &weights->global, fields);
  ListLayers("decoder", widths, &weights->decoder, fields);
  fields->Layer("output", widths.width, kOutputs, &weights->output);
}

}  // namespace

void AddTensors(const MrtWeights& weights, TensorList* tensors) {
  MrtWeights written = weights;
  TensorFields fields(tensors);
  ListTensors(&written, &fields);
}

MrtWeights TakeMrt(MrtSize size, TensorReader* reader) {
  MrtWeights weights;
  weights.size = size;
  TensorFields fields(reader);
  ListTensors(&weights, &fields);
  return weights;
}

namespace {

Eigen::Map<const Eigen::VectorXd> Column(const Pose& pose) { return {pose.data(), pose.size()}; }

// kMrtPoseRows x kMrtTokens, in world.
Eigen::MatrixXd CoefficientsOfGiven(const BodyMotion& motion, int last) {
  static const Eigen::MatrixXd transform = CosineTransform(kMrtTokens).transpose();
  Eigen::MatrixXd steps(kMrtPoseRows, kMrtTokens);
  for (int k = 0; k < kMrtTokens; ++k) {
    const int t = last - kMrtTokens + k;
    steps.col(k) = Column(motion[t + 1] - motion[t]);
  }
  return steps * transform;
}

// The numbers of a matrix as one column.
Eigen::Map<const Eigen::VectorXf> Flat(const Eigen::MatrixXf& values) {
  return {values.data(), values.size()};
}

}  // namespace

MrtView MrtViewOf(const std::vector<BodyMotion>& people, int last, int person) {
  const Pose& asked = people[person][last];
  const double heading = Heading(asked);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const int count = static_cast<int>(people.size());
  MrtView view;
  view.person = person;
  view.tokens.resize(kMrtPoseRows, kMrtTokens * count);
  view.places.resize(kMrtPlaceRows, count);
  for (int n = 0; n < count; ++n) {
    const Eigen::MatrixXd world = CoefficientsOfGiven(people[n], last);
    const Eigen::Map<const Eigen::Matrix3Xd> joints(world.data(), 3, kBodyJoints * kMrtTokens);
    const Eigen::Matrix3Xf turned = (turn * joints).cast<float>();
    view.tokens.middleCols(kMrtTokens * n, kMrtTokens) =
        Eigen::Map<const Eigen::MatrixXf>(turned.data(), kMrtPoseRows, kMrtTokens);
    const Eigen::Vector3d place = turn * (people[n][last].col(0) - asked.col(0));
    const double near = std::exp(-place.head<2>().squaredNorm());
    const double facing = Heading(people[n][last]) - heading;
    view.places.col(n) << static_cast<float>(place.x()), static_cast<float>(place.y()),
        static_cast<float>(near), static_cast<float>(std::sin(facing)),
        static_cast<float>(std::cos(facing));
  }
  Pose pose = turn * (asked.colwise() - asked.col(0));
  pose.col(0) << 0.0, 0.0, asked(2, 0);
  const Pose step = turn * (asked - people[person][last - 1]);
  view.query.resize(kMrtQueryRows);
  view.query << Column(pose).cast<float>(), Column(step).cast<float>();
  return view;
}

Eigen::MatrixXf MrtWays(const BodyMotion& motion, int last) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(motion[last]));
  Eigen::MatrixXf ways(kMrtPoseRows, kMrtFrames);
  for (int t = 0; t < kMrtFrames; ++t) {
    const Pose way = turn * (motion[last + 1 + t] - motion[last]);
    ways.col(t) = Column(way).cast<float>();
  }
  return ways;
}

const Eigen::MatrixXf& MrtWaysMatrix() {
  // The inverse transform, then the sum of all displacements so far.
  static const Eigen::MatrixXf matrix = [] {
    const Eigen::MatrixXd sums =
        Eigen::MatrixXd::Ones(kMrtFrames, kMrtFrames).triangularView<Eigen::Upper>();
    return Eigen::MatrixXf((CosineTransform(kMrtFrames) * sums).cast<float>());
  }();
  return matrix;
}

Eigen::MatrixXf MrtWaysOf(const Eigen::MatrixXf& coefficients) {
  return coefficients * MrtWaysMatrix();
}

Eigen::MatrixXf MrtCoefficientsOf(const Eigen::MatrixXf& ways) {
  static const Eigen::MatrixXf transform = CosineTransform(kMrtFrames).transpose().cast<float>();
  Eigen::MatrixXf steps = ways;
  steps.rightCols(kMrtFrames - 1) -= ways.leftCols(kMrtFrames - 1);
  return steps * transform;
}

MrtView Scaled(const MrtScalings& scalings, MrtView view) {
  Eigen::Map<Eigen::MatrixXf> by_person(view.tokens.data(), kMrtPoseRows * kMrtTokens,
                                        view.num_people());
  by_person = scalings.tokens.Scaled(by_person);
  view.query = scalings.query.Scaled(view.query);
  return view;
}

MrtScalings MrtScalingsOf(const std::vector<std::vector<BodyMotion>>& groups, int stride) {
  std::vector<Eigen::VectorXf> tokens, queries, outputs;
  for (const std::vector<BodyMotion>& people : groups) {
    const int frames = static_cast<int>(people.front().size());
    for (int last = kMrtGiven - 1; last + kMrtFrames < frames; last += stride) {
      for (int n = 0; n < static_cast<int>(people.size()); ++n) {
        const MrtView view = MrtViewOf({people[n]}, last, 0);
        tokens.push_back(Flat(view.tokens));
        queries.push_back(view.query);
        outputs.push_back(Flat(MrtCoefficientsOf(MrtWays(people[n], last))));
      }
    }
  }
  const auto scaling = [](const std::vector<Eigen::VectorXf>& columns) {
    if (columns.empty()) return Scaling();
    Eigen::MatrixXf all(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
    for (size_t i = 0; i < columns.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = columns[i];
    constexpr float kSmallestStep = 1e-4f;  // m
    return ScalingOf(all, kSmallestStep);
  };
  return {scaling(tokens), scaling(queries), scaling(outputs)};
}

}  // namespace pushid
