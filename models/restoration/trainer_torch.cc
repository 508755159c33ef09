// models: the trainers of dense networks and of LDP's chain, in LibTorch.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "models/restoration/cvae_module_torch.h"

namespace pushid {
namespace {

class DenseModule : public torch::nn::Module {
 public:
  DenseModule(int inputs, int outputs, const RegressionOptions& options)
      : dropout_(options.dropout) {
    int width = inputs;
    for (int i = 0; i <= options.hidden_layers; ++i) {
      const int next = i == options.hidden_layers ? outputs : options.hidden;
      layers_.push_back(
          register_module("layer" + std::to_string(i), torch::nn::Linear(width, next)));
      width = next;
    }
  }
  Tensor forward(Tensor x) {
    for (size_t i = 0; i + 1 < layers_.size(); ++i) {
      x = torch::dropout(torch::elu(layers_[i](x)), dropout_, is_training());
    }
    return layers_.back()(x);
  }
  DenseNetwork Weights() const {
    DenseNetwork network;
    for (const auto& layer : layers_) network.layers.push_back(ToLayer(layer));
    return network;
  }

 private:
  double dropout_;
  std::vector<torch::nn::Linear> layers_;
};

Tensor AbsoluteLoss(const Tensor& output, const Tensor& target, const Tensor& weight) {
  return ((output - target).abs().mean(1) * weight).sum() / weight.sum();
}

// `best` has the weights of the epoch with the least held-out loss.
struct RegressionTraining : TrainerOf<DenseNetwork> {
  RegressionOptions options;
  std::shared_ptr<DenseModule> network, best;
  std::unique_ptr<AdamW> optimizer;
  Tensor inputs, targets, weights, held_inputs, held_targets, held_weights;
  int epoch = 0, best_epoch = 0;
  double best_loss = 1e30;

  RegressionTraining(const RegressionSamples& training, const RegressionSamples& held,
                     const RegressionOptions& given)
      : options(given) {
    StartTraining(options);
    inputs = ToTensor(training.inputs), targets = ToTensor(training.targets);
    weights = ToTensor(training.weights);
    held_inputs = ToTensor(held.inputs), held_targets = ToTensor(held.targets);
    held_weights = ToTensor(held.weights);
    const int in = static_cast<int>(inputs.size(1)), out = static_cast<int>(targets.size(1));
    network = std::make_shared<DenseModule>(in, out, options);
    // The draws of `best` are part of the seed's sequence.
    best = std::make_shared<DenseModule>(in, out, options);
    CopyWeights(*network, best.get());
    optimizer = MakeOptimizer(network->parameters(), options.learning_rate, options.weight_decay);
  }

  bool Done() const override {
    return epoch >= options.epochs || epoch - best_epoch >= options.patience;
  }
  double ShareDone() const override { return static_cast<double>(epoch) / options.epochs; }

  Tensor LossOf(const Tensor& rows) {
    Tensor x = inputs.index_select(0, rows);
    x = x + options.input_noise * torch::randn_like(x);
    return AbsoluteLoss(network->forward(x), targets.index_select(0, rows),
                        weights.index_select(0, rows));
  }

  double HeldLoss() {
    torch::NoGradGuard no_grad;
    network->eval();
    return AbsoluteLoss(network->forward(held_inputs), held_targets, held_weights).item<double>();
  }

  TrainingPoint RunRound() override {
    const Tensor order = torch::randperm(inputs.size(0));
    const int64_t batches = (inputs.size(0) + options.batch - 1) / options.batch;
    double sum = 0.0;
    network->train();
    for (int64_t b = 0; b < batches; ++b) {
      const double done = (epoch + static_cast<double>(b) / batches) / options.epochs;
      const Tensor loss = LossOf(order.slice(0, b * options.batch, (b + 1) * options.batch));
      Improve(optimizer.get(), options.learning_rate * OneCycle(done), loss);
      sum += loss.item<double>();
    }
    ++epoch;
    const double held_loss = HeldLoss();
    if (held_loss < best_loss) {
      best_loss = held_loss;
      best_epoch = epoch;
      CopyWeights(*network, best.get());
    }
    return {epoch, sum / static_cast<double>(batches), held_loss};
  }

