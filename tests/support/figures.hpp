#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include <fmt/format.h>

/// Figures of a test beside its verdict: gtest's report has them as properties, and verify/frozen_states shows them.
namespace pliant::testing {

/// Keeps the largest value of each name within the test under way.
class LargestFigures {
 public:
  void note(const std::string& name, double value) {
    double& largest = largest_.try_emplace(name, value).first->second;
    largest = std::max(largest, value);
    ::testing::Test::RecordProperty(name, fmt::format("{:.3e}", largest));
  }

 private:
  std::map<std::string, double> largest_;
};

}  // namespace pliant::testing
