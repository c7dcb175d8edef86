#include "benchmarks/baseline/from_model.hpp"

#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>
#include <variant>

#include "bodies/body_view.hpp"

namespace pliant::baseline {
namespace {

void add_tables(const Model& model, const pliant::Body& body, Body& to) {
  const Batch& batch = model.batches[body.batch];
  const Discretisation& space = model.shape_of(body).space;
  const IntegrationTable& table = space.table;
  const double s = body.scale;
  to.mu = batch.mu[body.lane], to.lambda = batch.lambda[body.lane];
  to.nodes.resize(space.mass_at_unit_density.size());
  for (std::size_t i = 0; i < to.nodes.size(); ++i) {
    to.nodes[i] = {};
    to.nodes[i].mass = space.mass_at_unit_density[i] * batch.density[body.lane];
    to.nodes[i].distance = s * space.nodal_distance[i];
  }
  to.points.resize(table.weight.size());
  for (std::size_t g = 0; g < to.points.size(); ++g) {
    to.points[g].weight = s * s * table.weight[g];
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      to.points[g].neighbours.push_back(table.node[e]);
      to.points[g].dphi_dx.push_back(table.gradient[e].x() / s);
      to.points[g].dphi_dy.push_back(table.gradient[e].y() / s);
    }
  }
  for (std::size_t k = 0; k < to.outline.size(); ++k)
    for (int e = space.outline_rows.start[k]; e < space.outline_rows.start[k + 1]; ++e) {
      to.outline[k].neighbours.push_back(space.outline_rows.node[e]);
      to.outline[k].phi.push_back(space.outline_rows.value[e]);
    }
}

ContactLaw plain(const pliant::ContactLaw& law) {
  ContactLaw result;
  if (const auto* l = std::get_if<Frictionless>(&law)) {
    result = {l->normal_stiffness, 0, l->reach, 0, 0, 0, 0};
  } else if (const auto* m = std::get_if<MohrCoulomb>(&law)) {
    result = {m->normal_stiffness, m->shear_stiffness, m->reach, m->friction, m->cohesion, 0, 0};
  } else if (const auto* c = std::get_if<Cohesive>(&law)) {
    result = {c->normal_stiffness, c->shear_stiffness, c->reach, 0, 0, c->strength, c->shear_strength};
  } else {
    throw std::invalid_argument("no plain version of this contact law");
  }
  return result;
}

}  // namespace

std::vector<Body> bodies_of(const Model& model, const Dofs& position) {
  std::vector<Body> bodies(model.bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const pliant::Body& body = model.bodies[b];
    const OutlineShape& outline = model.outlines[body.outline];
    bodies[b].rigid = body.kind == BodyKind::rigid;
    bodies[b].turn_shift = outline.turn_shift;
    bodies[b].outline.resize(static_cast<std::size_t>(outline.count));
    for (std::size_t k = 0; k < bodies[b].outline.size(); ++k) {
      OutlineNode& node = bodies[b].outline[k];
      node.fx = node.fy = 0;
      node.length = outline.tributary_length[k];
      node.reference_x = outline.points[k].x(), node.reference_y = outline.points[k].y();
    }
    if (!bodies[b].rigid) add_tables(model, body, bodies[b]);
  }
  move_to(model, position, bodies);
  return bodies;
}

void move_to(const Model& model, const Dofs& position, std::vector<Body>& bodies) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const pliant::Body& body = model.bodies[b];
    if (bodies[b].rigid) {
      const double* q = &position.rigid[3 * static_cast<std::size_t>(body.rigid)];
      bodies[b].x = q[0], bodies[b].y = q[1], bodies[b].angle = q[2];
      continue;
    }
    bodies[b].x = body.centre.x(), bodies[b].y = body.centre.y();
    const BodyView q(model, body, position);
    for (std::size_t i = 0; i < bodies[b].nodes.size(); ++i) {
      bodies[b].nodes[i].x = body.scale * q[i].x();
      bodies[b].nodes[i].y = body.scale * q[i].y();
    }
  }
}

Contact contact_of(const Model& model, const ContactSystem& contact, std::vector<Body>& bodies) {
  const LawTable& laws = contact.laws();
  std::map<std::pair<int, double>, int> numbers;  // by what laws depend on
  std::vector<int> one;                           // body of each group
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    const auto [group, fresh] = numbers.try_emplace({laws.group(b), laws.spacing(b)}, static_cast<int>(one.size()));
    if (fresh) one.push_back(b);
    bodies[b].group = group->second;
  }
  std::vector<std::vector<ContactLaw>> table(one.size());
  for (std::size_t p = 0; p < one.size(); ++p)
    for (const int other : one) {
      const bool may_meet = !model.bodies[one[p]].wall || !model.bodies[other].wall;
      table[p].push_back(may_meet ? plain(laws.between(one[p], other)) : ContactLaw());
    }
  return Contact(table, contact.skin(), model.scene.period.value_or(0));
}

}  // namespace pliant::baseline
