// One kernel, once, for callgrind to count: ./pliant bench gate runs it on small scenes.
//   pliant_counted_kernels SCENE KERNEL    prepares a state by some steps, then calls the kernel in pliant_counted
//   pliant_counted_kernels --build         what this program was built with, as JSON
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/place_outlines.hpp"
#include "build_info.hpp"
#include "core/errors.hpp"
#include "dynamics/simulation.hpp"
#include "dynamics/time_step_bound.hpp"
#include "input/read_scene.hpp"
#include "setup/build_model.hpp"

/// What is counted: --toggle-collect=pliant_counted. What stands behind the call keeps it from becoming a jump, which
/// callgrind would not see return.
extern "C" [[gnu::noinline]] void pliant_counted(const std::function<void()>& kernel) {
  kernel();
  asm volatile("" ::: "memory");
}

namespace pliant {
namespace {

/// Until contacts have slipped; far from the next power iterations, which are a kernel of their own.
constexpr int steps_before = 20;

/// Counts the second call: the first one makes room.
void count_second(const std::function<void()>& kernel) {
  kernel();
  pliant_counted(kernel);
}

void expect(bool met, const char* what) {
  if (!met) throw std::runtime_error(fmt::format("the scene does not show the kernel: {}", what));
}

void internal_forces(Simulation& simulation) {
  const Model& model = simulation.model();
  expect(!model.batches.empty(), "no compliant bodies");
  Dofs force = zero_dofs(model);
  count_second([&] {
    for (const Batch& batch : model.batches)
      add_internal_forces(model, batch, {.position = &simulation.state().position.compliant[batch.offset]},
                          &force.compliant[batch.offset]);
  });
}

void outlines(Simulation& simulation) {
  OutlineField place(simulation.model().outline_offset.back());
  count_second([&] { place_outlines(simulation.model(), simulation.state().position, place); });
}

void carried_forces(Simulation& simulation) {
  const Model& model = simulation.model();
  Dofs force = zero_dofs(model);
  count_second([&] {
    for (const Region& region : model.regions)
      add_outline_forces(model, region, simulation.state().contact_force,
                         &force.compliant[model.batches[region.batch].offset]);
  });
}

/// Candidates of a simulation's outlines, with a history of slip.
struct Contact {
  explicit Contact(const Simulation& simulation) : outlines(simulation.state().outlines), system(simulation.model()) {
    system.find_candidates(outlines, history);
    ContactHistory trial;
    OutlineField force;
    expect(system.forces(outlines, history, trial, force).contacts > 0, "no contacts");
    std::swap(history, trial);
  }

  const Outlines& outlines;
  ContactSystem system;
  ContactHistory history;
};

void contact_forces(Simulation& simulation) {
  Contact contact(simulation);
  ContactHistory trial;
  OutlineField force;
  count_second([&] { contact.system.forces(contact.outlines, contact.history, trial, force); });
}

void find_candidates(Simulation& simulation) {
  Contact contact(simulation);
  count_second([&] { contact.system.find_candidates(contact.outlines, contact.history); });
}

/// Every fifth body has moved by so much of the skin that its pairs must be searched: each call moves it on.
void renew_candidates(Simulation& simulation) {
  const Model& model = simulation.model();
  Contact contact(simulation);
  const long all = contact.system.pairs_searched();
  Outlines moved = contact.outlines;
  const auto move = [&] {
    for (std::size_t b = 0; b < model.bodies.size(); b += 5)
      for (int i = model.outline_offset[b]; i < model.outline_offset[b + 1]; ++i)
        moved.position.x[i] += 0.6 * contact.system.skin();
  };
  move();
  contact.system.renew_candidates(moved, contact.history);
  move();
  const long before = contact.system.pairs_searched();
  pliant_counted([&] { contact.system.renew_candidates(moved, contact.history); });
  const long searched = contact.system.pairs_searched() - before;
  expect(searched > 0 && searched < all, "all pairs were searched, or none");
}

void contact_bound(Simulation& simulation) {
  const ContactSystem& contact = simulation.forces().contact();
  TimeStepBound bound(simulation.model(), contact.laws());
  // A second time there is nothing new to see.
  pliant_counted([&] { bound.update_contact(contact, simulation.forces().bonds()); });
}

void internal_bound(Simulation& simulation) {
  const State& state = simulation.state();
  TimeStepBound bound(simulation.model(), simulation.forces().contact().laws());
  count_second([&] { bound.update_internal(state.position, state.memory); });
}

void step(Simulation& simulation) {
  pliant_counted([&] { simulation.step(simulation.model().scene.time.end); });
}

const std::map<std::string_view, void (*)(Simulation&)> kernels{
    {"internal_forces", internal_forces},
    {"outlines", outlines},
    {"carried_forces", carried_forces},
    {"contact_forces", contact_forces},
    {"find_candidates", find_candidates},
    {"renew_candidates", renew_candidates},
    {"contact_bound", contact_bound},
    {"internal_bound", internal_bound},
    {"step", step},
};

std::string names() {
  std::string all;
  for (const auto& [name, kernel] : kernels) all += fmt::format("{}{}", all.empty() ? "" : ", ", name);
  return all;
}

int main_program(const std::vector<std::string>& arguments) {
  if (arguments.size() == 1 && arguments[0] == "--build") {
    const nlohmann::ordered_json json{
        {"compiler", build_compiler}, {"options", build_options}, {"architecture", PLIANT_ARCHITECTURE}};
    fmt::print("{}\n", json.dump());
    return 0;
  }
  if (arguments.size() != 2 || !kernels.contains(arguments[1]))
    throw InputError(fmt::format("usage: pliant_counted_kernels SCENE KERNEL; kernels: {}", names()));
  const Model model = build_model(read_scene(arguments[0]));
  Simulation simulation(model);
  for (int i = 0; i < steps_before; ++i) simulation.step(model.scene.time.end);
  kernels.at(arguments[1])(simulation);
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::err);
  try {
    return pliant::main_program({argv + 1, argv + argc});
  } catch (const pliant::Error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(pliant::ExitCode::physics_failure);
  }
}
