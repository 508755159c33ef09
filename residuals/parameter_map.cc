// residuals: block sizes and columns of a recording.
#include "residuals/parameter_map.h"

#include <algorithm>

namespace pushid {

BlockLayout::BlockLayout(const ParameterMap& map,
                         const std::vector<std::string>& unit_of_each_person, bool free_velocity)
    : free_initial_velocity(free_velocity),
      num_shared(map.num_shared()),
      num_deviations(map.num_deviations),
      num_weights(map.num_weights) {
  for (const std::string& unit : unit_of_each_person) {
    const auto found = std::find(units.begin(), units.end(), unit);
    unit_of_person.push_back(static_cast<int>(found - units.begin()));
    if (found == units.end()) units.push_back(unit);
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

int BlockLayout::DeviationColumn(int person) const {
  if (num_deviations == 0) return -1;
  return num_shared + unit_of_person[person] * num_deviations;
}

int BlockLayout::VelocityColumn() const {
  return free_initial_velocity ? num_columns() - num_weights - 4 * num_people() : -1;
}

int BlockLayout::WeightColumn() const { return num_weights > 0 ? num_columns() - num_weights : -1; }

}  // namespace pushid
