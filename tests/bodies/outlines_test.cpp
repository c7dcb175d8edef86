#include <gtest/gtest.h>

#include <cmath>

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

// Lengths of a closed or a periodic polyline, and of its copies behind the end.
void expect_lengths(const OutlineShape& shape) {
  const int n = shape.count;
  const auto point = [&](int i) {
    return Vec2(shape.points[(i + n) % n] + Vec2(shape.turn_shift * ((i + n) / n - 1), 0));
  };
  double perimeter = 0;
  for (int i = 0; i < n + lane_count; ++i) {
    const double after = (point(i + 1) - point(i)).norm(), before = (point(i) - point(i - 1)).norm();
    EXPECT_NEAR(shape.tributary_length[i], (before + after) / 2, 1e-14);
    if (i < n) perimeter += after;
  }
  EXPECT_NEAR(shape.spacing, perimeter / n, 1e-15);
}

// EXACT. The triangle has fewer nodes than there are lanes.
TEST(OutlineShape, Lengths) {
  Random random(1);
  expect_lengths(make_outline_shape({{0, 0}, {2, 0}, {0.3, 1}}, 0));
  expect_lengths(make_outline_shape(random_star(random, 17, 0.4), 0));
  expect_lengths(make_outline_shape({{0, 0}, {1, 0.3}, {2.5, 0.1}}, 3));
  expect_lengths(make_outline_shape({{3, 0}, {2, 0.3}, {1, 0}, {0.5, 0.1}}, -3));
}

// EXACT.
TEST(OutlineShape, TurnsAreFloorDivision) {
  for (int count : {1, 3, 10})
    for (int index = -25; index <= 25; ++index) {
      const int turn = turn_of(index, count);
      EXPECT_LE(turn * count, index);
      EXPECT_GT((turn + 1) * count, index);
    }
}

Scene scene_of_all_kinds() {
  Scene scene = bare_scene();
  scene.period = 6;
  scene.contacts = {frictionless(1)};
  scene.shapes = {polygonal_disc("disc", 1, 24, 50), outline_shape("triangle", {{0, 0}, {1, 0}, {0, 0.8}})};
  for (int i = 0; i < 9; ++i) add_grain(scene, "disc", BodyKind::compliant, {0.6 * i, 2.0 + i}, 0.3 * i);
  add_grain(scene, "triangle", BodyKind::rigid, {3, 20}, 0.7);
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.2), flat_wall("lid", Wall::Solid::above, 30, 0.2)};
  return scene;
}

struct Moved {
  Model model = build_model(scene_of_all_kinds());
  Dofs q = initial_positions(model);
  OutlineField place, force;

  Moved() {
    Random random(5);
    for (Lanes& value : q.compliant)
      for (int lane = 0; lane < lane_count; ++lane) value[lane] += random.uniform(-0.1, 0.1);
    for (double& value : q.rigid) value += random.uniform(-1, 1);
    q.rigid[5] = q.rigid[8] = 0;  // walls do not turn
    place = placed_outlines(model, q);
    force = OutlineField(model.outline_offset.back());
  }
  Vec2 node(int body, int k) const { return place.at(model.outline_offset[body] + k); }
};

// EXACT: sum of phi_i(x_k) q_i plus the centre, for each lane.
TEST(PlaceOutlines, CompliantBodiesFollowTheirShapeFunctions) {
  const Moved moved;
  const ShapeRows& rows = moved.model.shapes[0].space.outline_rows;
  for (int body = 0; body < 9; ++body) {
    const Body& b = moved.model.bodies[body];
    const Batch& batch = moved.model.batches[b.batch];
    for (int k = 0; k < 24; ++k) {
      Vec2 x = b.centre;
      for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
        const std::size_t at = batch.offset + 2 * rows.node[e];
        x += rows.value[e] * Vec2(moved.q.compliant[at][b.lane], moved.q.compliant[at + 1][b.lane]);
      }
      EXPECT_LT((moved.node(body, k) - x).norm(), 1e-14);
    }
  }
}

