#include "files/frame_file.hpp"

#include <fmt/core.h>

#include <utility>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "files/hdf5_file.hpp"
#include "files/text_files.hpp"
#include "files/xdmf.hpp"

namespace pliant {
namespace {

/// Room for the groups and indices of one frame.
constexpr std::uintmax_t overhead_bytes = 1 << 20;
/// More frames are as welcome, but their index then grows by more than one write.
constexpr unsigned expected_frames = 2000;

void require_size(const std::filesystem::path& file, const std::string& what, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw OutputError(
      fmt::format("{}: '{}' has {} values, its grid needs {}; give one value for each point or cell and "
                  "component",
                  file.string(), what, found, expected));
}

void check_field(const std::filesystem::path& file, const Grid& grid, const Field& field) {
  const std::size_t entries =
      static_cast<std::size_t>(field.centre == Field::Centre::point ? grid.points : grid.cell_count);
  if (field.components < 1 || field.components > 3) {
    throw OutputError(fmt::format("{}: '{}/{}' has {} components; allowed are 1 to 3", file.string(), grid.name,
                                  field.name, field.components));
  }
  require_size(file, grid.name + "/" + field.name, field.values.size(),
               entries * static_cast<std::size_t>(field.components));
}

void check_grid(const std::filesystem::path& file, GridTopology& grid) {
  if (grid.cell_size != 2 && grid.cell_size != 3) {
    throw OutputError(fmt::format("{}: grid '{}' has cells of {} points; allowed are 2 (segments) and 3 (triangles)",
                                  file.string(), grid.name, grid.cell_size));
  }
  grid.cell_count = static_cast<int>(grid.cells.size()) / grid.cell_size;
  require_size(file, grid.name + "/cells", grid.cells.size(),
               static_cast<std::size_t>(grid.cell_count) * static_cast<std::size_t>(grid.cell_size));
  for (const int point : grid.cells) {
    if (point >= 0 && point < grid.points) continue;
    throw OutputError(fmt::format("{}: grid '{}' has a cell with point {}; allowed are 0 to {}", file.string(),
                                  grid.name, point, grid.points - 1));
  }
  for (const Field& field : grid.constant_fields) check_field(file, grid, field);
}

/// Throws unless every grid can be written.
std::vector<GridTopology> checked(const std::filesystem::path& file, std::vector<GridTopology> grids) {
  for (GridTopology& grid : grids) check_grid(file, grid);
  return grids;
}

void check_frame(const std::filesystem::path& file, const Grid& grid, const GridFrame& frame) {
  require_size(file, grid.name + "/position", frame.positions.size(), 2 * static_cast<std::size_t>(grid.points));
  for (const Field& field : frame.fields) check_field(file, grid, field);
}

/// [entries x 2] to [entries x 3] with zeros; anything else as it is.
std::vector<float> stored_values(const Field& field) {
  if (field.components != 2) return field.values;
  std::vector<float> values(field.values.size() / 2 * 3, 0.0F);
  for (std::size_t i = 0; i < field.values.size() / 2; ++i) {
    values[3 * i] = field.values[2 * i];
    values[3 * i + 1] = field.values[2 * i + 1];
  }
  return values;
}

void write_field(Hdf5Group& group, const Field& field) {
  group.write(field.name, stored_values(field), stored_components(field));
}

void write_topology(Hdf5File& file, const GridTopology& grid) {
  Hdf5Group group = file.new_group(expected_frames);
  group.write("cells", grid.cells, grid.cell_size);
  for (const Field& field : grid.constant_fields) write_field(group, field);
  file.publish(group, "/" + grid.name);
}

Hdf5Group write_frame(Hdf5File& file, double time, const GridFrame& frame) {
  Hdf5Group group = file.new_group();
  group.write_attribute("time", time);
  group.write("position", frame.positions, 2);
  for (const Field& field : frame.fields) write_field(group, field);
  return group;
}

Hdf5Group write_table(Hdf5File& file, double time, const FrameTable& table) {
  Hdf5Group group = file.new_group();
  group.write_attribute("time", time);
  for (const auto& [name, components, values] : table.columns) group.write(name, values, components);
  return group;
}

void check_table(const std::filesystem::path& file, const std::string& name, const FrameTable& table) {
  if (table.name != name)
    throw OutputError(fmt::format("{}: table '{}' was given; expected is '{}'", file.string(), table.name, name));
  const auto rows_of = [](const auto& column) {
    return column.values.size() / static_cast<std::size_t>(column.components);
  };
  for (const auto& column : table.columns)
    require_size(file, name + "/" + column.name, column.values.size(),
                 rows_of(table.columns.front()) * static_cast<std::size_t>(column.components));
}

/// What a frame may add to the file at most, should nothing compress.
std::uintmax_t frame_bytes(const std::vector<GridFrame>& frames, const std::vector<FrameTable>& tables) {
  std::uintmax_t values = 0;
  for (const FrameTable& table : tables)
    for (const FrameTable::Column& column : table.columns) values += column.values.size();
  for (const GridFrame& frame : frames) {
    values += frame.positions.size();
    for (const Field& field : frame.fields) values += field.values.size() * 3 / 2;
  }
  return values * sizeof(float) * 21 / 20 + overhead_bytes;
}

}  // namespace

struct FrameFile::Implementation {
  std::filesystem::path heavy, light;
  std::vector<Grid> grids;
  std::vector<std::string> tables;
  XdmfDocument document;
  int count = 0;

