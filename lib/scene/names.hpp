#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pliant {

/// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours, one character each.
int edit_distance(std::string_view a, std::string_view b);

/// The name closest to `word`, or an empty string when none differs in less than half of the letters.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

/// `allowed: a, b, c; nearest: b` for messages (the part on the nearest only when there is one).
std::string allowed_names(std::string_view word, const std::vector<std::string>& names);

/// What the [[grains]] of that number, from 1, are called that give no name.
std::string default_grains_name(std::size_t number);

}  // namespace pliant
