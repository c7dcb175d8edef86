#include "benchmarks/baseline/contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace pliant::baseline {
namespace {

struct Box {
  double left, right, bottom, top;
};

Box box_of(const Body& body) {
  Box box{1e300, -1e300, 1e300, -1e300};
  for (const OutlineNode& node : body.outline) {
    box.left = std::min(box.left, node.x), box.right = std::max(box.right, node.x);
    box.bottom = std::min(box.bottom, node.y), box.top = std::max(box.top, node.y);
  }
  box.right = std::max(box.right, box.left + body.turn_shift);
  box.left = std::min(box.left, box.right - std::abs(body.turn_shift));
  return box;
}

double normal_pressure(const ContactLaw& law, double gap) {
  if (gap >= law.reach) return 0;
  const double critical = law.strength / law.normal_stiffness;
  if (law.strength == 0 || gap < critical) return -law.normal_stiffness * gap;
  return -law.strength * (law.reach - gap) / (law.reach - critical);
}

double shear_limit(const ContactLaw& law, double gap, double pressure) {
  if (law.strength == 0) return law.cohesion + law.friction * std::max(pressure, 0.0);
  const double critical = law.strength / law.normal_stiffness;
  return gap < critical ? law.shear_strength : law.shear_strength * (law.reach - gap) / (law.reach - critical);
}

}  // namespace

Contact::Contact(std::vector<std::vector<ContactLaw>> laws, double skin, double period)
    : laws_(std::move(laws)), skin_(skin), period_(period) {}

Contact::Segment Contact::segment_of(const Body& body, int segment, double shift) {
  const int count = static_cast<int>(body.outline.size()), next = segment + 1 == count ? 0 : segment + 1;
  const OutlineNode &a = body.outline[segment], &b = body.outline[next];
  Segment s{a.x + shift, a.y, b.x + shift + (next == 0 ? body.turn_shift : 0), b.y, 0, 0, 0};
  s.length = std::sqrt((s.bx - s.ax) * (s.bx - s.ax) + (s.by - s.ay) * (s.by - s.ay));
  s.tx = (s.bx - s.ax) / s.length, s.ty = (s.by - s.ay) / s.length;
  return s;
}

/// Keeps the closer of two segments; of two that meet in the closest point the one that is seen more steeply.
void Contact::find_foot(const Body& master, const Candidate& candidate, const OutlineNode& node, Foot& best) {
  const Segment s = segment_of(master, candidate.segment, candidate.shift);
  const double rx = node.x - s.ax, ry = node.y - s.ay;
  const double along = rx * s.tx + ry * s.ty, height = rx * s.ty - ry * s.tx;
  const double xi = std::min(std::max(along / s.length, 0.0), 1.0), over = along - xi * s.length;
  const double square = over * over + height * height;
  if (best.segment >= 0) {
    if (square > (1 + 1e-12) * best.square) return;
    if (square >= (1 - 1e-12) * best.square && std::abs(height) <= std::abs(best.height)) return;
  }
  best = {candidate.segment, candidate.shift, square, xi, height, height, s.ty, -s.tx, 0};
  if (over == 0 || square == 0) return;
  best.gap = height < 0 ? -std::sqrt(square) : std::sqrt(square);
  const double sine = over / best.gap, cosine = height / best.gap;
  best.angle = std::asin(sine);
  best.nx = cosine * s.ty + sine * s.tx, best.ny = sine * s.ty - cosine * s.tx;
}

/// Along the present outline, at the present gap.
double Contact::way(const Body& master, const Slip& old, const Foot& now) {
  const int count = static_cast<int>(master.outline.size());
  int rows = now.segment - old.segment;
  if (rows > count / 2) rows -= count;
  if (rows < -count / 2) rows += count;
  if (rows == 0) {
    const Segment s = segment_of(master, now.segment, 0);
    return s.length * (now.xi - old.xi) + now.gap * std::sin(now.angle - old.angle);
  }
  const bool onward = rows > 0;
  const double from_xi = onward ? old.xi : now.xi, to_xi = onward ? now.xi : old.xi;
  const double from_angle = onward ? old.angle : now.angle, to_angle = onward ? now.angle : old.angle;
  const int first = onward ? old.segment : now.segment;
  Segment before = segment_of(master, first, 0);
  double length = (1 - from_xi) * before.length + now.gap * (to_angle - from_angle);
  for (int k = 1; k <= std::abs(rows); ++k) {
    const Segment after = segment_of(master, (first + k) % count, 0);
    const double turn =
        std::atan2(before.tx * after.ty - before.ty * after.tx, before.tx * after.tx + before.ty * after.ty);
    length += now.height * turn > 0 ? now.gap * turn : 2 * now.height * std::tan(0.5 * turn);
    length += k == std::abs(rows) ? to_xi * after.length : after.length;
    before = after;
  }
  return onward ? length : -length;
}

