#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "input/value.hpp"

namespace pliant {

/// Limits that keep a slip of the pen from asking for all of the memory.
struct SceneLimits {
  static constexpr std::int64_t nodes_per_shape = 200'000;
  static constexpr std::int64_t polygon_points = 10'000;
  static constexpr std::int64_t variants = 1000;
  static constexpr std::int64_t cells = 10'000;
  static constexpr std::int64_t bodies = 1'000'000;
  static constexpr std::int64_t field_nodes = 100'000'000;
  static constexpr std::int64_t wall_nodes = 1'000'000;
  static constexpr std::int64_t outputs = 10'000'000;
};

/// What a key with tables holds.
struct SubTable {
  enum class Form { one, named, array } form = Form::one;
  std::string allowed() const;
};

using KeyKind =
    std::variant<SubTable, Quantity, QuantityOr, Friction, Integer, Flag, Text, Identifier, OneOf, Choice, Vector,
                 Matrix, Corners, HistoryOf, VectorHistory, List<Quantity>, List<Vector>, List<OneOf>>;

/// What holds without a key.
struct Default {
  explicit(false) Default(const char* text, const char* when_required = "", bool by_reader = false)
      : value(text), required(when_required), derived(by_reader) {}

  std::string value;     ///< as a scene would give it, or "none"; the reader checks it; empty: the key must be there
  std::string required;  ///< when the key must be there, such as "without `species`"
  bool derived;          ///< `value` are words for what the reader takes from the rest of the scene
};
inline const Default required{"", "always"};
inline Default required_if(const char* when, const char* otherwise = "") { return {otherwise, when}; }
inline Default derived(const char* words) { return {words, "", true}; }

/// A key of a table. A key with several kinds of values, or with limits that another key decides, has a row for each.
struct SceneKey {
  std::string name;
  KeyKind kind;
  Default otherwise;
  std::string meaning;
  /// When the table may have the key. `law = "a", "b"`: with these names of another key (`!=`: with others); `species`:
  /// with another key. The reader checks these. Other words are for people.
  std::string with{};
  std::string formerly{};  ///< an old name, which is read with a warning
};

struct SceneTable {
  std::string title;  ///< without names and numbers: "[materials.NAME]", "packing of [[grains]]"
  std::vector<SceneKey> keys;
};

/// What scene files may hold: TableReader reads by it, messages name its keys, and docs/scene.md prints it.
const std::vector<SceneTable>& scene_tables();
const SceneTable& scene_table(const std::string& title);
inline constexpr const char* top_table = "Top level";
/// Rows of the tables under a key: [key], [key.NAME] or [[key]] at the top, else "key of [[parent]]".
const SceneTable& sub_table(const SceneTable& parent, const SceneKey& key);

// Their parts.
std::vector<SceneTable> setting_tables();
std::vector<SceneTable> body_tables();
std::vector<SceneTable> load_and_contact_tables();
std::vector<SceneTable> output_tables();

/// All names that keys have in some table, sorted.
std::span<const std::string> scene_keys();

/// Whether some table has a key of this name: others are misspelt, whatever table they stand in.
bool is_scene_key(std::string_view word);

/// A section a table, a row a key, in Markdown.
std::string scene_key_tables();

/// Rows that readers asked for, and whether the key had to be there.
using KeyUse = std::set<std::pair<const SceneKey*, bool>>;

/// read_scene that notes in `use`, unless it is nullptr, what the file is asked for.
Scene read_scene(const std::filesystem::path& file, KeyUse* use);

inline constexpr SubTable one_table{SubTable::Form::one}, named_tables{SubTable::Form::named},
    array_of_tables{SubTable::Form::array};

// Choices that the readers turn into something else.
enum class ShapeName { disc, polygon, regular, ellipse, fourier, file };
enum class PackingName { hexagonal, grid, positions, file, in_place, random, fourier_voronoi };
enum class OutlineSide { left, right, bottom, top };
enum class Variant { each };

}  // namespace pliant
