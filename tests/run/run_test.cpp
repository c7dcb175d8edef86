// A whole run into a folder: every file that is promised, with what is promised in it; runs that fail, and folders
// that are in use.
#include "run/run.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fmt/format.h>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/errors.hpp"
#include "files/temporary_folder.hpp"
#include "input/read_scene.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

namespace fs = std::filesystem;

/// A compliant and a rigid disc between a floor and a plate that comes down; some probes and every field.
const std::string pressed_discs = R"(title = "Pressed discs"
[domain]
period = 5
gravity = [0, -0.01]
[time]
end = 2
[materials.soft]
law = "neo-hookean"
density = 1
young = 2.8
poisson = 0.4
[materials.hard]
law = "rigid"
density = 1
[shapes.disc]
kind = "disc"
diameter = 2
nodes = 60
[[grains]]
name = "first"
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [[1.2, 0]] }
[[grains]]
name = "second"
shape = "disc"
body = "rigid"
material = "hard"
packing = { kind = "positions", positions = [[3.7, 0]] }
velocity = { rotation = 0.5 }
[[walls]]
name = "floor"
material = "hard"
solid = "below"
level = -1.005
[[walls]]
name = "plate"
material = "hard"
solid = "above"
level = 1.01
y = { velocity = -0.02 }
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
stiffness = 100
[[probes]]
name = "push"
quantity = "force"
of = "plate"
period = 0.25
[[probes]]
name = "where"
quantity = "position"
of = "first"
period = 0.5
[[probes]]
name = "how_fast"
quantity = "velocity"
of = "second"
period = 0.25
[[probes]]
name = "wide"
quantity = "diameter"
of = "first"
period = 0.5
[[probes]]
name = "balance"
quantity = "energy"
period = 0.25
[[probes]]
name = "drag"
quantity = "friction_factor"
of = "floor"
period = 0.25
[frames]
period = 0.5
fields = ["velocity", "von_mises", "jacobian", "pressure", "contact_pressure", "displacement", "acceleration", "tresca",
  "strain_energy_density", "contact_count", "material", "scale", "contact_shear", "contact_gap", "contact_slip",
  "stress_xx", "stress_yy", "stress_xy", "stress_zz", "principal_stress_1", "principal_stress_2", "strain_xx",
  "strain_yy", "strain_xy"]
)";

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << "the scene has no " << old;
  return text.replace(at, old.size(), by);
}

/// A floor too soft to stop the grains: contacts are lost when a node is a segment length deep.
const std::string sinking_discs =
    replaced(replaced(pressed_discs, "stiffness = 100", "stiffness = 1e-3"), "end = 2", "end = 200");

using Rows = std::vector<std::vector<double>>;

/// A table's header, and its rows with NaN for empty cells.
struct Table {
  std::vector<std::string> header;
  Rows rows;

  std::vector<double> column(const std::string& name) const {
    const auto at = std::find(header.begin(), header.end(), name);
    EXPECT_NE(at, header.end()) << "no column " << name;
    std::vector<double> values;
    for (const auto& row : rows) values.push_back(row[static_cast<std::size_t>(at - header.begin())]);
    return values;
  }
};

Table read_table(const fs::path& file) {
  Table table;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> cells;
    std::istringstream parts(line + ",");
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (table.header.empty()) {
      table.header = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), table.header.size()) << line;
    auto& row = table.rows.emplace_back();
    for (const std::string& cell : cells) row.push_back(cell.empty() ? std::nan("") : std::stod(cell));
  }
  return table;
}

/// The engine that was built beside these tests.
fs::path engine() { return fs::canonical("/proc/self/exe").parent_path() / "pliant_engine"; }

class RunScene : public testing::TemporaryFolder {
 protected:
  Scene scene(const std::string& text) const {
    std::ofstream(folder_ / "scene.toml") << text;
    return read_scene(folder_ / "scene.toml");
  }
  fs::path out() const { return folder_ / "out"; }
  void run(const std::string& text) const { run_scene(scene(text), {out(), false, true, 1}); }
  nlohmann::json summary() const { return nlohmann::json::parse(read(out() / "summary.json")); }

