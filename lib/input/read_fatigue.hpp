#pragma once

#include "input/table_reader.hpp"

namespace pliant {

/// Keys of fatigue of a contact rule or a bond rule, after its `strength`. The threshold holds in shear too, in the
/// ratio of the strengths.
template <class Rule>
void read_fatigue(TableReader& table, Rule& rule) {
  const bool grows = table.optional("fatigue_rate", rule.fatigue_rate);
  rule.shear_fatigue_rate = rule.fatigue_rate;
  const bool grows_in_shear = table.optional("shear_fatigue_rate", rule.shear_fatigue_rate);
  const Range below_strength{.low = 0, .high = rule.strength, .high_open = true};
  if (grows || grows_in_shear)
    table.required("fatigue_threshold", rule.fatigue_threshold, below_strength);
  else
    table.optional("fatigue_threshold", rule.fatigue_threshold, below_strength);
}

}  // namespace pliant
