#include "benchmarks/kernels/work.hpp"

#include <set>

namespace pliant::kernels {
namespace {

constexpr double number = sizeof(double), index = sizeof(int), vector = 2 * number;

template <class Count>
double over_compliant(const Model& model, Count&& count) {
  double total = 0;
  for (const Body& body : model.bodies)
    if (body.kind == BodyKind::compliant) total += static_cast<double>(count(model.shape_of(body), body));
  return total;
}

/// Bytes of the tables that a model's batches read in an evaluation, each once: those of a shared shape, those of each
/// body of one topology, with connectivity once a batch, those of nodewise ones.
template <class Own, class Common>
double table_bytes(const Model& model, Own&& own, Common&& common) {
  double bytes = 0;
  std::set<int> shared;
  for (const Batch& batch : model.batches) {
    const CompliantShape& shape = model.shape_of(batch);
    if (batch.layout == Layout::shared && !shared.insert(batch.shape).second) continue;
    bytes += common(shape) + (batch.layout == Layout::shared ? 1 : batch.count) * own(shape);
  }
  return bytes;
}

double entries(const ShapeRows& rows) { return static_cast<double>(rows.node.size()); }
double entries(const IntegrationTable& table) { return static_cast<double>(table.node.size()); }
double points(const IntegrationTable& table) { return static_cast<double>(table.weight.size()); }

double rigid_outline_nodes(const Model& model) {
  double count = 0;
  for (const RigidBody& rigid : model.rigid_bodies) count += model.outlines[rigid.outline].count;
  return count;
}

/// Bytes of the rows from nodes to outlines.
double outline_table_bytes(const Model& model) {
  return table_bytes(
      model, [](const CompliantShape& s) { return number * entries(s.space.outline_rows); },
      [](const CompliantShape& s) { return index * (entries(s.space.outline_rows) + 1.0); });
}

}  // namespace

double integration_points(const Model& model) {
  return over_compliant(model, [](const CompliantShape& s, const Body&) { return points(s.space.table); });
}
double field_nodes(const Model& model) {
  return over_compliant(model, [](const CompliantShape& s, const Body&) { return s.nodes(); });
}
double outline_nodes(const Model& model) {
  double count = 0;
  for (const Body& body : model.bodies) count += model.outlines[body.outline].count;
  return count;
}
double records(const ContactSystem& contact) {
  double count = 0;
  for (const ContactPair& contact_pair : contact.contact_pairs())
    count += contact_pair.nodes[0].count + contact_pair.nodes[1].count;
  return count;
}

namespace work {

/// A neighbour of a point: 4 fused operations for F and 4 for the forces. A point: the weighted neo-Hookean stress: 2
/// products of constants, 3 for J, 22 for ln J, 3 for (lambda ln J - mu)/J, 12 for P. A node: its place is read, its
/// force read and written. A table: gradients and nodes of the entries, weights and rows of the points. A nodewise
/// body's points stand in two orders, and hand on their stresses.
Work internal_forces(const Model& model) {
  const double of_entries =
      over_compliant(model, [](const CompliantShape& s, const Body&) { return 16 * entries(s.space.table); });
  const double nodewise = over_compliant(model, [&](const CompliantShape& s, const Body& body) {
    if (model.batches[body.batch].layout != Layout::nodewise) return 0.0;
    return entries(s.space.table) * (vector + index) + points(s.space.table) * 2 * 2 * vector;
  });
  return {
      of_entries + 42 * integration_points(model),
      3 * vector * field_nodes(model) + nodewise +
          table_bytes(
              model,
              [](const CompliantShape& s) { return vector * entries(s.space.table) + number * points(s.space.table); },
              [](const CompliantShape& s) { return index * (entries(s.space.table) + points(s.space.table)); })};
}

/// A row's entry: 2 fused operations. Nodes are read, outline nodes written; of rigid bodies the reference outline is
/// read: 8 flops a node.
Work place_outlines(const Model& model) {
  const double of_entries =
      over_compliant(model, [](const CompliantShape& s, const Body&) { return 4 * entries(s.space.outline_rows); });
  const double rigid = rigid_outline_nodes(model);
  return {of_entries + 8 * rigid,
          vector * (field_nodes(model) + outline_nodes(model) + rigid) + outline_table_bytes(model)};
}

/// The same the other way: outline forces are read, nodal forces read and written. Rigid bodies: also the outline, 6
/// flops a node.
Work gather_outline_forces(const Model& model) {
  const double of_entries =
      over_compliant(model, [](const CompliantShape& s, const Body&) { return 4 * entries(s.space.outline_rows); });
  const double rigid = rigid_outline_nodes(model);
  return {of_entries + 6 * rigid,
          vector * (2 * field_nodes(model) + outline_nodes(model) + rigid) + outline_table_bytes(model)};
}

/// A component of a node: the prediction x + dt v + (dt^2/2m) f, 5 flops, reads three vectors and writes one; the end
/// of the step v + (dt/2m) (f + f'), 5 flops, and the error |f - f'|/(m d), 3 and a sum, read three and write one.
/// Masses and distances are those of a shape.
Work update(const Model& model) {
  const double nodes = field_nodes(model);
  return {2 * nodes * (5 + 9), 8 * vector * nodes};
}

/// A segment of a window: 14 flops for length, tangent and bisector. A record: 4 flops at each bisector, and some 70
/// for the projection, the slip, the law, its force and the reaction; its place and slip are read and written.
/// Outlines and tributary lengths are read, forces on them written; buffers of the contact pairs are written and read.
Work contact_forces(const Model& model, const ContactSystem& contact) {
  Work work{0, outline_nodes(model) * (2 * vector + number)};
  for (const ContactPair& contact_pair : contact.contact_pairs())
    for (int side = 0; side < 2; ++side) {
      const double slaves = contact_pair.nodes[side].count, segments = contact_pair.segments[1 - side].count;
      if (slaves == 0) continue;
      work = work + Work{14 * segments + slaves * (4 * (segments + 1) + 70),
                         2 * vector * slaves + 2 * vector * contact_pair.forces(side).count};
    }
  return work;
}

/// A bond: 22 flops for its frame and the couple on it, and 73 at either end for the gap, the law and the traction. Its
/// nodes, constants and history are read, the history and eight numbers of forces are written, and these are gathered.
Work bond_forces(const BondSystem& bonds) {
  constexpr double constants = 14 + 7, nodes = 6, history = 6, forces = 8;
  return static_cast<double>(bonds.bonds().size()) *
         Work{22 + 2 * 73, number * (constants + nodes + 2 * history + 2 * forces) + nodes * vector};
}

}  // namespace work
}  // namespace pliant::kernels
