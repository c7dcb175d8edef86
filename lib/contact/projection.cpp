#include "contact/projection.hpp"

namespace pliant {

void MasterWindow::fill(const OutlineShape& shape, const double* outline_x, const double* outline_y, const Arc& range, double shift) {
  nodes = range.count + 4;
  // Room for whole lanes beyond the last node; what is computed there is never read.
  if (static_cast<int>(x.size()) < nodes + 2 * lane_count)
    for (auto* array : {&x, &y, &tangent_x, &tangent_y, &length, &bisector_x, &bisector_y, &reference_length, &arc})
      array->resize(static_cast<std::size_t>(nodes + 2 * lane_count));
  int turn = turn_of(range.begin - 2, shape.count);
  int node = range.begin - 2 - turn * shape.count;
  for (int w = 0; w < nodes; ++w) {
    x[w] = outline_x[node] + (shift + turn * shape.turn_shift);
    y[w] = outline_y[node];
    reference_length[w] = shape.segment_length[node];
    arc[w] = shape.arc[node] + turn * shape.perimeter;
    if (++node == shape.count) node = 0, ++turn;
  }
  for (int w = 0; w < nodes; w += lane_count) {
    const Lanes dx = load(&x[w + 1]) - load(&x[w]), dy = load(&y[w + 1]) - load(&y[w]);
    const Lanes l = sqrt(dx * dx + dy * dy);
    const Lanes inverse = 1.0 / l;
    store(&length[w], l);
    store(&tangent_x[w], dx * inverse);
    store(&tangent_y[w], dy * inverse);
  }
  for (int w = 0; w < nodes; w += lane_count) {
    store(&bisector_x[w + 1], load(&tangent_x[w]) + load(&tangent_x[w + 1]));
    store(&bisector_y[w + 1], load(&tangent_y[w]) + load(&tangent_y[w + 1]));
  }
}

}  // namespace pliant
