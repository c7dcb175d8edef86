#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/line_reader.hpp"

namespace pliant {

/// The parts of a line of a text table: between commas, semicolons or tabs, whichever it has, or else between blanks,
/// where "[unit]" belongs to the name before it; "#" begins a comment. Throws InputError at the line for numbers with a
/// decimal comma, as in "0,5;0,7".
std::vector<std::string_view> columns_of(const LineReader& reader);

/// What a column is called by the first line of a text table: "x [mm]" is x in "mm".
struct ColumnName {
  std::string name;                 ///< lower case
  std::optional<std::string> unit;  ///< as it stands between the brackets; nullopt: there are none
};
ColumnName column_name(std::string_view field);

/// How a field should be written whose unit stands elsewhere than in brackets, for messages: `; write "x [mm]"` for
/// "x (mm)", "x_mm" or "x/mm"; else empty.
std::string unit_hint(std::string_view field);

/// The line of a text table that may name its columns though it is a comment, as programs write them ("# x [mm], y
/// [mm]" by numpy.savetxt).
class CommentedNames {
 public:
  /// Keeps the line where it is a comment whose every part is one of `names`, in whatever unit, x and y among them;
  /// else it is a comment like others.
  void look_at(const LineReader& reader, const std::vector<std::string>& names);
  const std::optional<LineReader>& line() const { return line_; }  ///< the last such; errors name it
  std::vector<std::string_view> fields() const;                    ///< of that line

 private:
  std::optional<LineReader> line_;
};

}  // namespace pliant
