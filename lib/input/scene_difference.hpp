#pragma once

#include <string>

namespace pliant {

/// What a run that goes on would do otherwise by the text `now` of a scene file than by `before`: the first key that
/// differs, with both values; empty when none does. The end, the title and [checkpoint] may differ: they change no
/// step. Throws InputError for text that is not TOML.
std::string scene_difference(const std::string& before, const std::string& now);

/// Likewise of a run that starts from the end of another one: the first key that differs and must not. Bodies, shapes
/// and the discretisation must be the same; loads, motions, laws' constants, contact, time and outputs may differ.
std::string start_difference(const std::string& before, const std::string& now);

}  // namespace pliant
