#pragma once

#include <filesystem>
#include <string>

namespace pliant {

/// Hands all of a text to an open file. 0, or the errno of the write that failed.
int write_all(int descriptor, const std::string& content);

/// Throws OutputError with what could not be done, as "be written", and why.
[[noreturn]] void refuse_file(const std::filesystem::path& file, const char* action, int error);

}  // namespace pliant
