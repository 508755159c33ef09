// models: forward through MRT, and on from its own output.
#include "models/peers/mrt_network.h"

#include <cmath>

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

void AddNorm(const std::string& name, const MrtNorm& norm, TensorList* tensors) {
  tensors->push_back({name + ".scale", norm.scale});
  tensors->push_back({name + ".shift", norm.shift});
}

MrtNorm TakeNorm(const std::string& name, int width, TensorReader* reader) {
  return {reader->Take(name + ".scale", width, 1), reader->Take(name + ".shift", width, 1)};
}

void AddLayers(const std::string& name, const std::vector<MrtLayer>& layers, TensorList* tensors) {
  for (size_t i = 0; i < layers.size(); ++i) {
    const std::string of_layer = name + "." + std::to_string(i);
    AddTensors(of_layer + ".query", layers[i].query, tensors);
    AddTensors(of_layer + ".key", layers[i].key, tensors);
    AddTensors(of_layer + ".value", layers[i].value, tensors);
    AddTensors(of_layer + ".join", layers[i].join, tensors);
    AddNorm(of_layer + ".after_attention", layers[i].after_attention, tensors);
    AddTensors(of_layer + ".widen", layers[i].widen, tensors);
    AddTensors(of_layer + ".narrow", layers[i].narrow, tensors);
    AddNorm(of_layer + ".after_dense", layers[i].after_dense, tensors);
  }
}

std::vector<MrtLayer> TakeLayers(const std::string& name, const MrtWidths& widths,
                                 TensorReader* reader) {
  const int width = widths.width, all_heads = widths.heads * widths.head;
  std::vector<MrtLayer> layers;
  for (int i = 0; i < widths.layers; ++i) {
    const std::string of_layer = name + "." + std::to_string(i);
    MrtLayer layer;
    layer.query = TakeLayer(of_layer + ".query", width, all_heads, reader);
    layer.key = TakeLayer(of_layer + ".key", width, all_heads, reader);
    layer.value = TakeLayer(of_layer + ".value", width, all_heads, reader);
    layer.join = TakeLayer(of_layer + ".join", all_heads, width, reader);
    layer.after_attention = TakeNorm(of_layer + ".after_attention", width, reader);
    layer.widen = TakeLayer(of_layer + ".widen", width, widths.inner, reader);
    layer.narrow = TakeLayer(of_layer + ".narrow", widths.inner, width, reader);
    layer.after_dense = TakeNorm(of_layer + ".after_dense", width, reader);
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace

void AddTensors(const MrtWeights& weights, TensorList* tensors) {
  AddTensors("scaling.tokens", weights.scalings.tokens, tensors);
  AddTensors("scaling.query", weights.scalings.query, tensors);
  AddTensors("scaling.outputs", weights.scalings.outputs, tensors);
  AddTensors("local_token", weights.local_token, tensors);
  AddTensors("global_token", weights.global_token, tensors);
  AddTensors("place", weights.place, tensors);
  AddTensors("query", weights.query, tensors);
  tensors->push_back({"coefficients", weights.coefficients});
  AddLayers("local", weights.local, tensors);
  AddLayers("global", weights.global, tensors);
  AddLayers("decoder", weights.decoder, tensors);
  AddTensors("output", weights.output, tensors);
}

MrtWeights TakeMrt(MrtSize size, TensorReader* reader) {
  const MrtWidths widths = WidthsOf(size);
  constexpr int kOutputs = kMrtPoseRows * kMrtFrames;
  MrtWeights weights;
  weights.size = size;
  weights.scalings = {TakeScaling("scaling.tokens", kMrtPoseRows * kMrtTokens, reader),
                      TakeScaling("scaling.query", kMrtQueryRows, reader),
                      TakeScaling("scaling.outputs", kOutputs, reader)};
  weights.local_token = TakeLayer("local_token", kMrtPoseRows, widths.width, reader);
  weights.global_token = TakeLayer("global_token", kMrtPoseRows, widths.width, reader);
  weights.place = TakeLayer("place", kMrtPlaceRows, widths.width, reader);
  weights.query = TakeLayer("query", kMrtQueryRows, widths.width, reader);
  weights.coefficients = reader->Take("coefficients", widths.width, kMrtTokens);
  weights.local = TakeLayers("local", widths, reader);
  weights.global = TakeLayers("global", widths, reader);
  weights.decoder = TakeLayers("decoder", widths, reader);
  weights.output = TakeLayer("output", widths.width, kOutputs, reader);
  return weights;
}

}  // namespace pushid
