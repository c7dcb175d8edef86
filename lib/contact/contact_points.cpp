#include "contact/contact_points.hpp"

#include "contact/half_pass.hpp"
#include "contact/segment_pass.hpp"
#include "contact/slip.hpp"

namespace pliant {
namespace {

/// Response of the law without dashpot and energy correction.
template <class Law>
Contact answer(const Law& law, const PairView& view, const HalfPass& pass, int i, const Projection& p,
               LaneBits touching, const Lanes* before) {
  const FormerPlaces former{before[ContactHistory::place], view, pass, i};
  const Lanes moved = slip_increment(law, view.window, p, touching, former, place_of(p));
  return respond(law, law(p.gap), touching, before[ContactHistory::slip], moved);
}

std::vector<ContactPoint> inspect_contact_pair(const PairView& view, const ContactHistory& history) {
  if (view.contact_pair.integrated) return inspect_integrated(view, history);
  std::vector<ContactPoint> points;
  const auto add_points = [&]<class Law>(const Law& law, const HalfPass& pass, int side, int i, const Projection& p) {
    const LaneBits touching = first_lanes(pass.nodes.count - i) & p.hit & (p.gap < law.reach);
    const SlaveNodes nodes = load_slaves(pass, i);
    const Contact c = answer(law, view, pass, i, p, touching, history.at(pass.record + i));
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!touching[lane]) continue;
      const int index = pass.nodes.begin + i + lane, count = pass.slave->count;
      points.push_back({view.body(side), view.body(1 - side), index - turn_of(index, count) * count, p.gap[lane],
                        c.slip[lane], c.pressure[lane], c.shear[lane], nodes.tributary_length[lane],
                        Vec2(p.normal_x[lane], p.normal_y[lane]), side, Vec2(nodes.x[lane], nodes.y[lane])});
    }
  };
  std::visit(
      [&](const auto& law) {
        for_each_projection(view, law.reach + view.skin, [&](const auto&... found) { add_points(law, found...); });
      },
      view.contact_pair.law);
  return points;
}

}  // namespace

Vec2 TouchingPair::normal() const {
  Vec2 sum(0, 0);
  for (const ContactPoint& point : points) sum += (point.side == 0 ? -point.length : point.length) * point.normal;
  const double norm = sum.norm();
  return norm > 0 ? Vec2(sum / norm) : sum;
}

std::vector<TouchingPair> inspect_contacts(const Model& model, const ContactSystem& contact, const Outlines& outlines,
                                           const ContactHistory& history) {
  std::vector<TouchingPair> pairs;
  for (const ContactPair& contact_pair : contact.contact_pairs()) {
    std::vector<ContactPoint> points =
        inspect_contact_pair({model, outlines, contact_pair, contact.skin(), thread_scratch()}, history);
    if (!points.empty())
      pairs.push_back({contact_pair.first, contact_pair.second, contact_pair.images, std::move(points)});
  }
  return pairs;
}

}  // namespace pliant
