#pragma once

#include <string>
#include <vector>

namespace pliant {

/// Installs the program's logger. It writes to stderr, and keeps the texts of warnings, also of those not shown.
void install_logger();
/// From now on stderr gets errors only.
void write_errors_only();
/// Warnings of this process so far, each text once.
const std::vector<std::string>& warnings_so_far();

}  // namespace pliant
