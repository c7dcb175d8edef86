#include "bodies/nodewise_shape.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace pliant {
namespace {

/// Distributes the 16 bits of x over every second bit of the result.
std::uint32_t with_gaps(std::uint32_t x) {
  x = (x | x << 8) & 0x00ff00ffU;
  x = (x | x << 4) & 0x0f0f0f0fU;
  x = (x | x << 2) & 0x33333333U;
  return (x | x << 1) & 0x55555555U;
}

/// Numbers of the points in the order of a Z curve (Morton 1966), on which most neighbours in space are neighbours.
std::vector<int> spatial_order(const Points& points) {
  Vec2 low = points[0], high = points[0];
  for (const Vec2& x : points) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const double unit = 65535 / std::max((high - low).maxCoeff(), 1e-300);
  std::vector<std::uint32_t> key;
  for (const Vec2& x : points)
    key.push_back(with_gaps(static_cast<std::uint32_t>((x.x() - low.x()) * unit)) |
                  with_gaps(static_cast<std::uint32_t>((x.y() - low.y()) * unit)) << 1);
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key[a] < key[b]; });
  return order;
}

/// Centre of the triangles that each integration point represents.
Points point_positions(const Discretisation& space) {
  Points result;
  for (const std::array<int, 2>& cells : space.table.cells) {
    Vec2 sum(0, 0);
    for (int cell : cells)
      for (int corner : space.mesh.triangles[cell]) sum += space.mesh.nodes[corner];
    result.push_back(sum / 6);
  }
  return result;
}

void add_nodes(const Discretisation& space, NodewiseShape& shape) {
  const std::vector<int>& order = shape.order = spatial_order(space.mesh.nodes);
  const std::size_t nodes = order.size(), slots = (nodes + lane_count - 1) / lane_count;
  shape.offset.resize(nodes);
  shape.mass_at_unit_density.assign(slots, Lanes{});
  shape.inverse_mass_at_unit_density.assign(slots, Lanes{});
  shape.nodal_distance.assign(slots, broadcast(1));
  for (std::size_t n = 0; n < nodes; ++n) {
    const int node = order[n];
    shape.offset[node] = offset_of(static_cast<int>(n));
    shape.mass_at_unit_density[n / lane_count][n % lane_count] = space.mass_at_unit_density[node];
    shape.inverse_mass_at_unit_density[n / lane_count][n % lane_count] = 1 / space.mass_at_unit_density[node];
    shape.nodal_distance[n / lane_count][n % lane_count] = space.nodal_distance[node];
  }
}

/// Fills the tables by points. Padding points have weight 0 and the last point's gradients, so that their J is valid.
void add_points(const Discretisation& space, NodewiseShape& shape) {
  const IntegrationTable& table = space.table;
  std::vector<int> order = spatial_order(point_positions(space));
  const std::size_t points = order.size();
  shape.point_number.resize(points);
  for (std::size_t p = 0; p < points; ++p) shape.point_number[order[p]] = static_cast<int>(p);
  order.resize((points + lane_count - 1) / lane_count * lane_count, order.back());
  shape.start.push_back(0);
  for (std::size_t p = 0; p < order.size(); ++p) {
    const int g = order[p];
    shape.weight.push_back(p < points ? table.weight[g] : 0);
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      shape.node.push_back(shape.offset[table.node[e]]);
      shape.gradient.push_back(table.gradient[e]);
    }
    shape.start.push_back(static_cast<int>(shape.node.size()));
  }
}

/// Number, in the order of the shape, of the node at an offset.
int number_of(int offset) { return offset / (2 * lane_count) * lane_count + offset % lane_count; }

/// Fills the tables by nodes: each node's points in ascending order.
void transpose_points(NodewiseShape& shape) {
  std::vector<int>& start = shape.node_start;
  start.assign(static_cast<std::size_t>(lane_count * shape.slots()) + 1, 0);
  for (int offset : shape.node) ++start[number_of(offset) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next(start.begin(), start.end() - 1);
  shape.point.resize(shape.node.size());
  shape.node_gradient.resize(shape.node.size());
  for (int p = 0; p < shape.points(); ++p)
    for (int e = shape.start[p]; e < shape.start[p + 1]; ++e) {
      const int at = next[number_of(shape.node[e])]++;
      shape.point[at] = p;
      shape.node_gradient[at] = shape.gradient[e];
    }
}

void add_outline(const ShapeRows& rows, NodewiseShape& shape) {
  const auto region_of = [](const NodewiseShape::OutlineEntry& entry) {
    return number_of(entry.node) / (lane_count * NodewiseShape::region_slots);
  };
  for (int k = 0; k + 1 < static_cast<int>(rows.start.size()); ++k)
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      shape.outline_entries.push_back({shape.offset[rows.node[e]], k, rows.value[e]});
  std::stable_sort(shape.outline_entries.begin(), shape.outline_entries.end(),
                   [&](const auto& a, const auto& b) { return region_of(a) < region_of(b); });
  const int regions = (shape.slots() + NodewiseShape::region_slots - 1) / NodewiseShape::region_slots;
  shape.outline_start.assign(static_cast<std::size_t>(regions) + 1, 0);
  for (const NodewiseShape::OutlineEntry& entry : shape.outline_entries) ++shape.outline_start[region_of(entry) + 1];
  std::partial_sum(shape.outline_start.begin(), shape.outline_start.end(), shape.outline_start.begin());
}

}  // namespace

NodewiseShape make_nodewise_shape(const Discretisation& space) {
  NodewiseShape shape;
  add_nodes(space, shape);
  add_points(space, shape);
  transpose_points(shape);
  add_outline(space.outline_rows, shape);
  return shape;
}

}  // namespace pliant
