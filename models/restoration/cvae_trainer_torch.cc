// models: training of LDP's chain in LibTorch: the foot skate, the stages, and the trainer.
#include <algorithm>
#include <memory>
#include <vector>

#include "models/restoration/body.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/cvae_trainer.h"
#include "models/restoration/support_torch.h"

namespace pushid {

namespace {

// As CvaeSkateFrames, but a row per sample.
struct SkateTensors {
  torch::Tensor output, before, first, pendulum, first_pendulum;
};

constexpr double kTouch = 0.025;          // m: H
constexpr double kCentimetresOf = 100.0;  // per m
// Rows of a pendulum's frame (cvae_restoration.h).
constexpr int kEndHeight = 6, kEndWay = 12;

torch::Tensor RowsOf(const Eigen::MatrixXd& columns) {
  return torch::from_blob(const_cast<double*>(columns.data()), {columns.cols(), columns.rows()},
                          torch::kFloat64)
      .clone();
}

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

}  // namespace

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

// The foot-skate error on LibTorch's tensors. For *_torch.cc files alone.

// The modules of LDP's chain in LibTorch, for cvae_trainer_torch.cc and its likes alone.

using torch::Tensor;

struct Gaussian {
  Tensor mean, log_variance;

  Tensor Sigma() const { return torch::exp(0.5 * log_variance); }
  Tensor Draw() const { return mean + Sigma() * torch::randn_like(mean); }
};

Gaussian RowsOf(const CvaeGaussian& columns) {
  return {RowsOf(columns.mean), RowsOf(columns.log_variance)};
}

Tensor AutoencoderLossOf(const CvaeOptions& options, const Gaussian& encoded, const Tensor& output,
                         const Tensor& frame) {
  const Tensor kl =
      -0.5 * (1.0 + encoded.log_variance - encoded.mean.pow(2) - encoded.log_variance.exp()).mean();
  return (output - frame).pow(2).mean() + options.kl_weight * kl;
}

Tensor SamplerLossOf(CvaeTraining training, const Gaussian& sampled, const Gaussian& encoded) {
  const Tensor of_mean = (sampled.mean - encoded.mean).pow(2);
  if (training == CvaeTraining::kPublished) {
    return (of_mean + (sampled.Sigma() - encoded.Sigma()).pow(2)).sum(1).mean();
  }
  return of_mean.mean() + (sampled.log_variance - encoded.log_variance).pow(2).mean();
}

inline Tensor Join(const Tensor& a, const Tensor& b) { return torch::cat({a, b}, 1); }

// [x, c] -> 256 -> 256 -> mean and log-variance; `again` is concatenated at the later layers.
class EncoderModule : public torch::nn::Module {
 public:
  EncoderModule(int inputs, int again)
      : first_(register_module("first", torch::nn::Linear(inputs, kCvaeHidden))),
        second_(register_module("second", torch::nn::Linear(kCvaeHidden + again, kCvaeHidden))),
        mean_(register_module("mean", torch::nn::Linear(kCvaeHidden + again, kLatent))),
        log_variance_(
            register_module("log_variance", torch::nn::Linear(kCvaeHidden + again, kLatent))) {}

  // again_first: [again, h] as in the autoencoders, else [h, again] as in the samplers.
  Gaussian Forward(const Tensor& inputs, const Tensor& again, bool again_first) {
    const auto join = [&](const Tensor& h) {
      return again_first ? Join(again, h) : Join(h, again);
    };
    Tensor h = torch::elu(first_(inputs));
    h = torch::elu(second_(join(h)));
    h = join(h);
    return {mean_(h), log_variance_(h)};
  }
  CvaeSampler SamplerWeights() const {
    return {ToLayer(first_), ToLayer(second_), ToLayer(mean_), ToLayer(log_variance_)};
  }

