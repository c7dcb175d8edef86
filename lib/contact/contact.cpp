#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "contact/close_phase.hpp"
#include "contact/patch_forces.hpp"
#include "contact/patch_queries.hpp"
#include "contact/self_contact.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Adds a run of numbers to others. Both may be looked at beyond the run's end, up to whole lanes.
void add_run(const double* from, int count, double* to) {
  for (int i = 0; i < count; i += lane_count)
    store(to + i, load(to + i) + select(first_lanes(count - i), load(from + i), Lanes{}));
}

/// Patches are kept in this order.
auto key(const Patch& p) { return std::tie(p.first, p.second, p.images, p.part); }

/// The patch of the same bodies, if there is one.
const Patch* find_patch(const std::vector<Patch>& patches, const Patch& like) {
  const auto at = std::lower_bound(patches.begin(), patches.end(), like,
                                   [](const Patch& a, const Patch& b) { return key(a) < key(b); });
  return at == patches.end() || key(*at) != key(like) ? nullptr : &*at;
}

bool has_fixed_refresh(const ContactSettings& settings) {
  return settings.refresh_steps > 0 || settings.refresh_period > 0;
}

double skin_of(const Model& model) {
  double finest = 1e300;
  for (const Body& body : model.bodies) finest = std::min(finest, model.outlines[body.outline].spacing);
  return model.scene.skin * finest;
}

}  // namespace

ContactSystem::ContactSystem(const Model& model)
    : model_(model), laws_(model), skin_(skin_of(model)), watch_(model, skin_, laws_.max_reach()) {}

bool ContactSystem::candidates_hold(const OutlineField& position, const RunClock& clock) {
  if (!fresh_ || laws_.era(clock.time) != laws_.era(refreshed_.time)) return false;
  return has_fixed_refresh(model_.scene.contact) ? !period_is_over(clock)
                                                 : !watch_.is_used_up(found_at_.position, position);
}

bool ContactSystem::period_is_over(const RunClock& clock) const {
  const ContactSettings& settings = model_.scene.contact;
  if (settings.refresh_steps > 0) return clock.steps >= refreshed_.steps + settings.refresh_steps;
  return clock.time >= refreshed_.time + settings.refresh_period;
}

void ContactSystem::warn_of_missed_contacts(const OutlineField& position) {
  if (warned_ || !fresh_ || !has_fixed_refresh(model_.scene.contact) ||
      !watch_.is_used_up(found_at_.position, position))
    return;
  warned_ = true;
  spdlog::warn(
      "bodies move further than the contact skin, {:.3g} m, from one contact refresh to the next: contacts can be "
      "missed; shorten [contact] refresh, or leave it \"safe\"",
      skin_);
}

void ContactSystem::find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock) {
  warn_of_missed_contacts(outlines.position);
  watch_.forget();
  const bool start = !fresh_;  // an empty history would not tell: bodies may have been far from each other
  take_over_patches(outlines, history, clock);
  if (start) refuse_self_overlap();
  if (start)
    parallel_for(static_cast<int>(patches_.size()),
                 [&](int p) { start_records({model_, found_at_, patches_[p], skin_, thread_scratch()}, history); });
  fresh_ = true;
}

void ContactSystem::renew_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock) {
  const bool pair_by_pair = fresh_ && !has_fixed_refresh(model_.scene.contact) && !model_.scene.contact.self_contact &&
                            laws_.era(clock.time) == laws_.era(refreshed_.time);
  if (!pair_by_pair) return find_candidates(outlines, history, clock);
  watch_.add_up(found_at_.position, outlines.position);
  take_over_patches(outlines, history, clock);
}

/// Candidates at these outlines, of whatever is used up, and the history with them.
void ContactSystem::take_over_patches(const Outlines& outlines, ContactHistory& history, const RunClock& clock) {
  found_at_ = outlines;
  refreshed_ = clock;
  std::vector<Box> boxes(model_.bodies.size());
  parallel_for(static_cast<int>(boxes.size()), [&](int b) { boxes[b] = bounding_box(model_, outlines.position, b); });
  const std::vector<Patch> old = std::move(patches_);
  watch_.update(boxes);
  std::vector<char> anew = find_patches(boxes, old);
  if (model_.scene.contact.self_contact) {
    add_self_patches();
    anew.assign(patches_.size(), 1);
  }
  lay_out_patches();
  carry_history(old, history);
  parallel_for(static_cast<int>(patches_.size()), [&](int p) {
    if (anew[p]) locate_newcomers({model_, found_at_, patches_[p], skin_, thread_scratch()}, history);
  });
  ++refreshes_;
}

