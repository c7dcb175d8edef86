#include "files/xdmf.hpp"

#include <fmt/core.h>

namespace pliant {
namespace {

std::string topology_type(const Grid& grid) {
  return grid.cell_size == 3 ? R"(TopologyType="Triangle")"
                             : fmt::format(R"(TopologyType="Polyline" NodesPerElement="{}")", grid.cell_size);
}

}  // namespace

int stored_components(const Field& field) { return field.components == 2 ? 3 : field.components; }

std::string frame_group(const std::string& grid, int index) { return fmt::format("/{}/{:06}", grid, index); }

XdmfDocument::XdmfDocument(const std::filesystem::path& heavy, const std::vector<Grid>& grids)
    : heavy_(heavy.filename().string()) {
  for (const Grid& grid : grids) {
    const std::string folder = "/" + grid.name;
    std::string constant =
        fmt::format("        <Topology {} NumberOfElements=\"{}\">\n{}        </Topology>\n", topology_type(grid),
                    grid.cells, item(folder + "/cells", "Int", grid.cells, grid.cell_size));
    for (const Field& field : grid.constant_fields) constant += attribute(field, folder, grid);
    names_.push_back(grid.name);
    constants_.push_back(std::move(constant));
    frames_.emplace_back();
  }
}

void XdmfDocument::add(int index, double time, const std::vector<Grid>& grids) {
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const std::string folder = frame_group(grids[g].name, index);
    std::string& text = frames_[g];
    text += fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n{}",
                        grids[g].name, time, constants_[g]);
    text += fmt::format("        <Geometry GeometryType=\"XY\">\n{}        </Geometry>\n",
                        item(folder + "/position", "Float", grids[g].points, 2));
    for (const Field& field : grids[g].fields) text += attribute(field, folder, grids[g]);
    text += "      </Grid>\n";
  }
}

std::string XdmfDocument::text() const {
  std::string result = "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.2\">\n  <Domain>\n";
  for (std::size_t g = 0; g < names_.size(); ++g) {
    result += fmt::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}    </Grid>\n",
                          names_[g], frames_[g]);
  }
  return result + "  </Domain>\n</Xdmf>\n";
}

std::string XdmfDocument::attribute(const Field& field, const std::string& folder, const Grid& grid) const {
  const bool at_points = field.centre == Field::Centre::point;
  const int components = stored_components(field);
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}        </Attribute>\n",
                     field.name, components == 1 ? "Scalar" : "Vector", at_points ? "Node" : "Cell",
                     item(folder + "/" + field.name, "Float", at_points ? grid.points : grid.cells, components));
}

std::string XdmfDocument::item(const std::string& path, const char* type, int rows, int columns) const {
  const std::string shape = columns > 1 ? fmt::format("{} {}", rows, columns) : fmt::format("{}", rows);
  return fmt::format(
      "          <DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"4\" Dimensions=\"{}\">{}:{}</DataItem>\n", type,
      shape, heavy_, path);
}

}  // namespace pliant
