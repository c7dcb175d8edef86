#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <spdlog/spdlog.h>

#include "contact/halo.hpp"
#include "contact/master_window.hpp"
#include "contact/narrow_phase.hpp"
#include "contact/pair_forces.hpp"
#include "contact/pair_queries.hpp"
#include "core/parallel.hpp"
#include "core/prefetch.hpp"

namespace pliant {
namespace {

/// Adds a range of numbers to another. Both are read beyond its end, up to whole lanes.
void add_run(const double* from, int count, double* to) {
  for (int i = 0; i < count; i += lane_count)
    store(to + i, load(to + i) + select(first_lanes(count - i), load(from + i), Lanes{}));
}

bool has_fixed_refresh(const ContactSettings& settings) {
  return settings.refresh_steps > 0 || settings.refresh_period > 0;
}

double skin_of(const Model& model) {
  double finest = 1e300;
  for (const Body& body : model.bodies) finest = std::min(finest, model.outlines[body.outline].spacing);
  return model.scene.skin * finest;
}

bool some_may_be_integrated(const Model& model) {
  const ContactQuadrature quadrature = model.scene.contact.quadrature;
  return quadrature == ContactQuadrature::segments ||
         (quadrature == ContactQuadrature::automatic &&
          std::ranges::any_of(model.outlines, [](const OutlineShape& o) { return o.has_corners(); }));
}

}  // namespace

ContactSystem::ContactSystem(const Model& model)
    : model_(model),
      laws_(model),
      skin_(skin_of(model)),
      may_integrate_(some_may_be_integrated(model)),
      verlet_list_(model, skin_, laws_.max_reach()),
      table_(model),
      largest_correction_(largest_correction(model.scene.time.safety)) {}

bool ContactSystem::integrates(int first, int second) const {
  if (!may_integrate_) return false;
  return model_.scene.contact.quadrature == ContactQuadrature::segments || has_corners(first) || has_corners(second);
}

PairView ContactSystem::view(const ContactPair& contact_pair) const {
  return {model_, found_at_, contact_pair, skin_, thread_scratch()};
}

bool ContactSystem::candidates_hold(const OutlineField& position, const RunClock& clock) {
  if (!fresh_ || laws_.law_interval(clock.time) != laws_.law_interval(refreshed_.time)) return false;
  return has_fixed_refresh(model_.scene.contact) ? !period_is_over(clock) : !verlet_list_.skin_is_exceeded(position);
}

bool ContactSystem::period_is_over(const RunClock& clock) const {
  const ContactSettings& settings = model_.scene.contact;
  if (settings.refresh_steps > 0) return clock.steps >= refreshed_.steps + settings.refresh_steps;
  return clock.time >= refreshed_.time + settings.refresh_period;
}

void ContactSystem::warn_of_missed_contacts(const OutlineField& position) {
  if (warned_ || !fresh_ || !has_fixed_refresh(model_.scene.contact) || !verlet_list_.skin_is_exceeded(position))
    return;
  warned_ = true;
  spdlog::warn(
      "bodies move further than the contact skin, {:.3g} m, from one contact refresh to the next: contacts can be "
      "missed; shorten [contact] refresh, or leave it \"safe\"",
      skin_);
}

void ContactSystem::find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock) {
  warn_of_missed_contacts(outlines.position);
  verlet_list_.forget();
  const bool start = !fresh_;  // an empty history may also mean that bodies were far apart
  rebuild_list(outlines, outlines.position, history, clock);
  if (start && !starts_from_a_state_) refuse_self_overlap();
  fresh_ = true;
}

bool ContactSystem::renew_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock,
                                     const OutlineField* trial) {
  const OutlineField& asked = trial ? *trial : outlines.position;
  const bool pair_by_pair = fresh_ && !has_fixed_refresh(model_.scene.contact) && !model_.scene.contact.self_contact &&
                            laws_.law_interval(clock.time) == laws_.law_interval(refreshed_.time);
  if (pair_by_pair) {
    if (!trial) verlet_list_.skin_is_exceeded(asked);
    return rebuild_list(outlines, asked, history, clock);
  }
  find_candidates(outlines, history, clock);
  return candidates_hold(asked, clock);
}

