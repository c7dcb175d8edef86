#pragma once

#include <vector>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Node of a part of an outline, and whether its two segments belong to the part.
struct PartNode {
  int node = 0;
  bool before = false, after = false;
};

/// Pressure on a part of one body's outline (docs/method.md 5). Parts consist of whole segments, each of which loads
/// both of its nodes by halves: on a whole outline this gives the s_k of docs/method.md 2.
struct OutlinePressure {
  int body = 0;  ///< global index
  Window window;
  History pressure;             ///< Pa, positive in compression
  std::vector<PartNode> nodes;  ///< in the order of the outline
  Points dead_load;             ///< [nodes], m: force per pressure, independent of the motion; empty: following
};

/// Springs and dashpots that tie a part of one compliant body's outline to its initial position, which histories may
/// move (docs/method.md 5).
struct OutlineSupport {
  int body = 0;  ///< global index
  Window window;
  std::vector<int> nodes;
  std::vector<double> length;   ///< [nodes], m, tributary length of the node within the part
  double stiffness = 0;         ///< Pa/m
  double damping = 0;           ///< Pa s/m
  Points start;                 ///< [nodes], m
  AxisCondition prescribed[2];  ///< x, y: fixed, free, velocity or displacement
};

}  // namespace pliant