 private:
  torch::nn::Linear first_, second_, mean_, log_variance_;
};

class DecoderModule : public torch::nn::Module {
 public:
  DecoderModule(int condition, int frame) {
    const int inputs = kLatent + condition;
    gate_ = {register_module("gate0", torch::nn::Linear(inputs, kGateHidden)),
             register_module("gate1", torch::nn::Linear(kGateHidden, kGateHidden)),
             register_module("gate2", torch::nn::Linear(kGateHidden, kExperts))};
    layers_ = {
        register_module("first", torch::nn::Linear(inputs, kExperts * kCvaeHidden)),
        register_module("second", torch::nn::Linear(kLatent + kCvaeHidden, kExperts * kCvaeHidden)),
        register_module("last", torch::nn::Linear(kLatent + kCvaeHidden, kExperts * frame))};
  }
  Tensor Forward(const Tensor& z, const Tensor& condition) {
    const Tensor inputs = Join(z, condition);
    const Tensor shares =
        torch::softmax(gate_[2](torch::elu(gate_[1](torch::elu(gate_[0](inputs))))), 1);
    Tensor h = torch::elu(Mix(layers_[0], inputs, shares));
    h = torch::elu(Mix(layers_[1], Join(z, h), shares));
    return Mix(layers_[2], Join(z, h), shares);
  }
  CvaeDecoder Weights() const {
    CvaeDecoder decoder;
    for (const auto& layer : gate_) decoder.gate.layers.push_back(ToLayer(layer));
    decoder.first = ToLayer(layers_[0]);
    decoder.second = ToLayer(layers_[1]);
    decoder.last = ToLayer(layers_[2]);
    return decoder;
  }

 private:
  static Tensor Mix(torch::nn::Linear experts, const Tensor& inputs, const Tensor& shares) {
    const Tensor all = experts(inputs).view({inputs.size(0), kExperts, -1});
    return torch::bmm(shares.unsqueeze(1), all).squeeze(1);
  }
  std::vector<torch::nn::Linear> gate_, layers_;
};

// One half of the body: an autoencoder of frames and the sampler that stands in for its encoder.
class HalfModule : public torch::nn::Module {
 public:
  // pendulum: its numbers in a frame.
  HalfModule(int frame, int condition, int pendulum)
      : encoder(
            register_module("encoder", std::make_shared<EncoderModule>(frame + condition, frame))),
        decoder(register_module("decoder", std::make_shared<DecoderModule>(condition, frame))),
        sampler(register_module("sampler",
                                std::make_shared<EncoderModule>(condition + pendulum, pendulum))) {}

  Gaussian Encode(const Tensor& next, const Tensor& condition) {
    return encoder->Forward(Join(next, condition), next, true);
  }
  Gaussian Sample(const Tensor& condition, const Tensor& pendulum) {
    return sampler->Forward(Join(condition, pendulum), pendulum, false);
  }
  std::vector<Tensor> AutoencoderParameters() const {
    std::vector<Tensor> all = encoder->parameters();
    for (const Tensor& p : decoder->parameters()) all.push_back(p);
    return all;
  }

  std::shared_ptr<EncoderModule> encoder;
  std::shared_ptr<DecoderModule> decoder;
  std::shared_ptr<EncoderModule> sampler;
};

// Sequences padded to the longest: [sequence, frame, number].
struct CvaeSequences {
  Tensor lower, upper, pendulum, lower_predicted;  // the last: positions, once the chain is there
  std::vector<int64_t> frames;

  int64_t count() const { return static_cast<int64_t>(frames.size()); }
  int64_t longest() const { return lower.size(1); }
};

CvaeSequences Gather(const std::vector<CvaeSequence>& sequences);

inline constexpr double kWorstCvaeLoss = 1e30;

struct CvaeStages {
  CvaeOptions options;
  CvaeWeights scalings;
  CvaeSequences training, held;
  std::shared_ptr<HalfModule> lower, upper, best_lower, best_upper;  // upper: null without halves
  std::unique_ptr<torch::optim::AdamW> optimizer;
  Tensor lower_spread, upper_spread, lower_mean, pendulum_spread, pendulum_mean;  // for m
  int stage = 0, step = 0, rounds = 0;
  double best_loss = kWorstCvaeLoss;
  // The batch that is being rolled out.
  Tensor rows, first;
  int64_t at = 0, rollout_left = 0;
  Tensor state;  // x_t of the batch, true or its own

  bool Upper() const { return stage >= 2; }
  bool Sampler() const { return stage % 2 == 1; }
  bool Published() const { return options.training == CvaeTraining::kPublished; }
  std::vector<Tensor> Trained() {
    return Sampler() ? Half().sampler->parameters() : Half().AutoencoderParameters();
  }
  HalfModule& Half() { return Upper() ? *upper : *lower; }
  const Tensor& Frames(const CvaeSequences& s) const { return Upper() ? s.upper : s.lower; }
  const CvaeLayout& layout() const { return scalings.layout; }
  int NumPositions() const {
    return Upper() ? layout().UpperPositions() : layout().LowerPositions();
  }
  // x_t and, for the upper body, the lower positions of the next frame.
  Tensor Condition(const Tensor& x, const Tensor& lower_next) const {
    return Upper() ? Join(x, lower_next) : x;
  }

