// residuals: people of several recordings rolled out side by side, and back (adjoint_gradient.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/neighbours.h"
#include "models/rollout.h"
#include "residuals/adjoint/adjoint_gradient.h"
#include "residuals/adjoint/step_adjoint.h"
#include "residuals/packed/packed_layers.h"
#include "residuals/packed/packed_network.h"
#include "residuals/packed/vector_kernels.h"

namespace pushid {

// What people of several recordings do to each other, step by step, and back.
//
// With f the adjoint of what each of two people gets from the other, F = F_terms + 2 M g y of both,
//   L_s <- L_s + (dF_terms/ds)' f + (dg/ds)' (2 M y . f) + (du/ds)' u^,   s: the states of both
//   L_p <- L_p + (dF_terms/dp)' f + (dg/dp)' (2 M y . f)
// where u^ comes back through the network from y^ = 2 M g f (packed_layers.h). A person's step so
// hands parts to the neighbours' states. Terms and gate: PairBack (step_adjoint.h).
//
// Everybody is a column: the people of one recording side by side, one recording after the other.

// Everybody's state and parameters at one step, by column.
struct PeopleNow {
  std::vector<PendulumState<double>> states;
  std::vector<ParameterSet<double>> parameters;
};

class TouchingPeople {
 public:
  // options and scenes must outlive the object; scenes: of the recordings, in the columns' order.
  TouchingPeople(const ModelOptions& options, const std::vector<const Scene*>& scenes,
                 const VectorKernels& kernels);

  // Before the first step; weights: of all that is learned, there until the last step back; null
  // where nothing is.
  void Start(const double* weights);

  // The next step. going: by recording; who is not, is not looked at. received: 4 x columns, what
  // each gets from all others; overwritten.
  void Forward(const PeopleNow& now, const std::vector<bool>& going, Eigen::MatrixXd* received);

  // From the last step to the first, with the same states. by_received: d(cost)/d(received), 4 x
  // columns, zero for who is not going any more. Adds to by_state (8 x columns, [q, qd]) and to
  // by_parameter.
  void Backward(int step, const PeopleNow& now, const Eigen::MatrixXd& by_received,
                Eigen::MatrixXd* by_state, ParameterSet<double>* by_parameter);

  // After the last of these: adds d(cost)/d(weights), of all that is learned.
  void AddWeightGradient(double* gradient);

 private:
  struct Group {
    const Scene* scene;
    int first;  // column
    PairFinder finder;
  };
  // Two people who act on each other at one step.
  struct Contact {
    int n, j, first;  // columns: of the two, of the first of their recording
    Pair pair;
    bool terms;   // whether any but the network acts
    double gate;  // of the network; 0: it does not act
    // 2 M y of both.
    Vector4<double> learned_n = Vector4<double>::Zero(), learned_j = Vector4<double>::Zero();

    bool learned() const { return gate > 0.0; }
  };

  void FindContacts(Group* group, const PeopleNow& now, std::vector<Contact>* contacts,
                    Eigen::MatrixXd* received) const;
  void AskNetwork(const PeopleNow& now, std::vector<Contact>* contacts, Eigen::MatrixXd* received);
  void NetworkBack(int step, const Eigen::MatrixXd& by_received, Eigen::MatrixXd* by_state);

  const ModelOptions& options_;
  std::vector<Group> groups_;
  std::vector<std::vector<Contact>> contacts_;  // by step
  std::optional<PackedLayers> network_;         // none: nothing is learned
  Eigen::MatrixXd inputs_, outputs_;  // two columns for each contact that the network sees
};

class AdjointGradient::Batch {
 public:
  // recordings: indices into `all`; those of more frames first.
  Batch(const std::vector<AdjointRecording>& all, const std::vector<int>& recordings,
        const ModelOptions& options, const ResidualSigmas& sigmas, const VectorKernels& kernels);

  // Returns the cost, and what became of the batch's recordings.
  double Forward(const ParameterMap& map, const double* shared, const double* weights,
                 std::vector<RolloutStatus>* status);

  // After Forward. by_parameter: of natural values, the sum over all people; adds to both.
  // by_weight may be null.
  void Backward(ParameterSet<double>* by_parameter, double* by_weight);

 private:
  // d(cost)/d(force) of what a step back does not know itself: of the own network's, and of what
  // others do.
  struct ForceAdjoint {
    Vector4<double> network = Vector4<double>::Zero(), received = Vector4<double>::Zero();
  };

  // One column of the batch.
  struct Walker {
    const PendulumRecording* recording;
    int index, place, person;  // of the recording among all, in the batch; of the person in it
    double weight;
    SelfForce self;
    std::optional<ParameterSet<double>> held;  // in place of the map's values
    std::vector<PendulumState<double>> path;
    std::vector<Vector4<double>> acceleration;

    const Scene& scene() const { return recording->scene; }
    const Body& body() const { return self.body; }
    const Vector4<double>& VelocityBefore(int frame) const {
      return path[frame > 0 ? frame - 1 : 0].qd;
    }
    MeasuredFrame Measured(int frame, bool rod_moves) const;
  };

  bool Going(const Walker& walker, int step) const { return step + 1 < end_[walker.place]; }
  const ParameterSet<double>& Parameters(int column) const { return now_.parameters[column]; }
  void SetStates(int step);
  // What the networks answer to the states of a step, and what people do to each other there.
  void SetForces(int step);
  void SetReceived(int step);
  void SetRodVelocities(int step);
  void Step(int step, std::vector<RolloutStatus>* status);
  double Cost() const;
  // A walker's step back but for networks and others. by_rod: the adjoint of what the rod's law
  // saw; null where it is constant.
  ForceAdjoint StepBack(int column, int step, const Eigen::VectorXd* by_rod, StateAdjoint* adjoint,
                        ParameterSet<double>* by_parameter) const;
  // Adds the residuals of the frame after a step, and goes back through the rods' laws.
  void RodBack(int step, std::vector<StateAdjoint>* adjoints, ParameterSet<double>* by_parameter);
  // From the adjoints of a step's forces, forces_ and received_, to those of its states.
  void ForcesBack(int step, std::vector<StateAdjoint>* adjoints,
                  ParameterSet<double>* by_parameter);

  const ModelOptions options_;
  const ResidualSigmas sigmas_;
  std::vector<Walker> walkers_;
  std::vector<int> horizon_, end_;  // by place: frames to roll out, and those that count
  PackedColumns columns_;
  std::optional<PackedNetwork> network_;  // none: no force
  std::optional<PackedLayers> rod_;       // none: constant
  std::optional<TouchingPeople> others_;  // none: nobody does anything to another
  PeopleNow now_;                         // states: only where people touch
  Eigen::MatrixXd inputs_, forces_, rod_inputs_, rod_velocities_;
  Eigen::MatrixXd received_, by_state_;  // from others; backwards the adjoints of both sides
};

}  // namespace pushid
