#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "benchmarks/baseline/bodies.hpp"

namespace pliant::baseline {

/// Frictionless: without shear stiffness. Mohr-Coulomb: without strength. Cohesive: with it.
struct ContactLaw {
  double normal_stiffness = 0, shear_stiffness = 0;  ///< Pa/m
  double reach = 0;                                  ///< largest gap with a traction, m
  double friction = 0, cohesion = 0;                 ///< cohesion: Pa
  double strength = 0, shear_strength = 0;           ///< Pa
};

/// Contact by lists: for each slave node the segments near, found with a skin; the closest point of each; a penalty and
/// stick-slip history in a hash map. All nodes are slaves of all other bodies with half of the force, which makes the
/// two passes of docs/method.md 4.
class Contact {
 public:
  /// `laws`: [groups][groups]. `period`: 0 without.
  Contact(std::vector<std::vector<ContactLaw>> laws, double skin, double period);

  void find_candidates(const std::vector<Body>& bodies);
  /// Sets the forces on outline nodes, and takes the slip since the last call for a step's.
  void forces(std::vector<Body>& bodies);

  int contacts() const { return contacts_; }  ///< nodes in touch with a body
  double candidates() const;                  ///< segments in all lists

 private:
  /// A segment of another body, which is to be shifted in x.
  struct Candidate {
    int body, segment;
    double shift;
  };
  /// Where a node was on a master.
  struct Slip {
    int segment;
    double xi, angle;  ///< angle: of the normal from that of the segment
    double slip;       ///< elastic, m
  };
  struct Segment {
    double ax, ay, bx, by, length, tx, ty;
  };
  struct Foot {
    int segment = -1;
    double shift = 0, square = 0;  ///< distance squared
    double xi = 0, height = 0, gap = 0, nx = 0, ny = 0, angle = 0;
  };

  static Segment segment_of(const Body& body, int segment, double shift);
  static void find_foot(const Body& master, const Candidate& candidate, const OutlineNode& node, Foot& best);
  static double way(const Body& master, const Slip& old, const Foot& now);
  int touch(std::vector<Body>& bodies, int slave, int node, int master, const Foot& foot);
  void list_segments(const std::vector<Body>& bodies, int slave, int master, double shift);

  std::vector<std::vector<ContactLaw>> laws_;
  double skin_, period_;
  int contacts_ = 0;
  std::vector<std::vector<std::vector<Candidate>>> candidates_;   ///< [bodies][nodes]
  std::vector<std::unordered_map<std::uint64_t, Slip>> history_;  ///< [bodies], by node and master
};

}  // namespace pliant::baseline
