#include "results/probes/regions.hpp"

#include <cmath>

#include "contact/broad_phase.hpp"
#include "geometry/clip.hpp"
#include "geometry/lattice.hpp"
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

/// Calls visit(shift) for the images of an extent that may reach into a box of a cell with two periods.
template <class Visit>
void for_each_shift(const Lattice& lattice, const Box& extent, const ProbeBox& box, Visit&& visit) {
  const LatticeBasis basis = shortest_basis(lattice);
  const Eigen::Matrix2d counted = matrix_of(basis.lattice).inverse();
  Vec2 least(1e300, 1e300), most = -least;
  for (const double x : {box.low.x() - extent.x_max, box.high.x() - extent.x_min})
    for (const double y : {box.low.y() - extent.y_max, box.high.y() - extent.y_min}) {
      const Vec2 turns = counted * Vec2(x, y);
      least = least.cwiseMin(turns), most = most.cwiseMax(turns);
    }
  for (int i = static_cast<int>(std::floor(least.x())); i <= static_cast<int>(std::ceil(most.x())); ++i)
    for (int j = static_cast<int>(std::floor(least.y())); j <= static_cast<int>(std::ceil(most.y())); ++j)
      visit(lattice.shift(basis.images({i, j})));
}

}  // namespace

double outline_area(const Snapshot& snapshot, int body) { return polygon_properties(outline_of(snapshot, body)).area; }

bool has_region(const Selection& selection) { return selection.box || !selection.between.empty(); }

double region_area(const Snapshot& snapshot, const Selection& selection) {
  if (selection.box) return (selection.box->high - selection.box->low).prod();
  if (selection.between.empty()) return area_of(snapshot.outlines().lattice);
  return area_below(snapshot, selection.between[1]) - area_below(snapshot, selection.between[0]);
}

bool centre_is_in_region(const Snapshot& snapshot, const Selection& selection, int body) {
  if (!selection.box) return true;
  const Model& model = snapshot.model();
  Vec2 r = centre_of(model, model.bodies[body], snapshot.state().position) - selection.box->low;
  if (model.scene.cell) {
    const Vec2 size = selection.box->high - selection.box->low;
    bool inside = false;
    for_each_shift(snapshot.outlines().lattice, {r.x(), r.x(), r.y(), r.y()}, {Vec2(0, 0), size}, [&](const Vec2& s) {
      const Vec2 at = r + s;
      inside |= at.x() >= 0 && at.x() < size.x() && at.y() >= 0 && at.y() < size.y();
    });
    return inside;
  }
  if (const double period = model.scene.period.value_or(0); period > 0) r.x() -= period * std::floor(r.x() / period);
  const Vec2 size = selection.box->high - selection.box->low;
  return r.x() >= 0 && r.x() < size.x() && r.y() >= 0 && r.y() < size.y();
}

double area_in_region(const Snapshot& snapshot, const Selection& selection, int body) {
  if (!selection.box) return outline_area(snapshot, body);
  const Box extent = bounding_box(snapshot.model(), snapshot.outlines(), body);
  if (snapshot.model().scene.cell) {
    const Points points = outline_of(snapshot, body);
    double inside = 0;
    for_each_shift(snapshot.outlines().lattice, extent, *selection.box, [&](const Vec2& s) {
      inside += polygon_properties(clipped(points, selection.box->low - s, selection.box->high - s)).area;
    });
    return inside;
  }
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
