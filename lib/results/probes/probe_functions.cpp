#include "results/probes/probe_functions.hpp"

#include <algorithm>
#include <stdexcept>

namespace pliant {

const std::vector<ProbeFunction>& probe_functions() {
  static const std::vector<ProbeFunction> all = [] {
    std::vector<ProbeFunction> result;
    for (const auto& part : {motion_functions(), force_functions(), stress_functions(), cell_functions(),
                             energy_functions(), contact_functions(), bond_functions(), packing_functions()})
      result.insert(result.end(), part.begin(), part.end());
    return result;
  }();
  return all;
}

const ProbeFunction& probe_function(const std::string& quantity) {
  const auto& all = probe_functions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ProbeFunction& f) { return f.name == quantity; });
  if (found == all.end()) throw std::logic_error("no function for the quantity '" + quantity + "'");
  return *found;
}

}  // namespace pliant
