#include <map>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "bodies/natural_modes.hpp"
#include "build_info.hpp"
#include "cli/check.hpp"
#include "cli/modes.hpp"
#include "cli/shape_function.hpp"
#include "core/errors.hpp"
#include "core/floating_point_traps.hpp"
#include "core/warnings.hpp"
#include "files/output_folder.hpp"
#include "input/read_scene.hpp"
#include "input/scene_keys.hpp"
#include "run/run.hpp"
#include "scene/late_conditions.hpp"
#include "scene/units.hpp"

namespace pliant {
namespace {

/// Refuses an empty text, as of a shell variable that is not set: it would stand for no option.
const CLI::Validator not_empty([](const std::string& text) { return std::string(text.empty() ? "is empty" : ""); },
                               "TEXT");

/// Another ending is likely to be that of the scene, which would be overwritten.
const CLI::Validator json_file(
    [](const std::string& text) { return std::string(text.ends_with(".json") ? "" : "must end with .json"); },
    "FILE.json");

struct Arguments {
  std::string scene, until, checkpoint_every;
  RunOptions run;
};

Scene load(const Arguments& arguments) {
  if (arguments.scene.empty() && (!arguments.run.resume || arguments.run.out.empty()))
    throw InputError("no scene file is named; only --resume with --out can do without");
  Scene scene = arguments.scene.empty() ? scene_of_folder(arguments.run.out) : read_scene(arguments.scene);
  if (!arguments.until.empty()) scene.time.end = parse_time("--until", arguments.until);
  if (arguments.checkpoint_every == "never")
    scene.checkpoint_period.reset();
  else if (!arguments.checkpoint_every.empty())
    scene.checkpoint_period = parse_time("--checkpoint-every", arguments.checkpoint_every, ", or never");
  for (const std::string& text : scene.warnings) spdlog::warn(text);
  for (const std::string& text : late_conditions(scene)) spdlog::warn(text);
  return scene;
}

void run(Arguments arguments) {
  const Scene scene = load(arguments);
  if (arguments.run.out.empty()) arguments.run.out = std::filesystem::path("results") / scene.name;
  tell_output_folder(arguments.run.out);
  run_scene(scene, arguments.run);
}

void print_schema() {
  fmt::print(
      "# Keys of scene files\n\n"
      "`./pliant schema` writes this page from the table that scenes are read by (`scene_tables` in `lib/scene/`). A\n"
      "quantity is a number in SI units or a string with a unit, such as \"2 GPa\"; \"a number\" has no unit. An "
      "angle\n"
      "without a unit is in radians. The units deg, rad and turn apply only to quantities in rad and rad/s and to\n"
      "friction angles. `with` names the choice in the same table that a key belongs to. A name that a key had before "
      "is\n"
      "read with a warning. Unknown keys are refused. [defaults.md](defaults.md) gives the reasons of the defaults,\n"
      "[contact_laws.md](contact_laws.md) the contact laws.\n\n{}",
      scene_key_tables());
}

CLI::App* add_modes(CLI::App& app, std::string& scene, ModesRequest& modes) {
  CLI::App* command = app.add_subcommand(
      "modes", "Natural frequencies of compliant bodies, e.g. modes cases/two_discs.toml --count 20");
  command->add_option("scene", scene, "Scene file (TOML)")->required();
  command->add_option("--count", modes.count, "Frequencies a body; default 10")
      ->check(CLI::Range(1, 2 * most_modal_nodes));
  command->add_option("--body", modes.body,
                      "Grains, or one of a set as in \"grains 17\"; default all that are compliant");
  command->add_option("--json", modes.json, "File for the same figures")->check(json_file);
  command->add_option("--matrices", modes.matrices, "Folder for stiffness and inverse mass, Matrix Market format");
  return command;
}

int main_program(int argc, char** argv) {
  CLI::App app{"Pliant: rigid and compliant grains in one simulation"};
  app.set_version_flag("--version", build_commit, "The commit that this program was built from");
  app.require_subcommand(1);
  Arguments arguments;
  CLI::App* run_command = app.add_subcommand("run", "Simulate a scene, e.g. run cases/two_discs.toml --threads 2");
  CLI::App* check_command =
      app.add_subcommand("check", "Dry run: what a scene holds and costs, e.g. check cases/third_body.toml");
  check_command->add_option("scene", arguments.scene, "Scene file (TOML)")->required();
  run_command->add_option("scene", arguments.scene, "Scene file (TOML); with --resume and --out that of the folder");
  for (CLI::App* command : {run_command, check_command}) {
    command->add_option("--until", arguments.until, "End time instead of the scene's, as in \"0.02 us\"")
        ->check(not_empty);
    command->add_option("--threads", arguments.run.threads, "Number of threads; results do not depend on it")
        ->check(CLI::Range(1, 1024));
  }
  CLI::App* shape_function_command =
      app.add_subcommand("shape-function", "CSV of one shape function of a disc, e.g. shape-function --method rpim");
  ShapeFunctionRequest shape_function;
  const std::map<std::string, DiscretisationMethod> methods{
      {"mls", DiscretisationMethod::mls}, {"rpim", DiscretisationMethod::rpim}, {"t3", DiscretisationMethod::t3}};
  shape_function_command->add_option("--method,--recipe", shape_function.settings.method, "mls, rpim or t3")
      ->transform(CLI::CheckedTransformer(methods));
  shape_function_command->add_option("--support", shape_function.settings.support, "Nodes in a support")
      ->check(CLI::Range(7, 25));
  shape_function_command->add_option("--nodes", shape_function.nodes, "Nodes of the disc")->check(CLI::Range(30, 5000));
  shape_function_command->add_option("--grid", shape_function.grid, "Points along either axis")
      ->check(CLI::Range(3, 2000));
  run_command->add_option("--out", arguments.run.out, "Output folder; default results/<scene name>")->check(not_empty);
  CLI::Option* force = run_command->add_flag("--force", arguments.run.force, "Overwrite results in the output folder");
  run_command->add_flag("--resume", arguments.run.resume, "Go on from the output folder's checkpoint")->excludes(force);
  run_command
      ->add_option("--checkpoint-every", arguments.checkpoint_every,
                   "Wall time between checkpoints, as in \"10 min\", or never; default the scene's")
      ->check(not_empty);
  run_command->add_flag("--quiet", arguments.run.quiet, "Print errors only");
  ModesRequest modes;
  CLI::App* modes_command = add_modes(app, arguments.scene, modes);
  CLI::App* schema_command = app.add_subcommand("schema", "Table of the keys of scene files");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  if (arguments.run.quiet) write_errors_only();
  if (*run_command) run(arguments);
  if (*schema_command) print_schema();
  if (*check_command) print_check(load(arguments), arguments.run.threads);
  if (*modes_command) print_modes(load(arguments), modes);
  if (*shape_function_command) fmt::print("{}", shape_function_csv(shape_function));
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  pliant::trap_floating_point_errors();
  pliant::install_logger();
  try {
    return pliant::main_program(argc, argv);
  } catch (const pliant::Stopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.what());
    return static_cast<int>(stopped.code());
  } catch (const pliant::Error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory; `pliant check` estimates what a scene needs\n");
    return static_cast<int>(pliant::ExitCode::physics_failure);
  }
}
