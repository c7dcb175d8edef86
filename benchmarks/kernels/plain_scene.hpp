#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "benchmarks/baseline/from_model.hpp"
#include "benchmarks/kernels/meter.hpp"
#include "benchmarks/kernels/scenes.hpp"
#include "benchmarks/kernels/work.hpp"

namespace pliant::kernels {

/// The plain lists in the same state, after the same five steps.
struct PlainScene {
  explicit PlainScene(const ContactScene& scene)
      : bodies(baseline::bodies_of(scene.model, scene.before)),
        contact(baseline::contact_of(scene.model, scene.contact, bodies)) {
    baseline::place_outlines(bodies);
    contact.find_candidates(bodies);
    contact.forces(bodies);
    baseline::move_to(scene.model, scene.now, bodies);
    baseline::place_outlines(bodies);
    contact.forces(bodies);
    difference = difference_to(scene);
    contacts = contact.contacts();
  }
  /// Share of bodies whose sum of forces is another, by more than 1e-9 of the largest. Beside creases an engine that
  /// goes by wedges and lists that go by the nearest segment part by up to a percent of a distance
  /// (contact/projection.hpp).
  double difference_to(const ContactScene& scene) const {
    std::vector<double> difference(bodies.size());
    double largest = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      Vec2 plain(0, 0), engine(0, 0);
      for (std::size_t k = 0; k < bodies[b].outline.size(); ++k) {
        plain += Vec2(bodies[b].outline[k].fx, bodies[b].outline[k].fy);
        engine += scene.force.at(scene.model.outline_offset[b] + static_cast<int>(k));
      }
      largest = std::max(largest, engine.norm()), difference[b] = (plain - engine).norm();
    }
    const auto same = [&](double d) { return d <= 1e-9 * largest; };
    return 1 - static_cast<double>(std::ranges::count_if(difference, same)) / static_cast<double>(bodies.size());
  }
  std::vector<baseline::Body> bodies;
  baseline::Contact contact;
  double difference = 0;
  int contacts = 0;  ///< before it is timed
};

/// `unit`: what the engine's kernel counts, and how many there are.
inline void count_lists(benchmark::State& state, const PlainScene& plain, const std::string& unit, double units) {
  state.counters["contacts"] = plain.contact.contacts();
  state.counters["candidates"] = plain.contact.candidates();
  state.counters["difference"] = plain.difference;  // share of bodies
  if (!(plain.difference < 0.01)) state.SkipWithError("the plain lists find other forces than the engine");
  if (std::abs(plain.contact.contacts() - plain.contacts) > 0.01 * plain.contacts)
    state.SkipWithError("the plain lists have gone astray");
  report(state, unit, units, {});
}

}  // namespace pliant::kernels
