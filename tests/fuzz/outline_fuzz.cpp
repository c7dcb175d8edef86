// Any text as a file of an outline, of columns or by gmsh: a polygon that can be meshed, or refused with a message.

#include <cmath>

#include "core/errors.hpp"
#include "fuzz/fuzz_input.hpp"
#include "geometry/mesh.hpp"
#include "geometry/outline_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace pliant;
  fuzz::Input input(bytes, count);
  const int choice = input.byte();
  const bool gmsh = choice % 2 != 0;
  const char* const parts[] = {"", "all", "merged", "1"};
  const std::filesystem::path file = fuzz::scratch_folder() / (gmsh ? "outline.msh" : "outline.csv");
  fuzz::write_text(file, input.rest());
  try {
    constexpr std::size_t most_points = 500;
    for (const Points& points : read_outline_file(file, "mm", parts[choice / 2 % 4], most_points)) {
      fuzz::require(points.size() >= 3 && points.size() <= most_points, "as many points as a polygon has");
      const PolygonProperties polygon = polygon_properties(points);
      fuzz::require(std::isfinite(polygon.area) && polygon.area > 0, "counter-clockwise");
    }
  } catch (const InputError&) {
  }
  return 0;
}
