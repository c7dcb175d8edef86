#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/errors.hpp"
#include "files/text_files.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// A file whose kind a run or its plots write. Scene files other than scene.toml are the user's own.
bool is_result(const fs::directory_entry& entry) {
  constexpr std::array<std::string_view, 12> endings = {".csv", ".h5",  ".xdmf", ".json", ".png",  ".svg",
                                                        ".log", ".tmp", ".bin",  ".vtu",  ".lock", ".msh"};
  if (!entry.is_regular_file()) return false;
  const std::string ending = entry.path().extension().string();
  return entry.path().filename() == "scene.toml" || std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// Every entry of a folder that a run wrote. Throws before anything is removed when one of them may be somebody else's.
std::vector<fs::path> results_in(const fs::path& folder) {
  if (!fs::exists(folder / "summary.json") && !fs::exists(folder / "scene.toml")) {
    throw OutputError(
        fmt::format("{}: will not be overwritten: it holds neither summary.json nor scene.toml, so no run "
                    "of this program wrote it; choose another output folder or remove it yourself",
                    folder.string()));
  }
  std::vector<fs::path> results;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!is_result(entry)) {
      throw OutputError(
          fmt::format("{}: will not be overwritten: it holds '{}', which no run of this program writes; "
                      "move it away or choose another output folder",
                      folder.string(), entry.path().filename().string()));
    }
    results.push_back(entry.path());
  }
  return results;
}

/// Permission bits say nothing about a read-only disk or a full one: try.
void require_writable(const fs::path& folder) {
  const fs::path trial = folder / fmt::format("trial.{}", ::getpid());
  write_file_atomically(trial, "trial\n");
  fs::remove(trial);
}

void prepare(const fs::path& folder, bool overwrite) {
  if (!fs::exists(folder)) fs::create_directories(folder);
  if (!fs::is_directory(folder)) {
    throw OutputError(fmt::format("{}: is not a folder; choose another output folder", folder.string()));
  }
  if (!fs::is_empty(folder)) {
    if (!overwrite) {
      throw OutputError(
          fmt::format("{}: exists and is not empty; choose another output folder (--out) or overwrite it "
                      "(--force)",
                      folder.string()));
    }
    const std::vector<fs::path> results = results_in(folder);
    require_writable(folder);
    for (const fs::path& result : results) fs::remove(result);
  }
  require_writable(folder);
}

}  // namespace

void prepare_output_folder(const std::filesystem::path& folder, bool overwrite) {
  try {
    prepare(folder, overwrite);
  } catch (const fs::filesystem_error& error) {
    throw OutputError(
        fmt::format("{}: cannot be used as an output folder: {}; choose another one or check its permissions",
                    folder.string(), error.code().message()));
  }
}

}  // namespace pliant
