// Initial state of contact: a new one, or one from another run.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "contact/contact.hpp"
#include "contact/pair_queries.hpp"
#include "core/errors.hpp"

namespace pliant {
namespace {

PairLaws pair_laws(const LawTable& laws, int bodies) {
  PairLaws all;
  std::vector<int> member;  // [groups] one body of each
  for (int b = 0; b < bodies; ++b) {
    const int group = laws.group(b);
    all.groups.push_back(group);
    if (group >= static_cast<int>(member.size())) member.resize(group + std::size_t{1});
    member[group] = b;
  }
  all.count = static_cast<std::int32_t>(member.size());
  for (const int first : member)
    for (const int second : member) all.kinds.push_back(laws.kind(first, second));
  return all;
}

void require_fit(const PairLaws& laws, std::size_t bodies) {
  const auto is_one = [&](std::int32_t group) { return group >= 0 && group < laws.count; };
  if (laws.groups.size() != bodies || laws.kinds.size() != static_cast<std::size_t>(laws.count) * laws.count ||
      !std::ranges::all_of(laws.groups, is_one))
    throw ArchiveError("contacts have other laws");
}

}  // namespace

InheritedContact ContactSystem::leave(const ContactHistory& history) const {
  return {contact_pairs(), pair_laws(laws_, static_cast<int>(model_.bodies.size())), history};
}

void ContactSystem::inherit(const InheritedContact& from, ContactHistory& history) {
  require_fit(from.laws, model_.bodies.size());
  starts_from_a_state_ = true;
  table_.take(from.contact_pairs, from.history.records());
  std::vector<ContactPair> kept;
  std::ranges::copy_if(from.contact_pairs, std::back_inserter(kept), [&](const ContactPair& contact_pair) {
    return from.laws.kind(contact_pair.first, contact_pair.second) ==
           laws_.kind(contact_pair.first, contact_pair.second);
  });
  table_.take(std::move(kept), from.history.records());
  history = {};
  history.numbers = from.history.numbers;
  if (corrects_energy()) history.start_energy_errors(contact_pairs().size()), make_room(history.last);
}

/// Throws InputError if a body overlaps itself: a limb thinner than the detection depth would press its own far side
/// out.
void ContactSystem::refuse_self_overlap() const {
  for (const ContactPair& contact_pair : contact_pairs())
    if (contact_pair.of_itself() && overlaps(view(contact_pair)))
      throw InputError(fmt::format(
          "'{}' overlaps itself at the start, or is thinner somewhere than contact sees into it, a segment and a skin: "
          "{:.3g} m; give it a finer outline, or leave [contact] self_contact out",
          model_.bodies[contact_pair.first].name, model_.outline_of(contact_pair.first).spacing + skin_));
}

}  // namespace pliant
