// models: losses and steps of the chain's training.
#include "models/restoration/cvae_stages_torch.h"

#include <algorithm>

namespace pushid {
namespace {

constexpr double kTeacher = 0.14, kRamp = 0.14;  // shares of a stage's steps
// Of the published training, from the first step to the last, in a straight line.
constexpr double kFirstPublishedRate = 1e-4, kLastPublishedRate = 1e-7;

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
  optimizer = MakeOptimizer(Trained(), LearningRate(0.0), Published() ? 0.0 : 1e-4);
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
  const Tensor kl = -0.5 * (1.0 + g.log_variance - g.mean.pow(2) - g.log_variance.exp()).mean();
  return (*output - next).pow(2).mean() + options.kl_weight * kl;
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
  const Tensor width =
      Published() ? g.Sigma() - wanted.Sigma() : g.log_variance - wanted.log_variance;
  Tensor loss = (g.mean - wanted.mean).pow(2).mean() + width.pow(2).mean();
  *output = Half().decoder->Forward(Published() ? g.Draw() : g.mean, condition);
  if (!Upper()) loss = loss + options.skate_weight * Skate(*output, pendulum);
  return loss;
}

double CvaeStages::LearningRate(double done) const {
  if (!Published()) return options.learning_rate * OneCycle(done);
  return kFirstPublishedRate + (kLastPublishedRate - kFirstPublishedRate) * done;
}

double CvaeStages::Step() {
  if (rollout_left == 0) NewBatch();
  const double done = static_cast<double>(step) / options.steps[stage];
  SetLearningRate(optimizer.get(), LearningRate(done));
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

}  // namespace pushid