  /// Exit code of a command; what it prints goes to log.txt.
  int shell(const std::string& command) const {
    const int status = std::system((command + " > " + (folder_ / "log.txt").string() + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int run_engine(const std::string& options) const {
    return shell(engine().string() + " run " + (folder_ / "scene.toml").string() + " --out " + out().string() +
                 " --threads 1 " + options);
  }
  int check_frames() const {
    return shell("/usr/bin/python3 " PLIANT_SOURCE_DIR "/tests/files/check_xdmf.py " + out().string());
  }
};

TEST_F(RunScene, summary_has_every_key) {
  run(pressed_discs);
  const nlohmann::json json = summary();
  for (const char* key : {"state_hash", "evaluations", "steps", "rejections", "preparation_seconds", "wall_seconds",
                          "evaluations_per_second", "energy", "momentum_error", "peak_memory_bytes", "bodies", "nodes",
                          "dofs", "commit", "compiler", "threads"})
    EXPECT_TRUE(json.contains(key)) << "EXACT: " << key;
  double seconds = 0;
  for (const char* phase : {"outlines", "candidates", "contact", "internal", "update", "bound", "output"}) {
    EXPECT_GE(json["phase_seconds"][phase], 0) << "EXACT: " << phase;
    seconds += json["phase_seconds"][phase].get<double>();
  }
  const double wall = json["wall_seconds"];
  EXPECT_NEAR(seconds, wall, 1e-13 * wall) << "EXACT: rounding of 14 sums";
  for (const char* key : {"kinetic", "strain", "contact", "dissipated", "external_work", "balance_error"})
    EXPECT_TRUE(json["energy"].contains(key)) << "EXACT: " << key;
  EXPECT_EQ(json["bodies"], 4) << "EXACT";
  EXPECT_EQ(json["threads"], 1) << "EXACT";
  EXPECT_EQ(json["status"], "finished") << "EXACT";
  EXPECT_EQ(json["time"], 2.0) << "EXACT: the end";
  EXPECT_GE(json["evaluations"], json["steps"]) << "EXACT";
  EXPECT_LT(json["energy"]["balance_error"], 0.01) << "EXACT: the promise of 1 %";
  EXPECT_LT(json["momentum_error"], 1e-10) << "EXACT: rounding";
}

/// The files tell what a simulation in the test finds.
TEST_F(RunScene, files_tell_the_same_as_a_simulation) {
  run(pressed_discs);
  const Model model = build_model(scene(pressed_discs));
  Simulation simulation(model);
  const Table probes = read_table(out() / "probes.csv");
  const std::vector<double> time = probes.column("time [s]"), force = probes.column("push.force_y [N/m]"),
                            spin = probes.column("how_fast.angular_velocity [rad/s]"),
                            kinetic = probes.column("balance.kinetic [J/m]");
  std::size_t row = 0;
  std::string hash;
  const auto compare = [&] {
    EXPECT_DOUBLE_EQ(force[row], contact_force(simulation, 3).y()) << "EXACT, row " << row;
    EXPECT_DOUBLE_EQ(spin[row], rigid(simulation.state().reduced_momentum, 0)[2]) << "EXACT, row " << row;
    EXPECT_DOUBLE_EQ(kinetic[row], simulation.energy_balance().energy.kinetic) << "EXACT, row " << row;
    hash = fmt::format("{:016x}", state_hash(simulation.state()));
    return ++row < time.size();
  };
  const Observer observer{[&] { return time[row]; }, compare};
  compare();
  while (simulation.step(std::numeric_limits<double>::infinity(), &observer).dt > 0);
  EXPECT_EQ(row, time.size()) << "EXACT";
  EXPECT_EQ(summary()["state_hash"], hash) << "EXACT: the same states, step for step";
}

TEST_F(RunScene, probes_have_units_periods_and_empty_cells) {
  run(pressed_discs);
  const Table table = read_table(out() / "probes.csv");
  const std::vector<std::string> expected = {"time [s]",
                                             "push.force_x [N/m]",
                                             "push.force_y [N/m]",
                                             "where.position_x [m]",
                                             "where.position_y [m]",
                                             "where.angle [rad]",
                                             "how_fast.velocity_x [m/s]",
                                             "how_fast.velocity_y [m/s]",
                                             "how_fast.angular_velocity [rad/s]",
                                             "wide.diameter_x [m]",
                                             "wide.diameter_y [m]",
                                             "balance.kinetic [J/m]",
                                             "balance.strain [J/m]",
                                             "balance.contact [J/m]",
                                             "balance.boundary [J/m]",
                                             "balance.dissipated [J/m]",
                                             "balance.external_work [J/m]",
                                             "balance.balance_error [-]",
                                             "balance.momentum_error [-]",
                                             "drag.friction_factor [-]"};
  EXPECT_EQ(table.header, expected) << "EXACT";
  ASSERT_EQ(table.rows.size(), 9u) << "EXACT: 0 to 2 by 0.25";
  const std::vector<double> time = table.column("time [s]"), x = table.column("where.position_x [m]"),
                            width = table.column("wide.diameter_x [m]");
  for (std::size_t row = 0; row < time.size(); ++row) {
    EXPECT_EQ(time[row], 0.25 * static_cast<double>(row)) << "EXACT: steps end on output times";
    EXPECT_EQ(std::isnan(x[row]), row % 2 == 1) << "EXACT: every second row is not due";
  }
  EXPECT_NEAR(x[0], 1.2, 1e-12) << "EXACT: the centre of mass";
  EXPECT_NEAR(width[0], 2, 0.02) << "EXACT: of a polygon of 29 nodes and the circle's area";
  EXPECT_TRUE(std::isnan(table.column("where.angle [rad]")[0])) << "EXACT: a compliant body has no angle of its own";
  EXPECT_GT(table.column("push.force_y [N/m]").back(), 0) << "the grains push the plate up";
  EXPECT_LE(std::abs(table.column("drag.friction_factor [-]").back()), 0.3 * (1 + 1e-9)) << "EXACT: Coulomb";
}

TEST_F(RunScene, steps_are_monotone) {
  run(pressed_discs);
  const Table table = read_table(out() / "steps.csv");
  const std::vector<std::string> expected = {"time [s]",   "dt [s]",      "error [-]",
                                             "rejections", "evaluations", "contacts"};
  EXPECT_EQ(table.header, expected) << "EXACT";
  EXPECT_EQ(table.rows.size(), summary()["steps"]) << "EXACT";
  for (std::size_t row = 1; row < table.rows.size(); ++row) {
    const std::vector<double>&before = table.rows[row - 1], &now = table.rows[row];
    EXPECT_NEAR(now[0] - before[0], now[1], 1e-14) << "EXACT: dt is the way from row to row";
    EXPECT_GE(now[3], before[3]) << "EXACT";
    EXPECT_GT(now[4], before[4]) << "EXACT";
  }
  const std::vector<double>& last = table.rows.back();
  EXPECT_TRUE(last[0] < 2 && last[0] + 1.15 * last[1] > 2) << "EXACT: no step goes beyond the end";
}

TEST_F(RunScene, frames_resolve_every_field) {
  run(pressed_discs);
  EXPECT_EQ(check_frames(), 0) << read(folder_ / "log.txt");
  const std::string script = "/usr/bin/python3 " PLIANT_SOURCE_DIR "/tests/results/check_frames.py " + out().string();
  EXPECT_EQ(shell(script + " 5"), 0) << read(folder_ / "log.txt");
}

TEST_F(RunScene, a_frame_takes_few_bytes) {
  const auto bytes_with = [&](const std::string& period, const std::string& fields, int nodes) {
    std::string text =
        replaced(pressed_discs, "period = 0.5\nfields = ", "period = " + period + "\nfields = [" + fields + "]\n#");
    text = replaced(text.substr(0, text.find("]\n#")) + "]\n", "nodes = 60", "nodes = " + std::to_string(nodes));
    run_scene(scene(text), {out(), true, true, 1});
    return static_cast<double>(fs::file_size(out() / "frames.h5"));
  };
  const auto frame = [&](const std::string& fields, int nodes) {
    return (bytes_with("0.125", fields, nodes) - bytes_with("0.25", fields, nodes)) / 8;
  };
  for (const bool with_field : {false, true}) {
    const std::string fields = with_field ? "\"von_mises\"" : "";
    const double small = frame(fields, 60), large = frame(fields, 240);
    EXPECT_LT(small, 12000) << "FROZEN: 8.2 and 10.6 kB when written, mostly HDF5's own";
    EXPECT_LT((large - small) / 180, with_field ? 22 : 10) << "FROZEN: 7.1 and 18.5 bytes a node when written";
  }
}

TEST_F(RunScene, a_node_that_no_body_has_is_refused_before_anything_is_written) {
  const std::string text =
      replaced(pressed_discs, "of = \"first\"\nperiod = 0.5", "of = \"first\"\nnode = 60\nperiod = 0.5");
  EXPECT_THROW(run(text), InputError) << "EXACT: 60 nodes count from 0";
  EXPECT_FALSE(fs::exists(out())) << "EXACT";
}

TEST_F(RunScene, failure_leaves_readable_outputs_and_exit_code_3) {
  ASSERT_TRUE(fs::exists(engine())) << engine() << ": build pliant_engine beside the tests";
  scene(sinking_discs);
  EXPECT_EQ(run_engine("--quiet"), 3) << read(folder_ / "log.txt");
  const std::string message = read(folder_ / "log.txt");
  for (const char* word : {"error: ", "penetration", "t = ", "last good state", "stiffness"})
    EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
  const nlohmann::json json = summary();
  EXPECT_LT(json["time"], json["end"]) << "EXACT: it did not finish";
  EXPECT_EQ(json.value("status", "").find("failed: contact between body"), 0u)
      << "EXACT: the summary names the failure: " << json.dump();
  const Table steps = read_table(out() / "steps.csv");
  EXPECT_EQ(steps.rows.back()[0], json["time"]) << "EXACT: the last good state";
  EXPECT_FALSE(read_table(out() / "probes.csv").rows.empty());
  EXPECT_EQ(check_frames(), 0) << read(folder_ / "log.txt");
}

TEST_F(RunScene, refuses_to_overwrite_unless_forced) {
  run(pressed_discs);
  const std::string before = read(out() / "summary.json");
  EXPECT_THROW(run(pressed_discs), OutputError);
  EXPECT_EQ(read(out() / "summary.json"), before) << "EXACT: untouched";
  EXPECT_NO_THROW(run_scene(scene(replaced(pressed_discs, "end = 2", "end = 1")), {out(), true, true, 1}));
  EXPECT_EQ(summary()["time"], 1.0) << "EXACT";
}

}  // namespace
}  // namespace pliant::dynamics_tests
