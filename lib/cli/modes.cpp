#include "cli/modes.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bodies/natural_modes.hpp"
#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "scene/names.hpp"
#include "setup/build_model.hpp"

namespace pliant {
namespace {

/// Bodies that vibrate alike: of one shape, size and material.
struct AlikeBodies {
  const Body* body = nullptr;  ///< the first of them
  int bodies = 0;
};

bool alike(const Body& a, const Body& b) {
  return a.compliant_shape == b.compliant_shape && a.scale == b.scale && a.material == b.material;
}

bool is_asked_for(const Model& model, const Body& body, const std::string& name) {
  return name.empty() || body.name == name || (!body.wall && model.scene.grains[body.grains].name == name);
}

/// Why there is nothing to print.
[[noreturn]] void refuse(const Model& model, const std::string& name, bool known) {
  const std::string file = model.scene.file.string();
  if (name.empty()) throw InputError(fmt::format("{}: no compliant body: only they have natural frequencies", file));
  if (known)
    throw InputError(fmt::format(
        "{}: --body: '{}' is not compliant: rigid bodies and walls have no natural frequencies", file, name));
  std::vector<std::string> names;
  for (const Grains& grains : model.scene.grains) names.push_back(grains.name);
  throw InputError(fmt::format("{}: --body: no '{}'; {}; or one of a set, as in \"{} 0\"", file, name,
                               allowed_names(name, names), names.front()));
}

std::vector<AlikeBodies> kinds_of(const Model& model, const std::string& name) {
  std::vector<AlikeBodies> kinds;
  bool known = false;
  for (const Body& body : model.bodies) {
    if (!is_asked_for(model, body, name)) continue;
    known = true;
    if (body.kind != BodyKind::compliant) continue;
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const AlikeBodies& kind) { return alike(*kind.body, body); });
    if (found != kinds.end())
      ++found->bodies;
    else
      kinds.push_back({&body, 1});
  }
  if (kinds.empty()) refuse(model, name, known);
  return kinds;
}

/// Symmetric, entries that are not zero, counted from 1: https://math.nist.gov/MatrixMarket/formats.html
std::string matrix_market(const Eigen::MatrixXd& matrix, const std::string& comment) {
  std::string entries;
  int count = 0;
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    for (Eigen::Index row = column; row < matrix.rows(); ++row)
      if (const double value = matrix(row, column); value != 0) {
        entries += fmt::format("{} {} {}\n", row + 1, column + 1, value);
        ++count;
      }
  return fmt::format("%%MatrixMarket matrix coordinate real symmetric\n% {}\n{} {} {}\n{}", comment, matrix.rows(),
                     matrix.cols(), count, entries);
}

void write_matrices(const std::filesystem::path& folder, const Body& body, const SmallMotions& motions) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  std::string name = body.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  write_file_atomically(
      folder / (name + "_stiffness.mtx"),
      matrix_market(motions.stiffness, "stiffness of " + body.name + ", Pa; x and y of node 0, of node 1 ..."));
  write_file_atomically(
      folder / (name + "_inverse_mass.mtx"),
      matrix_market(motions.inverse_mass, "inverse mass of " + body.name + ", m/kg; node 0, node 1 ...; of x as of y"));
}

void print_table(const AlikeBodies& kind, int nodes, const NaturalModes& modes, int count) {
  fmt::print("{}{}: {} nodes, {} motions without stiffness{}\n", kind.body->name,
             kind.bodies > 1 ? fmt::format(" and {} like it", kind.bodies - 1) : "", nodes, modes.motions_at_rest,
             modes.motions_at_rest == 3 ? "" : ", not the 3 of a rigid body: the others are mechanisms");
  fmt::print("{:>6} {:>20} {:>16} {:>16}\n", "mode", "frequency [rad/s]", "[Hz]", "period [s]");
  for (int m = 0; m < count; ++m) {
    const double w = modes.frequency[static_cast<std::size_t>(m)], cycles = w / (2 * std::numbers::pi);
    fmt::print("{:>6} {:>20.10g} {:>16.8g} {:>16.8g}\n", m + 1, w, cycles, 1 / cycles);
  }
}

}  // namespace

void print_modes(const Scene& scene, const ModesRequest& request) {
  Eigen::setNbThreads(1);  // its products block their sums by the number of threads
  BuildOptions never_nodewise;
  never_nodewise.least_sparse_nodes = std::numeric_limits<int>::max();
  const Model model = build_model(scene, never_nodewise);
  nlohmann::ordered_json json{{"scene", scene.name}, {"unit", "rad/s"}, {"bodies", nlohmann::json::array()}};
  for (const AlikeBodies& kind : kinds_of(model, request.body)) {
    const SmallMotions motions = small_motions(model, *kind.body);
    const NaturalModes modes = natural_modes(motions);
    const int nodes = model.shape_of(*kind.body).nodes(),
              count = std::min(request.count, static_cast<int>(modes.frequency.size()));
    print_table(kind, nodes, modes, count);
    json["bodies"].push_back(
        {{"body", kind.body->name},
         {"like_it", kind.bodies - 1},
         {"nodes", nodes},
         {"motions_at_rest", modes.motions_at_rest},
         {"frequencies", std::vector<double>(modes.frequency.begin(), modes.frequency.begin() + count)}});
    if (!request.matrices.empty()) write_matrices(request.matrices, *kind.body, motions);
  }
  if (!request.json.empty()) write_file_atomically(request.json, json.dump(1) + "\n");
}

}  // namespace pliant