  DenseNetwork Network() const override { return best->Weights(); }
};

constexpr double kWorstCvaeLoss = 1e30;
constexpr double kTeacher = 0.14, kRamp = 0.14;  // shares of a stage's steps
constexpr int kStages = 4;

// Sequences padded to the longest: [sequence, frame, number].
struct CvaeSequences {
  explicit CvaeSequences(const std::vector<CvaeSequence>& sequences) {
    for (const CvaeSequence& s : sequences) frames.push_back(s.pendulum.cols());
    longest = *std::max_element(frames.begin(), frames.end());
    const auto padded = [&](auto part) {
      Tensor all = torch::zeros({count(), longest, part(sequences[0]).rows()});
      for (size_t i = 0; i < sequences.size(); ++i) {
        all[static_cast<int64_t>(i)].slice(0, 0, frames[i]).copy_(ToTensor(part(sequences[i])));
      }
      return all;
    };
    for (size_t half = 0; half < sequences[0].body.size(); ++half) {
      body.push_back(padded([half](const CvaeSequence& s) { return s.body[half]; }));
    }
    pendulum = padded([](const CvaeSequence& s) { return s.pendulum; });
  }

  int64_t count() const { return static_cast<int64_t>(frames.size()); }

  std::vector<Tensor> body;  // of each half
  Tensor pendulum;
  Tensor lower_predicted;  // positions, set when the lower chain is finished
  std::vector<int64_t> frames;
  int64_t longest;
};

struct CvaeStages : CvaeTrainer {
  CvaeOptions options;
  CvaeWeights scalings;
  CvaeSequences training, held;
  std::vector<std::shared_ptr<HalfModule>> halves, best;
  std::unique_ptr<AdamW> optimizer;
  int stage = 0, step = 0, rounds = 0;
  double best_loss = kWorstCvaeLoss;
  // The current batch of rollouts.
  Tensor rows, first;
  int64_t at = 0, rollout_left = 0;
  Tensor state;  // x_t of the batch, true or predicted

  CvaeStages(const std::vector<CvaeSequence>& learnt, const std::vector<CvaeSequence>& judged,
             const CvaeWeights& given_scalings, const CvaeOptions& given)
      : options(given), scalings(given_scalings), training(learnt), held(judged) {
    StartTraining(options);
    for (int half = 0; half < layout().num_halves(); ++half) {
      for (auto* modules : {&halves, &best}) {
        modules->push_back(std::make_shared<HalfModule>(
            layout().Frame(half), layout().Condition(half), layout().PendulumFrame()));
      }
    }
    StartStage();
  }

  const CvaeLayout& layout() const { return scalings.layout; }
  CvaeHalf half() const { return stage >= 2 ? kUpperHalf : kLowerHalf; }
  bool Sampler() const { return stage % 2 == 1; }
  bool Published() const { return options.training == CvaeTraining::kPublished; }
  HalfModule& Module() { return *halves[half()]; }
  std::vector<Tensor> Trained() {
    return Sampler() ? Module().sampler->parameters() : Module().AutoencoderParameters();
  }
  static Tensor Positions(const Tensor& frames, int numbers) {
    return frames.slice(-1, 3, 3 + numbers);
  }
  Tensor Condition(const Tensor& x, const Tensor& lower_next) const {
    return half() == kUpperHalf ? Join(x, lower_next) : x;
  }

  bool Has(int which) const {
    return (layout().halves || which < 2) && (layout().pendulum || which % 2 == 0);
  }
  int Steps(int which) const { return Has(which) ? options.steps[which] : 0; }

  void StartStage() {
    if (stage == 2) PredictLower(&training), PredictLower(&held);
    // AdamW without weight decay is Adam.
    optimizer = MakeOptimizer(Trained(), CvaeLearningRate(options, Sampler(), 0.0),
                              Published() ? 0.0 : 1e-4);
    step = 0;
    rollout_left = 0;
    best_loss = kWorstCvaeLoss;
  }

