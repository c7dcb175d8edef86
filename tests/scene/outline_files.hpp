#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/errors.hpp"

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

inline void expect_refused(const std::string& message, const std::string& start, const std::string& phrase) {
  EXPECT_TRUE(message.starts_with(start)) << message;
  EXPECT_NE(message.find(phrase), std::string::npos) << message;
}

}  // namespace pliant::scene_tests
