#include "benchmarks/baseline/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pliant::baseline {

void add_internal_forces(Body& body) {
  for (const Point& point : body.points) {
    double Fxx = 0, Fxy = 0, Fyx = 0, Fyy = 0;
    for (std::size_t k = 0; k < point.neighbours.size(); ++k) {
      const Node& node = body.nodes[point.neighbours[k]];
      Fxx += node.x * point.dphi_dx[k];
      Fxy += node.x * point.dphi_dy[k];
      Fyx += node.y * point.dphi_dx[k];
      Fyy += node.y * point.dphi_dy[k];
    }
    const double J = Fxx * Fyy - Fxy * Fyx;
    const double b = (body.lambda * std::log(J) - body.mu) / J;
    const double Pxx = point.weight * (body.mu * Fxx + b * Fyy), Pxy = point.weight * (body.mu * Fxy - b * Fyx);
    const double Pyx = point.weight * (body.mu * Fyx - b * Fxy), Pyy = point.weight * (body.mu * Fyy + b * Fxx);
    for (std::size_t k = 0; k < point.neighbours.size(); ++k) {
      Node& node = body.nodes[point.neighbours[k]];
      node.fx -= Pxx * point.dphi_dx[k] + Pxy * point.dphi_dy[k];
      node.fy -= Pyx * point.dphi_dx[k] + Pyy * point.dphi_dy[k];
    }
  }
}

void place_outline(Body& body) {
  if (body.rigid) {
    const double c = std::cos(body.angle), s = std::sin(body.angle);
    for (OutlineNode& outline : body.outline) {
      outline.x = body.x + c * outline.reference_x - s * outline.reference_y;
      outline.y = body.y + s * outline.reference_x + c * outline.reference_y;
    }
    return;
  }
  for (OutlineNode& outline : body.outline) {
    double x = body.x, y = body.y;
    for (std::size_t k = 0; k < outline.neighbours.size(); ++k) {
      x += outline.phi[k] * body.nodes[outline.neighbours[k]].x;
      y += outline.phi[k] * body.nodes[outline.neighbours[k]].y;
    }
    outline.x = x, outline.y = y;
  }
}

void gather_outline_forces(Body& body) {
  if (body.rigid) {
    body.fx = body.fy = body.moment = 0;
    for (const OutlineNode& outline : body.outline) {
      body.fx += outline.fx;
      body.fy += outline.fy;
      body.moment += (outline.x - body.x) * outline.fy - (outline.y - body.y) * outline.fx;
    }
    return;
  }
  for (const OutlineNode& outline : body.outline)
    for (std::size_t k = 0; k < outline.neighbours.size(); ++k) {
      body.nodes[outline.neighbours[k]].fx += outline.phi[k] * outline.fx;
      body.nodes[outline.neighbours[k]].fy += outline.phi[k] * outline.fy;
    }
}

void predict(Body& body, double dt) {
  for (Node& node : body.nodes) {
    node.x += dt * node.vx + 0.5 * dt * dt * node.fx / node.mass;
    node.y += dt * node.vy + 0.5 * dt * dt * node.fy / node.mass;
    node.old_fx = node.fx, node.old_fy = node.fy;
    node.fx = node.fy = 0;
  }
}

double finish(Body& body, double dt) {
  double largest = 0;
  for (Node& node : body.nodes) {
    node.vx += 0.5 * dt * (node.old_fx + node.fx) / node.mass;
    node.vy += 0.5 * dt * (node.old_fy + node.fy) / node.mass;
    const double change = std::max(std::abs(node.fx - node.old_fx), std::abs(node.fy - node.old_fy));
    largest = std::max(largest, change / (node.mass * node.distance));
  }
  return largest;
}

void place_outlines(std::vector<Body>& bodies) {
#pragma omp parallel for
  for (std::size_t b = 0; b < bodies.size(); ++b) place_outline(bodies[b]);
}

void gather_outline_forces(std::vector<Body>& bodies) {
#pragma omp parallel for
  for (std::size_t b = 0; b < bodies.size(); ++b) gather_outline_forces(bodies[b]);
}

void internal_forces(std::vector<Body>& bodies) {
#pragma omp parallel for
  for (std::size_t b = 0; b < bodies.size(); ++b) add_internal_forces(bodies[b]);
}

double compliant_step(std::vector<Body>& bodies, double dt) {
  double largest = 0;
#pragma omp parallel for reduction(max : largest)
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    predict(bodies[b], dt);
    place_outline(bodies[b]);
    gather_outline_forces(bodies[b]);
    add_internal_forces(bodies[b]);
    largest = std::max(largest, finish(bodies[b], dt));
  }
  return largest;
}

void clear_forces(std::vector<Body>& bodies) {
#pragma omp parallel for
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Node& node : bodies[b].nodes) node.fx = node.fy = 0;
}

void predict(std::vector<Body>& bodies, double dt) {
#pragma omp parallel for
  for (std::size_t b = 0; b < bodies.size(); ++b) predict(bodies[b], dt);
}

double finish(std::vector<Body>& bodies, double dt) {
  double largest = 0;
#pragma omp parallel for reduction(max : largest)
  for (std::size_t b = 0; b < bodies.size(); ++b) largest = std::max(largest, finish(bodies[b], dt));
  return largest;
}

double update(std::vector<Body>& bodies, double dt) {
  double largest = 0;
#pragma omp parallel for reduction(max : largest)
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    predict(bodies[b], dt);
    largest = std::max(largest, finish(bodies[b], dt));
  }
  return largest;
}

}  // namespace pliant::baseline
