#pragma once

#include <toml++/toml.h>
#include <string>
#include <vector>

namespace pliant {

/// Gives keys of a scene that stand under the name that they had before (SceneKey::formerly) their present one, with
/// their place. Returns a warning for each, "file:line:column: ...". Throws InputError where a table has both.
std::vector<std::string> rename_old_keys(toml::table& scene, const std::string& file);

}  // namespace pliant
