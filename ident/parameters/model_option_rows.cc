// ident: rows of the options that say what the model is.
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/files/names.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/option_row_makers.h"
#include "ident/parameters/presets.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
using Row = FitOptionRow;

Row PresetRow() {
  Row row = WordsRow(
      "preset", OptionStage::kPreset,
      "the model: auto (tail for recordings of one person, group where there are more), tail (push "
      "tail, posture-relative recovery), group (tail with contact, pooled by setting; with feet "
      "that slide, linear self forces too), ldp (plain PD and friction from upright), or "
      "ldp_published (LDP with all its networks, of one person or of groups)",
      nullptr);
  row.text = [](const FitOptions&) { return std::string(kAutoPreset); };
  row.json = "/preset";
  row.write = [](const FitOptions& o) { return Json(o.preset); };
  row.read = [](const Json& json, FitOptions* o) { o->preset = json; };
  return row;
}

// What is learned so far; its weights are drawn once all of it is known (fit_setup.h).
LearnedTerms Learned(const FitOptions& o) {
  return o.model.learned != nullptr ? *o.model.learned : LearnedTerms{};
}
void SetLearned(const LearnedTerms& network, FitOptions* o) {
  o->model.learned = network.any() ? std::make_shared<const LearnedTerms>(network) : nullptr;
}

Row StanceRow() {
  Row row = NameRow<Stance>(
      "stance", "/stance", &ModelOptions::stance,
      "behaviour of the feet: slide (the cart moves under any force), steps (they hold until the "
      "capture point leaves their support, then one of them steps), fixed (they hold), or auto "
      "(fixed where no pushed person's feet moved; steps where some did, and of people who touch "
      "also where all did; slide where three in four people alone did, fewer than half of them "
      "lifted a foot or feet were not recorded; ldp presets: slide)");
  row.text = [](const FitOptions&) { return std::string(kAutoStance); };
  row.apply = [](const std::string& text, FitOptions* o) -> MaybeError {
    if (text == kAutoStance) return std::nullopt;
    Stance stance;
    if (MaybeError error = ParseName("--stance", text, &stance)) {
      return Error{error->message + ", or " + kAutoStance};
    }
    SetStance(stance, o);
    return std::nullopt;
  };
  return MayBeAbsent(row);
}

std::string SelfForceHelp() {
  std::string text = "additional self force: none, ";
  for (const SelfForceLaw& law : kSelfForces) {
    if (law.value != SelfForceKind::kNone)
      text += law.name + (" (" + std::string(law.note)) + "), ";
  }
  std::vector<std::string> examples = NetworkExamples();
  const std::string embedding = examples.back();
  examples.pop_back();
  return text + "a network by kind and hidden size (" + Listed(examples, ",") + "; " + embedding +
         " with an embedding), or linear and a network, comma-separated";
}

Row SelfForceRow() {
  const std::string help = SelfForceHelp();
  Row row = Decided(WordsRow("self_force", OptionStage::kModel, help.c_str(),
                             [](const std::string& text, FitOptions* o) -> MaybeError {
                               const Result<SelfForceChoice> choice =
                                   ParseSelfForce("--self_force", text);
                               if (!choice.ok()) return choice.error();
                               SetSelfForce(choice.value().kind, o);
                               LearnedTerms network = Learned(*o);
                               network.shape = choice.value().network;
                               SetLearned(network, o);
                               return std::nullopt;
                             }));
  row.json = "/self_force";
  row.write = [](const FitOptions& o) {
    return Json(SelfForceText(o.self_force, o.model.learned.get()));
  };
  row.read = [](const Json& json, FitOptions* o) {
    const auto self = ParseSelfForce("self_force", json.get<std::string>());
    if (!self.ok()) throw std::runtime_error(self.error().ToString());
    o->self_force = self.value().kind;
  };
  return row;
}

Row RodRow() {
  Row row = WordsRow("rod", OptionStage::kModel,
                     "the rod's length: constant, or a state that a learned law changes, together "
                     "with the cart's height: linear, mlp:4 (hidden sizes); or LDP's, whose cart "
                     "keeps its height, ldp:256-128-256",
                     [](const std::string& text, FitOptions* o) -> MaybeError {
                       const Result<RodShape> rod = ParseRod("--rod", text);
                       if (!rod.ok()) return rod.error();
                       LearnedTerms network = Learned(*o);
                       network.rod = rod.value();
                       SetLearned(network, o);
                       return std::nullopt;
                     });
  row.text = [](const FitOptions& o) { return RodName(Learned(o).rod); };
  return row;
}

Row PresetPriorsRow() {
  return BoolRow(
      "preset_priors", "keep the preset's weak priors",
      [](const FitOptions& o) { return o.preset_priors; },
      [](bool value, FitOptions* o) { o->preset_priors = value; });
}

