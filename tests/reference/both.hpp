#pragma once

#include "bodies/nodal.hpp"
#include "dynamics/simulation.hpp"
#include "reference/time_stepping.hpp"
#include "setup/build_model.hpp"

/// The engine and the reference solver on one scene.
namespace pliant::reference_tests {

/// The engine's positions, or velocities, in the order of the reference solver's degrees of freedom.
inline Eigen::VectorXd engine_values(const Model& model, const Dofs& dofs, bool positions) {
  std::vector<double> values;
  for (const Body& body : model.bodies) {
    if (body.kind == BodyKind::rigid) {
      const double* at = &dofs.rigid[3 * static_cast<std::size_t>(body.rigid)];
      values.insert(values.end(), at, at + 3);
      continue;
    }
    for (const Vec2& value : dof_values(model, body, dofs))
      for (int c = 0; c < 2; ++c) values.push_back(value[c] + (positions ? body.centre[c] : 0));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

inline Eigen::VectorXd engine_positions(const Simulation& simulation) {
  return engine_values(simulation.model(), simulation.state().position, true);
}

/// Positions at the end of a scene by the engine with steps of a share of its stability bound, and no error control.
inline Eigen::VectorXd run_engine(Scene scene, double safety) {
  scene.time.tolerance = 1e300;
  scene.time.safety = safety;
  const Model model = build_model(scene);
  Simulation simulation(model);
  while (simulation.state().time < scene.time.end) simulation.step(scene.time.end);
  return engine_positions(simulation);
}

/// The reference solver on a scene. Not to be moved: the parts refer to each other.
struct ReferenceRun {
  reference::System system;
  reference::TimeStepping stepping;
  ReferenceRun(const Scene& scene, const reference::SolverOptions& options)
      : system(scene), stepping(system, options) {}

  /// In equal steps to the scene's end.
  const Eigen::VectorXd& run(int steps) {
    const double end = system.bodies().scene().time.end, start = stepping.motion().time;
    for (int i = 1; i <= steps; ++i) stepping.step(i == steps ? end : start + (end - start) * i / steps);
    return stepping.motion().q;
  }
};

inline Eigen::VectorXd run_reference(const Scene& scene, int steps, const reference::SolverOptions& options = {}) {
  return ReferenceRun(scene, options).run(steps);
}

/// Slope of log(error) over log(step) between the first and the last.
inline double observed_order(const std::vector<double>& steps, const std::vector<double>& errors) {
  return std::log(errors.front() / errors.back()) / std::log(steps.front() / steps.back());
}

}  // namespace pliant::reference_tests
