#include "results/probes/selection.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "scene/quantities.hpp"

namespace pliant {
namespace {

bool is_of(const Model& model, const Body& body, const std::string& of) {
  if (body.name == of) return true;
  if (body.wall) return false;
  return of == "all" || of == (body.kind == BodyKind::compliant ? "compliant" : "rigid") ||
         model.scene.grains[body.grains].name == of;
}

int wall_of(const Model& model, const std::string& name) {
  const auto found =
      std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) { return b.wall && b.name == name; });
  return static_cast<int>(found - model.bodies.begin());
}

std::vector<int> lower_and_upper(const Model& model, const Probe& probe) {
  std::vector<int> walls;
  for (const std::string& name : probe.between) walls.push_back(wall_of(model, name));
  const auto lower = [&](int wall) { return model.outlines[model.bodies[wall].outline].turn_shift < 0; };
  if (!walls.empty() && !lower(walls[0])) std::swap(walls[0], walls[1]);
  return walls;
}

void check_node(const Model& model, const Probe& probe, const Body& body) {
  const bool field = probe_quantity(probe.quantity).node == ProbeQuantity::Node::field;
  const int nodes =
      field && body.kind == BodyKind::compliant ? model.shape_of(body).nodes() : model.outlines[body.outline].count;
  if (*probe.node < nodes) return;
  throw InputError(fmt::format("{}: 'node' of the probe '{}': found {}, allowed: 0 to {}, the {} nodes of '{}'",
                               model.scene.file.string(), probe.name, *probe.node, nodes - 1,
                               field ? "field" : "outline", body.name));
}

}  // namespace

Selection select(const Model& model, const Probe& probe) {
  const bool compliant_only = probe_quantity(probe.quantity).of == ProbeQuantity::Of::compliant;
  Selection selection;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const bool chosen = is_of(model, body, probe.of) && (!compliant_only || body.kind == BodyKind::compliant);
    if (chosen) selection.bodies.push_back(static_cast<int>(b));
    selection.chosen.push_back(chosen);
    selection.partners.push_back(probe.with.empty() || is_of(model, body, probe.with));
  }
  selection.node = probe.node;
  if (probe.node && !selection.bodies.empty()) check_node(model, probe, model.bodies[selection.bodies.front()]);
  selection.between = lower_and_upper(model, probe);
  selection.box = probe.box;
  return selection;
}

}  // namespace pliant
