#pragma once

#include <vector>

/// The plain loops of codes that users write for themselves: arrays of structs, a table of each grain's own, one number
/// at a time. They compute what the engine computes (tests/benchmarks), and are timed beside it.
namespace pliant::baseline {

struct Node {
  double x, y;            ///< from the body's centre, m
  double vx, vy;          ///< m/s
  double fx, fy;          ///< N/m
  double old_fx, old_fy;  ///< at the beginning of the step
  double mass;            ///< kg/m
  double distance;        ///< to the nearest other node, m
};

/// An integration point, with reference gradients of the shape functions of the nodes near.
struct Point {
  double weight;  ///< m2
  std::vector<int> neighbours;
  std::vector<double> dphi_dx, dphi_dy;  ///< 1/m
};

struct OutlineNode {
  double x, y;                  ///< m
  double fx, fy;                ///< N/m
  double length;                ///< half of the two adjacent segments in the reference shape, m
  double reference_x;           ///< rigid bodies: from the centre, m
  double reference_y;           ///< likewise
  std::vector<int> neighbours;  ///< compliant bodies
  std::vector<double> phi;      ///< likewise
};

/// A grain or a wall.
struct Body {
  bool rigid = false;
  int group = 0;          ///< which contact law holds
  double x = 0, y = 0;    ///< fixed centre of a compliant body, present one of a rigid body, m
  double turn_shift = 0;  ///< x offset of an outline after its last node: a wall's period, m
  std::vector<OutlineNode> outline;
  // Compliant:
  double mu = 0, lambda = 0;  ///< Pa
  std::vector<Node> nodes;
  std::vector<Point> points;
  // Rigid:
  double angle = 0;
  double fx = 0, fy = 0, moment = 0;  ///< N/m, N
};

/// f = - sum over points of w P b, neo-Hookean, added to the nodes' forces.
void add_internal_forces(Body& body);
void place_outline(Body& body);
/// Forces on outline nodes, to nodes or as force and moment.
void gather_outline_forces(Body& body);

// Of velocity Verlet:

/// Positions at the end of a step; forces become the old ones.
void predict(Body& body, double dt);
/// Velocities there. Returns the largest change of an acceleration over the nodal distance, 1/s2.
double finish(Body& body, double dt);

// Of all bodies, shared out among threads:

void place_outlines(std::vector<Body>& bodies);
void gather_outline_forces(std::vector<Body>& bodies);
void internal_forces(std::vector<Body>& bodies);
/// A whole step of bodies that touch nothing: prediction, outlines, gathering, internal forces, velocities.
double compliant_step(std::vector<Body>& bodies, double dt);
double update(std::vector<Body>& bodies, double dt);
void clear_forces(std::vector<Body>& bodies);
void predict(std::vector<Body>& bodies, double dt);
double finish(std::vector<Body>& bodies, double dt);

}  // namespace pliant::baseline