void Contact::list_segments(const std::vector<Body>& bodies, int slave, int master, double shift) {
  const Body &a = bodies[slave], &b = bodies[master];
  const double reach = laws_[a.group][b.group].reach;
  for (std::size_t i = 0; i < a.outline.size(); ++i)
    for (std::size_t k = 0; k < b.outline.size(); ++k) {
      const OutlineNode& node = a.outline[i];
      const double dx = std::abs(node.x - b.outline[k].x - shift), dy = std::abs(node.y - b.outline[k].y);
      if (dx > 4 * skin_ + reach + b.outline[k].length || dy > 4 * skin_ + reach + b.outline[k].length) continue;
      const Segment s = segment_of(b, static_cast<int>(k), shift);
      const double sight = s.length + skin_ + reach;
      Foot foot;
      find_foot(b, {master, static_cast<int>(k), shift}, node, foot);
      if (foot.square < sight * sight) candidates_[slave][i].push_back({master, static_cast<int>(k), shift});
    }
}

void Contact::find_candidates(const std::vector<Body>& bodies) {
  const int count = static_cast<int>(bodies.size());
  history_.resize(bodies.size());
  candidates_.assign(bodies.size(), {});
  std::vector<Box> boxes(bodies.size());
#pragma omp parallel for
  for (int b = 0; b < count; ++b) boxes[b] = box_of(bodies[b]);
#pragma omp parallel for schedule(dynamic, 8)
  for (int slave = 0; slave < count; ++slave) {
    candidates_[slave].resize(bodies[slave].outline.size());
    for (int master = 0; master < count; ++master) {
      const double far = skin_ + laws_[bodies[slave].group][bodies[master].group].reach;
      const Box &a = boxes[slave], &b = boxes[master];
      if (master == slave || a.top + far < b.bottom || b.top + far < a.bottom) continue;
      const double first = a.left - far - b.right, last = a.right + far - b.left;  // shifts that bring them together
      if (period_ == 0 && first <= 0 && last >= 0) list_segments(bodies, slave, master, 0);
      for (double image = std::ceil(first / period_); period_ > 0 && image <= std::floor(last / period_); ++image)
        list_segments(bodies, slave, master, image * period_);
    }
  }
}

/// Returns 1 when the node touches the master.
int Contact::touch(std::vector<Body>& bodies, int slave, int node, int master, const Foot& foot) {
  Body& body = bodies[master];
  OutlineNode& at = bodies[slave].outline[node];
  const ContactLaw& law = laws_[bodies[slave].group][body.group];
  const std::uint64_t key = static_cast<std::uint64_t>(node) << 32 | static_cast<std::uint64_t>(master);
  const bool slides = law.shear_stiffness > 0;
  if (foot.gap > law.reach + (slides ? skin_ : 0)) {
    history_[slave].erase(key);
    return 0;
  }
  const bool touching = foot.gap < law.reach;
  const double pressure = normal_pressure(law, foot.gap);
  double slip = 0;
  if (slides) {
    const auto [found, fresh] = history_[slave].try_emplace(key, Slip{foot.segment, foot.xi, foot.angle, 0});
    if (!fresh && touching) {
      const double largest = shear_limit(law, foot.gap, pressure) / law.shear_stiffness;
      slip = std::clamp(found->second.slip + way(body, found->second, foot), -largest, largest);
    }
    found->second = {foot.segment, foot.xi, foot.angle, slip};
  }
  if (!touching) return 0;
  const double shear = -law.shear_stiffness * slip, weight = 0.5 * at.length;
  const double fx = weight * (pressure * foot.nx - shear * foot.ny);
  const double fy = weight * (pressure * foot.ny + shear * foot.nx);
  const Segment s = segment_of(body, foot.segment, foot.shift);
  // The shear acts at the gap's distance: its moment is balanced by a couple on the segment.
  const double couple = weight * shear * foot.gap / s.length;
  const double second_x = -foot.xi * fx + couple * s.ty, second_y = -foot.xi * fy - couple * s.tx;
  OutlineNode& first = body.outline[foot.segment];
  OutlineNode& second = body.outline[(static_cast<std::size_t>(foot.segment) + 1) % body.outline.size()];
#pragma omp atomic
  at.fx += fx;
#pragma omp atomic
  at.fy += fy;
#pragma omp atomic
  first.fx += -fx - second_x;
#pragma omp atomic
  first.fy += -fy - second_y;
#pragma omp atomic
  second.fx += second_x;
#pragma omp atomic
  second.fy += second_y;
  return 1;
}

void Contact::forces(std::vector<Body>& bodies) {
  const int count = static_cast<int>(bodies.size());
  int contacts = 0;
#pragma omp parallel for
  for (int b = 0; b < count; ++b)
    for (OutlineNode& node : bodies[b].outline) node.fx = node.fy = 0;
#pragma omp parallel for schedule(dynamic, 8) reduction(+ : contacts)
  for (int slave = 0; slave < count; ++slave)
    for (int node = 0; node < static_cast<int>(bodies[slave].outline.size()); ++node) {
      const std::vector<Candidate>& near = candidates_[slave][node];
      for (std::size_t k = 0; k < near.size();) {
        const int master = near[k].body;
        Foot foot;
        for (; k < near.size() && near[k].body == master; ++k)
          find_foot(bodies[master], near[k], bodies[slave].outline[node], foot);
        contacts += touch(bodies, slave, node, master, foot);
      }
    }
  contacts_ = contacts;
}

double Contact::candidates() const {
  double count = 0;
  for (const auto& nodes : candidates_)
    for (const std::vector<Candidate>& near : nodes) count += static_cast<double>(near.size());
  return count;
}

}  // namespace pliant::baseline
