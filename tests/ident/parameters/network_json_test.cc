// Interaction networks as files: round trip, and what is wrong with a wrong one.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "ident/parameters/learned_terms_io.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

InteractionNetwork Small() {
  InteractionNetwork network;
  network.mlp.layers = {{Eigen::MatrixXd::Constant(3, 10, 0.1), Eigen::VectorXd::Ones(3)},
                        {Eigen::MatrixXd::Constant(4, 3, 1.0 / 3.0), Eigen::VectorXd::Zero(4)}};
  network.lowest = Vector4<double>(-1, -2, -3, -4);
  return network;
}

TEST(NetworkJson, RoundTripWithoutLoss) {
  const nlohmann::ordered_json json = ToJson(Small());
  const auto again = InteractionNetworkFromJson(nlohmann::ordered_json::parse(json.dump()));
  EXPECT_EQ(ToJson(*again), json);
  EXPECT_EQ(again->mlp.layers[1].weights, Small().mlp.layers[1].weights);
  EXPECT_FALSE(again->highest.has_value());
}

TEST(NetworkJson, WrongOnesSayWhatIsWrong) {
  const auto problem = [](const std::function<void(nlohmann::ordered_json*)>& spoil) {
    nlohmann::ordered_json json = ToJson(Small());
    spoil(&json);
    try {
      InteractionNetworkFromJson(json);
    } catch (const std::exception& exception) {
      return std::string(exception.what());
    }
    return std::string("nothing");
  };
  using Json = nlohmann::ordered_json;
  EXPECT_NE(problem([](Json* j) { (*j)["activation"] = "sine"; }).find("tanh or relu"),
            std::string::npos);
  EXPECT_NE(problem([](Json* j) {
              (*j)["layers"][1]["weights"][0].push_back(1.0);
            }).find("row 0 has 4 weights; 3 come in"),
            std::string::npos);
  EXPECT_NE(problem([](Json* j) { (*j)["layers"].erase(1); }).find("must have 4"),
            std::string::npos);
  EXPECT_NE(problem([](Json* j) { (*j)["input_deviation"][3] = 0.0; }).find("positive"),
            std::string::npos);
  EXPECT_NE(problem([](Json* j) { (*j)["output_scale"].erase(0); }).find("must have 4"),
            std::string::npos);
}

}  // namespace
}  // namespace pushid
