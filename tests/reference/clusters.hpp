#pragma once

#include "reference/both.hpp"
#include "support/simulations.hpp"

/// Hexagonal clusters of discs of radius 1, the outermost ring pushed towards the centre.
namespace pliant::reference_tests {

inline bool is_outer(const Vec2& centre, int rings) { return centre.norm() > 2 * (rings - 0.5) * std::sqrt(3.0) / 2; }

/// [1 + 3 rings (rings + 1)] centres, nearly touching.
inline Points hexagonal_cluster(int rings) {
  Points centres;
  for (int i = -rings; i <= rings; ++i)
    for (int j = -rings; j <= rings; ++j)
      if (std::abs(i + j) <= rings) centres.emplace_back(2.0 * i + j, std::sqrt(3.0) * j);
  for (Vec2& centre : centres) centre *= 1.001;
  return centres;
}

/// The outermost grains move by a share of their distance towards the centre, until t = `ramp`: compliant ones by a
/// support of their outer half, rigid ones as a whole. `mixed`: every other grain is rigid, the one at the centre
/// compliant.
inline Scene pushed_cluster(int rings, int nodes, bool mixed, const ContactRule& rule, double share, double end,
                            double ramp = 20) {
  using namespace dynamics_tests;
  Scene scene = empty_scene(end);
  scene.shapes = {disc_shape("disc", 2, nodes)};
  scene.materials[0].mass_damping = scene.materials[1].mass_damping = 2;
  scene.contacts = {rule};
  int number = 0;
  for (const Vec2& centre : hexagonal_cluster(rings)) {
    const bool rigid = mixed && (number % 2 == 1) && centre.norm() > 0.1;
    const std::string name = "grain" + std::to_string(number++);
    scene.grains.push_back(grains(name, "disc", rigid ? BodyKind::rigid : BodyKind::compliant, {centre}));
    BoundaryCondition push;
    push.grains = name;
    push.kind = rigid ? BoundaryCondition::Kind::axes : BoundaryCondition::Kind::support;
    if (rigid) push.angle.mode = AxisCondition::Mode::fixed;
    if (!is_outer(centre, rings)) {
      if (!rigid) push.x.mode = push.y.mode = AxisCondition::Mode::fixed, push.stiffness = 0.3;
      scene.boundary.push_back(push);
      continue;
    }
    const Vec2 inward = -share * centre;
    AxisCondition* drives[2] = {&push.x, &push.y};
    for (int c = 0; c < 2; ++c) {
      drives[c]->mode = rigid ? AxisCondition::Mode::velocity : AxisCondition::Mode::displacement;
      drives[c]->history = rigid ? History{{0, ramp, ramp + 0.001}, {inward[c] / ramp, inward[c] / ramp, 0}}
                                 : History{{0, ramp}, {0, inward[c]}};
    }
    const double direction = std::atan2(centre.y(), centre.x());
    push.part = {.kind = OutlinePart::Kind::angles, .first = direction - 1.6, .second = direction + 1.6};
    scene.boundary.push_back(push);
  }
  return scene;
}

}  // namespace pliant::reference_tests
