#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/text_output.hpp"
#include "reference/outputs/view.hpp"

namespace pliant::reference {

/// Writes probes.csv with the engine's columns, for the quantities that this solver has.
class ProbeFile {
 public:
  ProbeFile(const Bodies& bodies, const std::filesystem::path& folder);

  double next_time() const;
  void record_due(const View& view);
  /// Names of the scene's probes whose quantities this solver does not have.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  struct Entry {
    Probe probe;
    std::vector<int> bodies;  ///< bodies that `of` names
    std::size_t columns = 0;
    long count = 0;  ///< rows so far
  };
  std::vector<std::string> choose(const Bodies& bodies);

  std::vector<Entry> entries_;
  std::vector<std::string> left_out_;
  CsvFile file_;
};

}  // namespace pliant::reference
