// Broad phase with two periods (docs/method.md 10).
#include <algorithm>
#include <cmath>

#include "contact/broad_phase.hpp"
#include "geometry/lattice.hpp"

namespace pliant {
namespace {

/// Box of a body, or of an image of it, near the first cell.
struct CellEntry {
  Box box;
  int body;
  Images images;  ///< from the body to here
  bool is_image;  ///< not the one whose middle is in the first cell
};

Box shifted(const Box& box, const Vec2& by) {
  return {box.x_min + by.x(), box.x_max + by.x(), box.y_min + by.y(), box.y_max + by.y()};
}

bool overlap(const Box& a, const Box& b, double margin) {
  return a.x_min <= b.x_max + margin && b.x_min <= a.x_max + margin && a.y_min <= b.y_max + margin &&
         b.y_min <= a.y_max + margin;
}

/// One image of each body: that with the middle of its box in the first cell of the basis.
std::vector<CellEntry> bodies_in_cell(const std::vector<Box>& boxes, const Lattice& lattice,
                                      const LatticeBasis& basis) {
  const Eigen::Matrix2d counted = matrix_of(basis.lattice).inverse();
  constexpr double far = 1 << 28;
  std::vector<CellEntry> entries;
  for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
    const Box& box = boxes[static_cast<std::size_t>(b)];
    const Vec2 middle(0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max));
    const Vec2 turns = (counted * middle).array().floor();
    if (!(turns.cwiseAbs().maxCoeff() < far)) continue;  // not a number: the step that led here is rejected
    const Images images = -basis.images({static_cast<int>(turns.x()), static_cast<int>(turns.y())});
    entries.push_back({shifted(box, lattice.shift(images)), b, images, false});
  }
  return entries;
}

Box hull(const std::vector<CellEntry>& entries) {
  Box all{1e300, -1e300, 1e300, -1e300};
  for (const CellEntry& entry : entries) {
    all.x_min = std::min(all.x_min, entry.box.x_min), all.x_max = std::max(all.x_max, entry.box.x_max);
    all.y_min = std::min(all.y_min, entry.box.y_min), all.y_max = std::max(all.y_max, entry.box.y_max);
  }
  return all;
}

/// Adds the images of an entry that come near the hull of all, in one half of the directions: the others of a pair see
/// it in the other half.
void add_images(const CellEntry& entry, const Box& all, double margin, const Lattice& lattice,
                const LatticeBasis& basis, std::vector<CellEntry>& images) {
  const Eigen::Matrix2d counted = matrix_of(basis.lattice).inverse();
  Vec2 least(1e300, 1e300), most = -least;
  for (const double x : {all.x_min - margin - entry.box.x_max, all.x_max + margin - entry.box.x_min})
    for (const double y : {all.y_min - margin - entry.box.y_max, all.y_max + margin - entry.box.y_min}) {
      const Vec2 turns = counted * Vec2(x, y);
      least = least.cwiseMin(turns), most = most.cwiseMax(turns);
    }
  for (int j = 0; j <= static_cast<int>(std::floor(most.y())); ++j)
    for (int i = j == 0 ? 1 : static_cast<int>(std::ceil(least.x())); i <= static_cast<int>(std::floor(most.x()));
         ++i) {
      const Images further = basis.images({i, j});
      const Box box = shifted(entry.box, lattice.shift(further));
      if (overlap(box, all, margin)) images.push_back({box, entry.body, entry.images + further, true});
    }
}

BodyPair pair_of(const CellEntry& a, const CellEntry& b) {
  const Images images = b.images - a.images;
  if (a.body < b.body || (a.body == b.body && images > Images{})) return {a.body, b.body, images};
  return {b.body, a.body, -images};
}

}  // namespace

std::vector<BodyPair> broad_phase_in_cell(const std::vector<Box>& boxes, double margin, const Lattice& lattice) {
  const LatticeBasis basis = shortest_basis(lattice);
  std::vector<CellEntry> entries = bodies_in_cell(boxes, lattice, basis), images;
  const Box all = hull(entries);
  for (const CellEntry& entry : entries) add_images(entry, all, margin, lattice, basis, images);
  entries.insert(entries.end(), images.begin(), images.end());
  std::sort(entries.begin(), entries.end(),
            [](const CellEntry& a, const CellEntry& b) { return a.box.x_min < b.box.x_min; });
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t k = i + 1; k < entries.size() && entries[k].box.x_min <= entries[i].box.x_max + margin; ++k)
      if (!(entries[i].is_image && entries[k].is_image) && overlap(entries[i].box, entries[k].box, margin))
        pairs.push_back(pair_of(entries[i], entries[k]));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace pliant
