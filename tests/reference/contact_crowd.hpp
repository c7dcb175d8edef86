#pragma once

#include <cmath>
#include <vector>

#include "reference/contact_pair.hpp"

/// Several bodies in contact with each other and with walls, for comparisons of the engine with the reference solver.
namespace pliant::testing {

/// Discs and a square in a row across the period, on a wall with asperities or a flat one, two or three bodies
/// overlapping each other.
inline Scene crowd(Random& random, const std::vector<ContactRule>& rules, bool asperities) {
  Scene scene = nodal_scene();
  scene.contact.energy_consistent = false;  // the reference solver has no energy correction
  scene.contacts = rules;
  scene.materials.push_back({"softer", MaterialLaw::neo_hookean, 1, 0.7, 0.4});
  scene.period = 4.45;
  scene.skin = 1;  // so that no state asks for new candidates: the engine finds them at accepted states only
  const double turn = random.uniform(0, 6), x = random.uniform(-20, 20), y = asperities ? 0.99 : 0.79;
  add_body(scene, polygonal_disc("disc", 1.6, 30, 60), BodyKind::compliant, {x, y}, turn);
  add_body(scene, outline_shape("square", rectangle(1.3, 1.3, 0.13)), BodyKind::rigid, {x + 1.46, y - 0.13},
           random.uniform(-0.01, 0.01));
  add_body(scene, outline_shape("disc", regular(37, 0.8)), BodyKind::rigid, {x + 2.9, y}, -turn);
  // In the gap above: overlaps the discs, one of them across the period.
  add_grain(scene, "shape0", BodyKind::compliant, {x - 0.775, y + 1.15}, 2 * turn, "softer");
  scene.grains.back().size.factors = {0.75};
  scene.walls = {flat_wall("floor", Wall::Solid::below, asperities ? -0.26 : 0.0, 0.15),
                 flat_wall("lid", Wall::Solid::above, y + 1.745, 0.11)};
  if (asperities) scene.walls[0].asperities = Asperities{0.9, 4, 0.2, {0, 0.02}, {0.8, 0.5}};
  return scene;
}

/// A disc, or a block whose floor has more nodes beneath it than the period, pressed against its image.
inline Scene lone_body(Random& random, BodyKind kind, const ContactRule& rule) {
  Scene scene = nodal_scene();
  scene.contact.energy_consistent = false;  // the reference solver has no energy correction
  scene.contacts = {rule};
  scene.skin = 1;  // so that no state asks for new candidates: the engine finds them at accepted states only
  const double x = random.uniform(-20, 20);
  if (random.below(2) == 0) {
    scene.period = 1.57;
    add_body(scene, polygonal_disc("", 1.6, 30, 60), kind, {x, 0.79}, random.uniform(0, 6));
  } else {
    scene.period = 1.29;
    add_body(scene, outline_shape("", rectangle(1.3, 0.65, 0.13), 70), kind, {x, 0.32}, random.uniform(-0.01, 0.01));
  }
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.1)};
  return scene;
}

/// Moves and deforms all bodies by that much, m.
inline void stir(ContactRig& rig, Random& random, double size) {
  const auto by = [&] { return random.uniform(-size, size); };
  for (std::size_t b = 0; b < rig.model.bodies.size(); ++b) {
    rig.move(static_cast<int>(b), {by(), by() / 2});
    if (rig.model.bodies[b].kind == BodyKind::rigid && !rig.model.bodies[b].wall) rig.turn(static_cast<int>(b), by());
  }
  for (const Batch& batch : rig.model.batches)
    for (int i = 0; i < 2 * rig.model.shape_of(batch).nodes(); ++i)
      for (int lane = 0; lane < batch.count; ++lane) rig.q.compliant[batch.offset + i][lane] += by() / 8;
}

}  // namespace pliant::testing
