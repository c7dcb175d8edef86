#pragma once

#include <cstddef>
#include <vector>

#include "core/lanes.hpp"
#include "core/vec2.hpp"

namespace pliant {

/// How the bodies of a batch stand in Dofs::compliant, whose entries come in slots of 8 nodes' x and their y
/// (docs/design.md 4):
/// shared: one body a lane, node i of each in slot i, all copies of one shape and so of one table;
/// related: the same, of shapes with one mesh topology: one connectivity, values by lane;
/// spread: one body alone, its nodes over slots and lanes: its cost is not that of eight, and threads share it.
enum class Layout { shared, related, spread };

/// What the nodes of a batch have, slot by slot: one value for all lanes (double), or one a lane (Lanes).
template <class T>
struct NodeArrays {
  const T *mass_at_unit_density,
      *inverse_mass_at_unit_density;  ///< [slots], lumped mass at density 1, m2, and its inverse; both 0 in padding
  const T* nodal_distance;            ///< [slots], m
};

/// A part of a batch that one thread handles at once: the whole batch, or a stretch of a spread body.
struct Region {
  int batch = 0;
  int number = 0;           ///< within its batch
  int first = 0, last = 0;  ///< slots [first, last)
};

/// A stretch of a spread body's integration points, or of its outline nodes.
struct Chunk {
  int batch = 0;
  int first = 0, last = 0;
};

/// As Vec2, of eight bodies.
struct LaneVector {
  Lanes components[2];
  const Lanes& x() const { return components[0]; }
  const Lanes& y() const { return components[1]; }
};

/// As IntegrationTable: the neighbours of a point are those of all lanes' shapes together, with gradient 0 where a
/// shape has none.
struct LaneTable {
  std::vector<Lanes> weight;         ///< [points], m2
  std::vector<int> start;            ///< [points + 1]
  std::vector<int> node;             ///< [entries]
  std::vector<LaneVector> gradient;  ///< [entries], 1/m
};

/// ShapeRows of all lanes' shapes together, in the same way.
struct LaneRows {
  std::vector<int> start;    ///< [rows + 1]
  std::vector<int> node;     ///< [entries]
  std::vector<Lanes> value;  ///< [entries]
};

/// The shapes of one batch of related bodies, members as Discretisation's; padding lanes repeat the last one.
struct RelatedShapes {
  std::vector<Lanes> mass_at_unit_density, inverse_mass_at_unit_density, nodal_distance;  ///< [nodes]
  LaneTable table;
  LaneRows outline_rows, node_rows, mass_correction;
  Lanes correction_bound{}, weight_share{};
};

/// A shape whose bodies are spread: tables in an order in which neighbours in space are neighbours in memory, so that
/// slots, points and the threads' shares of them are patches of the body. An `offset` is where x of a node stands from
/// the batch's first entry, counted in doubles; y stands lane_count further.
struct SpreadShape {
  static constexpr int region_slots = 64;    ///< slots of a region: 512 nodes
  static constexpr int chunk_points = 1024;  ///< integration points of a chunk, a multiple of lane_count
  static constexpr int chunk_nodes = 128;    ///< outline nodes of a chunk

  std::vector<int> order;   ///< [nodes], the node that is the n-th in memory
  std::vector<int> offset;  ///< [nodes], of each node
  std::vector<Lanes> mass_at_unit_density, inverse_mass_at_unit_density;  ///< [slots]
  std::vector<Lanes> nodal_distance;                                      ///< [slots], m; 1 in padding

  std::vector<int> point_number;  ///< [points of the IntegrationTable], where each stands among the following
  std::vector<double> weight;     ///< [points, whole lanes], m2; 0 in padding
  std::vector<int> start;         ///< [points, whole lanes, + 1], rows of the two following
  std::vector<int> node;          ///< [entries], offsets
  Points gradient;                ///< [entries], 1/m

  std::vector<int> node_start;  ///< [8 x slots + 1]: the same table by nodes, rows of the two following
  std::vector<int> point;       ///< [entries]
  Points node_gradient;         ///< [entries], 1/m

  /// Share of an outline node's force that goes to a node.
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

/// Offset of the number-th node in the order of a spread shape.
inline int offset_of(int number) { return number / lane_count * 2 * lane_count + number % lane_count; }

}  // namespace pliant
