#include "reference/contact/integrated_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "reference/contact/reference_outline.hpp"

namespace pliant::reference {
namespace {

/// Gaps at which pressure or the limit of shear has a kink.
std::vector<double> kinks(const Law& law) {
  std::vector<double> levels{0};
  if (law.start > 0) levels.push_back(-law.start);
  if (law.reach > 0) levels.push_back(law.reach);
  if (law.kind == ContactLawKind::cohesive) levels.push_back(law.strength / law.kn);
  return levels;
}

struct Extent {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec2& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
};

Extent extent_of(const PresentOutline& outline) {
  Extent extent;
  for (int i = 0; i <= outline.count(); ++i) extent.add(outline.node(i));
  return extent;
}

Extent extent_of(const PresentOutline& outline, int segment) {
  Extent extent;
  extent.add(outline.node(segment));
  extent.add(outline.node(segment + 1));
  return extent;
}

/// Extent of the body; unbounded for a wall, whose solid has no end.
Extent solid_of(const PresentOutline& outline, const Vec2& shift) {
  constexpr double far = std::numeric_limits<double>::infinity();
  if (!outline.closed()) return {Vec2(-far, -far), Vec2(far, far)};
  Extent extent = extent_of(outline);
  extent.low += shift, extent.high += shift;
  return extent;
}

struct Range {
  int first, count;
};

/// Range of segments beside another extent. For a wall it has as many turns as the other is wide, and one more on
/// either side.
Range segments_beside(const PresentOutline& outline, const Extent& other) {
  if (outline.closed()) return {0, outline.count()};
  const Extent one = extent_of(outline);
  const double turn = outline.turn_shift(), middle = (one.low.x() + one.high.x()) / 2;
  const auto [low, high] =
      std::minmax({std::lround((other.low.x() - middle) / turn), std::lround((other.high.x() - middle) / turn)});
  return {static_cast<int>(low - 1) * outline.count(), static_cast<int>(high - low + 3) * outline.count()};
}

bool are_apart(const Extent& a, const Extent& b, double by) {
  return (a.low - b.high).maxCoeff() > by || (b.low - a.high).maxCoeff() > by;
}

}  // namespace

IntegratedContacts::IntegratedContacts(const Scene& scene, const std::vector<ContactOutline>& outlines,
                                       const PairLaws& laws, std::function<bool(int, int)> has)
    : outlines_(outlines), laws_(laws), has_(std::move(has)), periods_(scene), past_periods_(scene) {
  for (const ContactOutline& outline : outlines) {
    const ReferenceOutline shape(outline);
    longest_.push_back(shape.longest());
    lengths_.emplace_back();
    if (scene.contact.length == ContactLength::reference)
      for (int i = 0; i < outline.count; ++i) lengths_.back().push_back(shape.length(i));
  }
}

ContactResult IntegratedContacts::evaluate(const Points& x, const Periods& periods) {
  x_ = x;
  periods_ = periods;
  trial_.clear();
  ContactResult result;
  const int count = static_cast<int>(outlines_.size());
  for (int slave = 0; slave < count; ++slave)
    for (int master = 0; master < count; ++master)
      if (has_(slave, master)) meet(slave, master, result);
  for (const auto& [encounter, slips] : accepted_)
    for (const auto& [node, slip] : slips) {
      const auto found = trial_.find(encounter);
      if (found != trial_.end() && found->second.contains(node)) continue;
      result.dissipated += lost_slip(*laws_.between(std::get<0>(encounter), std::get<1>(encounter)), slip);
    }
  return result;
}

void IntegratedContacts::accept() {
  accepted_ = trial_;
  past_ = x_;
  past_periods_ = periods_;
}

/// Contact with all periodic images of the master. A wall is periodic itself and counts as one body, beside each other
/// body.
void IntegratedContacts::meet(int slave, int master, ContactResult& result) {
  if (outlines_[slave].wall || outlines_[master].wall) return meet_image({slave, master, {}}, result);
  const Vec2 reach = Vec2::Constant(laws_.between(slave, master)->reach);
  const Extent a = extent_of({outlines_[slave], x_}), b = extent_of({outlines_[master], x_});
  for (const Image& image : periods_.between(a.low - b.high - reach, a.high - b.low + reach))
    if (slave != master || image != Image{}) meet_image({slave, master, image}, result);
}

void IntegratedContacts::meet_image(const Encounter& encounter, ContactResult& result) {
  const auto& [slave, master, image] = encounter;
  const PresentOutline from(outlines_[slave], x_), to(outlines_[master], x_), past_from(outlines_[slave], past_),
      past_to(outlines_[master], past_);
  const Law& law = *laws_.between(slave, master);
  const Vec2 shift = periods_.shift(image);
  const Range seen = segments_beside(to, extent_of(from));
  PassSetting setting{{from, to, shift, seen.first, seen.count, kinks(law), law.reach}, law, {}, lengths_[slave], {}};
  if (!past_.empty()) setting.past.emplace(past_from, past_to, past_periods_.shift(image));
  const Extent extent = solid_of(to, shift);
  // For two walls one turn of the slave suffices.
  const Range own = to.closed() ? segments_beside(from, extent) : Range{0, from.count()};
  for (int i = own.first; i < own.first + own.count; ++i)
    if (!are_apart(extent_of(from, i), extent, law.reach)) setting.segments.push_back(i);
  const auto found = accepted_.find(encounter);
  PassResult pass = integrated_pass(setting, found == accepted_.end() ? NodeSlips{} : found->second);
  if (pass.patch.node.empty()) return;
  pass.patch.body = {slave, master};
  pass.patch.lever.image = image;
  pass.patch.depth = pass.patch.deepest / longest_[master];
  if (!past_.empty()) pass.patch.compression = 0;
  result.stored += pass.stored;
  result.dissipated += pass.dissipated;
  trial_[encounter] = std::move(pass.slips);
  result.patches.push_back(std::move(pass.patch));
}

}  // namespace pliant::reference
