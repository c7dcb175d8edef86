#include "results/probes/regions.hpp"

#include <cmath>

#include "contact/broad_phase.hpp"
#include "geometry/clip.hpp"
#include "geometry/mesh.hpp"
#include "results/body_motion.hpp"

namespace pliant {
namespace {

Points outline_of(const Snapshot& snapshot, int body) {
  const Model& model = snapshot.model();
  Points points;
  for (int i = model.outline_offset[body]; i < model.outline_end(body); ++i)
    points.push_back(snapshot.outlines().at(i));
  return points;
}

/// Integral of a wall's height over one period, m2. Its first copy behind the last node closes the period.
double area_below(const Snapshot& snapshot, int wall) {
  const OutlineField& o = snapshot.outlines();
  const Model& model = snapshot.model();
  double sum = 0;
  for (int i = model.outline_offset[wall]; i < model.outline_end(wall); ++i)
    sum += 0.5 * (o.y[i] + o.y[i + 1]) * (o.x[i + 1] - o.x[i]);
  return std::copysign(1.0, model.outline_of(wall).turn_shift) * sum;
}

}  // namespace

double outline_area(const Snapshot& snapshot, int body) { return polygon_properties(outline_of(snapshot, body)).area; }

bool has_region(const Selection& selection) { return selection.box || !selection.between.empty(); }

double region_area(const Snapshot& snapshot, const Selection& selection) {
  if (selection.box) return (selection.box->high - selection.box->low).prod();
  return area_below(snapshot, selection.between[1]) - area_below(snapshot, selection.between[0]);
}

bool centre_is_in_region(const Snapshot& snapshot, const Selection& selection, int body) {
  if (!selection.box) return true;
  const Model& model = snapshot.model();
  Vec2 r = centre_of(model, model.bodies[body], snapshot.state().position) - selection.box->low;
  if (const double period = model.scene.period.value_or(0); period > 0) r.x() -= period * std::floor(r.x() / period);
  const Vec2 size = selection.box->high - selection.box->low;
  return r.x() >= 0 && r.x() < size.x() && r.y() >= 0 && r.y() < size.y();
}

double area_in_region(const Snapshot& snapshot, const Selection& selection, int body) {
  if (!selection.box) return outline_area(snapshot, body);
  const Box extent = bounding_box(snapshot.model(), snapshot.outlines(), body);
  const double period = snapshot.model().scene.period.value_or(0);
  const auto first = period > 0 ? std::ceil((selection.box->low.x() - extent.x_max) / period) : 0.0,
             last = period > 0 ? std::floor((selection.box->high.x() - extent.x_min) / period) : 0.0;
  const Points outline = outline_of(snapshot, body);
  double area = 0;
  for (double image = first; image <= last; ++image) {
    const Vec2 shift(image * period, 0);
    area += polygon_properties(clipped(outline, selection.box->low - shift, selection.box->high - shift)).area;
  }
  return area;
}

}  // namespace pliant