/// Stores the outlines at which candidates of these pairs are searched.
void ContactSystem::remember(const Outlines& outlines, const std::vector<int>& pairs) {
  found_at_.velocity = outlines.velocity;
  found_at_.tributary_length = outlines.tributary_length;
  found_at_.position.x.resize(outlines.position.x.size());
  found_at_.position.y.resize(outlines.position.x.size());
  found_at_.position.lattice = outlines.position.lattice;
  std::vector<char> is_searched(model_.bodies.size(), model_.scene.contact.self_contact);
  for (int p : pairs) is_searched[verlet_list_[p].first] = is_searched[verlet_list_[p].second] = 1;
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    if (!is_searched[b]) return;
    const int first = model_.outline_offset[b], count = model_.outline_offset[b + 1] - first;
    std::copy_n(&outlines.position.x[first], count, &found_at_.position.x[first]);
    std::copy_n(&outlines.position.y[first], count, &found_at_.position.y[first]);
  });
}

/// Searches pairs that exceed the skin and transfers the history. Returns whether candidates are valid for the trial.
bool ContactSystem::rebuild_list(const Outlines& outlines, const OutlineField& trial, ContactHistory& history,
                                 const RunClock& clock) {
  if (laws_.law_interval(clock.time) != laws_.law_interval(refreshed_.time))
    history.last.dt = 0;  // the laws have changed
  refreshed_ = clock;
  ++refreshes_;
  const bool same_pairs = !verlet_list_.update(outlines.position, trial);
  const std::vector<int> to_search = verlet_list_.pairs_to_search(trial);
  remember(outlines, to_search);
  const bool all_anew = !same_pairs && static_cast<int>(to_search.size()) == verlet_list_.count();
  std::vector<ContactPair> found = search(to_search, all_anew ? std::move(spare_pairs_) : std::vector<ContactPair>{});
  found_ = to_search;  // contact pairs are ordered as the pairs, unless there is self-contact
  const auto carry = [&](const ContactPair& old, const ContactPair& now) {
    if (corrects_energy()) carry_forces(model_, old, history.last.forces, now, history.last.forces);
  };
  if (!same_pairs || !table_.replace(to_search, found, history, carry)) lay_out_anew(std::move(found), history);
  parallel_for(static_cast<int>(found_.size()),
               [&](int i) { locate_new_contacts(view(contact_pairs()[found_[i]]), history); });
  return verlet_list_.hold(to_search, trial);
}

/// Contact pairs of these pairs of bodies, in the memory of others.
std::vector<ContactPair> ContactSystem::search(const std::vector<int>& pairs, std::vector<ContactPair> found) {
  found.resize(pairs.size());
  parallel_for_uneven(static_cast<int>(found.size()), 4, [&](int i) {
    const BodyPair& pair = verlet_list_[pairs[i]];
    ContactPair& contact_pair = found[i];
    contact_pair = {};
    contact_pair.first = pair.first, contact_pair.second = pair.second, contact_pair.images = pair.images;
    contact_pair.law = laws_.between(pair.first, pair.second, refreshed_.time);
    contact_pair.integrated = integrates(pair.first, pair.second);
    contact_pair.found = refreshes_;
    const double gap = find_arcs(model_, found_at_.position, contact_pair, reach_of(contact_pair.law) + skin_, skin_,
                                 thread_scratch(), verlet_list_.margin());
    verlet_list_.searched(pairs[i], found_at_.position, gap);
  });
  pairs_searched_ += static_cast<long>(found.size());
  return found;
}

/// One contact pair per pair of bodies, either just found or kept.
std::vector<ContactPair> ContactSystem::found_or_kept(std::vector<ContactPair> found) {
  if (static_cast<int>(found.size()) == verlet_list_.count()) return found;
  std::vector<ContactPair> all = std::move(spare_pairs_);
  all.resize(static_cast<std::size_t>(verlet_list_.count()));
  parallel_for(verlet_list_.count(), [&](int p) {
    ContactPair& contact_pair = all[p];
    contact_pair.first = verlet_list_[p].first, contact_pair.second = verlet_list_[p].second;
    contact_pair.images = verlet_list_[p].images, contact_pair.part = 0;
    const int just_found = find_pair(found, contact_pair, p);
    contact_pair = just_found < 0 ? contact_pairs()[find_pair(contact_pairs(), contact_pair, p)] : found[just_found];
  });
  return all;
}

