#pragma once

#include <vector>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// A node of a part of an outline, and which of its two segments belong to the part.
struct PartNode {
  int node = 0;
  bool before = false, after = false;
};

/// A pressure on a part of one body's outline (docs/method.md 5). Parts are made of whole segments, each of which loads
/// its
/// two nodes by halves: on a whole outline that is the s_k of docs/method.md 2.
struct OutlinePressure {
  int body = 0;  ///< global index
  Window window;
  History pressure;             ///< Pa, positive: pushes
  std::vector<PartNode> nodes;  ///< in the order of the outline
  Points dead_load;             ///< [nodes], m: force per pressure, the same whatever the motion; empty: following
};

/// Springs and dashpots that tie a part of one compliant body's outline to where it was at the start, moved by
/// histories (docs/method.md 5).
struct OutlineSupport {
  int body = 0;  ///< global index
  Window window;
  std::vector<int> nodes;
  std::vector<double> length;  ///< [nodes], m of the part that a node stands for
  double stiffness = 0;        ///< Pa/m
  double damping = 0;          ///< Pa s/m
  Points start;                ///< [nodes], m
  Drive drive[2];              ///< x, y: fixed, free, velocity or displacement
};

}  // namespace pliant
