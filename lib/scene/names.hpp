#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

/// All names that keys have in some table of a scene file, sorted.
std::span<const std::string_view> scene_keys();

/// Whether some table of a scene file has a key of this name: others are misspelt, whatever table they stand in.
bool is_scene_key(std::string_view word);

/// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours, one character each.
int edit_distance(std::string_view a, std::string_view b);

/// The name closest to `word`, or an empty string when none differs in less than half of the letters.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

/// `allowed: a, b, c; nearest: b` for messages (the part on the nearest only when there is one).
std::string allowed_names(std::string_view word, const std::vector<std::string>& names);

/// What the [[grains]] of that number, from 1, are called that give no name.
std::string default_grains_name(std::size_t number);

}  // namespace pliant
