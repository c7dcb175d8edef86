#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>

#include "core/vec2.hpp"

namespace pliant::fuzz {

/// What a fuzzer gave, taken from the front; zeros when it ends.
class Input {
 public:
  Input(const std::uint8_t* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
  int byte() {
    if (count_ == 0) return 0;
    --count_;
    return *bytes_++;
  }
  bool empty() const { return count_ == 0; }
  std::string_view rest() const { return {reinterpret_cast<const char*>(bytes_), count_}; }

 private:
  const std::uint8_t* bytes_;
  std::size_t count_;
};

/// Ends the process, so that the fuzzer keeps the input.
inline void require(bool holds, std::string_view what) {
  if (holds) return;
  fmt::print(stderr, "does not hold: {}\n", what);
  std::abort();
}

/// A folder of this process, in memory where the system has such.
class Scratch {
 public:
  Scratch() {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path parent =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    folder_ = parent / fmt::format("pliant_fuzz_{}", getpid());
    std::filesystem::create_directory(folder_);
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

inline const std::filesystem::path& scratch_folder() {
  static const Scratch scratch;
  return scratch.folder();
}

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

/// A polygon around the origin that does not cross itself, with corners as far out as the input says: nearly coinciding
/// ones, needles and flat corners among them.
inline Points star_polygon(Input& input) {
  const int corners = 3 + input.byte() % 30;
  Points points;
  for (int i = 0; i < corners; ++i) {
    const double angle = (i + input.byte() / 256.0) * 2 * std::numbers::pi / corners;
    const double radius = (1 + input.byte()) / 256.0;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

}  // namespace pliant::fuzz