void ContactSystem::lay_out_anew(std::vector<ContactPair> found, ContactHistory& history) {
  std::vector<ContactPair> all = found_or_kept(std::move(found));
  if (model_.scene.contact.self_contact) add_self_pairs(all);
  std::swap(before_, history.last);
  const std::vector<ContactPair>& old = spare_pairs_ = table_.lay_out(std::move(all), history);
  found_.clear();
  for (int p = 0; p < table_.count(); ++p)
    if (contact_pairs()[p].found == refreshes_) found_.push_back(p);
  if (!corrects_energy()) return make_room(unkept_);
  make_room(history.last);
  history.last.refreshes = before_.refreshes, history.last.dt = before_.dt;
  carry_step(old, history.last);
}

/// Transfers forces and totals of the last step from the contact pairs before a layout.
void ContactSystem::carry_step(const std::vector<ContactPair>& old, StepForces& last) const {
  parallel_for(table_.count(), [&](int p) {
    const ContactPair& contact_pair = contact_pairs()[p];
    const int from = find_pair(old, contact_pair, p);
    if (from < 0) return;
    last.totals[p] = before_.totals[from];
    carry_forces(model_, old[from], before_.forces, contact_pair, last.forces);
  });
}

/// Threads share the writing: of many grains these are megabytes.
void ContactSystem::make_room(StepForces& evaluated) const {
  const Blocks blocks{table_.entries() + lane_count, 4096};  // read in whole lanes
  for (LinedNumbers* numbers : {&evaluated.forces.x, &evaluated.forces.y}) {
    numbers->clear();  // or those before would be copied
    numbers->resize(static_cast<std::size_t>(blocks.iterations));
    parallel_for(blocks.count(),
                 [&](int b) { std::fill(numbers->begin() + blocks[b].begin, numbers->begin() + blocks[b].end, 0.0); });
  }
  evaluated.totals.assign(contact_pairs().size(), {});
}

/// Prefetches what a contact pair reads and writes: a write that waits for its cache line delays all later ones.
void ContactSystem::prefetch(const ContactPair& contact_pair, const OutlineField& position, const StepStart* step,
                             const ContactHistory& from, const ContactHistory& to,
                             const PairForceBuffer& forces) const {
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? contact_pair.first : contact_pair.second, n = model_.outline_of(body).count;
    const Arc arc = contact_pair.forces(side);
    const int node = model_.outline_offset[body] + arc.begin - turn_of(arc.begin, n) * n;
    prefetch_run(position, node, arc.count);
    const int record = contact_pair.record[side], numbers = padded(contact_pair.nodes[side].count) * from.columns;
    prefetch_run(reinterpret_cast<const double*>(from.at(record)), numbers);
    prefetch_run<Access::write>(reinterpret_cast<const double*>(to.at(record)), numbers);
    prefetch_run<Access::write>(forces, contact_pair.entry[side], arc.count);
    if (!step) continue;
    prefetch_run(step->position, node, arc.count);
    if (!corrects_energy()) continue;
    prefetch_run(from.last.forces, contact_pair.entry[side], arc.count);
  }
}