/// Which patches are not among the old ones.
std::vector<char> ContactSystem::find_patches(const std::vector<Box>& boxes, const std::vector<Patch>& old) {
  std::vector<Patch> found(static_cast<std::size_t>(watch_.count()));
  std::vector<char> found_anew(found.size(), 0);
  parallel_for_uneven(watch_.count(), 64, [&](int p) {
    const BodyPair& pair = watch_[p];
    Patch& patch = found[p];
    patch.first = pair.first, patch.second = pair.second, patch.images = pair.images;
    if (watch_.may_keep(p)) {
      if (const Patch* same = find_patch(old, patch)) patch = *same;
      return;
    }
    found_anew[p] = 1;
    watch_.searched(p);
    patch.law = laws_.between(pair.first, pair.second, refreshed_.time);
    patch.corners = has_corners(pair.first) || has_corners(pair.second);
    find_arcs(model_, found_at_.position, boxes, patch, reach_of(patch.law) + skin_, skin_, thread_scratch());
  });
  pairs_searched_ += std::count(found_anew.begin(), found_anew.end(), 1);
  patches_.clear();
  std::vector<char> anew;
  for (std::size_t p = 0; p < found.size(); ++p)
    if (found[p].nodes[0].count + found[p].nodes[1].count > 0)
      patches_.push_back(found[p]), anew.push_back(found_anew[p]);
  return anew;
}

void ContactSystem::lay_out_patches() {
  body_arcs_.assign(model_.bodies.size(), {});
  int record = 0, force = 0;
  for (Patch& patch : patches_)
    for (int side = 0; side < 2; ++side) {
      const Arc arc = patch.forces(side);
      patch.record[side] = record;
      patch.force[side] = force;
      if (arc.count > 0) body_arcs_[side == 0 ? patch.first : patch.second].push_back({arc.begin, arc.count, force});
      record += padded(patch.nodes[side].count);
      force += padded(arc.count);
    }
  records_ = record;
  force += lane_count;  // looked at by whole lanes
  forces_.x.assign(static_cast<std::size_t>(force), 0.0);
  forces_.y.assign(static_cast<std::size_t>(force), 0.0);
  totals_.assign(patches_.size(), {});
}

void ContactSystem::carry_history(const std::vector<Patch>& old, ContactHistory& history) const {
  const std::size_t records = static_cast<std::size_t>(records_);
  ContactHistory next{std::vector(records, std::numeric_limits<double>::quiet_NaN()), std::vector(records, 0.0),
                      std::vector(records * laws_.remembered(), 0.0)};
  parallel_for(static_cast<int>(patches_.size()), [&](int p) {
    const Patch& patch = patches_[p];
    const std::span<const Remembered> remembered = remembered_of(patch.law);
    for (int side = 0; side < 2; ++side)
      for (std::size_t k = 0; k < remembered.size(); ++k)
        std::fill_n(next.field(k) + patch.record[side], padded(patch.nodes[side].count), remembered[k].at_first);
    const Patch* from = find_patch(old, patch);
    if (!from) return;
    const bool two_walls = model_.bodies[patch.first].wall && model_.bodies[patch.second].wall;
    for (int side = 0; side < 2; ++side) {
      const int count = patch.nodes[side].count, begin = patch.record[side], old_begin = from->record[side];
      if (patch.nodes[side] == from->nodes[side]) {
        std::copy_n(&history.place[old_begin], count, &next.place[begin]);
        std::copy_n(&history.slip[old_begin], count, &next.slip[begin]);
        for (std::size_t k = 0; k < remembered.size(); ++k)
          std::copy_n(std::as_const(history).field(k) + old_begin, count, next.field(k) + begin);
        continue;
      }
      const OutlineShape& shape = model_.outlines[model_.bodies[side == 0 ? patch.first : patch.second].outline];
      const bool images_apart = shape.turn_shift != 0 && !two_walls;  // nodes of a wall under a body: see find_arcs
      for (int i = 0; i < count; ++i) {
        int at = patch.nodes[side].begin + i - from->nodes[side].begin;
        if (!images_apart) at -= turn_of(at, shape.count) * shape.count;
        if (at < 0 || at >= from->nodes[side].count) continue;
        const int record = begin + i, old_record = old_begin + at;
        next.place[record] = history.place[old_record];
        next.slip[record] = history.slip[old_record];
        for (std::size_t k = 0; k < remembered.size(); ++k)
          next.field(k)[record] = std::as_const(history).field(k)[old_record];
      }
    }
  });
  history = std::move(next);
}

