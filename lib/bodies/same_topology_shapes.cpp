#include "bodies/same_topology_shapes.hpp"

#include <map>

namespace pliant {
namespace {

using Shapes = const Discretisation* const (&)[lane_count];

/// Unites one row of neighbours from those of each lane; `add` copies entry e of a lane's arrays to a node's united
/// entry.
template <class Entry, class Rows, class Add>
void unite_row(const Rows* const (&rows)[lane_count], int row, std::vector<int>& node, std::vector<Entry>& entries,
               Add&& add) {
  std::map<int, Entry> united;
  for (int lane = 0; lane < lane_count; ++lane)
    for (int e = rows[lane]->start[row]; e < rows[lane]->start[row + 1]; ++e) add(united[rows[lane]->node[e]], lane, e);
  for (const auto& [number, entry] : united) {
    node.push_back(number);
    entries.push_back(entry);
  }
}

LaneTable unite_tables(Shapes shapes) {
  const IntegrationTable* tables[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) tables[lane] = &shapes[lane]->table;
  LaneTable result;
  result.start.push_back(0);
  for (int point = 0; point < static_cast<int>(tables[0]->weight.size()); ++point) {
    Lanes weight;
    for (int lane = 0; lane < lane_count; ++lane) weight[lane] = tables[lane]->weight[point];
    result.weight.push_back(weight);
    unite_row(tables, point, result.node, result.gradient, [&](LaneVector& entry, int lane, int e) {
      entry.components[0][lane] = tables[lane]->gradient[e].x();
      entry.components[1][lane] = tables[lane]->gradient[e].y();
    });
    result.start.push_back(static_cast<int>(result.node.size()));
  }
  return result;
}

LaneRows unite_rows(Shapes shapes, ShapeRows Discretisation::* member) {
  const ShapeRows* rows[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) rows[lane] = &(shapes[lane]->*member);
  LaneRows result;
  result.start.push_back(0);
  for (int row = 0; row + 1 < static_cast<int>(rows[0]->start.size()); ++row) {
    unite_row(rows, row, result.node, result.value,
              [&](Lanes& value, int lane, int e) { value[lane] = rows[lane]->value[e]; });
    result.start.push_back(static_cast<int>(result.node.size()));
  }
  return result;
}

}  // namespace

SameTopologyShapes unite(Shapes shapes) {
  SameTopologyShapes result;
  const std::size_t nodes = shapes[0]->mass_at_unit_density.size();
  result.mass_at_unit_density.resize(nodes), result.inverse_mass_at_unit_density.resize(nodes),
      result.nodal_distance.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i)
    for (int lane = 0; lane < lane_count; ++lane) {
      result.mass_at_unit_density[i][lane] = shapes[lane]->mass_at_unit_density[i];
      result.inverse_mass_at_unit_density[i][lane] = 1 / shapes[lane]->mass_at_unit_density[i];
      result.nodal_distance[i][lane] = shapes[lane]->nodal_distance[i];
    }
  for (int lane = 0; lane < lane_count; ++lane)
    result.reciprocal_mass_bound[lane] = shapes[lane]->reciprocal_mass_bound;
  result.table = unite_tables(shapes);
  result.outline_rows = unite_rows(shapes, &Discretisation::outline_rows);
  result.node_rows = unite_rows(shapes, &Discretisation::node_rows);
  result.reciprocal_mass = unite_rows(shapes, &Discretisation::reciprocal_mass);
  result.relative_mass = unite_rows(shapes, &Discretisation::relative_mass);
  return result;
}

}  // namespace pliant
