// models: MRT as named matrices and back.
#include "models/restoration/mrt_network.h"

namespace pushid {
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
