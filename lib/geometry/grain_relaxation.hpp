#pragma once

#include <vector>

#include "geometry/distance_field.hpp"
#include "geometry/fire.hpp"
#include "geometry/placement.hpp"
#include "geometry/wall_profile.hpp"

namespace pliant {

/// Relaxation of grains that repel each other and the edges of their region within a small clearance, so that they move
/// into gaps until no two overlap. Penalties act between the nodes of one outline and the signed distance from the
/// other; FIRE seeks the minimum (E. Bitzek et al., Phys. Rev. Lett. 97 (2006) 170201). Results are bitwise equal on
/// any number of threads. Internal lengths are in units of the mean radius of the circles around the grains.
class GrainRelaxation {
 public:
  /// `grains`: at their full size, at any positions; outlines of their shapes by index. Both must outlive the
  /// relaxation. `walls`: those that reach into the region.
  GrainRelaxation(std::vector<Placement>& grains, const std::vector<Points>& outlines, const Strip& region,
                  const std::vector<WallProfile>& walls, bool turn);

  /// Moves (and rotates) the grains, at their present size. Returns whether their true outlines are free of overlap.
  bool relax(int sweeps);

  double radius(const Placement& grain) const { return grain.scale * shape_of(grain).radius; }  ///< of its circle, m
  /// Vector from one grain's centre to the nearest image of another's.
  Vec2 apart(const Placement& from, const Placement& to) const;

 private:
  /// Shape of size 1, for grains of any size.
  struct Shape {
    Points outline;
    std::vector<double> weight;  // [nodes] share of the outline
    DistanceField distance;
    double length = 0;    // of the outline
    double radius = 0;    // of the circle around it
    double gyration = 0;  // radius of gyration
  };

  /// Force and moment on a grain.
  struct Push {
    Vec2 force{0, 0};
    double moment = 0, deepest = 0;
    void add(const Vec2& f, const Vec2& arm) { force += f, moment += cross(arm, f); }
    void add(const Push& other);
  };

  struct Pair {
    int first, second;
  };

  static Shape make_shape(const Points& outline);
  const Shape& shape_of(const Placement& grain) const { return shapes_[index_[grain.shape]]; }
  double inertia(const Placement& grain) const;  // rotational, for a grain of mass 1
  double reach() const;
  void find_pairs();
  bool pairs_are_stale() const;
  void place_nodes();
  void push(int slave, int master, const Vec2& to_slave, Push& on_slave, Push& on_master) const;
  Push push_of_edges(int i) const;
  void push_of_wall(int i, const WallProfile& wall, Push& result) const;
  double push_all();
  void step(Fire& fire);
  void move(double dt);
  bool overlapping() const;

  std::vector<Placement>& grains_;
  Strip region_;
  std::vector<WallProfile> walls_;
  bool turn_;
  std::vector<Shape> shapes_;
  std::vector<int> index_;  // in shapes_, by index of the scene's shapes
  double unit_ = 0;
  std::vector<Points> nodes_;  // relative to the centres, m
  Points velocity_, found_at_;
  std::vector<double> spin_;
  std::vector<Pair> pairs_;
  std::vector<std::pair<Push, Push>> pair_pushes_;
  std::vector<Push> pushes_;
};

}  // namespace pliant
