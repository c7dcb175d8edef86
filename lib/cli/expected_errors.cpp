#include "cli/expected_errors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "cli/measured_errors.hpp"

namespace pliant {
namespace {

double between(std::span<const double> errors, int nodes) {
  const auto above = std::ranges::find_if(measured_nodes, [&](int n) { return n >= nodes; });
  if (above == std::begin(measured_nodes)) return errors.front();
  if (above == std::end(measured_nodes)) return errors.back();
  const std::ptrdiff_t next = above - std::begin(measured_nodes);
  const double share = std::log(static_cast<double>(nodes) / measured_nodes[next - 1]) /
                       std::log(static_cast<double>(measured_nodes[next]) / measured_nodes[next - 1]);
  return errors[next - 1] * std::pow(errors[next] / errors[next - 1], share);
}

/// "about", or what is sure of sizes beyond those measured.
const char* likeness(int nodes) {
  return nodes < *std::begin(measured_nodes) ? "over" : nodes > *std::rbegin(measured_nodes) ? "under" : "about";
}

/// Nodes of the coarsest shape; 0 without compliant grains.
int fewest_nodes(const Model& model) {
  int fewest = 0;
  for (const CompliantShape& shape : model.shapes)
    if (fewest == 0 || shape.nodes() < fewest) fewest = shape.nodes();
  return fewest;
}

}  // namespace

std::optional<ExpectedErrors> expected_errors(DiscretisationMethod method, Mass mass, int nodes) {
  const auto known = std::ranges::find_if(
      measured_errors, [&](const MeasuredErrors& m) { return m.method == method && m.mass == mass; });
  if (known == std::end(measured_errors)) return {};
  return ExpectedErrors{between(known->oscillation, nodes), between(known->plates, nodes),
                        between(known->impact, nodes)};
}

std::string describe_expected_errors(const Model& model) {
  const DiscretisationSettings& chosen = model.scene.discretisation;
  const int nodes = fewest_nodes(model);
  const auto errors = expected_errors(chosen.method, chosen.mass, nodes);
  if (nodes == 0 || !errors || chosen.mass_scaling > 1) return {};  // measured without mass scaling
  std::string text = fmt::format(
      "discs of {} nodes were off by {} {:.2g} % of their swing after three periods, {:.2g} % of the force when "
      "squeezed "
      "to 30 %, {:.2g} % of their speed in a fast bounce (docs/defaults.md, \"Method, mass and nodes\")",
      nodes, likeness(nodes), 100 * errors->oscillation, 100 * errors->plates, 100 * errors->impact);
  if (const auto corrected = expected_errors(chosen.method, Mass::corrected, nodes);
      chosen.mass == Mass::lumped && !model.scene.cell && corrected->oscillation < 0.5 * errors->oscillation)
    text +=
        fmt::format("; with mass = \"corrected\" by {:.2g}, {:.2g} and {:.2g} %, for a quarter to a third more steps",
                    100 * corrected->oscillation, 100 * corrected->plates, 100 * corrected->impact);
  return text;
}

}  // namespace pliant
