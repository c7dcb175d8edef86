#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "input/read_scene.hpp"
#include "input/scene_files.hpp"

/// Scenes with one mistake, and what their refusal must say.
namespace pliant::scene_tests {

/// One change to the good scene. The error must stand at the first `at` of the changed text, and `message` gives its
/// words: " ... " stands for any. In `from`, `to` and `at`, ' is ".
struct Bad {
  std::string name, from, to, at, message;
};

/// A scene of rigid discs, up to what else their table says.
inline const std::string stones = R"([time]
end = 1
[materials.stone]
law = "rigid"
density = 1
[shapes.disc]
kind = "disc"
diameter = 1
nodes = 100
[[grains]]
shape = "disc"
body = "rigid"
material = "stone"
)";

/// What ctest lists beside the test's name.
inline void PrintTo(const Bad& bad, std::ostream* out) { *out << '\'' << bad.to << "' for '" << bad.from << '\''; }

inline std::string error_of(const std::string& text) {
  const SceneFile file(text);
  try {
    read_scene(file.path());
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string path = file.path().string() + ":";
    EXPECT_TRUE(message.starts_with(path)) << message;
    return message.substr(std::min(path.size(), message.size()));
  }
  return "no error";
}

inline std::string line_and_column(const std::string& text, std::size_t offset) {
  int line = 1, column = 1;
  for (std::size_t i = 0; i < offset; ++i) {
    column = text[i] == '\n' ? 1 : column + 1;
    line += text[i] == '\n' ? 1 : 0;
  }
  return std::to_string(line) + ":" + std::to_string(column) + ": ";
}

inline std::string double_quoted(std::string text) {
  std::replace(text.begin(), text.end(), '\'', '"');
  return text;
}

/// EXACT: place and words of the message.
inline void expect_refused(const Bad& bad) {
  const std::string text = edited({{double_quoted(bad.from), double_quoted(bad.to)}});
  const auto expected = text.find(double_quoted(bad.at));
  ASSERT_NE(expected, std::string::npos) << bad.at;
  const std::string message = error_of(text), gap = " ... ";
  EXPECT_TRUE(message.starts_with(line_and_column(text, expected)))
      << message << "\nexpected at " << line_and_column(text, expected);
  std::size_t at = 0;
  for (std::size_t begin = 0; begin < bad.message.size();) {
    const std::size_t end = std::min(bad.message.find(gap, begin), bad.message.size());
    const std::string words = bad.message.substr(begin, end - begin);
    at = message.find(words, at);
    ASSERT_NE(at, std::string::npos) << message << "\nlacks, or has earlier, " << words;
    at += words.size();
    begin = end + gap.size();
  }
}

inline std::string name_of(const ::testing::TestParamInfo<Bad>& info) { return info.param.name; }

}  // namespace pliant::scene_tests
