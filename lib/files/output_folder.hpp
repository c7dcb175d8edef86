#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace pliant {

/// Creates an output folder, or makes sure that an existing one may be used: it is empty or, with `overwrite`, holds
/// what a run of this program wrote (known by a summary.json, scene.toml or run.lock) and nothing but kinds of files
/// that a run writes. Throws OutputError for any other and where nothing can be written. Removes nothing.
void check_output_folder(const std::filesystem::path& folder, bool overwrite);

/// Removes the results of an earlier run from a folder that was checked, but for run.lock and the files named in
/// `kept`. A kill in between leaves the earlier run whole, or no checkpoint: never one beside files that it does not
/// fit.
void empty_output_folder(const std::filesystem::path& folder, const std::set<std::string>& kept = {});

/// Both, one after the other.
void prepare_output_folder(const std::filesystem::path& folder, bool overwrite);

/// Tells a caller that asks where results go: writes the folder into the file that the environment variable
/// PLIANT_TELL_FOLDER names, if there is one. Throws OutputError when that cannot be written.
void tell_output_folder(const std::filesystem::path& folder);

/// Removes what killed runs had begun to write and not yet put in place.
void remove_temporary_files(const std::filesystem::path& folder);

/// Whether there is nothing to resume: no such folder, or its run was killed before its first checkpoint. Then its lock
/// is there, or nothing at all is in the folder, and what it wrote is of no use.
bool begins_anew(const std::filesystem::path& folder);

}  // namespace pliant
