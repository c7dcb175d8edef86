#pragma once

#include "geometry/shapes.hpp"

/// Shapes and methods on which the tests of the reference solver look at its discretisation.
namespace pliant::testing {

inline std::vector<ShapeSpec> reference_shapes() {
  const Points square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  return {disc(60),
          disc(168),
          disc(700),
          curve("rounded", rounded_polygon(square, 0.3), 150),
          l_shape(250),
          fork(180),
          curve("fourier", fourier_grain(1e-3, {0.15, 0.1, 0.05}, 3), 168)};
}

inline DiscretisationSettings settings_of(DiscretisationMethod method, int gauss_points = 3, int support = 8) {
  DiscretisationSettings settings;
  settings.method = method;
  settings.gauss_points = gauss_points;
  settings.support = support;
  return settings;
}

inline std::vector<DiscretisationSettings> reference_methods() {
  return {settings_of(DiscretisationMethod::mls),
          settings_of(DiscretisationMethod::mls, 1, 10),
          settings_of(DiscretisationMethod::mls_gauss, 1),
          settings_of(DiscretisationMethod::mls_gauss, 3),
          settings_of(DiscretisationMethod::mls_gauss, 6, 12),
          settings_of(DiscretisationMethod::t3),
          settings_of(DiscretisationMethod::es_t3)};
}

inline double mean_node_distance(const FieldMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return std::sqrt(area / static_cast<double>(mesh.nodes.size()));
}

/// As in scene files, with what is not the default.
inline std::string name_of(const DiscretisationSettings& settings) {
  const auto number = std::to_string(settings.gauss_points), support = std::to_string(settings.support);
  switch (settings.method) {
    case DiscretisationMethod::mls:
      return "mls, support " + support;
    case DiscretisationMethod::mls_gauss:
      return "mls-gauss of " + number + " points, support " + support;
    case DiscretisationMethod::t3:
      return "t3";
    default:
      return "es-t3";
  }
}

inline std::string described(const ShapeSpec& shape, const DiscretisationSettings& settings) {
  return shape.name + " of " + std::to_string(*shape.nodes) + " nodes, " + name_of(settings);
}

}  // namespace pliant::testing