  // Whether the layout has it.
  bool Has(int which) const {
    return (layout().halves || which < 2) && (layout().pendulum || which % 2 == 0);
  }
  // Steps of a stage; 0 where the layout does not have it.
  int Steps(int which) const { return Has(which) ? options.steps[which] : 0; }
  void StartStage();
  void FinishStage();
  void NewBatch();
  double Step();
  Tensor AutoencoderLoss(const Tensor& next, const Tensor& condition, Tensor* output);
  Tensor SamplerLoss(const Tensor& next, const Tensor& condition, const Tensor& pendulum,
                     Tensor* output);
  Tensor Skate(const Tensor& output, const Tensor& pendulum) const;
  enum class Latent { kEncoder, kSampler, kPriorMean };
  Tensor RollOut(const CvaeSequences& s, Latent latent);
  double HeldLoss();
  void PredictLower(CvaeSequences* s);
};

namespace {

constexpr double kTeacher = 0.14, kRamp = 0.14;  // shares of a stage's steps

Tensor Padded(const std::vector<const Eigen::MatrixXf*>& parts, int64_t longest) {
  Tensor all = torch::zeros({static_cast<int64_t>(parts.size()), longest, parts[0]->rows()});
  for (size_t i = 0; i < parts.size(); ++i) {
    const Tensor part = ToTensor(*parts[i]);
    all[static_cast<int64_t>(i)].slice(0, 0, part.size(0)).copy_(part);
  }
  return all;
}

Tensor Positions(const Tensor& frames, int numbers) { return frames.slice(-1, 3, 3 + numbers); }

}  // namespace

double CvaeAutoencoderLoss(const CvaeOptions& options, const CvaeGaussian& encoded,
                           const Eigen::MatrixXd& output, const Eigen::MatrixXd& frame) {
  return AutoencoderLossOf(options, RowsOf(encoded), RowsOf(output), RowsOf(frame)).item<double>();
}

double CvaeSamplerLoss(CvaeTraining training, const CvaeGaussian& sampled,
                       const CvaeGaussian& encoded) {
  return SamplerLossOf(training, RowsOf(sampled), RowsOf(encoded)).item<double>();
}

double CvaeLearningRate(const CvaeOptions& options, bool sampler, double done) {
  constexpr double kFirst = 1e-4, kLast = 1e-7;
  if (options.training == CvaeTraining::kOwn) return options.learning_rate * OneCycle(done);
  return sampler ? kFirst : kFirst + (kLast - kFirst) * done;
}

CvaeSequences Gather(const std::vector<CvaeSequence>& sequences) {
  CvaeSequences all;
  std::vector<const Eigen::MatrixXf*> lower, upper, pendulum;
  for (const CvaeSequence& s : sequences) {
    all.frames.push_back(s.lower.cols());
    lower.push_back(&s.lower), upper.push_back(&s.upper), pendulum.push_back(&s.pendulum);
  }
  const int64_t longest = *std::max_element(all.frames.begin(), all.frames.end());
  all.lower = Padded(lower, longest);
  all.upper = Padded(upper, longest);
  all.pendulum = Padded(pendulum, longest);
  return all;
}

void CvaeStages::StartStage() {
  if (stage == 2) {  // from here on the lower chain is finished
    PredictLower(&training);
    PredictLower(&held);
  }
  // Without weight decay AdamW is Adam.
  optimizer =
      MakeOptimizer(Trained(), CvaeLearningRate(options, Sampler(), 0.0), Published() ? 0.0 : 1e-4);
  step = 0;
  rollout_left = 0;
  best_loss = kWorstCvaeLoss;
}

// Takes the best weights of the stage that ended and goes on to the next.
void CvaeStages::FinishStage() {
  CopyWeights(Upper() ? *best_upper : *best_lower, &Half());
  do ++stage;
  while (stage < 4 && !Has(stage));
}

// Sequences at random, recordings weighted by nothing else; a random first frame that leaves room.
void CvaeStages::NewBatch() {
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
  state = Frames(training).index({rows, first});
}

Tensor CvaeStages::AutoencoderLoss(const Tensor& next, const Tensor& condition, Tensor* output) {
  const Gaussian g = Half().Encode(next, condition);
  *output = Half().decoder->Forward(g.Draw(), condition);
  return AutoencoderLossOf(options, g, *output, next);
}

// FSE of the batch's outputs, with what they started from, in m.
Tensor CvaeStages::Skate(const Tensor& output, const Tensor& pendulum) const {
  const auto lower_of = [this](const Tensor& t) { return t * lower_spread + lower_mean; };
  const auto pendulum_of = [this](const Tensor& t) { return t * pendulum_spread + pendulum_mean; };
  const Tensor zeros = torch::zeros_like(first);
  return FootSkateOf(
      layout(), {lower_of(output), lower_of(state), lower_of(training.lower.index({rows, zeros})),
                 pendulum_of(pendulum), pendulum_of(training.pendulum.index({rows, zeros}))});
}

Tensor CvaeStages::SamplerLoss(const Tensor& next, const Tensor& condition, const Tensor& pendulum,
                               Tensor* output) {
  Gaussian wanted;
  {
    torch::NoGradGuard no_grad;
    wanted = Half().Encode(next, condition);
  }
  const Gaussian g = Half().Sample(condition, pendulum);
  Tensor loss = SamplerLossOf(options.training, g, wanted);
  *output = Half().decoder->Forward(Published() ? g.Draw() : g.mean, condition);
  if (!Upper()) loss = loss + options.skate_weight * Skate(*output, pendulum);
  return loss;
}

double CvaeStages::Step() {
  if (rollout_left == 0) NewBatch();
  const double done = static_cast<double>(step) / options.steps[stage];
  SetLearningRate(optimizer.get(), CvaeLearningRate(options, Sampler(), done));
  const Tensor next = Frames(training).index({rows, first + at + 1});
  const Tensor pendulum = training.pendulum.index({rows, first + at + 1});
  Tensor lower_next;
  if (Upper()) lower_next = training.lower_predicted.index({rows, first + at + 1});
  const Tensor condition = Condition(state, lower_next);
  Tensor output;
  const Tensor loss = Sampler() ? SamplerLoss(next, condition, pendulum, &output)
                                : AutoencoderLoss(next, condition, &output);
  Improve(optimizer.get(), loss, Trained(), 1.0);
  const double own = std::clamp((done - kTeacher) / kRamp, 0.0, 1.0);
  const Tensor take = (torch::rand({options.batch, 1}) < own).to(torch::kFloat32);
  state = (take * output.detach() + (1.0 - take) * next).clamp(-kLargestScaled, kLargestScaled);
  ++at, ++step, --rollout_left;
  return loss.item<double>();
}

// Whole sequences from their first frame: [sequence, frame, number].
Tensor CvaeStages::RollOut(const CvaeSequences& s, Latent latent) {
  torch::NoGradGuard no_grad;
  const Tensor& frames = Frames(s);
  Tensor out = torch::zeros_like(frames);
  Tensor x = frames.select(1, 0);
  out.select(1, 0).copy_(x);
  for (int64_t t = 1; t < s.longest(); ++t) {
    const Tensor condition = Condition(x, Upper() ? s.lower_predicted.select(1, t) : Tensor());
    const Tensor z =
        latent == Latent::kSampler   ? Half().Sample(condition, s.pendulum.select(1, t)).mean
        : latent == Latent::kEncoder ? Half().Encode(frames.select(1, t), condition).mean
                                     : torch::zeros({s.count(), kLatent});
    x = Half().decoder->Forward(z, condition).clamp(-kLargestScaled, kLargestScaled);
    out.select(1, t).copy_(x);
  }
  return out;
}

double CvaeStages::HeldLoss() {
  const Tensor out = RollOut(held, Sampler() ? Latent::kSampler : Latent::kEncoder);
  const Tensor spread = (Upper() ? upper_spread : lower_spread).slice(0, 3, 3 + NumPositions());
  const Tensor error =
      (Positions(out, NumPositions()) - Positions(Frames(held), NumPositions())) * spread;
  double sum = 0.0;
  for (int64_t i = 0; i < held.count(); ++i) {
    const Tensor of_sequence = error[i].slice(0, 1, held.frames[i]);
    sum += of_sequence.reshape({-1, 3}).norm(2, 1).mean().item<double>();
  }
  return sum / static_cast<double>(held.count());
}

void CvaeStages::PredictLower(CvaeSequences* s) {
  const int kept = stage;
  stage = 0;  // of the lower body
  const Latent latent = layout().pendulum ? Latent::kSampler : Latent::kPriorMean;
  s->lower_predicted = Positions(RollOut(*s, latent), layout().LowerPositions()).contiguous();
  stage = kept;
}

struct CvaeTrainer::Torch : KeptRun<Run, Torch>, CvaeStages {
  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("lower", lower.get());
    fields->Part("best_lower", best_lower.get());
    if (upper) {
      fields->Part("upper", upper.get());
      fields->Part("best_upper", best_upper.get());
    }
    int of_stage = stage, of_step = step;
    double loss = best_loss;
    int64_t column = at, left = rollout_left;
    fields->Numbers("counts", &of_stage, &of_step, &rounds, &loss, &column, &left);
    if (Fields::kReads) {  // the stage first, with its optimizer; then how far it is
      stage = of_stage;
      if (stage == 3) PredictLower(&training), PredictLower(&held);
      if (stage < 4) StartStage();
      step = of_step, best_loss = loss, at = column, rollout_left = left;
    }
    fields->Part("optimizer", optimizer.get());
    if (rollout_left == 0) return;
    fields->Tensor("rows", &rows);
    fields->Tensor("first", &first);
    fields->Tensor("state", &state);
  }

