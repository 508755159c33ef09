// models: the chain's training in rounds, with its state.
#include <algorithm>

#include "models/restoration/cvae_stages_torch.h"
#include "models/restoration/cvae_trainer.h"

namespace pushid {
namespace {

const char* const kStageNames[4] = {"lower autoencoder", "lower sampler", "upper autoencoder",
                                    "upper sampler"};

}  // namespace

struct CvaeTrainer::Torch : CvaeStages {};

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

CvaeTrainer::~CvaeTrainer() = default;

bool CvaeTrainer::Done() const { return torch_->stage == 4; }

double CvaeTrainer::ShareDone() const {
  double all = 0.0, done = 0.0;
  for (int i = 0; i < 4; ++i) {
    all += torch_->Steps(i);
    if (i < torch_->stage) done += torch_->Steps(i);
  }
  return Done() ? 1.0 : (done + torch_->step) / all;
}

TrainingPoint CvaeTrainer::RunRound() {
  Torch& t = *torch_;
  double sum = 0.0;
  int steps = 0;
  while (steps < t.options.round && t.step < t.Steps(t.stage)) sum += t.Step(), ++steps;
  TrainingPoint point = {++t.rounds, sum / std::max(1, steps), t.HeldLoss(), kStageNames[t.stage]};
  // Best of the part in which the network goes on from its own frames.
  if (point.validation_loss < t.best_loss && t.step >= t.Steps(t.stage) / 2) {
    torch::NoGradGuard no_grad;
    t.best_loss = point.validation_loss;
    const std::vector<Tensor> from = t.Half().parameters();
    const std::vector<Tensor> to = (t.Upper() ? t.best_upper : t.best_lower)->parameters();
    for (size_t i = 0; i < to.size(); ++i) to[i].copy_(from[i]);
  }
  if (t.step >= t.Steps(t.stage)) {
    t.FinishStage();
    if (t.stage < 4) t.StartStage();
  }
  return point;
}

CvaeWeights CvaeTrainer::Best() const {
  CvaeWeights weights = torch_->scalings;
  const auto take = [&](const HalfModule& half, CvaeSampler* sampler, CvaeDecoder* decoder) {
    if (weights.layout.pendulum) *sampler = half.sampler->SamplerWeights();
    *decoder = half.decoder->Weights();
  };
  take(*torch_->lower, &weights.lower_sampler, &weights.lower_decoder);
  if (weights.layout.halves) take(*torch_->upper, &weights.upper_sampler, &weights.upper_decoder);
  return weights;
}

std::array<int64_t, 4> CvaeTrainer::NumParameters() const {
  const auto count = [](const std::vector<Tensor>& parameters) {
    int64_t sum = 0;
    for (const Tensor& p : parameters) sum += p.numel();
    return sum;
  };
  std::array<int64_t, 4> all = {};
  for (int i = 0; i < 4; ++i) {
    if (!torch_->Has(i)) continue;
    const HalfModule& half = i < 2 ? *torch_->lower : *torch_->upper;
    all[i] = count(i % 2 == 0 ? half.AutoencoderParameters() : half.sampler->parameters());
  }
  return all;
}

std::string CvaeTrainer::State() const {
  const Torch& t = *torch_;
  torch::serialize::OutputArchive archive;
  WritePart("lower", *t.lower, &archive);
  WritePart("best_lower", *t.best_lower, &archive);
  if (t.upper) {
    WritePart("upper", *t.upper, &archive);
    WritePart("best_upper", *t.best_upper, &archive);
  }
  WritePart("optimizer", *t.optimizer, &archive);
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
  return Unarchived(state, [&t](torch::serialize::InputArchive* archive) {
    Tensor counts, random;
    archive->read("counts", counts);
    archive->read("random", random);
    ReadPart("lower", archive, t.lower.get());
    ReadPart("best_lower", archive, t.best_lower.get());
    if (t.upper) {
      ReadPart("upper", archive, t.upper.get());
      ReadPart("best_upper", archive, t.best_upper.get());
    }
    t.stage = static_cast<int>(counts[0].item<double>());
    if (t.stage > 2 && t.stage < 4) {
      t.PredictLower(&t.training);
      t.PredictLower(&t.held);
    }
    if (t.stage < 4) t.StartStage();
    ReadPart("optimizer", archive, t.optimizer.get());
    t.step = static_cast<int>(counts[1].item<double>());
    t.rounds = static_cast<int>(counts[2].item<double>());
    t.best_loss = counts[3].item<double>();
    t.at = static_cast<int64_t>(counts[4].item<double>());
    t.rollout_left = static_cast<int64_t>(counts[5].item<double>());
    if (t.rollout_left > 0) {
      archive->read("rows", t.rows), archive->read("first", t.first);
      archive->read("state", t.state);
    }
    auto generator = at::detail::getDefaultCPUGenerator();
    generator.set_state(random);
  });
}

}  // namespace pushid
