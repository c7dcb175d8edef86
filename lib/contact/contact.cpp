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

/// The broad phase looks further than the skin, so that bodies that it leaves out need no watching pair by pair.
constexpr double extra_skins = 4;

Box motion_box(const OutlineField& before, const OutlineField& now, int offset, int count) {
  Lanes x_min = broadcast(1e300), x_max = -x_min, y_min = x_min, y_max = x_max;
  // The last lanes may reach into the cyclic copies, which move as their originals.
  for (int i = offset; i < offset + count; i += lane_count) {
    const Lanes dx = load(&now.x[i]) - load(&before.x[i]), dy = load(&now.y[i]) - load(&before.y[i]);
    x_min = min(x_min, dx), x_max = max(x_max, dx);
    y_min = min(y_min, dy), y_max = max(y_max, dy);
  }
  return {-largest(-x_min), largest(x_max), -largest(-y_min), largest(y_max)};
}

/// Bound on the square of the relative motion of any two nodes of two bodies.
double relative_motion(const Box& a, const Box& b) {
  const double dx = std::max(a.x_max - b.x_min, b.x_max - a.x_min), dy = std::max(a.y_max - b.y_min, b.y_max - a.y_min);
  return dx * dx + dy * dy;
}

/// Patches are kept in this order.
auto key(const Patch& p) { return std::tie(p.first, p.second, p.images, p.part); }

bool has_fixed_refresh(const ContactSettings& settings) {
  return settings.refresh_steps > 0 || settings.refresh_period > 0;
}

int padded(int count) { return (count + lane_count - 1) / lane_count * lane_count; }

}  // namespace

ContactSystem::ContactSystem(const Model& model) : model_(model), laws_(model) {
  double finest = 1e300;
  for (const Body& body : model.bodies) finest = std::min(finest, model.outlines[body.outline].spacing);
  skin_ = model.scene.skin * finest;
  broad_margin_ = laws_.max_reach() + (1 + extra_skins) * skin_;
  motion_.resize(model.bodies.size());
}

bool ContactSystem::candidates_hold(const OutlineField& position, const RunClock& clock) {
  if (!fresh_ || laws_.era(clock.time) != laws_.era(refreshed_.time)) return false;
  return has_fixed_refresh(model_.scene.contact) ? !period_is_over(clock) : !moved_by_the_skin(position);
}

bool ContactSystem::period_is_over(const RunClock& clock) const {
  const ContactSettings& settings = model_.scene.contact;
  if (settings.refresh_steps > 0) return clock.steps >= refreshed_.steps + settings.refresh_steps;
  return clock.time >= refreshed_.time + settings.refresh_period;
}

void ContactSystem::warn_of_missed_contacts(const OutlineField& position) {
  if (warned_ || !fresh_ || !has_fixed_refresh(model_.scene.contact) || !moved_by_the_skin(position)) return;
  warned_ = true;
  spdlog::warn(
      "bodies move further than the contact skin, {:.3g} m, from one contact refresh to the next: contacts can be "
      "missed; shorten [contact] refresh, or leave it \"safe\"",
      skin_);
}

bool ContactSystem::moved_by_the_skin(const OutlineField& position) {
  const int bodies = static_cast<int>(model_.bodies.size());
  parallel_for(bodies, [&](int b) {
    motion_[b] = motion_box(found_at_.position, position, model_.outline_offset[b], model_.outline_of(b).count);
  });
  const Vec2 drift = common_motion();
  const double largest_own = parallel_max(bodies, 0, [&](int b) {
    Box own = motion_[b];
    if (model_.bodies[b].wall) own.x_min = own.x_max = drift.x();
    return relative_motion(own, Box{drift.x(), drift.x(), drift.y(), drift.y()});
  });
  const double largest_pair = parallel_max(static_cast<int>(pairs_.size()), 0, [&](int p) {
    return relative_motion(motion_[pairs_[p].first], motion_[pairs_[p].second]);
  });
  return largest_pair >= skin_ * skin_ || 4 * largest_own >= std::pow((1 + extra_skins) * skin_, 2);
}

/// Middle of all bodies' motions since the last refresh: only what they move against each other can bring pairs
/// together that the broad phase left out. A wall lies in wait along all x, whatever its own motion in x.
Vec2 ContactSystem::common_motion() const {
  Box all{1e300, -1e300, 1e300, -1e300};
  for (std::size_t b = 0; b < motion_.size(); ++b) {
    const Box& m = motion_[b];
    all.y_min = std::min(all.y_min, m.y_min), all.y_max = std::max(all.y_max, m.y_max);
    if (model_.bodies[b].wall) continue;
    all.x_min = std::min(all.x_min, m.x_min), all.x_max = std::max(all.x_max, m.x_max);
  }
  return 0.5 * Vec2(all.x_min + all.x_max, all.y_min + all.y_max);
}