PairTotals ContactSystem::forces(const Outlines& outlines, const ContactHistory& from, ContactHistory& to,
                                 OutlineField& force, const StepStart* step) {
  table_.follow(from, to);  // also where no contact pair writes: states are compared bitwise
  StepForces& now = corrects_energy() ? to.last : unkept_;
  now.refreshes = refreshes_;
  now.dt = step ? step->dt : 0;
  force.x.resize(outlines.position.x.size());
  force.y.resize(outlines.position.x.size());
  parallel_for_by_cost(table_.cost(), [&](int p) {
    if (p + 1 < table_.count()) prefetch(contact_pairs()[p + 1], outlines.position, step, from, to, now.forces);
    const PairView view{model_,
                        outlines,
                        contact_pairs()[p],
                        skin_,
                        thread_scratch(),
                        step ? step->dt : 0.0,
                        step ? &step->position : nullptr};
    PairTotals& totals = now.totals[p];
    if (view.contact_pair.is_empty())
      totals = {};
    else if (corrects_energy())
      totals = corrected_forces(view, p, step, from, to);
    else
      totals = compute_pair(view, nullptr, from, to, now.forces);
  });
  const std::vector<int>& own = model_.own.bodies;
  const int bodies = static_cast<int>(own.size());
  const auto gather = [&](int number) {
    if (number + 1 < bodies)
      table_.for_each_run(own[number + 1], [&](int, int entry, int count) { prefetch_run(now.forces, entry, count); });
    const int b = own[number];
    const int n = model_.outline_of(b).count;
    double* x = &force.x[model_.outline_offset[b]];
    double* y = &force.y[model_.outline_offset[b]];
    std::fill_n(x, n, 0.0);
    std::fill_n(y, n, 0.0);
    table_.for_each_run(b, [&](int node, int entry, int count) {
      add_run(&now.forces.x[entry], count, x + node);
      add_run(&now.forces.y[entry], count, y + node);
    });
  };
  const Blocks pairs{table_.count(), 256};
  block_totals_.assign(static_cast<std::size_t>(pairs.count()), {});
  const auto add_up = [&](int b) { pairs.for_each_in(b, [&](int p) { block_totals_[b].add(now.totals[p]); }); };
  parallel_for(bodies, gather, pairs.count(), add_up);
  if (model_.halo) {
    const double* const entries[] = {now.forces.x.data(), now.forces.y.data()};
    double* const sums[] = {force.x.data(), force.y.data()};
    model_.halo->add_up_on_walls(table_, refreshes_, entries, sums);
  }
  PairTotals total;
  for (const PairTotals& of_block : block_totals_) total.add(of_block);
  if (model_.scene.cell) force.lattice = forces_on_images(now.forces);
  return total;
}

/// Forces on the vectors of the periods: of each pair the force on the second body, times its images.
Lattice ContactSystem::forces_on_images(const PairForceBuffer& forces) const {
  Lattice sum;
  for (const ContactPair& contact_pair : contact_pairs()) {
    if (contact_pair.images == Images{} || contact_pair.is_empty()) continue;
    double x = 0, y = 0;
    for (int i = 0, entry = contact_pair.entry[1]; i < contact_pair.forces(1).count; ++i)
      x += forces.x[entry + i], y += forces.y[entry + i];
    const Images n = contact_pair.images;
    sum = sum + Lattice{n.x * x, n.x * y, n.y * x, n.y * y};
  }
  return sum;
}

void ContactSystem::add_self_pairs(std::vector<ContactPair>& all) {
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].kind != BodyKind::compliant) continue;
    // as for any pair: parts of the body may move by the skin relative to each other
    verlet_list_.add({b, b, {}}, found_at_.position);
    ContactPair of_body;
    of_body.first = of_body.second = b;
    of_body.law = laws_.between(b, b, refreshed_.time);
    of_body.integrated = integrates(b, b);
    of_body.found = refreshes_;
    find_self_pairs(model_, found_at_.position, of_body, reach_of(of_body.law) + skin_, skin_, all, thread_scratch());
  }
}

/// Simultaneous contacts act together: N contacts of the same ratio z on one body have a ratio z sqrt(N) of their
/// common frequency. A lever can raise the square of a contact's share by 1 + m R^2 / I.
std::vector<double> ContactSystem::damping_ratios() const {
  std::vector<double> ratio(model_.bodies.size(), 0.0);
  if (!laws_.damps()) return ratio;
  std::vector<int> contacts(model_.bodies.size(), 0);
  for (const ContactPair& contact_pair : contact_pairs())
    if (!contact_pair.is_empty()) ++contacts[contact_pair.first], ++contacts[contact_pair.second];
  for (std::size_t b = 0; b < ratio.size(); ++b) {
    if (model_.bodies[b].rigid < 0) continue;
    const RigidBody& body = model_.rigid_bodies[model_.bodies[b].rigid];
    const double lever = body.dof[0].mass * body.dof[2].inverse_mass * body.max_radius * body.max_radius;
    ratio[b] = laws_.largest_damping_ratio(static_cast<int>(b)) * std::sqrt(std::max(1, contacts[b]) * (1 + lever));
  }
  return ratio;
}

}  // namespace pliant
