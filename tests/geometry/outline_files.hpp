#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "geometry/outline_file.hpp"
#include "geometry/polygon_rules.hpp"

/// Files written for one test, and what readers say of them.
namespace pliant::scene_tests {

/// A file in the temporary folder, removed at the end.
struct TextFile {
  std::filesystem::path path;
  TextFile(const std::string& extension, const std::string& text)
      : path(std::filesystem::path(::testing::TempDir()) /
             (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + extension)) {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TextFile() { std::filesystem::remove(path); }
};

/// What a file is refused with, less its folder and name: "LINE: reason".
template <class Read>
std::string refusal(const std::string& extension, const std::string& text, Read&& read) {
  const TextFile file(extension, text);
  try {
    read(file.path);
  } catch (const InputError& error) {
    const std::string message = error.what(), place = file.path.string() + ":";
    EXPECT_TRUE(message.starts_with(place)) << message;
    return message.substr(std::min(place.size(), message.size()));
  }
  return "no error";
}

inline std::vector<Points> read_parts(const std::string& extension, const std::string& text, const std::string& parts,
                                      const std::string& unit = "") {
  const TextFile file(extension, text);
  return read_outline_file(file.path, unit, parts, 100);
}

inline std::string error_of_parts(const std::string& extension, const std::string& text, const std::string& parts,
                                  const std::string& unit = "") {
  return refusal(extension, text,
                 [&](const std::filesystem::path& path) { read_outline_file(path, unit, parts, 100); });
}

inline void expect_refused(const std::string& message, const std::string& start, const std::string& phrase) {
  EXPECT_TRUE(message.starts_with(start)) << message;
  EXPECT_NE(message.find(phrase), std::string::npos) << message;
}

inline const Points square_of_2{{0, 0}, {2, 0}, {2, 2}, {0, 2}};

inline void expect_square(const Points& found, double unit) {
  ASSERT_EQ(found.size(), 4U);
  EXPECT_NEAR(signed_area(found), 4 * unit * unit, 1e-15 * unit * unit);
  for (const Vec2& corner : square_of_2)
    EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                            [&](const Vec2& p) { return (p - unit * corner).norm() < 1e-15 * unit; }));
}

inline const std::string head_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
inline const std::string nodes_22 = "$Nodes\n5\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n9 1 1 0\n$EndNodes\n";
// Four triangles around node 9, lines and a point beside them.
inline const std::string elements_22 =
    "$Elements\n6\n1 15 2 0 1 1\n2 1 2 0 1 1 2\n3 2 2 0 1 1 2 9\n4 2 2 0 1 2 3 9\n5 2 2 0 1 3 4 9\n6 2 2 0 1 4 1 9\n"
    "$EndElements\n";

}  // namespace pliant::scene_tests