void ContactSystem::find_candidates(const Outlines& outlines, ContactHistory& history, const RunClock& clock) {
  warn_of_missed_contacts(outlines.position);
  found_at_ = outlines;
  const bool start = !fresh_;  // an empty history would not tell: bodies may have been far from each other
  refreshed_ = clock;
  const int bodies = static_cast<int>(model_.bodies.size());
  std::vector<Box> boxes(model_.bodies.size());
  parallel_for(bodies, [&](int b) { boxes[b] = bounding_box(model_, outlines.position, b); });
  pairs_ = broad_phase(model_, boxes, broad_margin_);
  const std::vector<Patch> old = std::move(patches_);
  find_patches(boxes);
  if (model_.scene.contact.self_contact) add_self_patches();
  lay_out_patches();
  carry_history(old, history);
  if (start) refuse_self_overlap();
  parallel_for(static_cast<int>(patches_.size()), [&](int p) {
    const PatchView view{model_, found_at_, patches_[p], skin_, thread_scratch()};
    locate_newcomers(view, history);
    if (start) start_records(view, history);
  });
  fresh_ = true;
  ++refreshes_;
}

void ContactSystem::find_patches(const std::vector<Box>& boxes) {
  std::vector<Patch> found(pairs_.size());
  parallel_for_uneven(static_cast<int>(pairs_.size()), 64, [&](int p) {
    const BodyPair& pair = pairs_[p];
    Patch& patch = found[p];
    patch.first = pair.first, patch.second = pair.second, patch.images = pair.images;
    patch.law = laws_.between(pair.first, pair.second, refreshed_.time);
    patch.corners = has_corners(pair.first) || has_corners(pair.second);
    find_arcs(model_, found_at_.position, boxes, patch, reach_of(patch.law) + skin_, skin_, thread_scratch());
  });
  patches_.clear();
  for (const Patch& patch : found)
    if (patch.nodes[0].count + patch.nodes[1].count > 0) patches_.push_back(patch);
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
      force += arc.count + lane_count;  // room for whole lanes
    }
  records_ = record;
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
    const auto from =
        std::lower_bound(old.begin(), old.end(), patch, [](const Patch& a, const Patch& b) { return key(a) < key(b); });
    if (from == old.end() || key(*from) != key(patch)) return;
    const bool two_walls = model_.bodies[patch.first].wall && model_.bodies[patch.second].wall;
    for (int side = 0; side < 2; ++side) {
      const OutlineShape& shape = model_.outlines[model_.bodies[side == 0 ? patch.first : patch.second].outline];
      const bool images_apart = shape.turn_shift != 0 && !two_walls;  // nodes of a wall under a body: see find_arcs
      for (int i = 0; i < patch.nodes[side].count; ++i) {
        int at = patch.nodes[side].begin + i - from->nodes[side].begin;
        if (!images_apart) at -= turn_of(at, shape.count) * shape.count;
        if (at < 0 || at >= from->nodes[side].count) continue;
        const int record = patch.record[side] + i, old_record = from->record[side] + at;
        next.place[record] = history.place[old_record];
        next.slip[record] = history.slip[old_record];
        for (std::size_t k = 0; k < remembered.size(); ++k)
          next.field(k)[record] = std::as_const(history).field(k)[old_record];
      }
    }
  });
  history = std::move(next);
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
    totals_[p] = compute_patch({model_, outlines, patches_[p], skin_, thread_scratch()}, from, to, forces_);
  });
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    const int n = model_.outline_of(b).count;
    double* x = &force.x[model_.outline_offset[b]];
    double* y = &force.y[model_.outline_offset[b]];
    std::fill_n(x, n, 0.0);
    std::fill_n(y, n, 0.0);
    for_each_force(b, n, [&](int node, int entry) { x[node] += forces_.x[entry], y[node] += forces_.y[entry]; });
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
  const std::size_t pairs = pairs_.size();
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].kind != BodyKind::compliant) continue;
    pairs_.push_back({b, b, 0});  // watched as any pair: the body's parts may move by the skin against each other
    const ContactLaw law = laws_.between(b, b, refreshed_.time);
    find_self_patches(model_, found_at_.position, b, law, reach_of(law) + skin_, skin_, patches_, thread_scratch());
  }
  if (pairs_.size() > pairs)
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
