#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/table_reader.hpp"

namespace pliant {

// One function a table of the scene file. `scene` holds what has been read so far: names are checked against it, so
// the order is that of read_scene. All throw InputError.

/// Limits that keep a slip of the pen from asking for all of the memory.
struct SceneLimits {
  static constexpr std::int64_t nodes_per_shape = 200'000;
  static constexpr std::int64_t bodies = 1'000'000;
  static constexpr std::int64_t field_nodes = 100'000'000;
  static constexpr std::int64_t wall_nodes = 1'000'000;
  static constexpr std::int64_t outputs = 10'000'000;
};

void read_domain(TableReader table, Scene& scene);
TimeSettings read_time(TableReader table);
DiscretisationSettings read_discretisation(TableReader table);
Probe read_probe(TableReader table, const Scene& scene);
Frames read_frames(TableReader table, const Scene& scene);

Material read_material(TableReader table, const std::string& name);
ShapeSpec read_shape(TableReader table, const std::string& name);
Grains read_grains(TableReader table, const Scene& scene);
Wall read_wall(TableReader table, const Scene& scene);
ContactRule read_contact(TableReader table, const Scene& scene);

/// Number of bodies of a set of grains.
std::int64_t body_count(const Grains& grains);
bool has_body(const Grains& grains, BodyKind kind);

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

}  // namespace pliant
