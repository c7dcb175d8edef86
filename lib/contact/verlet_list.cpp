#include "contact/verlet_list.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "contact/halo.hpp"
#include "core/archive.hpp"
#include "core/parallel.hpp"
#include "core/sorted_search.hpp"
#include "geometry/lattice.hpp"

namespace pliant {
namespace {

constexpr double extra_skins = 4;
/// Diameter of a body's displacements, as a share of the skin, from which the body gets a new reference.
constexpr double reset_threshold = 0.25;
/// Share of the skin up to which a pair is kept when others are searched; likewise for the broad phase. Few pairs move
/// by much more than the others (docs/notes/contact_search.md).
constexpr double search_threshold = 0.75;
/// Bound of the rounding of stored displacements of some skins, over the skin, with a wide margin.
constexpr double rounded = 1e-4;
/// Unit of displacements over the skin. Sums of integers do not depend on the order, nor on the number of processes.
constexpr double displacement_unit = 0x1p-24;
/// Bound of a displacement in units, 16384 skins. The sum of 2^24 bodies does not overflow. Beyond it the mean
/// displacement is wrong, and the broad phase only runs more often.
constexpr double largest_in_units = 0x1p38;

/// Displacement in whole units; 0 if it is not a number.
std::int64_t in_units(double displacement, double unit) {
  if (std::isnan(displacement)) return 0;
  return std::llrint(std::clamp(displacement / unit, -largest_in_units, largest_in_units));
}

/// Loops over bodies and pairs are cut into blocks, whose results are put together in order.
Blocks blocks_of(int count) { return {count, 64}; }

std::vector<int> both_bodies(const std::vector<BodyPair>& pairs) {
  std::vector<int> bodies(2 * pairs.size());
  parallel_for(static_cast<int>(pairs.size()),
               [&](int p) { bodies[2 * p] = pairs[p].first, bodies[2 * p + 1] = pairs[p].second; });
  return bodies;
}

/// Mean of a closed outline's nodes, largest distance of the nodes from it, and least distance of the segments' lines
/// from it. The latter is negative if the mean is outside some line.
BodyPlace place_of(const Model& model, int body, const OutlineField& outlines) {
  const int begin = model.outline_offset[body], count = model.outline_of(body).count;
  const double first_x = outlines.x[begin], first_y = outlines.y[begin];
  Lanes sum_x{}, sum_y{};
  for (int i = 0; i < count; i += lane_count) {
    const LaneBits own = first_lanes(count - i);
    sum_x += select(own, load(&outlines.x[begin + i]) - first_x, Lanes{});
    sum_y += select(own, load(&outlines.y[begin + i]) - first_y, Lanes{});
  }
  const double x = first_x + sum(sum_x) / count, y = first_y + sum(sum_y) / count;
  Lanes farthest{}, nearest = broadcast(1e300);
  for (int i = 0; i < count; i += lane_count) {
    const int at = begin + i;
    const LaneBits own = first_lanes(count - i);
    const Lanes ax = load(&outlines.x[at]) - x, ay = load(&outlines.y[at]) - y;
    const Lanes dx = load(&outlines.x[at + 1]) - x - ax, dy = load(&outlines.y[at + 1]) - y - ay;
    farthest = max(farthest, select(own, ax * ax + ay * ay, Lanes{}));
    nearest = select(own, min(nearest, (ax * dy - ay * dx) / sqrt(dx * dx + dy * dy)), nearest);
  }
  return {x, y, std::sqrt(largest(farthest)), -largest(-nearest)};
}

}  // namespace

VerletList::VerletList(const Model& model, double skin, double reach)
    : model_(model),
      skin_(skin),
      own_skin_(0.5 * (1 + extra_skins) * skin),
      margin_(reach + (1 + extra_skins) * skin),
      motion_(model.bodies.size()),
      pair_displacements_(model),
      spare_displacements_(model),
      grains_(static_cast<int>(std::ranges::count(model.bodies, false, &Body::wall))) {
  forget();
}

void VerletList::forget() {
  reference_.x.clear(), reference_.y.clear();
  pairs_.clear();
  use_.clear();
  of_pairs_.resize(0, false);
  pair_displacements_.set_bodies({});
  since_sweep_.assign(model_.bodies.size(), unknown_displacement);
  swept_at_.assign(model_.bodies.size(), BodyPlace{0, 0, 0, -1});
}

void VerletList::loaded() {
  pair_displacements_.restore_bodies(both_bodies(pairs_));
  if (swept_at_.size() != motion_.size() || since_sweep_.size() != motion_.size())
    throw ArchiveError("displacements are those of other bodies");
  const auto& [excess, gap, watched, image] = of_pairs_;
  if (excess.size() != pairs_.size() || gap.size() != pairs_.size() || watched.size() != pairs_.size())
    throw ArchiveError("displacements are those of other pairs");
  if (image.size() != (model_.scene.cell ? pairs_.size() : 0)) throw ArchiveError("images are those of other pairs");
  use_.assign(pairs_.size(), search_again);
}

/// Sets motion_ and drift_.
void VerletList::measure(const OutlineField& now) {
  swept_by_.setZero();
  if (now.lattice != swept_lattice_ && model_.scene.cell)
    swept_by_ = matrix_of(now.lattice) * matrix_of(swept_lattice_).inverse() - Eigen::Matrix2d::Identity();
  const std::vector<int>& present = present_bodies(model_);
  const int own = static_cast<int>(model_.own.bodies.size());
  const Blocks bodies = blocks_of(static_cast<int>(present.size()));
  of_block_.resize(static_cast<std::size_t>(bodies.count()));
  const double unit = displacement_unit * skin_;
  parallel_for(bodies.count(), [&](int number) {
    std::array<std::int64_t, 2> sum{};
    bodies.for_each_in(number, [&](int i) {
      const int b = present[i];
      motion_[b] = displacement_disc(model_, b, now, reference_);
      if (model_.bodies[b].wall || i >= own) return;
      const DisplacementDisc displacement = displacement_since_sweep(b);
      sum[0] += in_units(displacement.x, unit), sum[1] += in_units(displacement.y, unit);
    });
    of_block_[number] = sum;
  });
  std::array<std::int64_t, 2> total{};
  for (const auto& of_block : of_block_) total[0] += of_block[0], total[1] += of_block[1];
  if (model_.halo) model_.halo->add(total);
  drift_.setZero();
  if (grains_ > 0) drift_ = unit / grains_ * Vec2(static_cast<double>(total[0]), static_cast<double>(total[1]));
}

/// Displacement of a body since the last broad phase. In a cell that is deformed it is relative to the motion of the
/// cell at the body's place.
DisplacementDisc VerletList::displacement_since_sweep(int body) const {
  DisplacementDisc displacement = displacement_between(since_sweep_[body], motion_[body]);
  if (!model_.scene.cell) return displacement;
  const Vec2 with_cell = swept_by_ * Vec2(swept_at_[body].x, swept_at_[body].y);
  displacement.x -= with_cell.x(), displacement.y -= with_cell.y();
  return displacement;
}

/// Half of the distance by which the cell's deformation alone may have brought a pair together that the broad phase
/// excluded. The gap of two bodies, with the radii R, shrinks by at most the norm of the growth times gap + 2 R. What
/// is left of a gap larger than the margin is larger too.
double VerletList::approach_by_cell() const {
  double radius = 0;
  for (const BodyPlace& place : swept_at_) radius = std::max(radius, place.outer);
  return swept_by_.norm() * (radius + 0.5 * margin_);
}

/// Distance by which a body may have left its place relative to the mean of all. The box of a wall covers all x,
/// whatever its own displacement in x. A round body may spin without leaving its place: the distance is from the disc
/// inside its former outline to the disc around its present one.
double VerletList::come_out_of_place(int body, const OutlineField& now) const {
  const DisplacementDisc displacement = displacement_since_sweep(body);
  const bool wall = model_.bodies[body].wall;
  const double x = wall ? 0.0 : displacement.x - drift_.x(), y = displacement.y - drift_.y(),
               from_mean = std::sqrt(x * x + y * y) + displacement.radius;
  const BodyPlace& then = swept_at_[body];
  if (from_mean < search_threshold * own_skin_ || then.inner < 0) return from_mean;
  const BodyPlace place = place_of(model_, body, now);
  const Vec2 with_cell = swept_by_ * Vec2(then.x, then.y);
  const double dx = place.x - then.x - with_cell.x() - drift_.x(), dy = place.y - then.y - with_cell.y() - drift_.y();
  return std::min(from_mean, std::sqrt(dx * dx + dy * dy) + place.outer - then.inner);
}

/// Relative displacement of both bodies of a pair, the second one at its image.
double VerletList::with_image(int pair, const DisplacementDisc& first, DisplacementDisc second,
                              const OutlineField& now) const {
  if (!of_pairs_.image.empty()) {
    const Vec2 image = now.lattice.shift(pairs_[pair].images);
    second.x += image.x() - of_pairs_.image[pair].x, second.y += image.y() - of_pairs_.image[pair].y;
  }
  return relative_displacement(first, second);
}

void VerletList::note_image(int pair, const OutlineField& now) {
  if (of_pairs_.image.empty()) return;
  const Vec2 image = now.lattice.shift(pairs_[pair].images);
  of_pairs_.image[pair] = {image.x(), image.y()};
}

/// Bound from the discs of the nodes' displacements: cheap, but an overestimate.
double VerletList::displacement_bound(int pair, const OutlineField& now) const {
  return with_image(pair, pair_displacements_.displacement_bound(2 * pair, displacements(now)),
                    pair_displacements_.displacement_bound(2 * pair + 1, displacements(now)), now);
}

/// Bound from each node's own displacement.
double VerletList::displacement(int pair, const OutlineField& now) const {
  return with_image(pair, pair_displacements_.displacement(2 * pair, displacements(now)),
                    pair_displacements_.displacement(2 * pair + 1, displacements(now)), now);
}

bool VerletList::stays_within(int pair, double limit, const OutlineField& now) const {
  return displacement_bound(pair, now) < limit || displacement(pair, now) < (1 - rounded) * limit;
}

/// What a pair needs at these positions, after measure(). If the disc bound is below the skin, the pair is valid and an
/// estimate suffices.
VerletList::Use VerletList::use_of(int pair, const OutlineField& now) const {
  if (!of_pairs_.watched[pair]) return keep;
  const double rough = displacement_bound(pair, now),
               likely = rough < skin_ ? rough - of_pairs_.excess[pair] : displacement(pair, now);
  return likely < search_threshold * skin_ ? keep : likely < (1 - rounded) * skin_ ? check : search_again;
}

/// Only relative displacements can bring pairs together that the broad phase excluded. The result does not depend on
/// the direction of the axes. All that determines when pairs are searched must have that property, because the stable
/// step depends on the positions at the search.
bool VerletList::skin_is_exceeded(const OutlineField& now) {
  measure(now);
  use_.resize(pairs_.size());
  const std::vector<int>& own = model_.own.bodies;
  const Blocks pairs = blocks_of(count()), bodies = blocks_of(static_cast<int>(own.size()));
  exceeded_.resize(static_cast<std::size_t>(pairs.count()));
  farthest_.resize(static_cast<std::size_t>(bodies.count()));
  const auto of_pairs = [&](int number) {
    exceeded_[number] = 0;
    pairs.for_each_in(number, [&](int p) {
      use_[p] = use_of(p, now);
      if (use_[p] == search_again) exceeded_[number] = 1;
    });
  };
  const auto of_bodies = [&](int number) {
    farthest_[number] = 0;
    bodies.for_each_in(number,
                       [&](int i) { farthest_[number] = std::max(farthest_[number], come_out_of_place(own[i], now)); });
  };
  parallel_for(pairs.count(), of_pairs, bodies.count(), of_bodies);
  come_out_ = swept_by_.isZero(0) ? 0 : approach_by_cell();
  double farthest = 0;
  for (double of_block : farthest_) farthest = std::max(farthest, of_block);
  bool exceeded = std::ranges::any_of(exceeded_, [](char some) { return some; });
  if (model_.halo) {
    double largest[] = {farthest, exceeded ? 1.0 : 0.0};
    model_.halo->take_largest(largest);
    farthest = largest[0], exceeded = largest[1] > 0;
  }
  come_out_ += farthest;
  return exceeded || !(come_out_ < own_skin_);
}

/// Sets a new reference for bodies that have deformed or rotated since theirs. The bounds of all their pairs would
/// become overestimates.
void VerletList::reset_references(const OutlineField& here, const OutlineField& trial) {
  const auto is_due = [&](int b) { return displacement_diameter(motion_[b]) >= reset_threshold * skin_; };
  parallel_for(pair_displacements_.count(), [&](int e) {
    if (is_due(pair_displacements_.body(e))) pair_displacements_.reset_reference(e, displacements(here));
  });
  const std::vector<int>& present = present_bodies(model_);
  parallel_for(static_cast<int>(present.size()), [&](int i) {
    const int b = present[i];
    if (!is_due(b)) return;
    const int first = model_.outline_offset[b], nodes = model_.outline_offset[b + 1] - first;
    since_sweep_[b] = displacement_between(displacement_disc(model_, b, here, reference_), since_sweep_[b]);
    std::copy_n(&here.x[first], nodes, &reference_.x[first]);
    std::copy_n(&here.y[first], nodes, &reference_.y[first]);
    motion_[b] = displacement_disc(model_, b, trial, reference_);
  });
}

/// Pairs of the broad phase, those that this process computes. Their ghosts get their outlines.
std::vector<BodyPair> VerletList::close_boxes(const OutlineField& here) {
  const std::vector<int>& own = model_.own.bodies;
  boxes_.resize(model_.bodies.size());
  parallel_for(static_cast<int>(own.size()), [&](int i) { boxes_[own[i]] = bounding_box(model_, here, own[i]); });
  if (model_.halo) model_.halo->gather_boxes(boxes_);
  std::vector<BodyPair> found = broad_phase(model_, boxes_, margin_, here.lattice);
  if (model_.halo) {
    std::erase_if(found, [&](const BodyPair& pair) { return !model_.halo->computes(pair); });
    model_.halo->set_pairs(found);
    model_.halo->renew(reference_);
  }
  return found;
}

bool VerletList::update(const OutlineField& here, const OutlineField& trial) {
  just_swept_ = false;
  const bool forgotten = reference_.x.empty();
  if (forgotten) {
    reference_ = here;
  } else {
    reset_references(here, trial);
    if (come_out_ < search_threshold * own_skin_) return false;
  }
  just_swept_ = true;
  swept_lattice_ = here.lattice;
  std::vector<BodyPair> found = close_boxes(here);
  const std::vector<int>& present = present_bodies(model_);
  parallel_for(static_cast<int>(present.size()), [&](int i) {
    const int b = present[i];
    since_sweep_[b] = displacement_disc(model_, b, here, reference_);
    if (!model_.bodies[b].wall) swept_at_[b] = place_of(model_, b, here);
  });
  std::erase_if(found, [&](const BodyPair& pair) { return discs_are_apart(pair, here); });
  if (model_.halo) model_.halo->set_pairs(found);
  follow(std::move(found), here);
  skin_is_exceeded(trial);
  return true;
}

/// Whether discs around both outlines were further apart than the margin at the broad phase. Of the pairs of grains
/// that only boxes let in, few remain to be searched.
bool VerletList::discs_are_apart(const BodyPair& pair, const OutlineField& here) const {
  if (model_.bodies[pair.first].wall || model_.bodies[pair.second].wall) return false;
  const BodyPlace &a = swept_at_[pair.first], &b = swept_at_[pair.second];
  const Vec2 image = here.lattice.shift(pair.images);
  const double dx = b.x + image.x() - a.x, dy = b.y + image.y() - a.y, reach = a.outer + b.outer + margin_;
  return dx * dx + dy * dy > reach * reach;
}

/// Replaces the pairs by those found. Data of pairs that were found before are kept, unless these may have entered or
/// left the margin since. Which of those the boxes let in depends on the axes.
void VerletList::follow(std::vector<BodyPair> found, const OutlineField& here) {
  std::vector<char> stays(pairs_.size());
  parallel_for(count(), [&](int p) {
    const double gap = of_pairs_.gap[p];
    if (of_pairs_.watched[p])
      stays[p] = gap <= margin_ - skin_ || gap + displacement(p, here) <= margin_;
    else
      stays[p] = gap - displacement(p, here) > margin_;
  });
  std::swap(pairs_, found);
  std::swap(of_pairs_, spare_of_pairs_), std::swap(pair_displacements_, spare_displacements_);
  of_pairs_.resize(pairs_.size(), model_.scene.cell.has_value());
  pair_displacements_.set_bodies(both_bodies(pairs_));
  parallel_for(count(), [&](int p) {
    const int old = find_near(found, pairs_[p], p, std::less{});
    if (old < 0 || !stays[old]) return of_pairs_.reset(p);
    of_pairs_.copy(p, spare_of_pairs_, old);
    for (int side = 0; side < 2; ++side)
      pair_displacements_.copy_entry(2 * p + side, spare_displacements_, 2 * old + side);
  });
}

/// The discs of the bound, the lattice and the nodes are those of one configuration, the trial's.
std::vector<int> VerletList::pairs_to_search(const OutlineField& trial) {
  parallel_for(count(), [&](int p) {
    if (use_[p] != check) return;
    const double exact = displacement(p, trial);
    of_pairs_.excess[p] = std::max(0.0, displacement_bound(p, trial) - exact);
    if (exact < search_threshold * skin_) use_[p] = keep;
  });
  std::vector<int> result;
  for (int p = 0; p < count(); ++p)
    if (use_[p] != keep) result.push_back(p);
  return result;
}

bool VerletList::hold(const std::vector<int>& pairs, const OutlineField& trial) const {
  const auto holds = [&](int p) { return !of_pairs_.watched[p] || stays_within(p, skin_, trial); };
  const bool hold = come_out_ < own_skin_ && std::ranges::all_of(pairs, holds);
  return model_.halo ? model_.halo->largest(hold ? 0 : 1) == 0 : hold;
}

void VerletList::searched(int pair, const OutlineField& now, double gap) {
  of_pairs_.excess[pair] = 0, of_pairs_.gap[pair] = gap;
  of_pairs_.watched[pair] = !(just_swept_ && gap > margin_);
  note_image(pair, now);
  for (int side = 0; side < 2; ++side) pair_displacements_.set_reference(2 * pair + side, displacements(now));
}

void VerletList::add(const BodyPair& pair, const OutlineField& now) {
  pairs_.push_back(pair);
  use_.push_back(keep);
  of_pairs_.resize(pairs_.size(), model_.scene.cell.has_value());
  of_pairs_.reset(count() - 1);
  for (int body : {pair.first, pair.second}) pair_displacements_.append(body);
  searched(count() - 1, now, 0);
}

}  // namespace pliant
