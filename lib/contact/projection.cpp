#include "contact/projection.hpp"

#include <cmath>

namespace pliant {

void MasterWindow::fill(const OutlineShape& shape, const double* outline_x, const double* outline_y, const Arc& range, double shift) {
  nodes = range.count + 4;
  if (static_cast<int>(x.size()) < nodes)
    for (auto* array : {&x, &y, &tangent_x, &tangent_y, &length, &bisector_x, &bisector_y, &reference_length, &arc})
      array->resize(static_cast<std::size_t>(nodes));
  int turn = turn_of(range.begin - 2, shape.count);
  int node = range.begin - 2 - turn * shape.count;
  for (int w = 0; w < nodes; ++w) {
    x[w] = outline_x[node] + (shift + turn * shape.turn_shift);
    y[w] = outline_y[node];
    reference_length[w] = shape.segment_length[node];
    arc[w] = shape.arc[node] + turn * shape.perimeter;
    if (++node == shape.count) node = 0, ++turn;
  }
  for (int w = 0; w + 1 < nodes; ++w) {
    const double dx = x[w + 1] - x[w], dy = y[w + 1] - y[w];
    length[w] = std::sqrt(dx * dx + dy * dy);
    tangent_x[w] = dx / length[w];
    tangent_y[w] = dy / length[w];
  }
  for (int w = 1; w + 1 < nodes; ++w) {
    bisector_x[w] = tangent_x[w - 1] + tangent_x[w];
    bisector_y[w] = tangent_y[w - 1] + tangent_y[w];
  }
}

}  // namespace pliant