  // Draws sequences, and first frames with room for the rollout.
  void NewBatch() {
    const int64_t length = Sampler() ? options.sampler_rollout : options.rollout;
    rows = torch::randint(training.count(), {options.batch}, torch::kInt64);
    const Tensor share = torch::rand({options.batch});
    first = torch::empty({options.batch}, torch::kInt64);
    for (int64_t b = 0; b < options.batch; ++b) {
      const int64_t room = training.frames[rows[b].item<int64_t>()] - length - 1;
      // A third of the rollouts begin at frame 0, from where every prediction begins.
      const double s = std::max(0.0, 1.5 * share[b].item<double>() - 0.5);
      first[b] = static_cast<int64_t>(s * static_cast<double>(std::max<int64_t>(0, room) + 1));
    }
    at = 0;
    rollout_left = length;
    state = training.body[half()].index({rows, first});
  }

  // FSE of the batch's outputs.
  Tensor Skate(const Tensor& output, const Tensor& pendulum) const {
    const auto unscaled = [](const Scaling& scaling, const Tensor& t) {
      return t * ToTensor(scaling.spread) + ToTensor(scaling.mean);
    };
    const Scaling& lower = scalings.halves[kLowerHalf].scaling;
    const Tensor zeros = torch::zeros_like(first);
    return FootSkateOf(layout(),
                       {unscaled(lower, output), unscaled(lower, state),
                        unscaled(lower, training.body[kLowerHalf].index({rows, zeros})),
                        unscaled(scalings.pendulum, pendulum),
                        unscaled(scalings.pendulum, training.pendulum.index({rows, zeros}))});
  }

  Tensor AutoencoderLoss(const Tensor& next, const Tensor& condition, Tensor* output) {
    const Gaussian g = Module().Encode(next, condition);
    *output = Module().decoder->Forward(g.Draw(), condition);
    return AutoencoderLossOf(options, g, *output, next);
  }

  Tensor SamplerLoss(const Tensor& next, const Tensor& condition, const Tensor& pendulum,
                     Tensor* output) {
    Gaussian wanted;
    {
      torch::NoGradGuard no_grad;
      wanted = Module().Encode(next, condition);
    }
    const Gaussian g = Module().Sample(condition, pendulum);
    const Tensor loss = SamplerLossOf(options.training, g, wanted);
    *output = Module().decoder->Forward(Published() ? g.Draw() : g.mean, condition);
    return half() == kUpperHalf ? loss : loss + options.skate_weight * Skate(*output, pendulum);
  }

  double Step() {
    if (rollout_left == 0) NewBatch();
    const double done = static_cast<double>(step) / options.steps[stage];
    const auto next_of = [this](const Tensor& all) { return all.index({rows, first + at + 1}); };
    const Tensor next = next_of(training.body[half()]), pendulum = next_of(training.pendulum);
    const Tensor condition =
        Condition(state, half() == kUpperHalf ? next_of(training.lower_predicted) : Tensor());
    Tensor output;
    const Tensor loss = Sampler() ? SamplerLoss(next, condition, pendulum, &output)
                                  : AutoencoderLoss(next, condition, &output);
    Improve(optimizer.get(), CvaeLearningRate(options, Sampler(), done), loss, Trained(), 1.0);
    const double own = std::clamp((done - kTeacher) / kRamp, 0.0, 1.0);
    const Tensor take = (torch::rand({options.batch, 1}) < own).to(torch::kFloat32);
    state = (take * output.detach() + (1.0 - take) * next).clamp(-kLargestScaled, kLargestScaled);
    ++at, ++step, --rollout_left;
    return loss.item<double>();
  }

