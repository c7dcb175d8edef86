#include "input/read_drive.hpp"

#include <fmt/format.h>

namespace pliant {

namespace {

std::string keys_of(const std::vector<DriveKind>& kinds) {
  std::vector<std::string> keys;
  for (const DriveKind& kind : kinds) keys.push_back(kind.key);
  return fmt::format("{}", fmt::join(keys, ", "));
}

Drive read_drive_table(TableReader table, const std::vector<DriveKind>& kinds) {
  Drive drive;
  const DriveKind* chosen = nullptr;
  for (const DriveKind& kind : kinds) {
    History history;
    if (!table.optional(kind.key, history)) continue;
    if (chosen)
      table.fail(kind.key, fmt::format("only one of {} can drive an axis; remove the others", keys_of(kinds)));
    chosen = &kind;
    drive.mode = kind.mode;
    drive.history = std::move(history);
  }
  if (chosen && chosen->damped) table.optional("damping", drive.damping);
  drive.window = read_window(table);
  table.finish();
  if (!chosen) table.fail(fmt::format("nothing drives {}; give one of {}", table.title(), keys_of(kinds)));
  return drive;
}

}  // namespace

Drive read_drive(TableReader& table, const std::string& axis, const std::vector<DriveKind>& kinds,
                 const Drive& otherwise) {
  Drive drive = otherwise;
  if (table.has(axis)) {
    const Value value = table.value(axis);
    if (value.node.is_table()) return read_drive_table(table.optional_table(axis), kinds);
    if (!value.node.is_string()) value.reject("\"fixed\", \"free\" or a table such as { velocity = \"1 m/s\" }");
  }
  table.optional(axis, drive.mode);
  return drive;
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
