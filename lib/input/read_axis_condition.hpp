#pragma once

#include <string>
#include <vector>

#include "input/table_reader.hpp"

namespace pliant {

/// A history that can move an axis.
struct AxisConditionKind {
  std::string key;
  AxisCondition::Mode mode;
  bool damped = false;  ///< may have a dashpot beside it
};

/// "fixed", "free", or a table with one of the histories, its dashpot and its times; `otherwise` without the key.
AxisCondition read_axis_condition(TableReader& table, const std::string& axis,
                                  const std::vector<AxisConditionKind>& kinds, const AxisCondition& otherwise);

/// The keys `from` and `until`.
Window read_window(TableReader& table);

}  // namespace pliant
