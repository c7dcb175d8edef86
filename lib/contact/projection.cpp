#include "contact/projection.hpp"

namespace pliant {

void MasterWindow::fill(const OutlineShape& shape, const double* outline_x, const double* outline_y, const Arc& range,
                        double shift) {
  nodes = range.count + 4;
  // Room for whole lanes beyond the last node, where the outline simply goes on.
  if (static_cast<int>(x.size()) < nodes + 2 * lane_count)
    for (auto* array : {&x, &y, &tangent_x, &tangent_y, &length, &bisector_x, &bisector_y, &reference_length, &arc})
      array->resize(static_cast<std::size_t>(nodes + 2 * lane_count));
  for (int w = 0; w < nodes + lane_count; w += lane_count) {
    const int index = range.begin - 2 + w, turn = turn_of(index, shape.count), node = index - turn * shape.count;
    store(&x[w], load(outline_x + node) + (shift + turn * shape.turn_shift));
    store(&y[w], load(outline_y + node));
    store(&reference_length[w], load(&shape.segment_length[node]));
    store(&arc[w], load(&shape.arc[node]) + turn * shape.perimeter);
  }
  Lanes longest_lanes{};
  for (int w = 0; w < nodes; w += lane_count) {
    const Lanes dx = load(&x[w + 1]) - load(&x[w]), dy = load(&y[w + 1]) - load(&y[w]);
    const Lanes l = sqrt(dx * dx + dy * dy);
    const Lanes inverse = 1.0 / l;
    longest_lanes = max(longest_lanes, l);
    store(&length[w], l);
    store(&tangent_x[w], dx * inverse);
    store(&tangent_y[w], dy * inverse);
  }
  for (int w = 0; w < nodes; w += lane_count) {
    store(&bisector_x[w + 1], load(&tangent_x[w]) + load(&tangent_x[w + 1]));
    store(&bisector_y[w + 1], load(&tangent_y[w]) + load(&tangent_y[w + 1]));
  }
  longest = largest(longest_lanes);
}

}  // namespace pliant
