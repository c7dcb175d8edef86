#pragma once

#include "reference/time_stepping.hpp"

namespace pliant::reference {

/// Run at one accepted motion, for outputs.
class View {
 public:
  View(const System& system, const TimeStepping& run) : system_(system), run_(run), acceleration_(run.acceleration()) {}

  const Bodies& bodies() const { return system_.bodies(); }
  const System& system() const { return system_; }
  const TimeStepping& run() const { return run_; }
  const Forces& forces() const { return run_.forces(); }
  const Vector& positions() const { return run_.motion().q; }
  const Vector& velocities() const { return run_.motion().v; }
  const Vector& accelerations() const { return acceleration_; }

  /// Mass-weighted mean of a vector of degrees of freedom: for positions the centre of mass.
  Vec2 mean(const Body& body, const Vector& values) const;
  /// Positions of all nodes for probes and pictures: field nodes of a compliant body, outline nodes of a rigid one.
  Points positions_of(const Body& body) const;
  Points start_of(const Body& body) const;
  Points velocities_of(const Body& body) const;
  Points accelerations_of(const Body& body) const;
  /// Elastic stresses at the points of a compliant body, and the points' weights.
  std::vector<PointStress> stresses_of(const Body& body) const;
  const Vector& weights_of(const Body& body) const;
  Points contact_forces() const;  ///< [outline nodes], with those of bonds, N/m
  double kinetic_energy(const Body& body) const;

 private:
  Points at_nodes(const Body& body, const Vector& values) const;
  const InternalForces& internal_of(const Body& body) const;

  const System& system_;
  const TimeStepping& run_;
  const Vector& acceleration_;
};

/// Von Mises stress of a plane stress with its part out of the plane, Pa.
double von_mises(const PointStress& stress);

}  // namespace pliant::reference
