// models: the diffusion network as named matrices and back.
#include "models/generators/diffusion_network.h"

namespace pushid {
namespace {

constexpr int kConditions = kTimeWidth + kStaticWidth;

std::string BlockName(const std::string& name, int block) {
  return name + ".block" + std::to_string(block);
}

std::string PoolName(const std::string& name, int pool) {
  return name + ".pool" + std::to_string(pool);
}

}  // namespace

void AddTensors(const std::string& name, const DiffusionNetwork& network, TensorList* tensors) {
  tensors->push_back({name + ".scales", network.scales});
  AddTensors(name + ".static0", network.first_static, tensors);
  AddTensors(name + ".static1", network.second_static, tensors);
  for (int b = 0; b < kDiffusionBlocks; ++b) {
    const DiffusionBlock& block = network.blocks[b];
    AddTensors(BlockName(name, b) + ".first", block.first, tensors);
    AddTensors(BlockName(name, b) + ".second", block.second, tensors);
    AddTensors(BlockName(name, b) + ".skip", block.skip, tensors);
    AddTensors(BlockName(name, b) + ".film", block.film, tensors);
  }
  for (size_t p = 0; p < network.pools.size(); ++p) {
    const std::string of_pool = PoolName(name, static_cast<int>(p));
    AddTensors(of_pool + ".join", network.pools[p].join, tensors);
    if (network.structure.pooling != SocialPooling::kAttention) continue;
    AddTensors(of_pool + ".query", network.pools[p].query, tensors);
    AddTensors(of_pool + ".key", network.pools[p].key, tensors);
  }
  AddTensors(name + ".out", network.out, tensors);
  AddTensors(name + ".direct", network.direct, tensors);
}

DiffusionNetwork TakeDiffusion(const std::string& name, const DiffusionStructure& structure,
                               TensorReader* reader) {
  DiffusionNetwork network;
  network.structure = structure;
  network.scales = reader->Take(name + ".scales", kBodyJoints, 1);
  if (!(network.scales.array() > 0.0f).all()) {
    reader->Fail("the tensor " + name + ".scales must be positive");
  }
  network.first_static = TakeLayer(name + ".static0", kStaticRows, kStaticWidth, reader);
  network.second_static = TakeLayer(name + ".static1", kStaticWidth, kStaticWidth, reader);
  for (int b = 0; b < kDiffusionBlocks; ++b) {
    const BlockWidths widths = WidthsOf(b, structure);
    const std::string of_block = BlockName(name, b);
    network.blocks.push_back(
        {TakeLayer(of_block + ".first", kTaps * widths.in, widths.out, reader),
         TakeLayer(of_block + ".second", kTaps * widths.out, widths.out, reader),
         TakeLayer(of_block + ".skip", widths.in, widths.out, reader),
         TakeLayer(of_block + ".film", kConditions, 2 * widths.out, reader)});
  }
  for (int p = 0; p <= kDiffusionLevels && structure.Pools(); ++p) {
    const int width = WidthsOf(p, structure).out;
    const std::string of_pool = PoolName(name, p);
    DiffusionPool pool{
        TakeLayer(of_pool + ".join", structure.NumViews() * width, width, reader), {}, {}};
    if (structure.pooling == SocialPooling::kAttention) {
      pool.query = TakeLayer(of_pool + ".query", width, kAttentionWidth, reader);
      pool.key = TakeLayer(of_pool + ".key", width, kAttentionWidth, reader);
    }
    network.pools.push_back(std::move(pool));
  }
  network.out = TakeLayer(name + ".out", kTaps * kDownWidths[0], kMotionRows, reader);
  network.direct = TakeLayer(name + ".direct", structure.NumInputs(), kMotionRows, reader);
  return network;
}

}  // namespace pushid
