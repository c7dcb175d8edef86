#pragma once

#include <string>
#include <vector>

#include "results/probes/samples.hpp"
#include "results/probes/selection.hpp"
#include "results/snapshot.hpp"

namespace pliant {

/// How a quantity of scene/quantities.hpp is measured.
struct ProbeFunction {
  std::string name;
  Samples (*measure)(const Snapshot&, const Selection&);
  void (*finish)(std::vector<double>& row) = nullptr;  ///< what follows from means, not a mean itself
};

// One file a family: a new quantity is an entry there, and one under the same name in scene/quantities.cpp.
std::vector<ProbeFunction> motion_functions();
std::vector<ProbeFunction> force_functions();
std::vector<ProbeFunction> stress_functions();
std::vector<ProbeFunction> cell_functions();
std::vector<ProbeFunction> energy_functions();
std::vector<ProbeFunction> contact_functions();
std::vector<ProbeFunction> bond_functions();
std::vector<ProbeFunction> packing_functions();

const std::vector<ProbeFunction>& probe_functions();
/// Throws std::logic_error for a quantity without a function.
const ProbeFunction& probe_function(const std::string& quantity);

}  // namespace pliant
