// residuals: block sizes and columns of a recording.
#include "residuals/parameter_map.h"

#include <algorithm>

namespace pushid {

BlockLayout::BlockLayout(const ParameterMap& map,
                         const std::vector<std::string>& unit_of_each_person, bool free_velocity,
                         std::vector<std::vector<double>> covariates_of_each_person)
    : free_initial_velocity(free_velocity),
      num_shared(map.num_shared()),
      num_deviations(map.num_deviations),
      num_weights(map.num_weights),
      first_acting(1, 0),
      of_deviation(map.num_deviations, 0),
      covariates(std::move(covariates_of_each_person)) {
  for (const std::string& unit : unit_of_each_person) {
    const auto found = std::find(units.begin(), units.end(), unit);
    unit_of_person.push_back(static_cast<int>(found - units.begin()));
    if (found == units.end()) units.push_back(unit);
  }
  first_acting.reserve(map.fitted.size() + 1);
  for (size_t i = 0; i < map.fitted.size(); ++i) {
    const int deviation = num_deviations > 0 ? map.fitted[i].deviation : -1;
    if (deviation >= 0) of_deviation[deviation] = static_cast<int>(i);
    first_acting.push_back(first_acting.back() +
                           (deviation >= 0 ? static_cast<int>(units.size()) : 1));
  }
}

std::vector<int> BlockLayout::BlockSizes() const {
  std::vector<int> sizes = {num_shared};
  if (num_deviations > 0) sizes.insert(sizes.end(), units.size(), num_deviations);
  if (free_initial_velocity) sizes.push_back(4 * num_people());
  if (num_weights > 0) sizes.push_back(num_weights);
  return sizes;
}

int BlockLayout::num_columns() const {
  int columns = 0;
  for (int size : BlockSizes()) columns += size;
  return columns;
}

int BlockLayout::num_acting() const {
  return first_acting.back() + (free_initial_velocity ? 4 * num_people() : 0) + num_weights;
}

int BlockLayout::VelocityColumn() const { return free_initial_velocity ? first_acting.back() : -1; }

int BlockLayout::WeightColumn() const { return num_weights > 0 ? num_acting() - num_weights : -1; }

std::vector<ColumnEntry> BlockLayout::Entries(const ParameterMap& map,
                                              const ParameterSet<double>& set, int person) const {
  std::vector<ColumnEntry> entries = map.Entries(set, CovariatesOf(static_cast<size_t>(person)));
  for (ColumnEntry& entry : entries) {
    const size_t fitted = static_cast<size_t>(entry.column);
    const bool by_unit = num_deviations > 0 && map.fitted[fitted].deviation >= 0;
    entry.column = first_acting[fitted] + (by_unit ? unit_of_person[person] : 0);
  }
  return entries;
}

std::vector<std::pair<int, int>> BlockLayout::ActingOfColumns() const {
  std::vector<std::pair<int, int>> acting;
  for (int i = 0; i < num_shared; ++i)
    acting.emplace_back(first_acting[i], first_acting[i + 1] - 1);
  if (num_deviations > 0) {
    for (int unit = 0; unit < static_cast<int>(units.size()); ++unit) {
      for (int fitted : of_deviation) {
        acting.emplace_back(first_acting[fitted] + unit, first_acting[fitted] + unit);
      }
    }
  }
  for (int column = first_acting.back(); column < num_acting(); ++column) {
    acting.emplace_back(column, column);
  }
  return acting;
}

}  // namespace pushid