/// Asks for what the patch's windows and nodes look at first: there are many patches, each on places of its own.
void ContactSystem::prefetch(const Patch& patch, const OutlineField& position) const {
  constexpr int per_line = 8;
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? patch.first : patch.second, n = model_.outline_of(body).count;
    const Arc& arc = patch.segments[side];
    const int node = model_.outline_offset[body] + arc.begin - turn_of(arc.begin, n) * n;
    for (int i = 0; i < arc.count; i += per_line) {
      __builtin_prefetch(position.x.data() + node + i);
      __builtin_prefetch(position.y.data() + node + i);
    }
  }
}

PatchTotals ContactSystem::forces(const Outlines& outlines, const ContactHistory& from, ContactHistory& to,
                                  OutlineField& force) {
  to.place.resize(from.records());
  to.slip.resize(from.records());
  to.of_law = from.of_law;  // laws that remember less than others leave the rest alone
  force.x.resize(outlines.position.x.size());
  force.y.resize(outlines.position.x.size());
  const int count = static_cast<int>(patches_.size());
  parallel_for(count, [&](int p) {
    if (p + 1 < count) prefetch(patches_[p + 1], outlines.position);
    totals_[p] = compute_patch({model_, outlines, patches_[p], skin_, thread_scratch()}, from, to, forces_);
  });
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    const int n = model_.outline_of(b).count;
    double* x = &force.x[model_.outline_offset[b]];
    double* y = &force.y[model_.outline_offset[b]];
    std::fill_n(x, n, 0.0);
    std::fill_n(y, n, 0.0);
    for_each_run(b, n, [&](int node, int entry, int count) {
      add_run(&forces_.x[entry], count, x + node);
      add_run(&forces_.y[entry], count, y + node);
    });
  });
  PatchTotals total;
  for (const PatchTotals& t : totals_) {
    total.stored += t.stored;
    total.dissipated += t.dissipated;
    total.damping_power += t.damping_power;
    total.deepest = std::max(total.deepest, t.deepest);
    total.contacts += t.contacts;
  }
  return total;
}

void ContactSystem::add_self_patches() {
  const int pairs = watch_.count();
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].kind != BodyKind::compliant) continue;
    watch_.add({b, b, 0});  // as any pair: the body's parts may move by the skin against each other
    const ContactLaw law = laws_.between(b, b, refreshed_.time);
    find_self_patches(model_, found_at_.position, b, law, reach_of(law) + skin_, skin_, patches_, thread_scratch());
  }
  if (watch_.count() > pairs)
    std::sort(patches_.begin(), patches_.end(), [](const Patch& a, const Patch& b) { return key(a) < key(b); });
}

/// A limb thinner than contact sees would press its own far side out.
void ContactSystem::refuse_self_overlap() const {
  for (const Patch& patch : patches_)
    if (patch.of_itself() && overlaps({model_, found_at_, patch, skin_, thread_scratch()}))
      throw InputError(fmt::format(
          "'{}' overlaps itself at the start, or is thinner somewhere than contact sees into it, a segment and a skin: "
          "{:.3g} m; give it a finer outline, or leave [contact] self_contact out",
          model_.bodies[patch.first].name, model_.outline_of(patch.first).spacing + skin_));
}

}  // namespace pliant
