#include "contact/master_window.hpp"

namespace pliant {
namespace {

/// The last lane of one vector, then all but the last of another.
Lanes after(Lanes last, Lanes next) { return __builtin_shufflevector(last, next, 7, 8, 9, 10, 11, 12, 13, 14); }

}  // namespace

void MasterWindow::fill(const OutlineShape& shape, const double* outline_x, const double* outline_y,
                        const Arc& segments, double shift, double inward) {
  count_ = segments.count;
  outline_count_ = shape.count;
  first_number_ = segments.begin - turn_of(segments.begin, shape.count) * shape.count;
  const int rows = count_ + 2;
  if (static_cast<int>(rows_.size()) < rows + lane_count) rows_.resize(static_cast<std::size_t>(rows + lane_count));
  // Of the segment before the first, only the tangent is of use: for the bisector at the first node.
  Lanes last_tx{}, last_ty{}, longest{};
  for (int w = 0; w < rows; w += lane_count) {
    const int index = segments.begin - 1 + w, turn = turn_of(index, shape.count), node = index - turn * shape.count;
    const Lanes x = load(outline_x + node), y = load(outline_y + node);
    const Lanes dx = load(outline_x + node + 1) - x, dy = load(outline_y + node + 1) - y;
    const Lanes length = sqrt(dx * dx + dy * dy), inverse = 1.0 / length, tx = dx * inverse, ty = dy * inverse;
    longest = max(longest, select(first_lanes(rows - w), length, Lanes{}));
    Lanes transposed[8];
    transpose({x + (shift + turn * shape.turn_shift), y, tx, ty, length, inverse, after(last_tx, tx) + tx,
               after(last_ty, ty) + ty},
              transposed);
    for (int lane = 0; lane < lane_count; ++lane) store(&rows_[w + lane].x, transposed[lane]);
    last_tx = tx, last_ty = ty;
  }
  longest_ = largest(longest);
  depth_ = longest_ + inward;
}

}  // namespace pliant
