// models: the four stages of the chain's training, in LibTorch.
#include <algorithm>

#include "models/restoration/cvae_modules_torch.h"
#include "models/restoration/cvae_trainer.h"

namespace pushid {
namespace {

constexpr double kTeacher = 0.14, kRamp = 0.14;  // shares of a stage's steps
constexpr double kStandingSpeed = 0.15;          // m/s: slower true ankles should stand
constexpr double kWorstLoss = 1e30;
const char* const kStageNames[4] = {"lower autoencoder", "lower sampler", "upper autoencoder",
                                    "upper sampler"};

// Sequences padded to the longest: [sequence, frame, number].
struct Sequences {
  Tensor lower, upper, pendulum, lower_predicted;  // the last: positions, once the chain is there
  std::vector<int64_t> frames;

  int64_t count() const { return static_cast<int64_t>(frames.size()); }
  int64_t longest() const { return lower.size(1); }
};

Tensor Padded(const std::vector<const Eigen::MatrixXf*>& parts, int64_t longest) {
  Tensor all = torch::zeros({static_cast<int64_t>(parts.size()), longest, parts[0]->rows()});
  for (size_t i = 0; i < parts.size(); ++i) {
    const Tensor part = ToTensor(*parts[i]);
    all[static_cast<int64_t>(i)].slice(0, 0, part.size(0)).copy_(part);
  }
  return all;
}

Sequences Gather(const std::vector<CvaeSequence>& sequences) {
  Sequences all;
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

Tensor Positions(const Tensor& frames, int numbers) { return frames.slice(-1, 3, 3 + numbers); }

}  // namespace

struct CvaeTrainer::Torch {
  CvaeOptions options;
  CvaeWeights scalings;
  Sequences training, held;
  std::shared_ptr<HalfModule> lower, upper, best_lower, best_upper;
  std::unique_ptr<torch::optim::AdamW> optimizer;
  Tensor lower_spread, upper_spread, lower_mean;  // of positions, for errors in m
  int stage = 0, step = 0, rounds = 0;
  double best_loss = kWorstLoss;
  // The batch that is being rolled out.
  Tensor rows, first;
  int64_t at = 0, rollout_left = 0;
  Tensor state;  // x_t of the batch, true or its own

  bool Upper() const { return stage >= 2; }
  bool Sampler() const { return stage % 2 == 1; }
  HalfModule& Half() { return Upper() ? *upper : *lower; }
  const Tensor& Frames(const Sequences& s) const { return Upper() ? s.upper : s.lower; }
  int NumPositions() const {
    return Upper() ? 3 * static_cast<int>(kUpperJoints.size()) : kLowerPositions;
  }
  // x_t and, for the upper body, the lower positions of the next frame.
  Tensor Condition(const Tensor& x, const Tensor& lower_next) const {
    return Upper() ? Join(x, lower_next) : x;
  }

