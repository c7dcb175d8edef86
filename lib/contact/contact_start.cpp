// How contact begins: from nothing, or from another run.
#include <algorithm>

#include <fmt/format.h>

#include "contact/contact.hpp"
#include "contact/patch_queries.hpp"
#include "core/errors.hpp"

namespace pliant {

InheritedContact ContactSystem::leave(const ContactHistory& history) const {
  InheritedContact left{patches(), {}, history};
  for (const Patch& patch : left.patches)
    left.kinds.push_back(static_cast<std::int32_t>(laws_.kind(patch.first, patch.second)));
  return left;
}

void ContactSystem::inherit(const InheritedContact& from, ContactHistory& history) {
  if (from.kinds.size() != from.patches.size()) throw ArchiveError("contacts have other laws");
  table_.take(from.patches, from.history.records());
  std::vector<Patch> kept;
  for (std::size_t p = 0; p < from.patches.size(); ++p)
    if (const Patch& patch = from.patches[p];
        from.kinds[p] == static_cast<std::int32_t>(laws_.kind(patch.first, patch.second)))
      kept.push_back(patch);
  table_.take(std::move(kept), from.history.records());
  make_room(last_);
  history = {};
  history.set_columns(keeps_debts(), static_cast<int>(laws_.remembered()));
  history.resize(from.history.records());
  history.clear(0, history.records());
  if (keeps_debts()) history.owed.assign(patches().size(), 0.0);
  const int fields = std::min(history.fields(), from.history.fields());
  for (int record = 0; record < history.records(); record += lane_count) {
    Lanes* to = history.at(record);
    const Lanes* old = from.history.at(record);
    for (const int column : {ContactHistory::place, ContactHistory::slip}) to[column] = old[column];
    std::copy_n(old + from.history.first_of_law, fields, to + history.first_of_law);
  }
}

/// A limb thinner than contact sees would press its own far side out.
void ContactSystem::refuse_self_overlap() const {
  for (const Patch& patch : patches())
    if (patch.of_itself() && overlaps(view(patch)))
      throw InputError(fmt::format(
          "'{}' overlaps itself at the start, or is thinner somewhere than contact sees into it, a segment and a skin: "
          "{:.3g} m; give it a finer outline, or leave [contact] self_contact out",
          model_.bodies[patch.first].name, model_.outline_of(patch.first).spacing + skin_));
}

}  // namespace pliant
