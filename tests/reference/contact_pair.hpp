#pragma once

#include "reference/contact/contacts.hpp"
#include "support/contact_rig.hpp"

namespace pliant::testing {

/// The outlines of a model as the reference solver's contacts see them.
inline std::vector<reference::ContactOutline> reference_outlines(const Model& model) {
  std::vector<reference::ContactOutline> outlines;
  int first = 0;
  for (const Body& body : model.bodies) {
    const OutlineShape& shape = model.outlines[body.outline];
    const std::string name = body.wall ? body.name : model.scene.grains[body.grains].name;
    outlines.push_back({first, shape.count, shape.turn_shift, shape.points, model.scene.materials[body.material].name,
                        name, body.wall, body.kind});
    first += shape.count;
  }
  return outlines;
}

/// All outline nodes of a rig.
inline Points outline_points(const ContactRig& rig) {
  Points points;
  for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
    for (const Vec2& point : rig.outline(body)) points.push_back(point);
  return points;
}

}  // namespace pliant::testing
