#include "files/frame_file.hpp"

#include <fmt/core.h>

#include <utility>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"
#include "files/hdf5_file.hpp"
#include "files/text_output.hpp"
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

std::size_t entries_of(const Grid& grid, const Field& field) {
  return static_cast<std::size_t>(field.centre == Field::Centre::point ? grid.points : grid.cells);
}

void check_field(const std::filesystem::path& file, const Grid& grid, const Field& field) {
  if (field.components >= 1 && field.components <= 3) return;
  throw OutputError(fmt::format("{}: '{}/{}' has {} components; allowed are 1 to 3", file.string(), grid.name,
                                field.name, field.components));
}

/// Throws unless every grid can be written.
std::vector<Grid> checked(const std::filesystem::path& file, std::vector<Grid> grids) {
  for (const Grid& grid : grids) {
    if (grid.cell_size != 2 && grid.cell_size != 3) {
      throw OutputError(fmt::format("{}: grid '{}' has cells of {} points; allowed are 2 (segments) and 3 (triangles)",
                                    file.string(), grid.name, grid.cell_size));
    }
    for (const Field& field : grid.constant_fields) check_field(file, grid, field);
    for (const Field& field : grid.fields) check_field(file, grid, field);
  }
  return grids;
}

/// [entries x 2] to [entries x 3] with zeros; anything else as it is.
std::vector<float> stored_values(const std::vector<float>& values, int components) {
  if (components != 2) return values;
  std::vector<float> stored(values.size() / 2 * 3, 0.0F);
  for (std::size_t i = 0; i < values.size() / 2; ++i)
    stored[3 * i] = values[2 * i], stored[3 * i + 1] = values[2 * i + 1];
  return stored;
}

/// An array of a grid while its parts come in.
class GridArray {
 public:
  GridArray(std::filesystem::path file, std::string name, Hdf5Array array, std::size_t expected)
      : file_(std::move(file)), name_(std::move(name)), array_(std::move(array)), expected_(expected) {}

  /// `components`: of the values, which are written as stored_values().
  void append(const std::vector<float>& values, int components = 1) {
    count(values.size());
    if (values.size() % static_cast<std::size_t>(components) != 0)
      throw OutputError(fmt::format("{}: {} values of '{}' were given; it has {} components", file_.string(),
                                    values.size(), name_, components));
    array_.append(stored_values(values, components));
  }
  void append(const std::vector<int>& values) {
    count(values.size());
    array_.append(values);
  }
  void end() const { require_size(file_, name_, found_, expected_); }

 private:
  void count(std::size_t more) {
    found_ += more;
    if (found_ > expected_) end();
  }

  std::filesystem::path file_;
  std::string name_;
  Hdf5Array array_;
  std::size_t found_ = 0, expected_;
};

/// The arrays of some fields of a grid.
class FieldArrays {
 public:
  FieldArrays(const std::filesystem::path& file, Hdf5Group& group, const Grid& grid, const std::vector<Field>& fields)
      : what_(fmt::format("{}: grid '{}'", file.string(), grid.name)), fields_(fields) {
    for (const Field& field : fields) {
      const std::size_t entries = entries_of(grid, field);
      arrays_.emplace_back(file, grid.name + "/" + field.name,
                           group.new_floats(field.name, entries, stored_components(field)),
                           entries * static_cast<std::size_t>(field.components));
    }
  }
  void append(const std::vector<std::vector<float>>& values) {
    if (values.size() != fields_.size())
      throw OutputError(fmt::format("{}: {} fields were given; expected are {}", what_, values.size(), fields_.size()));
    for (std::size_t f = 0; f < fields_.size(); ++f) arrays_[f].append(values[f], fields_[f].components);
  }
  void end() const {
    for (const GridArray& array : arrays_) array.end();
  }

 private:
  std::string what_;
  const std::vector<Field>& fields_;
  std::vector<GridArray> arrays_;
};

void check_cells(const std::filesystem::path& file, const Grid& grid, const std::vector<int>& cells) {
  for (const int point : cells) {
    if (point >= 0 && point < grid.points) continue;
    throw OutputError(fmt::format("{}: grid '{}' has a cell with point {}; allowed are 0 to {}", file.string(),
                                  grid.name, point, grid.points - 1));
  }
}

