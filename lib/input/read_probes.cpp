#include <algorithm>
#include <charconv>

#include "input/read_tables.hpp"
#include "scene/quantities.hpp"

namespace pliant {

namespace {

using Of = ProbeQuantity::Of;
using Where = ProbeQuantity::Where;

/// Refuses a period that would write more rows or frames than anybody can read.
void check_output_count(const TableReader& table, double end, double period) {
  const double count = end / period;
  if (count <= static_cast<double>(SceneLimits::outputs)) return;
  table.fail("period", fmt::format("{:.3g} outputs until the end at {} s; allowed: at most {}, so a period >= {} s",
                                   count, end, SceneLimits::outputs, end / SceneLimits::outputs));
}

bool some_grains(const Scene& scene, BodyKind kind) {
  return std::any_of(scene.grains.begin(), scene.grains.end(),
                     [&](const Grains& grains) { return has_body(grains, kind); });
}

/// Names that `of` and `with` may carry beside those of single grains.
std::vector<std::string> target_names(Of of, const Scene& scene) {
  std::vector<std::string> names;
  if (of == Of::walls || of == Of::any) names = names_of(scene.walls);
  if (of == Of::walls) return names;
  for (const Grains& grains : scene.grains)
    if (of != Of::compliant || has_body(grains, BodyKind::compliant)) names.push_back(grains.name);
  const bool compliant = some_grains(scene, BodyKind::compliant);
  if (compliant) names.emplace_back("compliant");
  if (of != Of::compliant && some_grains(scene, BodyKind::rigid)) names.emplace_back("rigid");
  if (of != Of::compliant || compliant) names.emplace_back("all");
  return names;
}

/// A name of bodies, or of one of a set of grains: "grains 17".
struct Target {
  Of of;
  const Scene& scene;

  std::string allowed() const { return OneOf{"wall or grains", target_names(of, scene)}.allowed(); }

  /// Bodies bear the names that it returns.
  std::string operator()(const Value& value) const {
    const std::vector<std::string> names = target_names(of, scene);
    if (const auto text = value.node.value<std::string>()) {
      const std::size_t space = text->find(' ');
      const std::string group = text->substr(0, space);
      const bool known = std::find(names.begin(), names.end(), group) != names.end();
      const auto grains =
          std::find_if(scene.grains.begin(), scene.grains.end(), [&](const Grains& one) { return one.name == group; });
      if (space != std::string::npos && known && grains != scene.grains.end()) {
        check_number(value, *grains, text->substr(space + 1));
        return grains->body_count() == 1 ? group : *text;
      }
    }
    return OneOf{"wall or grains", names}(value);
  }

 private:
  /// Bodies count from 0.
  static void check_number(const Value& value, const Grains& grains, const std::string& text) {
    std::int64_t number = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::int64_t count = grains.body_count();
    const bool whole = error == std::errc() && end == text.data() + text.size() && !text.starts_with('0');
    if ((whole || text == "0") && number >= 0 && number < count) return;
    value.reject(count == 1 ? fmt::format("\"{0}\" or \"{0} 0\": {0} has one body", grains.name)
                            : fmt::format("\"{0} 0\" to \"{0} {1}\"", grains.name, count - 1));
  }
};

/// Whether a target names one body.
bool is_single(const std::string& of, const Scene& scene) {
  if (of.find(' ') != std::string::npos) return true;
  const auto named = [&](const auto& one) { return one.name == of; };
  if (std::any_of(scene.walls.begin(), scene.walls.end(), named)) return true;
  const auto grains = std::find_if(scene.grains.begin(), scene.grains.end(), named);
  return grains != scene.grains.end() && grains->body_count() == 1;
}

void read_reduction(TableReader& table, const ProbeQuantity& quantity, Probe& probe) {
  if (quantity.reductions.empty()) return;
  std::vector<std::string> names;
  for (Reduction reduction : quantity.reductions) names.push_back(reduction_name(reduction));
  table.optional("reduce", probe.reduce, names);
}

void read_node(TableReader& table, const ProbeQuantity& quantity, const Scene& scene, Probe& probe) {
  if (quantity.node == ProbeQuantity::Node::none || !table.optional("node", probe.node)) return;
  if (!is_single(probe.of, scene))
    table.fail("node", fmt::format("a node is one of one body, '{}' are several; name one, such as of = \"{} 0\"",
                                   probe.of, scene.grains.front().name));
  if (probe.reduce) table.fail("reduce", "there is nothing to reduce at one node; remove node or reduce");
}

/// Two walls or a box, where a quantity is of a region.
void read_region(TableReader& table, const ProbeQuantity& quantity, const Scene& scene, Probe& probe) {
  if (quantity.where == Where::nowhere) return;
  const bool between = table.optional("between", probe.between, names_of(scene.walls));
  const bool box = table.optional("box", probe.box);
  if (between && box) table.fail("box", "the region is given by between or by box, not by both; remove one");
  if (!between && !box && quantity.where == Where::region_needed && !scene.cell)
    table.fail(fmt::format("{} needs a region; add between = [lower wall, upper wall] or box = {}", quantity.name,
                           Corners{}.allowed()));
  if (!between) return;
  const auto solid = [&](const std::string& name) {
    return std::find_if(scene.walls.begin(), scene.walls.end(), [&](const Wall& w) { return w.name == name; })->solid;
  };
  if (solid(probe.between[0]) == solid(probe.between[1]))
    table.fail("between", fmt::format("'{}' and '{}' are solid on the same side; allowed: one wall below and one above",
                                      probe.between[0], probe.between[1]));
}

}  // namespace

Probe read_probe(TableReader table, const Scene& scene) {
  Probe probe;
  table.required("name", probe.name);
  table.required("quantity", probe.quantity);
  const ProbeQuantity& quantity = probe_quantity(probe.quantity);
  if (quantity.in_cell && !scene.cell)
    table.fail("quantity",
               fmt::format("{} is of a cell with two periods; add [domain] periods, or take another", quantity.name));
  if (quantity.of != Of::whole) table.required("of", probe.of, Target{quantity.of, scene});
  table.required("period", probe.period);
  check_output_count(table, scene.time.end, probe.period);
  read_reduction(table, quantity, probe);
  read_node(table, quantity, scene, probe);
  if (quantity.with) table.optional("with", probe.with, Target{Of::any, scene});
  read_region(table, quantity, scene, probe);
  table.finish();
  return probe;
}

Frames read_frames(TableReader table, const Scene& scene) {
  Frames frames;
  table.required("period", frames.period);
  check_output_count(table, scene.time.end, frames.period);
  table.optional("fields", frames.fields);
  for (std::size_t i = 0; i < frames.fields.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (frames.fields[i] == frames.fields[j]) table.fail("fields", fmt::format("\"{}\" twice", frames.fields[i]));
    }
  }
  table.optional("contacts", frames.contacts);
  table.finish();
  return frames;
}

}  // namespace pliant
