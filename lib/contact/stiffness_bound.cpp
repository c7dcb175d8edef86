#include "contact/stiffness_bound.hpp"

#include <algorithm>

#include "contact/halo.hpp"
#include "contact/pair_queries.hpp"
#include "core/parallel.hpp"

namespace pliant {

/// Transfers the entries of contact pairs that were counted before. Counted at their present positions, they would miss
/// what they can still reach before the next search.
void StiffnessBound::follow_layout(const PairTable& table) {
  std::swap(entries_, spare_);
  entries_.clear();  // or those before would be copied
  entries_.resize(static_cast<std::size_t>(table.entries() + lane_count));
  const Blocks blocks{static_cast<int>(entries_.size()), 4096};
  parallel_for(blocks.count(),
               [&](int b) { std::fill(entries_.begin() + blocks[b].begin, entries_.begin() + blocks[b].end, 0.0); });
  parallel_for(table.count(), [&](int p) {
    const ContactPair& contact_pair = table.contact_pairs()[p];
    if (contact_pair.found > seen_) return;
    const ContactPair& old = weighed_[find_pair(weighed_, contact_pair, p)];
    for (int side = 0; side < 2; ++side)
      std::copy_n(spare_.data() + old.entry[side], contact_pair.forces(side).count,
                  entries_.data() + contact_pair.entry[side]);
  });
  weighed_.resize(table.contact_pairs().size());
  parallel_for(table.count(), [&](int p) { weighed_[p] = table.contact_pairs()[p]; });
}

std::vector<int> StiffnessBound::update(const ContactSystem& contact, const std::vector<double>& compliance) {
  const PairTable& table = contact.table();
  const bool all = layout_ != table.laid_out();
  if (all) follow_layout(table);
  std::vector<int> found;
  std::vector<char> changed(model_.bodies.size(), all);
  const auto note = [&](int p) {
    const ContactPair& contact_pair = table.contact_pairs()[p];
    if (contact_pair.found <= seen_) return;
    found.push_back(p);
    if (!all) weighed_[p] = contact_pair;
    changed[contact_pair.first] = changed[contact_pair.second] = 1;
  };
  if (all || contact.refreshes() != seen_ + 1)
    for (int p = 0; p < table.count(); ++p) note(p);
  else
    for (int p : contact.found()) note(p);
  parallel_for(static_cast<int>(found.size()), [&](int i) {
    const ContactPair& contact_pair = table.contact_pairs()[found[i]];
    for (int side = 0; side < 2; ++side)
      std::fill_n(entries_.data() + contact_pair.entry[side], padded(contact_pair.forces(side).count), 0.0);
    const double a = compliance[contact_pair.first], b = compliance[contact_pair.second];
    // (u - v)^2 <= (1 + s) u^2 + (1 + 1/s) v^2; s = b/a gives either body the same bound a + b.
    const double factor[2] = {a > 0 ? 1 + b / a : 0, b > 0 ? 1 + a / b : 0};
    if (!contact_pair.is_empty()) add_patch_stiffness(contact.view(contact_pair), factor, entries_);
  });
  layout_ = table.laid_out(), seen_ = contact.refreshes();
  if (model_.halo) add_up_on_walls(table, contact.refreshes());
  std::vector<int> bodies;
  for (const int b : model_.own.bodies)
    if (changed[b] || has_partners_elsewhere(b)) bodies.push_back(b);
  return bodies;
}

std::vector<double> StiffnessBound::of_body(const ContactSystem& contact, int body) const {
  std::vector<double> stiffness(static_cast<std::size_t>(model_.outline_of(body).count), 0.0);
  add_of_body(contact, body, stiffness.data(), 1);
  return stiffness;
}

/// Sums of the pairs of all processes on walls.
void StiffnessBound::add_up_on_walls(const PairTable& table, long rebuild) {
  on_walls_.resize(static_cast<std::size_t>(model_.outline_offset.back()));
  const double* const entries[] = {entries_.data()};
  double* const sums[] = {on_walls_.data()};
  model_.halo->add_up_on_walls(table, rebuild, entries, sums);
}

void StiffnessBound::add_of_body(const ContactSystem& contact, int body, double* to, int stride) const {
  if (has_partners_elsewhere(body)) {
    for (int i = 0; i < model_.outline_of(body).count; ++i)
      to[stride * i] += on_walls_[static_cast<std::size_t>(model_.outline_offset[body] + i)];
    return;
  }
  contact.table().for_each_run(body, [&](int node, int entry, int count) {
    for (int i = 0; i < count; ++i) to[stride * (node + i)] += entries_[entry + i];
  });
}

}  // namespace pliant