void write_topology(const std::filesystem::path& path, Hdf5File& file, const Grid& grid,
                    const Parts<GridTopology>& parts) {
  Hdf5Group group = file.new_group(expected_frames);
  {
    const std::size_t count = static_cast<std::size_t>(grid.cells);
    GridArray cells(path, grid.name + "/cells", group.new_integers("cells", count, grid.cell_size),
                    count * static_cast<std::size_t>(grid.cell_size));
    FieldArrays fields(path, group, grid, grid.constant_fields);
    parts([&](const GridTopology& part) {
      check_cells(path, grid, part.cells);
      cells.append(part.cells), fields.append(part.values);
    });
    cells.end(), fields.end();
  }
  file.publish(group, "/" + grid.name);
}

Hdf5Group write_frame(const std::filesystem::path& path, Hdf5File& file, double time, const Grid& grid,
                      const Parts<GridFrame>& parts) {
  Hdf5Group group = file.new_group();
  group.write_attribute("time", time);
  const std::size_t points = static_cast<std::size_t>(grid.points);
  GridArray positions(path, grid.name + "/position", group.new_floats("position", points, 2), 2 * points);
  FieldArrays fields(path, group, grid, grid.fields);
  parts([&](const GridFrame& part) { positions.append(part.positions), fields.append(part.values); });
  positions.end(), fields.end();
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
std::uintmax_t frame_bytes(const std::vector<Grid>& grids, const std::vector<FrameTable>& tables) {
  std::uintmax_t values = 0;
  for (const FrameTable& table : tables)
    for (const FrameTable::Column& column : table.columns) values += column.values.size();
  for (const Grid& grid : grids) {
    values += 2 * static_cast<std::uintmax_t>(grid.points);
    for (const Field& field : grid.fields)
      values += entries_of(grid, field) * static_cast<std::uintmax_t>(stored_components(field));
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

  Implementation(const std::filesystem::path& folder, std::vector<Grid> all,
                 const std::vector<Parts<GridTopology>>& topologies, Opening opening,
                 std::vector<std::string> table_names)
      : heavy(folder / "frames.h5"),
        light(folder / "frames.xdmf"),
        grids(checked(heavy, std::move(all))),
        tables(std::move(table_names)),
        document(heavy, grids) {
    if (opening == Opening::resume) return;
    Hdf5File file(heavy, Hdf5File::Mode::create);
    for (std::size_t g = 0; g < grids.size(); ++g) write_topology(heavy, file, grids[g], topologies.at(g));
    for (const std::string& table : tables) file.publish(file.new_group(expected_frames), "/" + table);
    file.write_empty_list("/times");
    file.close();
    write_file_atomically(light, document.text());
  }

  /// Opened and closed for each frame: between frames both files are complete, whatever ends the run. A frame is
  /// published when it is in the file, group by group, and its time listed last: it counts when it is whole.
  void append(double time, const std::vector<Parts<GridFrame>>& frames, const std::vector<FrameTable>& rows) {
    check(frames, rows);
    reserve_disk_space(heavy, frame_bytes(grids, rows));
    write(time, frames, rows);
    document.add(count, time, grids);
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

  void write(double time, const std::vector<Parts<GridFrame>>& frames, const std::vector<FrameTable>& rows) const {
    Hdf5File file(heavy, Hdf5File::Mode::append);
    std::vector<Hdf5Group> groups;
    groups.reserve(frames.size() + rows.size());
    for (std::size_t g = 0; g < grids.size(); ++g)
      groups.push_back(write_frame(heavy, file, time, grids[g], frames[g]));
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

  void check(const std::vector<Parts<GridFrame>>& frames, const std::vector<FrameTable>& rows) const {
    if (frames.size() != grids.size() || rows.size() != tables.size()) {
      throw OutputError(
          fmt::format("{}: a frame of {} grids and {} tables was given, the file has {} and {}; give one for each",
                      heavy.string(), frames.size(), rows.size(), grids.size(), tables.size()));
    }
    for (std::size_t t = 0; t < tables.size(); ++t) check_table(heavy, tables[t], rows[t]);
  }
};

FrameFile::FrameFile(const std::filesystem::path& folder, std::vector<Grid> grids,
                     const std::vector<Parts<GridTopology>>& topologies, Opening opening,
                     std::vector<std::string> tables)
    : implementation_(
          std::make_unique<Implementation>(folder, std::move(grids), topologies, opening, std::move(tables))) {}

FrameFile::~FrameFile() = default;

void FrameFile::append(double time, const std::vector<Parts<GridFrame>>& frames,
                       const std::vector<FrameTable>& tables) {
  implementation_->append(time, frames, tables);
}

int FrameFile::count() const { return implementation_->count; }

int& FrameFile::written_count() { return implementation_->count; }

std::vector<std::string>& FrameFile::document_frames() { return implementation_->document.frames(); }

void FrameFile::loaded() { implementation_->cut_back(); }

}  // namespace pliant
