#include "results/frames.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <set>
#include <string>
#include <vector>

#include "files/temporary_folder.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using testing::empty_scene, testing::grains, testing::polygonal_disc;

constexpr double far = 3;  ///< between centres of discs of diameter 1
constexpr int columns = 30, rows = 20;

/// More bodies than a part of a frame has.
Scene many_discs() {
  Scene scene = empty_scene(1);
  scene.shapes = {polygonal_disc("disc", 1, 8)};
  Points centres;
  for (int i = 0; i < columns * rows; ++i) centres.emplace_back(far * (i % columns), far * (i / columns));
  scene.grains = {grains("discs", "disc", BodyKind::rigid, centres)};
  scene.frames.period = 1;
  return scene;
}

class Frames : public testing::TemporaryFolder {
 protected:
  std::vector<double> read_array(const std::string& name) const {
    const hid_t file = H5Fopen((folder_ / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space), H5Dclose(set), H5Fclose(file);
    return values;
  }
  /// EXACT: each cell's points are those of the body that it is said to be of, and each body has cells.
  void expect_cells_at_their_bodies(const std::string& grid, std::size_t cell_size, const Model& model) const {
    const std::vector<double> cells = read_array("/" + grid + "/cells"), body = read_array("/" + grid + "/body"),
                              position = read_array("/" + grid + "/000000/position");
    ASSERT_EQ(cells.size(), cell_size * body.size());
    std::set<double> seen;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t point = static_cast<std::size_t>(cells[i]), b = static_cast<std::size_t>(body[i / cell_size]);
      const Vec2 at(position[2 * point], position[2 * point + 1]);
      ASSERT_LT((at - model.bodies[b].centre).norm(), 0.3 * far) << grid << ", cell " << i / cell_size;
      seen.insert(body[i / cell_size]);
    }
    EXPECT_EQ(seen.size(), model.bodies.size());
  }
};

TEST_F(Frames, number_their_points_on_from_part_to_part) {
  const Model model = build_model(many_discs());
  Simulation simulation(model);
  FrameRecorder(model, folder_).record_due(simulation);
  expect_cells_at_their_bodies("bodies", 3, model);
  expect_cells_at_their_bodies("outlines", 2, model);
}

}  // namespace
}  // namespace pliant
