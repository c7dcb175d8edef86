// The lists of quantities and fields: complete, documented, and each with its function.
#include "scene/quantities.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "results/frame_fields.hpp"
#include "setup/build_model.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

std::string read_documentation() {
  std::ifstream stream(std::filesystem::path(PLIANT_SOURCE_DIR) / "docs/probes.md");
  return {std::istreambuf_iterator<char>(stream), {}};
}

Probe anything_like(const ProbeQuantity& quantity) {
  using Of = ProbeQuantity::Of;
  Probe probe = probe_of(quantity.name, quantity.of == Of::whole ? "" : quantity.of == Of::walls ? "upper" : "layer");
  if (quantity.where == ProbeQuantity::Where::region_needed) probe.between = {"lower", "upper"};
  return probe;
}

TEST(Quantities, have_functions_and_columns) {
  std::set<std::string> described, implemented;
  for (const ProbeQuantity& quantity : probe_quantities()) EXPECT_TRUE(described.insert(quantity.name).second);
  for (const ProbeFunction& function : probe_functions()) EXPECT_TRUE(implemented.insert(function.name).second);
  EXPECT_EQ(described, implemented) << "EXACT";
  const Model model = build_model(small_third_body(0.1));
  Simulation simulation(model);
  advance(simulation, 0.1);
  for (const ProbeQuantity& quantity : probe_quantities())
    EXPECT_EQ(measured(simulation, anything_like(quantity)).size(), quantity.columns.size())
        << "EXACT: " << quantity.name;
}

/// A '|' would end a table's column in docs/probes.md.
TEST(Quantities, meanings_fit_into_tables) {
  for (const ProbeQuantity& quantity : probe_quantities())
    EXPECT_EQ(std::string(quantity.meaning).find('|'), std::string::npos) << "EXACT: " << quantity.name;
  for (const FrameField& field : frame_fields())
    EXPECT_EQ(std::string(field.meaning).find('|'), std::string::npos) << "EXACT: " << field.name;
}

TEST(Quantities, fields_have_functions) {
  for (const FrameField& field : frame_fields()) {
    if (field.constant)
      EXPECT_TRUE(constant_field(field.name)) << "EXACT";
    else if (field.grid == FrameField::Grid::bodies)
      EXPECT_TRUE(body_field(field.name)) << "EXACT";
    else
      EXPECT_TRUE(outline_field(field.name)) << "EXACT";
  }
}

/// On a change: put the tables that a failure prints into docs/probes.md.
TEST(Quantities, are_documented) {
  const std::string text = read_documentation();
  for (const std::string& table : {probe_table(), field_table()})
    EXPECT_NE(text.find(table), std::string::npos) << "EXACT: docs/probes.md lacks\n" << table;
}

TEST(Quantities, every_unit_stands_in_the_header) {
  for (const ProbeQuantity& quantity : probe_quantities())
    for (const std::string& column : quantity.columns) {
      EXPECT_NE(column.find(" ["), std::string::npos) << "EXACT: " << column;
      EXPECT_TRUE(column.ends_with("]")) << "EXACT: " << column;
    }
}

}  // namespace
}  // namespace pliant::dynamics_tests
