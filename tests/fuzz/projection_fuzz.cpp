// Nodes anywhere beside any polygon: where contact takes them to stand is on the polygon, as far away as it says.

#include <cmath>

#include "contact/projection.hpp"
#include "fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace pliant;
  fuzz::Input input(bytes, count);
  const OutlineShape shape = make_outline_shape(fuzz::star_polygon(input), 0);
  OutlineField outline(shape.count + lane_count);
  for (int i = 0; i < shape.count + lane_count; ++i) {
    const Vec2& point = shape.points[static_cast<std::size_t>(i % shape.count)];
    outline.x[static_cast<std::size_t>(i)] = point.x();
    outline.y[static_cast<std::size_t>(i)] = point.y();
  }
  MasterWindow window;
  const Arc arc{input.byte() % shape.count, shape.count};
  window.fill(shape, outline.x.data(), outline.y.data(), arc, Vec2::Zero(), 0.05);
  const double outward = input.byte() / 256.0;
  while (!input.empty()) {
    Lanes px{}, py{};
    for (int lane = 0; lane < lane_count; ++lane)
      px[lane] = (input.byte() - 128) / 100.0, py[lane] = (input.byte() - 128) / 100.0;
    const Projection p = project(window, px, py, outward);
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!p.hit[lane]) continue;
      const MasterSegment segment = window[static_cast<int>(p.row[lane])];
      const double foot_x = segment.x + p.xi[lane] * segment.length * segment.tangent_x,
                   foot_y = segment.y + p.xi[lane] * segment.length * segment.tangent_y;
      fuzz::require(p.xi[lane] >= 0 && p.xi[lane] <= 1, "a foot on the segment");
      fuzz::require(std::abs(std::hypot(p.normal_x[lane], p.normal_y[lane]) - 1) < 1e-9, "a normal of length 1");
      fuzz::require(std::hypot(foot_x + p.gap[lane] * p.normal_x[lane] - px[lane],
                               foot_y + p.gap[lane] * p.normal_y[lane] - py[lane]) < 1e-9,
                    "a node is its foot and the gap along the normal");
    }
  }
  return 0;
}
