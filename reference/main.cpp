#include <map>
#include <optional>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "core/errors.hpp"
#include "core/floating_point_traps.hpp"
#include "files/output_folder.hpp"
#include "input/read_scene.hpp"
#include "reference/natural_modes.hpp"
#include "reference/run.hpp"
#include "scene/units.hpp"

namespace pliant::reference {
namespace {

int main_program(int argc, char** argv) {
  CLI::App app{"Pliant's reference solver: implicit, slow, independent of the engine"};
  std::string file, until, dt, modes;
  RunOptions options;
  std::optional<MassMatrix> mass;
  const std::map<std::string, MassMatrix> masses{{"lumped", MassMatrix::lumped},
                                                 {"scaled", MassMatrix::scaled},
                                                 {"corrected", MassMatrix::corrected},
                                                 {"consistent", MassMatrix::consistent}};
  app.add_option("scene", file, "Scene file (TOML)")->required();
  app.add_option("--out", options.out, "Output folder; default results/<scene name>_reference");
  app.add_option("--until", until, "End time instead of the scene's, as in \"0.02 us\"");
  app.add_option("--dt", dt, "Time step; default: the fastest wave over a segment");
  app.add_option("--mass", mass, "lumped, scaled, corrected or consistent; default the scene's")
      ->transform(CLI::CheckedTransformer(masses));
  app.add_option("--hht", options.solver.hht, "alpha of Hilber, Hughes and Taylor; 0: Newmark")
      ->check(CLI::Range(-1.0 / 3, 0.0));
  app.add_option("--modes", modes, "Write the natural frequencies of compliant bodies to this file (JSON), and end");
  app.add_flag("--static", options.solver.statics, "Equilibrium at each time, without inertia");
  app.add_option(
         "--pseudo-inertia", options.solver.pseudo_inertia,
         "Static: share of the largest stiffness that holds bodies at first where Newton's method fails; 0: never")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--tolerance", options.solver.newton.tolerance, "Newton: residual over the forces")
      ->check(CLI::Range(1e-14, 1e-2));
  app.add_flag("--force", options.force, "Overwrite results in the output folder");
  CLI::Option* quiet = app.add_flag("--quiet", options.quiet, "Print errors only");
  app.add_flag("--verbose", options.verbose, "Print a line for every step")->excludes(quiet);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  if (options.quiet) spdlog::set_level(spdlog::level::err);
  Scene scene = read_scene(file);
  for (const std::string& text : scene.warnings) spdlog::warn(text);
  if (!scene.start_from.empty())
    throw InputError(fmt::format("{}: [start]: the reference solver starts no scene from another run's end", file));
  if (!until.empty()) scene.time.end = parse_time("--until", until);
  if (!dt.empty()) options.solver.dt = parse_time("--dt", dt);
  options.solver.mass = mass.value_or(scene.discretisation.mass == Mass::corrected ? MassMatrix::corrected
                                      : scene.discretisation.mass_scaling > 1      ? MassMatrix::scaled
                                                                                   : MassMatrix::lumped);
  if (!modes.empty()) {
    write_modes(scene, options.solver.mass, modes);
    return 0;
  }
  if (options.out.empty()) options.out = std::filesystem::path("results") / (scene.name + "_reference");
  tell_output_folder(options.out);
  run_scene(scene, options);
  return 0;
}

}  // namespace
}  // namespace pliant::reference

int main(int argc, char** argv) {
  pliant::trap_floating_point_errors();
  spdlog::set_default_logger(spdlog::stderr_logger_st("pliant reference"));
  spdlog::set_pattern("%l: %v");
  try {
    return pliant::reference::main_program(argc, argv);
  } catch (const pliant::Stopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.what());
    return static_cast<int>(stopped.code());
  } catch (const pliant::Error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory\n");
    return static_cast<int>(pliant::ExitCode::physics_failure);
  }
}