  /// Topologies are let go of: they may be as large as all the rest of a run.
  Implementation(const std::filesystem::path& folder, const std::vector<GridTopology>& topologies, Opening opening,
                 std::vector<std::string> table_names)
      : heavy(folder / "frames.h5"),
        light(folder / "frames.xdmf"),
        grids(topologies.begin(), topologies.end()),
        tables(std::move(table_names)),
        document(heavy, topologies) {
    if (opening == Opening::resume) return;
    Hdf5File file(heavy, Hdf5File::Mode::create);
    for (const GridTopology& grid : topologies) write_topology(file, grid);
    for (const std::string& table : tables) file.publish(file.new_group(expected_frames), "/" + table);
    file.write_empty_list("/times");
    file.close();
    write_file_atomically(light, document.text());
  }

  /// Opened and closed for each frame: between frames both files are complete, whatever ends the run. A frame is
  /// published when it is in the file, group by group, and its time listed last: it counts when it is whole.
  void append(double time, const std::vector<GridFrame>& frames, const std::vector<FrameTable>& rows) {
    check(frames, rows);
    reserve_disk_space(heavy, frame_bytes(frames, rows));
    write(time, frames, rows);
    document.add(count, time, grids, frames);
    write_file_atomically(light, document.text());
    ++count;
  }

  /// Of grids and tables, in this order.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Grid& grid : grids) all.push_back(grid.name);
    all.insert(all.end(), tables.begin(), tables.end());
    return all;
  }

  void write(double time, const std::vector<GridFrame>& frames, const std::vector<FrameTable>& rows) const {
    Hdf5File file(heavy, Hdf5File::Mode::append);
    std::vector<Hdf5Group> groups;
    groups.reserve(frames.size() + rows.size());
    for (const GridFrame& frame : frames) groups.push_back(write_frame(file, time, frame));
    for (const FrameTable& table : rows) groups.push_back(write_table(file, time, table));
    file.flush();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      file.publish(groups[g], frame_group(names()[g], count));
      file.flush();
    }
    groups.clear();  // before the file closes: an open group would keep it open
    file.append_value("/times", time);
    file.close();
  }

  /// Frames that a killed run was about to add may be in the file without their time.
  void cut_back() const {
    Hdf5File file(heavy, Hdf5File::Mode::append);
    const std::size_t wanted = static_cast<std::size_t>(count), there = file.list_size("/times");
    if (there < wanted)
      throw OutputError(fmt::format("{}: has {} frames, {} at the checkpoint; it was changed: start anew (--force)",
                                    heavy.string(), there, wanted));
    if (there > wanted) file.shorten_list("/times", wanted);
    for (const std::string& name : names()) {
      int end = count;
      while (file.has(frame_group(name, end))) ++end;
      // The last first: a kill in between leaves no gap, behind which the next call would not look.
      while (end > count) file.remove(frame_group(name, --end));
    }
    file.close();
    write_file_atomically(light, document.text());
  }

  void check(const std::vector<GridFrame>& frames, const std::vector<FrameTable>& rows) const {
    if (frames.size() != grids.size() || rows.size() != tables.size()) {
      throw OutputError(
          fmt::format("{}: a frame of {} grids and {} tables was given, the file has {} and {}; give one for each",
                      heavy.string(), frames.size(), rows.size(), grids.size(), tables.size()));
    }
    for (std::size_t g = 0; g < grids.size(); ++g) check_frame(heavy, grids[g], frames[g]);
    for (std::size_t t = 0; t < tables.size(); ++t) check_table(heavy, tables[t], rows[t]);
  }
};

FrameFile::FrameFile(const std::filesystem::path& folder, std::vector<GridTopology> grids, Opening opening,
                     std::vector<std::string> tables)
    : implementation_(std::make_unique<Implementation>(folder, checked(folder / "frames.h5", std::move(grids)), opening,
                                                       std::move(tables))) {}

FrameFile::~FrameFile() = default;

void FrameFile::append(double time, const std::vector<GridFrame>& frames, const std::vector<FrameTable>& tables) {
  implementation_->append(time, frames, tables);
}

int FrameFile::count() const { return implementation_->count; }

int& FrameFile::written_count() { return implementation_->count; }

std::vector<std::string>& FrameFile::document_frames() { return implementation_->document.frames(); }

void FrameFile::loaded() { implementation_->cut_back(); }

}  // namespace pliant
