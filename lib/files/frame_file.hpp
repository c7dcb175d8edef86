#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/vec2.hpp"
#include "files/text_output.hpp"

namespace pliant {

/// Files know arrays and names, no mechanics. All arrays are row-major.

/// A named array over the points or cells of a grid.
struct Field {
  std::string name;
  enum class Centre { point, cell } centre = Centre::point;
  int components = 1;  ///< 1 scalar, 2 vector (written with a zero third component for ParaView)
};

/// What a grid is. `cell_size` 3: triangles, 2: line segments.
struct Grid {
  std::string name;  ///< "bodies", "outlines"
  int points = 0;
  int cell_size = 3;
  int cells = 0;
  std::vector<Field> constant_fields;  ///< written once: kind, body
  std::vector<Field> fields;           ///< in every frame
};

/// Adds both components to the values of a field, or to positions.
inline void append(const Vec2& v, std::vector<float>& values) {
  for (const double component : {v.x(), v.y()}) values.push_back(static_cast<float>(component));
}

/// Of a part of a grid, what is written once.
struct GridTopology {
  std::vector<int> cells;                  ///< [cells x cell_size]
  std::vector<std::vector<float>> values;  ///< [constant fields][points or cells x components]
};

/// Of a part of a grid, what changes from frame to frame.
struct GridFrame {
  std::vector<float> positions;            ///< [points x 2], m
  std::vector<std::vector<float>> values;  ///< [fields][points or cells x components]
};

/// Hands over a grid's parts, one after the other: the whole of one may be as large as all the rest of a run.
template <class Part>
using Parts = std::function<void(const std::function<void(const Part&)>& take)>;

/// All of a grid.
template <class Part>
Parts<Part> whole(Part part) {
  return [part = std::move(part)](const std::function<void(const Part&)>& take) { take(part); };
}

/// Columns of one length, which may be another in every frame.
struct FrameTable {
  std::string name;
  struct Column {
    std::string name;
    int components = 1;
    std::vector<float> values;  ///< [rows x components]
  };
  std::vector<Column> columns;
};

/// frames.h5 with frames.xdmf beside it. Layout: /<grid>/cells, /<grid>/<constant field>, and /<grid>/<frame, six
/// digits>/{position,<field>...}, with attribute `time` (s) on the frame's group; /times lists them. A table is not in
/// the XDMF file: /<table>/<frame>/<column>. After every append both files are complete and readable. Throws
/// OutputError.
class FrameFile {
 public:
  /// Topologies, one a grid, are asked for where the file is made.
  FrameFile(const std::filesystem::path& folder, std::vector<Grid> grids,
            const std::vector<Parts<GridTopology>>& topologies, Opening opening = Opening::create,
            std::vector<std::string> tables = {});
  ~FrameFile();
  /// One frame a grid and one FrameTable a table, in the order of the constructor.
  void append(double time, const std::vector<Parts<GridFrame>>& frames, const std::vector<FrameTable>& tables = {});
  int count() const;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("count", written_count());
    visitor("document", document_frames());
  }
  /// Cuts off the frames after those that were read by visit. Throws OutputError when the files hold less.
  void loaded();

 private:
  int& written_count();
  std::vector<std::string>& document_frames();

  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pliant