  bool Done() const override { return stage == 4; }

  double ShareDone() const override {
    double all = 0.0, done = 0.0;
    for (int i = 0; i < 4; ++i) {
      all += Steps(i);
      if (i < stage) done += Steps(i);
    }
    return Done() ? 1.0 : (done + step) / all;
  }

  TrainingPoint RunRound() override {
    double sum = 0.0;
    int steps = 0;
    while (steps < options.round && step < Steps(stage)) sum += Step(), ++steps;
    TrainingPoint point = {++rounds, sum / std::max(1, steps), HeldLoss(), kCvaeStageNames[stage]};
    // Best of the part in which the network goes on from its own frames.
    if (point.validation_loss < best_loss && step >= Steps(stage) / 2) {
      best_loss = point.validation_loss;
      CopyWeights(Half(), (Upper() ? best_upper : best_lower).get());
    }
    if (step >= Steps(stage)) {
      FinishStage();
      if (stage < 4) StartStage();
    }
    return point;
  }
};

CvaeTrainer::CvaeTrainer(std::vector<CvaeSequence> training, std::vector<CvaeSequence> held,
                         const CvaeWeights& scalings, const CvaeOptions& options)
    : Trainer(std::make_unique<Torch>()) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.options = options;
  t.scalings = scalings;
  t.training = Gather(training);
  t.held = Gather(held);
  t.lower_spread = ToTensor(scalings.lower.spread), t.lower_mean = ToTensor(scalings.lower.mean);
  t.upper_spread = ToTensor(scalings.upper.spread);
  t.pendulum_spread = ToTensor(scalings.pendulum.spread);
  t.pendulum_mean = ToTensor(scalings.pendulum.mean);
  const CvaeLayout& layout = scalings.layout;
  const auto lower = [&layout] {
    return std::make_shared<HalfModule>(layout.LowerFrame(), layout.LowerFrame(),
                                        layout.PendulumFrame());
  };
  const auto upper = [&layout] {
    return std::make_shared<HalfModule>(layout.UpperFrame(), layout.UpperCondition(),
                                        layout.PendulumFrame());
  };
  t.lower = lower(), t.best_lower = lower();
  if (layout.halves) t.upper = upper(), t.best_upper = upper();
  t.StartStage();
}

CvaeWeights CvaeTrainer::Best() const {
  const Torch& t = As<Torch>();
  CvaeWeights weights = t.scalings;
  const auto take = [&](const HalfModule& half, CvaeSampler* sampler, CvaeDecoder* decoder) {
    if (weights.layout.pendulum) *sampler = half.sampler->SamplerWeights();
    *decoder = half.decoder->Weights();
  };
  take(*t.lower, &weights.lower_sampler, &weights.lower_decoder);
  if (weights.layout.halves) take(*t.upper, &weights.upper_sampler, &weights.upper_decoder);
  return weights;
}

std::array<int64_t, 4> CvaeTrainer::NumParameters() const {
  const Torch& t = As<Torch>();
  std::array<int64_t, 4> all = {};
  for (int i = 0; i < 4; ++i) {
    if (!t.Has(i)) continue;
    const HalfModule& half = i < 2 ? *t.lower : *t.upper;
    all[i] = NumNumbers(i % 2 == 0 ? half.AutoencoderParameters() : half.sampler->parameters());
  }
  return all;
}

}  // namespace pushid
