// The options of a fit: one row drives flag, check and JSON.
#include "ident/parameters/option_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// By hand: one option from its words to the file and back.
TEST(OptionTable, ARowByHand) {
  const FitOptionRow& row = *FindFitOption("settling_weight");
  FitOptions options;
  EXPECT_EQ(row.text(options), "0");
  ASSERT_FALSE(row.apply("0.5", &options));
  EXPECT_EQ(options.settling_weight, 0.5);
  EXPECT_EQ(OptionsJson(options)["settling_weight"], 0.5);
  FitOptions read;
  row.read(0.7, &read);
  EXPECT_EQ(read.settling_weight, 0.7);
  EXPECT_EQ(FindFitOption("settling_wait"), nullptr);
}

TEST(OptionTable, NamesAndPlacesAreTheirOwn) {
  std::set<std::string> names, places;
  for (const FitOptionRow& row : FitOptionRows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.help.empty()) << row.name;
    EXPECT_TRUE(row.json.empty() || places.insert(row.json).second) << row.name;
    EXPECT_TRUE(row.json.empty() || (row.write && row.read)) << row.name;
  }
}

// A row reads the words that it gives for the defaults.
TEST(OptionTable, TextsReadBack) {
  const FitOptions defaults;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (!row.text || !row.apply) continue;
    FitOptions options;
    const std::string text = row.text(defaults);
    ASSERT_FALSE(row.apply(text, &options)) << row.name;
    EXPECT_EQ(row.text(options), text) << row.name;
  }
}

// A row drives its own place in the file, and no other.
TEST(OptionTable, NumbersGoWhereTheirRowSays) {
  const auto defaults = OptionsJson(FitOptions());
  int numbers = 0;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.json.empty() || !row.apply) continue;
    const nlohmann::ordered_json::json_pointer place(row.json);
    if (!defaults.at(place).is_number()) continue;
    ++numbers;
    FitOptions options;
    ASSERT_FALSE(row.apply("7", &options)) << row.name;
    auto expected = defaults;
    expected[place] = OptionsJson(options).at(place);
    EXPECT_EQ(expected[place], 7) << row.name;
    EXPECT_EQ(OptionsJson(options).dump(), expected.dump()) << row.name;
    EXPECT_EQ(OptionsJson(OptionsFrom(expected)).dump(), expected.dump()) << row.name;
  }
  EXPECT_GT(numbers, 4);
}

TEST(OptionTable, EveryPresetComesBackFromJson) {
  for (const char* name : {"tail", "ldp", "group", "ldp_published_groups"}) {
    FitOptions options = MakePreset(name).value();
    options.model.learned = nullptr;  // is written apart
    const auto json = OptionsJson(options);
    EXPECT_EQ(OptionsJson(OptionsFrom(json)).dump(), json.dump()) << name;
  }
}

TEST(OptionTable, JsonOfOtherTypesAndNamesThrows) {
  const auto good = OptionsJson(MakePreset("tail").value());
  for (const char* key : {"posture", "settling_weight", "horizons", "seed", "network_prior"}) {
    auto json = good;
    json[key] = nlohmann::ordered_json::array({"no", "such"});
    EXPECT_THROW(OptionsFrom(json), std::exception) << key;
    json.erase(key);
    EXPECT_THROW(OptionsFrom(json), std::exception) << key;
  }
}

TEST(FitOptions, IsValidSaysOptionValueAndConstraint) {
  struct Case {
    void (*spoil)(FitOptions*);
    std::string says;
  };
  const Case cases[] = {
      {[](FitOptions* o) { o->sigmas.hip = 0.0; }, "sigma_hip is 0; it must be positive"},
      {[](FitOptions* o) { o->sigmas.rate = std::nan(""); },
       "sigma_rate is nan; it must be positive"},
      {[](FitOptions* o) { o->settling_weight = -3.0; },
       "--settling_weight is -3; it must be a number of at least 0"},
      {[](FitOptions* o) {
         o->horizons = {1, 0};
       },
       "horizons is [1,0]; it must be numbers of frames of at least 2"},
      {[](FitOptions* o) { o->max_iterations = 0; }, "--max_iterations is 0; it must be positive"},
      {[](FitOptions* o) {
         for (ParameterSpec& spec : o->table.specs) spec.free = false;
       },
       "every parameter is fixed: nothing is left to fit"},
  };
  std::string error;
  EXPECT_TRUE(MakePreset("tail").value().IsValid(&error)) << error;
  EXPECT_EQ(error, "");
  for (const Case& one : cases) {
    FitOptions options = MakePreset("tail").value();
    one.spoil(&options);
    EXPECT_FALSE(options.IsValid(&error)) << one.says;
    EXPECT_EQ(error, one.says);
  }
}

}  // namespace
}  // namespace pushid
