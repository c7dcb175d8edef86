#pragma once

#include <string>
#include <vector>

namespace pliant {

/// Installs the program's logger, which writes to stderr, and keeps the texts of warnings even where they are not shown.
void install_logger();
/// Whether to write errors only.
void write_errors_only();
/// Warnings of this process so far, each text once.
const std::vector<std::string>& warnings_so_far();

}  // namespace pliant
