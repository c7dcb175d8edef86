#pragma once

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "contact/contact.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant::testing {

/// A model, where its bodies are, and their contacts: what a step does with them, without dynamics.
class ContactRig {
 public:
  explicit ContactRig(const Scene& scene) : model(build_model(scene)), q(initial_positions(model)), contact(model) {
    show();
  }
  ContactRig(const ContactRig&) = delete;

  void show() { update_outlines(model, {q, q, 0}, outlines); }
  /// Forces at the positions q. Returns whether the candidates were searched anew. Without energy correction it is the
  /// end of a step from the last accepted evaluation.
  bool evaluate() {
    show();
    const bool hold = contact.candidates_hold(outlines.position);
    if (!hold) contact.renew_candidates(outlines, committed);
    const StepStart start{accepted_outlines, 1};
    const bool is_step = !accepted_outlines.x.empty() && !model.scene.corrects_energy();
    totals = contact.forces(outlines, committed, trial, forces, is_step ? &start : nullptr);
    return !hold;
  }
  /// Searches the candidates anew, whether needed or not.
  void refresh() {
    show();
    contact.find_candidates(outlines, committed);
  }
  /// Accepts the last evaluation.
  void commit() {
    std::swap(committed, trial);
    accepted_outlines = outlines.position;
    dissipated += totals.dissipated;
  }
  void step() {
    evaluate();
    commit();
  }

  int count(int body) const { return model.outlines[model.bodies[body].outline].count; }
  Vec2 node(int body, int k) const { return outlines.position.at(model.outline_offset[body] + k); }
  Vec2 force(int body, int k) const { return forces.at(model.outline_offset[body] + k); }
  Vec2 force(int body) const {
    Vec2 sum(0, 0);
    for (int k = 0; k < count(body); ++k) sum += force(body, k);
    return sum;
  }
  Points outline(int body) const {
    Points points;
    for (int k = 0; k < count(body); ++k) points.push_back(node(body, k));
    return points;
  }
  /// x, y, angle of a rigid body.
  double* rigid(int body) { return &q.rigid[3 * model.bodies[body].rigid]; }
  void move(int body, const Vec2& by) {
    const Body& b = model.bodies[body];
    if (b.kind == BodyKind::rigid) {
      rigid(body)[0] += by.x(), rigid(body)[1] += by.y();
      return;
    }
    const Batch& batch = model.batches[b.batch];
    for (int i = 0; i < model.shape_of(batch).nodes(); ++i) {
      q.compliant[batch.offset + 2 * i][b.lane] += by.x();
      q.compliant[batch.offset + 2 * i + 1][b.lane] += by.y();
    }
  }
  void turn(int body, double angle) { rigid(body)[2] += angle; }

  /// Contact forces on all degrees of freedom.
  Dofs dof_forces() const {
    Dofs f = zero_dofs(model);
    for (const Region& region : model.regions)
      add_outline_forces(model, region, forces, &f.compliant[model.batches[region.batch].offset]);
    for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
      outline_force_resultant(model, model.rigid_bodies[r], outlines.position, forces, &q.rigid[3 * r],
                              &f.rigid[3 * r]);
    return f;
  }

  Model model;
  Dofs q;
  Outlines outlines;
  OutlineField forces, accepted_outlines;
  ContactSystem contact;
  ContactHistory committed, trial;
  PairTotals totals;
  double dissipated = 0;
};

/// Whether two intervals have at most a margin between them.
inline bool overlap(double a_min, double a_max, double b_min, double b_max, double margin) {
  return a_min <= b_max + margin && b_min <= a_max + margin;
}

/// A random body of one of the kinds that contact has to cope with; its size is about 1.
inline Points random_outline(Random& random, int kind) {
  switch (kind) {
    case 0: {
      const int count = 5 + random.below(40);
      return random_convex(random, count, 1, random.uniform(0.4, 1));
    }
    case 1:
      return refined(random_star(random, 5 + random.below(8), 0.35), 0.15);  // sharp and re-entrant corners
    case 2:
      return refined(random_convex(random, 12, 1.2, 0.15), 0.12);  // flat
    case 3:
      return refined({{-1, 0}, {1, -0.25}, {1.1, 0.25}}, 0.1);  // a wedge of 27 degrees
    default: {
      const int count = 24 + random.below(30);
      return regular(count, 0.8, random.uniform(0, 1));
    }
  }
}

/// A rigid body of random outline, turned at random.
inline void add_random_body(Scene& scene, Random& random, int kind) {
  const Points outline = random_outline(random, kind);
  add_body(scene, outline_shape("outline", outline), BodyKind::rigid, {0, 0}, random.uniform(0, 6));
}

/// Puts body 1 beside body 0 in a random direction, with its outermost node on the line of approach `depth` inside.
inline void press_together(ContactRig& rig, Random& random, double depth) {
  const double direction = random.uniform(0, 2 * M_PI);
  const Vec2 d(std::cos(direction), std::sin(direction));
  rig.move(1, 4 * d);
  rig.show();
  double gap = 1e300;
  // Distance along d of each node of one to the segments of the other.
  const auto cast = [&](const Points& from, const Points& to, const Vec2& along) {
    for (const Vec2& p : from)
      for (std::size_t i = 0; i < to.size(); ++i) {
        const Vec2 a = to[i], b = to[(i + 1) % to.size()], edge = b - a;
        const double det = cross(along, edge), t = cross(a - p, edge) / det, s = cross(a - p, along) / det;
        if (s >= 0 && s <= 1 && t > 0) gap = std::min(gap, t);
      }
  };
  cast(rig.outline(1), rig.outline(0), -d);
  cast(rig.outline(0), rig.outline(1), d);
  rig.move(1, -(gap < 1e300 ? gap + depth : 4) * d);
  rig.show();
}

}  // namespace pliant::testing
