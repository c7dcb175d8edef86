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
  const int first_turn = turn_of(segments.begin, shape.count);
  first_number_ = segments.begin - first_turn * shape.count;
  const int rows = count_ + 2;
  // Whole lanes, and what look_up may see beyond them.
  const std::size_t wanted = static_cast<std::size_t>(padded(rows) / lane_count) + 2;
  if (stride_ < wanted) stride_ = wanted, entries_.assign(columns * stride_, Lanes{});
  const Vec2 origin(outline_x[first_number_] + shift + first_turn * shape.turn_shift, outline_y[first_number_]);
  // Of the segment before the first, only the tangent is of use: for the bisector at the first node.
  Lanes last_tx{}, last_ty{}, longest{};
  for (int w = 0; w < rows; w += lane_count) {
    const int index = segments.begin - 1 + w, turn = turn_of(index, shape.count), node = index - turn * shape.count;
    const Lanes px = load(outline_x + node), py = load(outline_y + node);
    const Lanes dx = load(outline_x + node + 1) - px, dy = load(outline_y + node + 1) - py;
    const Lanes square = dx * dx + dy * dy, inverse = inverse_sqrt(square), size = square * inverse;
    const Lanes tx = dx * inverse, ty = dy * inverse;
    const Lanes along_x = after(last_tx, tx) + tx, along_y = after(last_ty, ty) + ty,
                shifted_x = px + (shift + turn * shape.turn_shift);
    Lanes* at = &entries_[static_cast<std::size_t>(w / lane_count)];
    const auto put = [&](Column c, Lanes value) { at[c * stride_] = value; };
    put(x, shifted_x), put(y, py);
    put(tangent_x, tx), put(tangent_y, ty);
    put(length, size), put(inverse_length, inverse);
    put(bisector_x, along_x), put(bisector_y, along_y);
    put(bisector_at, (shifted_x - origin.x()) * along_x + (py - origin.y()) * along_y);
    longest = max(longest, select(first_lanes(rows - w), size, Lanes{}));
    last_tx = tx, last_ty = ty;
  }
  longest_ = largest(longest);
  depth_ = longest_ + inward;
}

}  // namespace pliant