// EXACT: rotation about the centroid and translation; walls only move.
TEST(PlaceOutlines, RigidBodiesTurnAndMove) {
  const Moved moved;
  for (std::size_t r = 0; r < moved.model.rigid_bodies.size(); ++r) {
    const RigidBody& rigid = moved.model.rigid_bodies[r];
    const double* q = &moved.q.rigid[3 * r];
    const Points& points = moved.model.outlines[rigid.outline].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec2 turned(std::cos(q[2]) * points[k].x() - std::sin(q[2]) * points[k].y(),
                        std::sin(q[2]) * points[k].x() + std::cos(q[2]) * points[k].y());
      EXPECT_LT((moved.node(rigid.body, static_cast<int>(k)) - turned - Vec2(q[0], q[1])).norm(), 1e-14);
    }
  }
}

// EXACT: at rest outlines of both kinds are the turned reference outlines (linear reproduction of the shape functions:
// 1e-12).
TEST(PlaceOutlines, AtRestBothKindsShowTheReferenceOutline) {
  const Model model = build_model(scene_of_all_kinds());
  const OutlineField place = placed_outlines(model, initial_positions(model));
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Points& points = model.outlines[body.outline].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double c = std::cos(body.angle), s = std::sin(body.angle);
      const Vec2 x = body.centre + Vec2(c * points[k].x() - s * points[k].y(), s * points[k].x() + c * points[k].y());
      EXPECT_NEAR(place.x[model.outline_offset[b] + k], x.x(), 1e-12);
      EXPECT_NEAR(place.y[model.outline_offset[b] + k], x.y(), 1e-12);
    }
  }
}

// EXACT: copies behind the last node; on a wall a turn further.
TEST(PlaceOutlines, CopiesContinueTheOutline) {
  const Moved moved;
  for (std::size_t b = 0; b < moved.model.bodies.size(); ++b) {
    const OutlineShape& shape = moved.model.outlines[moved.model.bodies[b].outline];
    for (int i = 0; i < lane_count; ++i) {
      const Vec2 expected =
          moved.node(static_cast<int>(b), i % shape.count) + Vec2(shape.turn_shift * (1 + i / shape.count), 0);
      EXPECT_LT((moved.node(static_cast<int>(b), shape.count + i) - expected).norm(), 1e-14);
    }
  }
}

// EXACT: forces go to the degrees of freedom by the transpose of what moves the outline: equal virtual power for any
// velocities.
TEST(OutlineForces, HaveThePowerOfTheOutline) {
  Moved moved;
  Random random(8);
  for (std::size_t b = 0; b < moved.model.bodies.size(); ++b)
    for (int k = 0; k < moved.model.outlines[moved.model.bodies[b].outline].count; ++k) {  // copies carry no force
      moved.force.x[moved.model.outline_offset[b] + k] = random.uniform(-1, 1);
      moved.force.y[moved.model.outline_offset[b] + k] = random.uniform(-1, 1);
    }
  for (std::size_t b = 0; b < moved.model.bodies.size(); ++b) {
    const Body& body = moved.model.bodies[b];
    Dofs there = moved.q, force = zero_dofs(moved.model);
    double power = 0;
    const auto move = [&](double& q, double f) {
      const double rate = random.uniform(-1, 1);
      q += 1e-6 * rate;
      power += rate * f;
    };
    if (body.kind == BodyKind::compliant) {
      const Batch& batch = moved.model.batches[body.batch];
      add_outline_forces(moved.model, moved.model.regions[body.batch], moved.force, &force.compliant[batch.offset]);
      for (std::size_t i = batch.offset; i < batch.offset + 100; ++i) {
        double q = there.compliant[i][body.lane];
        move(q, force.compliant[i][body.lane]);
        there.compliant[i][body.lane] = q;
      }
    } else {
      double* f = &force.rigid[3 * body.rigid];
      outline_force_resultant(moved.model, moved.model.rigid_bodies[body.rigid], moved.place, moved.force,
                              &there.rigid[3 * body.rigid], f);
      for (int c = 0; c < 3; ++c) move(there.rigid[3 * body.rigid + c], f[c]);
    }
    const OutlineField after = placed_outlines(moved.model, there);
    double expected = 0;
    for (int i = moved.model.outline_offset[b]; i < moved.model.outline_end(static_cast<int>(b)); ++i)
      expected += (after.at(i) - moved.place.at(i)).dot(moved.force.at(i)) / 1e-6;
    // One-sided differences: 1e-6 of the rotation's second derivative, times up to 30 forces; rounding 30 x 1e-16/1e-6
    // x 100 nodes.
    EXPECT_NEAR(power, expected, 2e-5) << body.name;
  }
}

}  // namespace
}  // namespace pliant
