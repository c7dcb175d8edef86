#include "input/read_axis_condition.hpp"

#include <fmt/format.h>

namespace pliant {

namespace {

std::string keys_of(const std::vector<AxisConditionKind>& kinds) {
  std::vector<std::string> keys;
  for (const AxisConditionKind& kind : kinds) keys.push_back(kind.key);
  return fmt::format("{}", fmt::join(keys, ", "));
}

AxisCondition read_axis_table(TableReader table, const std::vector<AxisConditionKind>& kinds) {
  AxisCondition prescribed;
  const AxisConditionKind* chosen = nullptr;
  for (const AxisConditionKind& kind : kinds) {
    History history;
    if (!table.optional(kind.key, history)) continue;
    if (chosen)
      table.fail(kind.key,
                 fmt::format("only one of {} can be prescribed for an axis; remove the others", keys_of(kinds)));
    chosen = &kind;
    prescribed.mode = kind.mode;
    prescribed.history = std::move(history);
  }
  if (chosen && chosen->damped) table.optional("damping", prescribed.damping);
  prescribed.window = read_window(table);
  table.finish();
  if (!chosen) table.fail(fmt::format("nothing is prescribed for {}; give one of {}", table.title(), keys_of(kinds)));
  return prescribed;
}

}  // namespace

AxisCondition read_axis_condition(TableReader& table, const std::string& axis,
                                  const std::vector<AxisConditionKind>& kinds, const AxisCondition& otherwise) {
  AxisCondition prescribed = otherwise;
  if (table.has(axis)) {
    const Value value = table.value(axis);
    if (value.node.is_table()) return read_axis_table(table.optional_table(axis), kinds);
    if (!value.node.is_string()) value.reject("\"fixed\", \"free\" or a table such as { velocity = \"1 m/s\" }");
  }
  table.optional(axis, prescribed.mode);
  return prescribed;
}

Window read_window(TableReader& table) {
  Window window;
  table.optional("from", window.from);
  table.optional("until", window.until);
  if (window.until <= window.from)
    table.fail("until", fmt::format("{} s; allowed: after 'from', {} s", window.until, window.from));
  return window;
}

}  // namespace pliant
