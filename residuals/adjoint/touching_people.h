// residuals: what people of several recordings do to each other, step by step, and back.
//
// With f the adjoint of what each of two people gets from the other, F = F_terms + 2 M g y of both,
//   L_s <- L_s + (dF_terms/ds)' f + (dg/ds)' (2 M y . f) + (du/ds)' u^,   s: the states of both
//   L_p <- L_p + (dF_terms/dp)' f + (dg/dp)' (2 M y . f)
// where u^ comes back through the network from y^ = 2 M g f (packed_layers.h). A person's step so
// hands parts to the neighbours' states. Derivatives of terms and gate are those that sensitivities
// are chained from (pair_jacobian.h, learned_pair_jacobian.h).
//
// Everybody is a column: the people of one recording side by side, one recording after the other.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/neighbours.h"
#include "residuals/packed/packed_layers.h"
#include "residuals/packed/vector_kernels.h"

namespace pushid {

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
  void TermsBack(const Contact& contact, const PeopleNow& now, const Eigen::MatrixXd& by_received,
                 Eigen::MatrixXd* by_state, ParameterSet<double>* by_parameter) const;
  void GateBack(const Contact& contact, const PeopleNow& now, const Eigen::MatrixXd& by_received,
                Eigen::MatrixXd* by_state, ParameterSet<double>* by_parameter) const;
  void NetworkBack(int step, const Eigen::MatrixXd& by_received, Eigen::MatrixXd* by_state);

  const ModelOptions& options_;
  std::vector<Group> groups_;
  std::vector<std::vector<Contact>> contacts_;  // by step
  std::optional<PackedPairs> network_;          // none: nothing is learned
  Eigen::MatrixXd inputs_, outputs_;  // two columns for each contact that the network sees
};

}  // namespace pushid
