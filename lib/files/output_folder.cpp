#include "files/output_folder.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/errors.hpp"
#include "files/atomic_file.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// A file whose kind a run or its plots write. Scene files other than scene.toml are the user's own.
bool is_result(const fs::directory_entry& entry) {
  constexpr std::array<std::string_view, 13> endings = {".csv", ".h5",  ".xdmf", ".json", ".png", ".svg", ".log",
                                                        ".tmp", ".bin", ".vtu",  ".lock", ".msh", ".html"};
  if (!entry.is_regular_file()) return false;
  const std::string ending = entry.path().extension().string();
  return entry.path().filename() == "scene.toml" || std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// A file that write_file_atomically had not put in place yet: NAME.PID.tmp.
bool is_temporary(const fs::directory_entry& entry) {
  const fs::path name = entry.path().filename();
  const std::string process = name.stem().extension().string();
  return entry.is_regular_file() && name.extension() == ".tmp" && process.size() > 1 &&
         process.find_first_not_of("0123456789", 1) == process.npos;
}

bool holds_nothing(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), is_temporary);
}

/// Throws when an entry of a folder may be somebody else's.
void require_results(const fs::path& folder) {
  if (!fs::exists(folder / "summary.json") && !fs::exists(folder / "scene.toml") && !fs::exists(folder / "run.lock")) {
    throw OutputError(
        fmt::format("{}: will not be overwritten: it holds neither summary.json nor scene.toml, so no run "
                    "of this program wrote it; choose another output folder or remove it yourself",
                    folder.string()));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!is_result(entry)) {
      throw OutputError(
          fmt::format("{}: will not be overwritten: it holds '{}', which no run of this program writes; "
                      "move it away or choose another output folder",
                      folder.string(), entry.path().filename().string()));
    }
  }
}

/// Permission bits say nothing about a read-only disk or a full one: try.
void require_writable(const fs::path& folder) {
  const fs::path trial = folder / fmt::format("trial.{}.tmp", ::getpid());
  write_file_atomically(trial, "trial\n");
  fs::remove(trial);
}

void check(const fs::path& folder, bool overwrite) {
  if (!fs::exists(folder)) fs::create_directories(folder);
  if (!fs::is_directory(folder)) {
    throw OutputError(fmt::format("{}: is not a folder; choose another output folder", folder.string()));
  }
  if (!holds_nothing(folder)) {
    if (!overwrite) {
      throw OutputError(
          fmt::format("{}: exists and is not empty; choose another output folder (--out) or overwrite it "
                      "(--force)",
                      folder.string()));
    }
    require_results(folder);
  }
  require_writable(folder);
}

void empty(const fs::path& folder, const std::set<std::string>& kept) {
  // First what says that there is a run to go on with.
  for (const char* name : {"summary.json", "checkpoint.bin"}) fs::remove(folder / name);
  std::vector<fs::path> results;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (is_result(entry) && name != "run.lock" && !kept.contains(name)) results.push_back(entry.path());
  }
  for (const fs::path& result : results) fs::remove(result);
}

/// Calls a function; what goes wrong in the file system is told with the folder and what to do.
template <class Function>
void on_folder(const fs::path& folder, Function&& function) {
  try {
    function();
  } catch (const fs::filesystem_error& error) {
    throw OutputError(
        fmt::format("{}: cannot be used as an output folder: {}; choose another one or check its permissions",
                    folder.string(), error.code().message()));
  }
}

}  // namespace

void check_output_folder(const fs::path& folder, bool overwrite) {
  on_folder(folder, [&] { check(folder, overwrite); });
}

void empty_output_folder(const fs::path& folder, const std::set<std::string>& kept) {
  on_folder(folder, [&] { empty(folder, kept); });
}

void prepare_output_folder(const fs::path& folder, bool overwrite) {
  check_output_folder(folder, overwrite);
  empty_output_folder(folder);
}

void tell_output_folder(const fs::path& folder) {
  if (const char* file = std::getenv("PLIANT_TELL_FOLDER")) write_file_atomically(file, folder.string() + "\n");
}

void remove_temporary_files(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (is_temporary(entry)) found.push_back(entry.path());
  on_folder(folder, [&] {
    for (const fs::path& file : found) fs::remove(file);
  });
}

bool begins_anew(const fs::path& folder) {
  if (!fs::exists(folder)) return true;
  if (!fs::is_directory(folder) || fs::exists(folder / "checkpoint.bin")) return false;
  return fs::exists(folder / "run.lock") || holds_nothing(folder);
}

}  // namespace pliant
