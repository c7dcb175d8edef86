#include "reference/natural_modes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "reference/materials/internal.hpp"

namespace pliant::reference {
namespace {

constexpr double at_rest = 1e-4;  ///< of the largest frequency: modes without stiffness

/// Whether two bodies have the same natural frequencies.
bool alike(const Body& a, const Body& b) {
  return a.space == b.space && a.placed.scale == b.placed.scale && a.placed.material == b.placed.material;
}

}  // namespace

Vector natural_frequencies(const Bodies& bodies, const Body& body, MassMatrix kind) {
  if (body.dofs > 2 * most_modal_nodes)
    throw InputError(fmt::format("{}: {}: {} nodes; natural frequencies are found for at most {}",
                                 bodies.scene().file.string(), body.placed.name, body.dofs / 2, most_modal_nodes));
  const InternalForces forces(bodies.space_of(body), bodies.material_of(body), body.placed.scale, body.placed.angle);
  const Vector start = bodies.initial_positions().segment(body.first_dof, body.dofs);
  const Eigen::MatrixXd tangent(forces.evaluate(start, true).tangent);
  const Eigen::MatrixXd mass(bodies.mass(kind).block(body.first_dof, body.first_dof, body.dofs, body.dofs));
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(tangent, mass, Eigen::EigenvaluesOnly);
  // One by one: Eigen's vectorised root computes 0 times infinity for 0, which is trapped.
  return solver.eigenvalues().unaryExpr([](double square) { return std::sqrt(std::max(square, 0.0)); });
}

void write_modes(const Scene& scene, MassMatrix kind, const std::filesystem::path& file) {
  const Bodies bodies(scene);
  nlohmann::ordered_json json{{"scene", scene.name}, {"unit", "rad/s"}, {"bodies", nlohmann::json::array()}};
  std::vector<const Body*> kinds;
  for (const Body& body : bodies.all()) {
    if (!body.compliant()) continue;
    const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const Body* other) { return alike(*other, body); });
    if (known != kinds.end()) {
      auto& like_it = json["bodies"][static_cast<std::size_t>(known - kinds.begin())]["like_it"];
      like_it = like_it.get<int>() + 1;
      continue;
    }
    kinds.push_back(&body);
    const Vector all = natural_frequencies(bodies, body, kind);
    const auto first = std::upper_bound(all.begin(), all.end(), at_rest * all.maxCoeff());
    json["bodies"].push_back({{"body", body.placed.name},
                              {"like_it", 0},
                              {"nodes", body.dofs / 2},
                              {"motions_at_rest", first - all.begin()},
                              {"frequencies", std::vector<double>(first, all.end())}});
  }
  if (json["bodies"].empty())
    throw InputError(fmt::format("{}: no compliant body: only they have natural frequencies", scene.file.string()));
  write_file_atomically(file, json.dump(1) + "\n");
}

}  // namespace pliant::reference
