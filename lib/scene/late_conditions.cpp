#include "scene/late_conditions.hpp"

#include <fmt/format.h>

#include <initializer_list>

namespace pliant {
namespace {

/// One text a table, whatever the number of its axes that are late.
void add_if_late(const std::string& where, const std::string& name, std::initializer_list<Window> windows, double end,
                 std::vector<std::string>& texts) {
  for (const Window& window : windows) {
    if (window.from < end) continue;
    texts.push_back(fmt::format("{}: '{}' is acted on from {:.6g} s, but the run ends at {:.6g} s: it never is", where,
                                name, window.from, end));
    return;
  }
}

}  // namespace

std::vector<std::string> late_conditions(const Scene& scene) {
  std::vector<std::string> texts;
  const double end = scene.time.end;
  for (const Wall& wall : scene.walls) add_if_late(wall.where, wall.name, {wall.x.window, wall.y.window}, end, texts);
  for (const BoundaryCondition& condition : scene.boundary)
    add_if_late(condition.where, condition.grains,
                {condition.window, condition.x.window, condition.y.window, condition.angle.window}, end, texts);
  for (const BondRule& rule : scene.bonds)
    if (rule.from > 0 && rule.from >= end)
      texts.push_back(fmt::format("{}: bonds between '{}' and '{}' are made at {:.6g} s, but the run ends at {:.6g} s",
                                  rule.where, rule.first, rule.second, rule.from, end));
  return texts;
}

}  // namespace pliant
