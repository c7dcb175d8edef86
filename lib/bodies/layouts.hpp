#pragma once

#include <cstddef>
#include <vector>

#include "core/lanes.hpp"
#include "core/vec2.hpp"

namespace pliant {

/// Storage of the bodies of a batch in Dofs::compliant, whose entries come in slots of 8 nodes' x and their y
/// (docs/design.md 4):
/// shared: one body per lane, node i of each in slot i, all copies of one shape and so with one table;
/// same_topology: the same, for shapes with one mesh topology: one connectivity, values by lane;
/// nodewise: one body alone, its nodes over slots and lanes. It does not cost as much as eight, and threads share it.
enum class Layout { shared, same_topology, nodewise };

/// Nodal data of a batch by slots: one value for all lanes (double), or one per lane (Lanes).
template <class T>
struct NodeArrays {
  const T *mass_at_unit_density,
      *inverse_mass_at_unit_density;  ///< [slots], lumped mass at density 1, m2, and its inverse; both 0 in padding
  const T* nodal_distance;            ///< [slots], m
};

/// Part of a batch that one thread handles at once: the whole batch, or a range of a nodewise body.
struct Region {
  int batch = 0;
  int number = 0;           ///< within its batch
  int first = 0, last = 0;  ///< slots [first, last)
};

/// Range of a nodewise body's integration points, or of its outline nodes.
struct Chunk {
  int batch = 0;
  int first = 0, last = 0;
};

/// Vec2 for eight bodies.
struct LaneVector {
  Lanes components[2];
  const Lanes& x() const { return components[0]; }
  const Lanes& y() const { return components[1]; }
};

/// IntegrationTable for eight shapes: the neighbours of a point are those of all lanes' shapes together, with gradient
/// 0 where a shape has none.
struct LaneTable {
  std::vector<Lanes> weight;         ///< [points], m2
  std::vector<int> start;            ///< [points + 1]
  std::vector<int> node;             ///< [entries]
  std::vector<LaneVector> gradient;  ///< [entries], 1/m
};

/// ShapeRows for eight shapes, united likewise.
struct LaneRows {
  std::vector<int> start;    ///< [rows + 1]
  std::vector<int> node;     ///< [entries]
  std::vector<Lanes> value;  ///< [entries]
};

/// Shapes of one batches of one topology, members as in Discretisation; padding lanes repeat the last one.
struct SameTopologyShapes {
  std::vector<Lanes> mass_at_unit_density, inverse_mass_at_unit_density, nodal_distance;  ///< [nodes]
  LaneTable table;
  LaneRows outline_rows, node_rows, reciprocal_mass, relative_mass;
  Lanes reciprocal_mass_bound{};
};

/// Shape of nodewise bodies. Its tables are ordered so that neighbours in space are neighbours in memory: slots, points
/// and the threads' shares of them are patches of the body. An `offset` is the position of a node's x relative to the
/// batch's first entry, counted in doubles; y is lane_count further.
struct NodewiseShape {
  static constexpr int region_slots = 64;    ///< slots of a region: 512 nodes
  static constexpr int chunk_points = 1024;  ///< integration points of a chunk, a multiple of lane_count
  static constexpr int chunk_nodes = 128;    ///< outline nodes of a chunk

  std::vector<int> order;                                                 ///< [nodes] number of the n-th node in memory
  std::vector<int> offset;                                                ///< [nodes] of each node
  std::vector<Lanes> mass_at_unit_density, inverse_mass_at_unit_density;  ///< [slots]
  std::vector<Lanes> nodal_distance;                                      ///< [slots], m; 1 in padding

  std::vector<int> point_number;  ///< [points of the IntegrationTable], position of each in the following
  std::vector<double> weight;     ///< [points, whole lanes], m2; 0 in padding
  std::vector<int> start;         ///< [points, whole lanes, + 1], rows of the two following
  std::vector<int> node;          ///< [entries], offsets
  Points gradient;                ///< [entries], 1/m

  std::vector<int> node_start;  ///< [8 x slots + 1]: the same table by nodes, rows of the two following
  std::vector<int> point;       ///< [entries]
  Points node_gradient;         ///< [entries], 1/m

  /// Share of an outline node's force that a node receives.
  struct OutlineEntry {
    int node;     ///< offset
    int outline;  ///< number of the outline node
    double value;
  };
  std::vector<int> outline_start;             ///< [regions + 1], rows of the following
  std::vector<OutlineEntry> outline_entries;  ///< region by region

  int slots() const { return static_cast<int>(mass_at_unit_density.size()); }
  int points() const { return static_cast<int>(weight.size()); }
};

/// Offset of the number-th node in the order of a nodewise shape.
inline int offset_of(int number) { return number / lane_count * 2 * lane_count + number % lane_count; }

}  // namespace pliant