  // Whole sequences predicted from their first frame: [sequence, frame, number]. sampled: z is the
  // mean of the sampler, or of the prior without a sampler; otherwise of the encoder.
  Tensor RollOut(const CvaeSequences& s, bool sampled) {
    torch::NoGradGuard no_grad;
    const Tensor& frames = s.body[half()];
    Tensor out = torch::zeros_like(frames);
    Tensor x = frames.select(1, 0);
    out.select(1, 0).copy_(x);
    for (int64_t t = 1; t < s.longest; ++t) {
      const Tensor condition =
          Condition(x, half() == kUpperHalf ? s.lower_predicted.select(1, t) : Tensor());
      const Tensor z = !sampled ? Module().Encode(frames.select(1, t), condition).mean
                       : layout().pendulum
                           ? Module().Sample(condition, s.pendulum.select(1, t)).mean
                           : torch::zeros({s.count(), kLatent});
      x = Module().decoder->Forward(z, condition).clamp(-kLargestScaled, kLargestScaled);
      out.select(1, t).copy_(x);
    }
    return out;
  }

  double HeldLoss() {
    const int numbers = layout().Positions(half());
    const Tensor error =
        Positions(RollOut(held, Sampler()), numbers) - Positions(held.body[half()], numbers);
    const Tensor in_metres =
        error * Positions(ToTensor(scalings.halves[half()].scaling.spread), numbers);
    double sum = 0.0;
    for (int64_t i = 0; i < held.count(); ++i) {
      const Tensor of_sequence = in_metres[i].slice(0, 1, held.frames[i]);
      sum += of_sequence.reshape({-1, 3}).norm(2, 1).mean().item<double>();
    }
    return sum / static_cast<double>(held.count());
  }

  void PredictLower(CvaeSequences* s) {
    const int kept = std::exchange(stage, 0);  // RollOut uses the stage's half of the body
    s->lower_predicted = Positions(RollOut(*s, true), layout().Positions(kLowerHalf)).contiguous();
    stage = kept;
  }

  bool Done() const override { return stage == kStages; }

  double ShareDone() const override {
    double all = 0.0, done = step;
    for (int i = 0; i < kStages; ++i) {
      all += Steps(i);
      if (i < stage) done += Steps(i);
    }
    return Done() ? 1.0 : done / all;
  }

  TrainingPoint RunRound() override {
    double sum = 0.0;
    int steps = 0;
    while (steps < options.round && step < Steps(stage)) sum += Step(), ++steps;
    TrainingPoint point = {++rounds, sum / std::max(1, steps), HeldLoss(), kCvaeStageNames[stage]};
    // In the second half the network starts from its own frames.
    if (point.validation_loss < best_loss && step >= Steps(stage) / 2) {
      best_loss = point.validation_loss;
      CopyWeights(Module(), best[half()].get());
    }
    if (step < Steps(stage)) return point;
    CopyWeights(*best[half()], &Module());
    do ++stage;
    while (!Done() && !Has(stage));
    if (!Done()) StartStage();
    return point;
  }

  CvaeWeights Network() const override {
    CvaeWeights weights = scalings;
    for (size_t half = 0; half < halves.size(); ++half) {
      CvaeNetworks& networks = weights.halves[half];
      if (layout().pendulum) networks.sampler = halves[half]->sampler->SamplerWeights();
      networks.decoder = halves[half]->decoder->Weights();
    }
    return weights;
  }

  std::array<int64_t, 4> NumParameters() const override {
    std::array<int64_t, 4> all = {};
    for (int i = 0; i < kStages; ++i) {
      if (!Has(i)) continue;
      const HalfModule& module = *halves[i / 2];
      for (const Tensor& parameter :
           i % 2 == 0 ? module.AutoencoderParameters() : module.sampler->parameters()) {
        all[i] += parameter.numel();
      }
    }
    return all;
  }
};

}  // namespace

std::unique_ptr<TrainerOf<DenseNetwork>> MakeRegressionTrainer(const RegressionSamples& training,
                                                               const RegressionSamples& validation,
                                                               const RegressionOptions& options) {
  return std::make_unique<RegressionTraining>(training, validation, options);
}

std::unique_ptr<CvaeTrainer> CvaeTrainer::Make(const std::vector<CvaeSequence>& training,
                                               const std::vector<CvaeSequence>& held,
                                               const CvaeWeights& scalings,
                                               const CvaeOptions& options) {
  return std::make_unique<CvaeStages>(training, held, scalings, options);
}

}  // namespace pushid
