// models: MRT, a peer for groups, without its training. In the manner of the Multi-Range
// Transformer (Wang et al., Multi-person 3D motion prediction with multi-range transformers,
// NeurIPS 2021): 20 frames given, 20 predicted at once, and on.
//
//   local    encoder over the 19 cosine coefficients (tokens) of the person asked for
//   global   encoder over those of everybody, with where everybody is, seen from that person
//   decoder  one query, that person's last pose, attends to the outputs of both encoders
//   output   linear: cosine coefficients of the next 20 displacements
//
//   layer(x, m) = N(y + W_2 max(0, W_1 y)),  y = N(x + attention(x, m));  m = x in encoders
//   attention   = W_o [heads: softmax(q k / sqrt(width of a head)) v],  N = layer normalization
//
// Different from the published network: no self-attention in the decoder, which for one query is a
// linear map; one linear layer for the output; places stand for the published distance (which is
// one of their rows), so that the network knows who is in front and who behind; no discriminator in
// the training, for errors are judged here and not looks. So the published widths come to 5.0
// million weights instead of 6.6; the small ones to 0.3 million (README.md has what both cost).
// Coefficients are a set with a learned vector for each, people a set with their places: the order
// of people changes nothing.
#pragma once

#include <utility>
#include <vector>

#include "models/enum_names.h"
#include "models/peers/peer.h"
#include "models/restoration/body.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

// What the network is told of a group, and how its outputs become motion. Everybody's motion is
// told as displacements from frame to frame, transformed by cosines over time, in the heading of
// the person who is asked for, at the last given frame. So nothing depends on where a group stands
// or which way it faces.

inline constexpr int kMrtGiven = 20, kMrtFrames = 20;  // seen, and predicted at once
inline constexpr int kMrtTokens = kMrtGiven - 1;       // cosine coefficients, of a person
inline constexpr int kMrtPoseRows = 3 * kBodyJoints;
inline constexpr int kMrtPlaceRows = 5;
inline constexpr int kMrtQueryRows = 2 * kMrtPoseRows;

// What is told when one of a group is asked for.
struct MrtView {
  int person = 0;          // who is asked for
  Eigen::MatrixXf tokens;  // kMrtPoseRows x (kMrtTokens people); a person's coefficients, lowest
                           // first, then the next person's
  Eigen::MatrixXf places;  // kMrtPlaceRows x people: where a hip is from the asked one's, x and y
                           // in m; exp(-distance^2 / m^2); sine and cosine of the way it faces
  Eigen::VectorXf query;   // the asked one's last pose from its hip (the hip: its height), and its
                           // last displacement, both in m

  int num_people() const { return static_cast<int>(places.cols()); }
};

// people: everybody of one recording; of the frames [last - 19, last].
MrtView MrtViewOf(const std::vector<BodyMotion>& people, int last, int person);

// kMrtPoseRows x kMrtFrames: ways from the pose of `last` to the frames after it, m, in its
// heading.
Eigen::MatrixXf MrtWays(const BodyMotion& motion, int last);

// A column per coefficient of the displacements <-> a column per way; one is the other's inverse.
Eigen::MatrixXf MrtCoefficientsOf(const Eigen::MatrixXf& ways);
Eigen::MatrixXf MrtWaysOf(const Eigen::MatrixXf& coefficients);

// The matrix by which coefficients are multiplied from the right to give ways.
const Eigen::MatrixXf& MrtWaysMatrix();

// The numbers of a view and of what is asked, brought to spread 1. Rows of tokens are those of one
// person below one another (kMrtPoseRows kMrtTokens), and so are those of outputs.
struct MrtScalings {
  Scaling tokens, query, outputs;
};
MrtView Scaled(const MrtScalings& scalings, MrtView view);

// Of all people of groups at every `stride`-th frame that has enough before and after it. Empty
// where there is none.
MrtScalings MrtScalingsOf(const std::vector<std::vector<BodyMotion>>& groups, int stride);

enum class MrtSize { kSmall, kPublished };
constexpr EnumNames<MrtSize, 2> Names(MrtSize) {
  return {{{"small", MrtSize::kSmall}, {"published", MrtSize::kPublished}}};
}

struct MrtWidths {
  int width, inner;  // of a token, and of the layer in the middle of two
  int layers;        // of each encoder and of the decoder
  int heads, head;   // of attention, and the width of one
};
MrtWidths WidthsOf(MrtSize size);

struct MrtNorm {
  Eigen::VectorXf scale, shift;
};
struct MrtLayer {
  DenseLayer query, key, value, join;
  MrtNorm after_attention;
  DenseLayer widen, narrow;
  MrtNorm after_dense;
};

struct MrtWeights {
  MrtSize size = MrtSize::kSmall;
  MrtScalings scalings;
  DenseLayer local_token, global_token, place, query;  // into tokens of the network's width
  Eigen::MatrixXf coefficients;                        // width x kMrtTokens: which one it is
  std::vector<MrtLayer> local, global, decoder;
  DenseLayer output;  // scaled; kMrtPoseRows kMrtFrames, coefficient after coefficient
};

// view: scaled. The scaled outputs, a column of kMrtPoseRows kMrtFrames.
Eigen::VectorXf Evaluate(const MrtWeights& weights, const MrtView& view);

// Ways of a person's next frames (MrtWays), of a view that is not scaled.
Eigen::MatrixXf PredictedWays(const MrtWeights& weights, const MrtView& view);

class MrtPeer : public Peer {
 public:
  explicit MrtPeer(MrtWeights weights) : weights_(std::move(weights)) {}
  std::string_view name() const override { return RowOf(RestorationKind::kMrt).name; }
  int given_frames() const override { return kMrtGiven; }
  std::vector<BodyMotion> Continue(const std::vector<BodyMotion>& people,
                                   int frames) const override;

 private:
  MrtWeights weights_;
};

void AddTensors(const MrtWeights& weights, TensorList* tensors);
MrtWeights TakeMrt(MrtSize size, TensorReader* reader);

}  // namespace pushid
