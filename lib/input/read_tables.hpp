#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "input/table_reader.hpp"
#include "scene/scene.hpp"

namespace pliant {

// One function a table of the scene file. `scene` holds what has been read so far: names are checked against it, so
// the order is that of read_scene. All throw InputError.

void read_domain(TableReader table, Scene& scene);
/// Refuses what a cell with two periods has no place for.
void check_cell(const TableReader& root, const Scene& scene);
TimeSettings read_time(TableReader table);
DiscretisationSettings read_discretisation(TableReader table);
Probe read_probe(TableReader table, const Scene& scene);
Frames read_frames(TableReader table, const Scene& scene);
void read_checkpoint(TableReader table, Scene& scene);
void read_start(TableReader table, Scene& scene);

Material read_material(TableReader table, const std::string& name);
/// One shape, or all variants of it.
std::vector<ShapeSpec> read_shape(TableReader table, const std::string& name);
SizeDistribution read_size(TableReader table);
/// `grains`: with shapes and sizes, from which a solid fraction gives the number of grains.
Packing read_packing(TableReader table, const Scene& scene, const Grains& grains);
Grains read_grains(TableReader table, const Scene& scene);
Wall read_wall(TableReader table, const Scene& scene);
BoundaryCondition read_condition(TableReader table, const Scene& scene);
/// The names of both sides of a rule, or twice "all".
std::pair<std::string, std::string> read_between(TableReader& table, const Scene& scene);
ContactRule read_contact(TableReader table, const Scene& scene);
BondRule read_bond(TableReader table, const Scene& scene);
/// [contact] and all [[contacts]]; every pair of bodies gets exactly one rule. After grains and walls.
void read_contacts(TableReader& root, Scene& scene);

/// A file that a scene names.
struct NamedFile {
  std::filesystem::path path;  ///< from the folder of the scene; it is there
  std::string unit;            ///< of length; empty: the scene gives none
};
/// The keys 'file' and 'unit'.
NamedFile read_named_file(TableReader& table);

double extent_of(const ShapeSpec& shape);  ///< largest distance of two points, m
double area_of(const ShapeSpec& shape);    ///< m2

/// Throws InputError at the key unless the sum is 1.
void check_shares(const TableReader& table, const std::string& key, double sum);

/// Linear elasticity is not objective: refuses grains of such a material that start turned.
void check_angle(TableReader& table, const Grains& grains, const Scene& scene);

bool has_body(const Grains& grains, BodyKind kind);

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

}  // namespace pliant
