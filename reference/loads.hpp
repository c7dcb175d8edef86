#pragma once

#include <vector>

#include "reference/bodies.hpp"
#include "scene/instant.hpp"

namespace pliant::reference {

/// Load or prescribed motion of one rigid degree of freedom (docs/method.md 5).
struct RigidLoad {
  int dof = 0;
  AxisCondition prescribed;
  double factor = 1;  ///< load = factor x history: signed period for a wall's pressure
  bool imposed(double time) const {
    return (prescribed.mode == AxisCondition::Mode::fixed || prescribed.mode == AxisCondition::Mode::velocity) &&
           prescribed.window.contains(time);
  }
  bool loaded(const Instant& at) const {
    return (prescribed.mode == AxisCondition::Mode::force || prescribed.mode == AxisCondition::Mode::pressure) &&
           contains(prescribed.window, at);
  }
};

/// Node of an outline with the two neighbours of its chosen segments; -1: that segment is not chosen.
struct LoadedNode {
  int node = 0, before = -1, after = -1;  ///< in the list of all outline nodes
  Vec2 start{0, 0};                       ///< m
  Vec2 normal{0, 0};                      ///< half the sum of the chosen segments' outward normals at the start, m
  double length = 0;                      ///< half the sum of their lengths, m
};

/// Pressure or soft support on a part of one body's outline.
struct OutlineLoad {
  BoundaryCondition condition;
  std::vector<LoadedNode> nodes;
  double stiffness = 0;  ///< of a support, Pa/m
};

/// Forces on the outlines as residuals (minus the force), with their tangent.
struct OutlineResidual {
  Vector residual;       ///< [2 outline nodes], N/m
  Triplets tangent;      ///< of the residual by the outline's positions
  double stored = 0;     ///< in the supports' springs, J/m
  double potential = 0;  ///< of dead loads, J/m
  bool symmetric = true;
};

/// Dashpots of soft supports, added up at each node: force = pull - coefficient x velocity. [2 outline nodes]
struct Dashpots {
  Vector coefficient;  ///< Pa s
  Vector pull;         ///< force from their targets' velocities, N/m
};

/// All external loads on bodies.
class Loads {
 public:
  explicit Loads(const Bodies& bodies);

  /// Forces of histories on the degrees of freedom: [dofs], N/m. A wall's pressure includes the force that bears its
  /// weight.
  Vector applied(const Instant& at) const;
  Vector gravity(double time) const;  ///< [dofs], N/m
  /// Forces of pressures and supports.
  OutlineResidual outlines(const Points& x, const Instant& at) const;
  /// Work of pressures, and of supports whose targets move, between two times, by the mean of the forces, J/m.
  double outline_work(const Points& x0, double t0, const Points& x1, const Instant& t1) const;
  /// Coefficients of the dashpots beside loads, whose forces are minus these times the velocities: [dofs].
  Vector load_dashpots(const Instant& at) const;
  /// Rates of mass-proportional damping, [dofs], 1/s.
  const Vector& mass_damping() const { return mass_damping_; }
  Dashpots dashpots(const Instant& at) const;
  /// Work of the targets on dashpots that act at t0, by the mean of the forces at outline velocities v0 and v1
  /// [2 outline nodes], J/m.
  double dashpot_work(const Vector& v0, double t0, const Vector& v1, const Instant& t1) const;

  bool imposed(int dof, double time) const;
  /// Position at t1 of a degree of freedom that is imposed from t0 on and was at q0 then.
  double imposed_position(int dof, double q0, double t0, double t1) const;
  double imposed_velocity(int dof, double time) const;
  /// Points of histories, and ends of windows: ascending, after the start, s.
  std::vector<double> switch_times() const;

 private:
  void add_walls();
  /// Returns false if no segment of the body lies in the part.
  bool add_condition(const BoundaryCondition& condition, const Body& body);
  bool is_within_a_grain(const Body& body, const Points& x, int a, int b) const;
  OutlineLoad outline_load(const BoundaryCondition& condition, const Body& body) const;
  const RigidLoad* of(int dof) const;

  const Bodies& bodies_;
  Vector heavy_mass_;    ///< [dofs], mass on which gravity acts
  Vector mass_damping_;  ///< [dofs], 1/s
  std::vector<RigidLoad> rigid_;
  std::vector<int> load_of_dof_;  ///< [dofs], index in `rigid_`; -1: none
  std::vector<OutlineLoad> outline_;
};

}  // namespace pliant::reference