Row InteractionRow() {
  const char* const help =
      "interaction between people: none, or some of these, comma-separated: contact (smooth and "
      "mutual: spring,damping), ldp_published (LDP's equations 10 and 11 and its table of signs), "
      "network:4 (learned beside contact, by hidden sizes), ldp_network:512-512 (LDP's, learned of "
      "every neighbour in range)";
  Row row = Decided(WordsRow("interaction", OptionStage::kModel, help,
                             [](const std::string& text, FitOptions* o) -> MaybeError {
                               const Result<InteractionChoice> choice =
                                   ParseInteraction("--interaction", text);
                               if (!choice.ok()) return choice.error();
                               o->model.interaction = choice.value().terms;
                               LearnedTerms learned = Learned(*o);
                               learned.pair = choice.value().pair;
                               SetLearned(learned, o);
                               return std::nullopt;
                             }));
  row.json = "/interaction";
  row.text = [](const FitOptions& o) { return InteractionText(o.model); };
  row.write = [](const FitOptions& o) { return Json(InteractionText(o.model)); };
  row.read = [](const Json& json, FitOptions* o) {
    const auto choice = ParseInteraction("interaction", json.get<std::string>());
    if (!choice.ok()) throw std::runtime_error(choice.error().ToString());
    o->model.interaction = choice.value().terms;
  };
  return row;
}

}  // namespace

std::vector<Row> ModelOptionRows() {
  using O = FitOptions;
  return {
      PresetRow(),
      StanceRow(),
      SelfForceRow(),
      RodRow(),
      NameRow<SkeletonMapping>("mapping", "/mapping", &O::mapping,
                               "skeleton to pendulum: exact, or ldp for comparison"),
      Decided(NameRow<Posture>("posture", "/posture", &ModelOptions::posture,
                               "balance error measured from: upright or initial")),
      MayBeAbsent(Decided(NameRow<Directions>(
          "directions", "/directions", &ModelOptions::directions,
          "isotropic (people answer alike in all directions; fitted along each push), body (along "
          "what people face, sideways parameters free where forward ones are) or axes (those of "
          "the file; sideways parameters as the preset has them)"))),
      Decided(
          NameRow<GainScaling>("gain_scaling", "/gain_scaling", &ModelOptions::gain_scaling,
                               "gains of other bodies: none, mass, or body (mass and rod length)")),
      Decided(NameRow<FrictionKind>("friction", "/friction", &ModelOptions::friction,
                                    AnyName<FrictionKind>().c_str())),
      Decided(NameRow<PushUse>("push", "/push", &ModelOptions::push,
                               "as_recorded (honour push_kind) or added")),
      Decided(NameRow<PushTail>("push_tail", "/push_tail", &ModelOptions::push_tail,
                                "none or exponential")),
      NameRowWith<Delay>(
          SetDelay, "delay", "/delay", &ModelOptions::delay,
          "reaction delay of active feedback: none, one (of all of it) or ankle_and_step (the "
          "feet's own); reaction_delay and the passive shares of stiffness and damping are then "
          "fitted"),
      NameRowWith<BodyModel>(
          SetBody, "body", "/body", &ModelOptions::body,
          "where a body's mass is: ldp (nine tenths at the hip; of who stands, an average body's), "
          "anthropometric (by the recorded segments, de Leva 1996), or table (cart_share, "
          "com_height, gyration_radius and push_gain, of robots and rigs: fixed or fitted)"),
      NameRow<CartDerivative>("cart_derivative", "/cart_derivative", &ModelOptions::cart_derivative,
                              "none or backward: lets Kd_x and Kd_y act"),
      InteractionRow(),
      MayBeAbsent(NameRow<ProcessNoise>(
          "process_noise", "/process_noise", &ModelOptions::process_noise,
          "white-noise forces in addition to all others: none or diagonal (independent)")),
      NameRowWith<Likelihood>(
          SetLikelihood, "likelihood", "/likelihood", &O::likelihood,
          "what a fit maximizes: trajectory (whole rollouts), transition (each measured state "
          "given the one before), or innovation (each measurement given all before it, with errors "
          "of measurement)"),
      PresetPriorsRow(),
  };
}

std::vector<FitOptionRow> NetworkOptionRows() {
  using O = FitOptions;
  return {
      MayBeAbsent(Decided(NameRow<NetworkTraining>(
          "network_training", "/network_training", &O::network_training,
          "large networks: after_physics (fitted without them first, and again with them held), or "
          "together with the free parameters"))),
      MayBeAbsent(Decided(NameRow<NetworkOptimizer>(
          "network_optimizer", "/network_optimizer", &O::network_optimizer,
          "large networks: lbfgs (Ceres' L-BFGS on all recordings) or adam (on eight at a time)"))),
      MayBeAbsent(CountRow("network_iterations", "/network_iterations", &O::network_iterations,
                           "large networks: iterations of L-BFGS or passes of Adam, at most")),
      MayBeAbsent(
          NumberRow("network_rate", "/network_rate", &O::network_rate, kPositive,
                    "large networks: Adam's learning rate, which falls to a hundredth of it")),
      MayBeAbsent(NumberRow(
          "network_prior", "/network_prior", &O::network_prior, kNotNegative,
          "standard deviation of the prior that ties a network's weights to zero; 0: none")),
      MayBeAbsent(NumberRow(
          "early_stopping", "/early_stopping", &O::early_stopping,
          {0.0, 0.5, false, "must lie between 0 and 0.5"},
          "share of the recordings held out for early stopping of a network's training; 0: none")),
  };
}

}  // namespace pushid
