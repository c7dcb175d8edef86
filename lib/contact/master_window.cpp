#include "contact/master_window.hpp"

#include <algorithm>

namespace pliant {
namespace {

/// The last lane of one vector, then all but the last of another.
Lanes after(Lanes last, Lanes next) { return __builtin_shufflevector(last, next, 7, 8, 9, 10, 11, 12, 13, 14); }

/// Eight segments from a node on.
struct Segments {
  Lanes x, y;  ///< first nodes
  Lanes length, inverse_length, tangent_x, tangent_y;

  Segments(const double* node_x, const double* node_y) : x(load(node_x)), y(load(node_y)) {
    const Lanes dx = load(node_x + 1) - x, dy = load(node_y + 1) - y, square = dx * dx + dy * dy;
    inverse_length = inverse_sqrt(square), length = square * inverse_length;
    tangent_x = dx * inverse_length, tangent_y = dy * inverse_length;
  }
};

}  // namespace

void MasterWindow::fill(const OutlineShape& shape, const double* outline_x, const double* outline_y,
                        const Arc& segments, const Vec2& shift, double inward,
                        const std::array<const double*, 2>& before) {
  shape_ = &shape;
  count_ = segments.count;
  outline_count_ = shape.count;
  const int first_turn = turn_of(segments.begin, shape.count);
  first_number_ = segments.begin - first_turn * shape.count;
  const int rows = count_ + 1;
  // Whole lanes, and at least two vectors for look_up.
  const std::size_t wanted = std::max<std::size_t>(static_cast<std::size_t>(padded(rows) / lane_count), 2);
  if (stride_ < wanted) stride_ = wanted, entries_.assign(columns * stride_, Lanes{});
  const Vec2 origin(outline_x[first_number_] + shift.x() + first_turn * shape.turn_shift,
                    outline_y[first_number_] + shift.y());
  // The segment before the first gives its tangent for the bisector at the first node.
  const int previous = segments.begin - 1 - turn_of(segments.begin - 1, shape.count) * shape.count;
  const Segments last(outline_x + previous, outline_y + previous);
  before_ = last.length[0];
  Lanes last_tx = broadcast(last.tangent_x[0]), last_ty = broadcast(last.tangent_y[0]),
        longest = broadcast(last.length[0]);
  for (int w = 0; w < rows; w += lane_count) {
    const int index = segments.begin + w, turn = turn_of(index, shape.count), node = index - turn * shape.count;
    const Segments now(outline_x + node, outline_y + node);
    const Lanes along_x = after(last_tx, now.tangent_x) + now.tangent_x,
                along_y = after(last_ty, now.tangent_y) + now.tangent_y,
                shifted_x = now.x + (shift.x() + turn * shape.turn_shift), shifted_y = now.y + shift.y();
    Lanes* at = &entries_[static_cast<std::size_t>(w / lane_count)];
    const auto put = [&](Column c, Lanes value) { at[c * stride_] = value; };
    put(x, shifted_x), put(y, shifted_y);
    put(tangent_x, now.tangent_x), put(tangent_y, now.tangent_y);
    put(length, now.length), put(inverse_length, now.inverse_length);
    put(mean_length, before[0] ? 0.5 * (now.length + Segments(before[0] + node, before[1] + node).length) : now.length);
    put(bisector_x, along_x), put(bisector_y, along_y);
    put(bisector_at, (shifted_x - origin.x()) * along_x + (shifted_y - origin.y()) * along_y - ties_up_to * now.length);
    longest = max(longest, select(first_lanes(rows - w), now.length, Lanes{}));
    last_tx = now.tangent_x, last_ty = now.tangent_y;
  }
  longest_ = largest(longest);
  depth_ = longest_ + inward;
}

}  // namespace pliant