  void StartStage();
  void FinishStage();
  void NewBatch();
  double Step();
  Tensor AutoencoderLoss(const Tensor& next, const Tensor& condition, Tensor* output);
  Tensor SamplerLoss(const Tensor& next, const Tensor& condition, const Tensor& pendulum,
                     const Tensor& before, Tensor* output);
  Tensor Skate(const Tensor& output, const Tensor& x, const Tensor& next,
               const Tensor& before) const;
  Tensor RollOut(const Sequences& s, bool with_sampler);
  double HeldLoss();
  void PredictLower(Sequences* s);
};

void CvaeTrainer::Torch::StartStage() {
  if (stage == 2) {  // from here on the lower chain is finished
    PredictLower(&training);
    PredictLower(&held);
  }
  optimizer = std::make_unique<torch::optim::AdamW>(
      Sampler() ? Half().sampler->parameters() : Half().AutoencoderParameters(),
      torch::optim::AdamWOptions(options.learning_rate).weight_decay(1e-4));
  step = 0;
  rollout_left = 0;
  best_loss = kWorstLoss;
}

// Takes the best weights of the stage that ended and goes on to the next.
void CvaeTrainer::Torch::FinishStage() {
  torch::NoGradGuard no_grad;
  const auto& best = Upper() ? best_upper : best_lower;
  const std::vector<Tensor> from = best->parameters(), to = Half().parameters();
  for (size_t i = 0; i < to.size(); ++i) to[i].copy_(from[i]);
  ++stage;
}

// Sequences at random, recordings weighted by nothing else; a random first frame that leaves room.
void CvaeTrainer::Torch::NewBatch() {
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

Tensor CvaeTrainer::Torch::AutoencoderLoss(const Tensor& next, const Tensor& condition,
                                           Tensor* output) {
  const Gaussian g = Half().Encode(next, condition);
  const Tensor z = g.mean + torch::exp(0.5 * g.log_variance) * torch::randn_like(g.mean);
  *output = Half().decoder->Forward(z, condition);
  const Tensor kl = -0.5 * (1.0 + g.log_variance - g.mean.pow(2) - g.log_variance.exp()).mean();
  return (*output - next).pow(2).mean() + options.kl_weight * kl;
}

// How far ankles slide (m) whose true speed says that they stand.
Tensor CvaeTrainer::Torch::Skate(const Tensor& output, const Tensor& x, const Tensor& next,
                                 const Tensor& before) const {
  Tensor skate = torch::zeros({1});
  for (const int64_t ankle : {3, 7}) {  // right and left among the lower joints
    const auto place = [&](const Tensor& frame) {
      const auto part = [&](const Tensor& t) { return t.slice(-1, 3 * ankle, 3 * ankle + 2); };
      const Tensor hip_way =
          frame.slice(-1, 0, 2) * lower_spread.slice(0, 0, 2) + lower_mean.slice(0, 0, 2);
      const Tensor p =
          Positions(frame, kLowerPositions) * lower_spread.slice(0, 3, 3 + kLowerPositions) +
          lower_mean.slice(0, 3, 3 + kLowerPositions);
      return std::make_pair(part(p), hip_way);
    };
    const auto [now, way] = place(output);
    const auto [last, unused] = place(x);
    const auto [true_now, true_way] = place(next);
    const auto [true_last, unused2] = place(before);
    const Tensor true_slide = (true_now - true_last + true_way).norm(2, 1);
    const Tensor standing = (true_slide * kCvaeRate < kStandingSpeed).to(torch::kFloat32);
    skate = skate + ((now - last + true_way).abs().sum(1) * standing).mean();
  }
  return skate;
}

Tensor CvaeTrainer::Torch::SamplerLoss(const Tensor& next, const Tensor& condition,
                                       const Tensor& pendulum, const Tensor& before,
                                       Tensor* output) {
  Gaussian wanted;
  {
    torch::NoGradGuard no_grad;
    wanted = Half().Encode(next, condition);
  }
  const Gaussian g = Half().Sample(condition, pendulum);
  Tensor loss =
      (g.mean - wanted.mean).pow(2).mean() + (g.log_variance - wanted.log_variance).pow(2).mean();
  *output = Half().decoder->Forward(g.mean, condition);
  if (!Upper())
    loss = loss + options.skate_weight * kCvaeRate * Skate(*output, state, next, before);
  return loss;
}

double CvaeTrainer::Torch::Step() {
  if (rollout_left == 0) NewBatch();
  const double done = static_cast<double>(step) / options.steps[stage];
  SetLearningRate(optimizer.get(), options.learning_rate * OneCycle(done));
  const Tensor before = Frames(training).index({rows, first + at});
  const Tensor next = Frames(training).index({rows, first + at + 1});
  const Tensor pendulum = training.pendulum.index({rows, first + at + 1});
  Tensor lower_next;
  if (Upper()) lower_next = training.lower_predicted.index({rows, first + at + 1});
  const Tensor condition = Condition(state, lower_next);
  Tensor output;
  const Tensor loss = Sampler() ? SamplerLoss(next, condition, pendulum, before, &output)
                                : AutoencoderLoss(next, condition, &output);
  optimizer->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(
      Sampler() ? Half().sampler->parameters() : Half().AutoencoderParameters(), 1.0);
  optimizer->step();
  const double own = std::clamp((done - kTeacher) / kRamp, 0.0, 1.0);
  const Tensor take = (torch::rand({options.batch, 1}) < own).to(torch::kFloat32);
  state = (take * output.detach() + (1.0 - take) * next).clamp(-kLargestScaled, kLargestScaled);
  ++at, ++step, --rollout_left;
  return loss.item<double>();
}

// Whole sequences from their first frame: [sequence, frame, number].
Tensor CvaeTrainer::Torch::RollOut(const Sequences& s, bool with_sampler) {
  torch::NoGradGuard no_grad;
  const Tensor& frames = Frames(s);
  Tensor out = torch::zeros_like(frames);
  Tensor x = frames.select(1, 0);
  out.select(1, 0).copy_(x);
  for (int64_t t = 1; t < s.longest(); ++t) {
    const Tensor condition = Condition(x, Upper() ? s.lower_predicted.select(1, t) : Tensor());
    const Tensor z = with_sampler ? Half().Sample(condition, s.pendulum.select(1, t)).mean
                                  : Half().Encode(frames.select(1, t), condition).mean;
    x = Half().decoder->Forward(z, condition).clamp(-kLargestScaled, kLargestScaled);
    out.select(1, t).copy_(x);
  }
  return out;
}

double CvaeTrainer::Torch::HeldLoss() {
  const Tensor out = RollOut(held, Sampler());
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

void CvaeTrainer::Torch::PredictLower(Sequences* s) {
  const int kept = stage;
  stage = 1;
  s->lower_predicted = Positions(RollOut(*s, true), kLowerPositions).contiguous();
  stage = kept;
}

CvaeTrainer::CvaeTrainer(std::vector<CvaeSequence> training, std::vector<CvaeSequence> held,
                         const CvaeWeights& scalings, const CvaeOptions& options)
    : torch_(std::make_unique<Torch>()) {
  torch::set_num_threads(options.num_threads);
  torch::manual_seed(options.seed);
  Torch& t = *torch_;
  t.options = options;
  t.scalings = scalings;
  t.training = Gather(training);
  t.held = Gather(held);
  t.lower_spread = ToTensor(scalings.lower.spread), t.lower_mean = ToTensor(scalings.lower.mean);
  t.upper_spread = ToTensor(scalings.upper.spread);
  t.lower = std::make_shared<HalfModule>(kLowerFrame, kLowerFrame);
  t.upper = std::make_shared<HalfModule>(kUpperFrame, kUpperCondition);
  t.best_lower = std::make_shared<HalfModule>(kLowerFrame, kLowerFrame);
  t.best_upper = std::make_shared<HalfModule>(kUpperFrame, kUpperCondition);
  t.StartStage();
}

CvaeTrainer::~CvaeTrainer() = default;

bool CvaeTrainer::Done() const { return torch_->stage == 4; }

double CvaeTrainer::ShareDone() const {
  double all = 0.0, done = 0.0;
  for (int i = 0; i < 4; ++i) {
    all += torch_->options.steps[i];
    if (i < torch_->stage) done += torch_->options.steps[i];
  }
  return Done() ? 1.0 : (done + torch_->step) / all;
}

TrainingPoint CvaeTrainer::RunRound() {
  Torch& t = *torch_;
  double sum = 0.0;
  int steps = 0;
  while (steps < t.options.round && t.step < t.options.steps[t.stage]) sum += t.Step(), ++steps;
  TrainingPoint point = {++t.rounds, sum / std::max(1, steps), t.HeldLoss(), kStageNames[t.stage]};
  // Best of the part in which the network goes on from its own frames.
  if (point.validation_loss < t.best_loss && t.step >= t.options.steps[t.stage] / 2) {
    torch::NoGradGuard no_grad;
    t.best_loss = point.validation_loss;
    const std::vector<Tensor> from = t.Half().parameters();
    const std::vector<Tensor> to = (t.Upper() ? t.best_upper : t.best_lower)->parameters();
    for (size_t i = 0; i < to.size(); ++i) to[i].copy_(from[i]);
  }
  if (t.step >= t.options.steps[t.stage]) {
    t.FinishStage();
    if (t.stage < 4) t.StartStage();
  }
  return point;
}

CvaeWeights CvaeTrainer::Best() const {
  CvaeWeights weights = torch_->scalings;
  weights.lower_sampler = torch_->lower->sampler->SamplerWeights();
  weights.upper_sampler = torch_->upper->sampler->SamplerWeights();
  weights.lower_decoder = torch_->lower->decoder->Weights();
  weights.upper_decoder = torch_->upper->decoder->Weights();
  return weights;
}

std::array<int64_t, 4> CvaeTrainer::NumParameters() const {
  const auto count = [](const std::vector<Tensor>& parameters) {
    int64_t sum = 0;
    for (const Tensor& p : parameters) sum += p.numel();
    return sum;
  };
  return {
      count(torch_->lower->AutoencoderParameters()), count(torch_->lower->sampler->parameters()),
      count(torch_->upper->AutoencoderParameters()), count(torch_->upper->sampler->parameters())};
}

std::string CvaeTrainer::State() const {
  const Torch& t = *torch_;
  torch::serialize::OutputArchive archive, lower, upper, best_lower, best_upper, optimizer;
  t.lower->save(lower), t.upper->save(upper);
  t.best_lower->save(best_lower), t.best_upper->save(best_upper);
  t.optimizer->save(optimizer);
  archive.write("lower", lower), archive.write("upper", upper);
  archive.write("best_lower", best_lower), archive.write("best_upper", best_upper);
  archive.write("optimizer", optimizer);
  archive.write("counts",
                torch::tensor({static_cast<double>(t.stage), static_cast<double>(t.step),
                               static_cast<double>(t.rounds), t.best_loss,
                               static_cast<double>(t.at), static_cast<double>(t.rollout_left)},
                              torch::kFloat64));
  if (t.rollout_left > 0) {
    archive.write("rows", t.rows), archive.write("first", t.first), archive.write("state", t.state);
  }
  archive.write("random", at::detail::getDefaultCPUGenerator().get_state());
  return Archived(archive);
}

bool CvaeTrainer::Resume(const std::string& state) {
  Torch& t = *torch_;
  try {
    std::istringstream stream(state);
    torch::serialize::InputArchive archive, lower, upper, best_lower, best_upper, optimizer;
    archive.load_from(stream);
    archive.read("lower", lower), archive.read("upper", upper);
    archive.read("best_lower", best_lower), archive.read("best_upper", best_upper);
    archive.read("optimizer", optimizer);
    t.lower->load(lower), t.upper->load(upper);
    t.best_lower->load(best_lower), t.best_upper->load(best_upper);
    Tensor counts, random;
    archive.read("counts", counts);
    archive.read("random", random);
    t.stage = static_cast<int>(counts[0].item<double>());
    if (t.stage > 2) {
      t.PredictLower(&t.training);
      t.PredictLower(&t.held);
    }
    if (t.stage < 4) t.StartStage();
    t.optimizer->load(optimizer);
    t.step = static_cast<int>(counts[1].item<double>());
    t.rounds = static_cast<int>(counts[2].item<double>());
    t.best_loss = counts[3].item<double>();
    t.at = static_cast<int64_t>(counts[4].item<double>());
    t.rollout_left = static_cast<int64_t>(counts[5].item<double>());
    if (t.rollout_left > 0) {
      archive.read("rows", t.rows), archive.read("first", t.first);
      archive.read("state", t.state);
    }
    auto generator = at::detail::getDefaultCPUGenerator();
    generator.set_state(random);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace pushid
