#include "contact/segment_pass.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "contact/laws/response.hpp"
#include "contact/segment_motion.hpp"
#include "contact/segment_quadrature.hpp"

namespace pliant {
namespace {

/// Data that a half pass needs besides the law.
struct SegmentHalfPass {
  const HalfPass& pass;
  const MasterWindow& window;
  const PairMotion* moved;   ///< displacements in the step; null: unknown
  const PairMotion* speeds;  ///< current velocities; null: not needed
  PairForceBuffer& forces;
};

struct Totals {
  double stored = 0, dissipated = 0, damping_power = 0, pressures = 0, shears = 0, deepest = 0;  ///< squared tractions
  int segments = 0;                                                                              ///< in contact
};

/// Nodes on which the forces of eight pairs of segments act.
struct ForcePlaces {
  LaneBits hit;         ///< pairs in contact
  LaneBits slave, row;  ///< as in SegmentPairs
  Linear xi;            ///< on the master's segment
};

/// Couple of shears: forces on the second node of the master's segment, and the opposite ones on the first.
struct Couple {
  Lanes x{}, y{};
};

/// Adds forces to the nodes of both bodies. `f`: on the slave's nodes. The reaction to a force at s goes to both nodes
/// of the master's segment by xi.
void add_forces(const SegmentHalfPass& at, const ForcePlaces& places, const PairForces& f, const Couple& couple) {
  const Linear& xi = places.xi;
  const Lanes all_x = f.x[0] + f.x[1], all_y = f.y[0] + f.y[1], change = xi.at1 - xi.at0;
  const Lanes far_x = xi.at0 * all_x + change * f.x[1] - couple.x, far_y = xi.at0 * all_y + change * f.y[1] - couple.y;
  const Lanes near_x = all_x - far_x, near_y = all_y - far_y;
  for_each_lane(places.hit, [&](int lane) {
    const auto first = static_cast<std::size_t>(at.pass.slave_force + places.slave[lane]),
               near = static_cast<std::size_t>(at.pass.master_force + places.row[lane]);
    double *x = &at.forces.x[first], *y = &at.forces.y[first];
    x[0] += f.x[0][lane], x[1] += f.x[1][lane], y[0] += f.y[0][lane], y[1] += f.y[1][lane];
    x = &at.forces.x[near], y = &at.forces.y[near];
    x[0] -= near_x[lane], x[1] -= far_x[lane], y[0] -= near_y[lane], y[1] -= far_y[lane];
  });
}

/// Eight pairs with shear: their normal forces, integrals of tangents times powers of s, and integrals of gaps. From
/// these the shear tractions of nodes make forces.
struct ShearingPairs {
  ForcePlaces places;
  PairForces forces;
  Lanes tangent_x, tangent_y, inverse_length;  ///< of the master's segment
  Lanes shear_x[3], shear_y[3];                ///< m
  Moments gap;                                 ///< m2

  /// Adds forces for shear tractions at both ends, linear between them.
  void put_out(const SegmentHalfPass& at, Lanes shear0, Lanes shear1) const {
    const Lanes change = shear1 - shear0;
    const Lanes all_x = shear0 * shear_x[0] + change * shear_x[1], all_y = shear0 * shear_y[0] + change * shear_y[1],
                second_x = shear0 * shear_x[1] + change * shear_x[2],
                second_y = shear0 * shear_y[1] + change * shear_y[2];
    PairForces f = forces;
    f.x[0] += all_x - second_x, f.x[1] += second_x, f.y[0] += all_y - second_y, f.y[1] += second_y;
    // Shears act at the gap's distance from the master.
    const Lanes couple = (shear0 * gap.plain + change * gap.times_s) * inverse_length;
    add_forces(at, places, f, {couple * tangent_y, -couple * tangent_x});
  }
};

/// Memory of a half pass that is allocated once.
struct PassScratch {
  NodeSums sums;
  std::vector<ShearingPairs> shearing;
  std::size_t shearing_count = 0;
  std::vector<char> touched;  ///< [slave segments]
};

/// Visits the points of a half pass: turns tractions of its law into forces of pairs and sums of nodes.
template <class Law>
class TractionVisitor {
 public:
  TractionVisitor(const Law& law, const SegmentHalfPass& at, PassScratch& scratch, Totals& totals)
      : law_(law), at_(at), scratch_(scratch), totals_(totals) {
    scratch_.touched.assign(static_cast<std::size_t>(at.pass.segments), 0);
    if constexpr (Law::has_shear) scratch_.sums.clear(at.pass.nodes.count), scratch_.shearing_count = 0;
  }

  void begin(const SegmentPairs& pairs, const Linear& xi) {
    pairs_ = &pairs, xi_ = xi, hit_ = LaneBits{};
    pressure_ = {}, in_fans_ = {}, stored_ = squares_ = damping_power_ = Lanes{};
    if constexpr (Law::has_shear) {
      weight_ = limit_ = slip_ = gap_ = {};
      for (int power = 0; power < 3; ++power) on_segments_[power] = shear_x_[power] = shear_y_[power] = Lanes{};
      if (at_.moved) motion_ = TangentialMotion(pairs, xi, *at_.moved);
    }
    if constexpr (has_dashpot<Law>) rates_ = SpeedPast(pairs, *at_.speeds);
  }

  void on_segment(const SegmentPoint& p) {
    const Traction traction = traction_at(p, pairs_->tangent_y, -pairs_->tangent_x);
    const Lanes force = p.weight * traction.pressure;
    pressure_.add(force, p.s);
    stored_ += p.weight * traction.energy, squares_ += force * traction.pressure;
    if constexpr (Law::has_shear) {
      const Lanes first = p.weight * p.s;
      on_segments_[0] += p.weight, on_segments_[1] += first, on_segments_[2] += first * p.s;
      limit_.add(p.weight * traction.shear_limit, p.s);
      gap_.add(p.weight * p.gap, p.s);
      if (at_.moved) slip_.add(p.weight * motion_.on_segment(p), p.s);
    }
  }

  void in_fan(const FanPoint& p) {
    const Traction traction = traction_at(p, p.normal_x, p.normal_y);
    const Lanes& pressure = traction.pressure;
    for (int end = 0; end < 2; ++end)
      in_fans_.x[end] += pressure * p.force_x[end], in_fans_.y[end] += pressure * p.force_y[end];
    stored_ += p.energy_weight * traction.energy, squares_ += p.energy_weight * pressure * pressure;
    if constexpr (Law::has_shear)
      limit_.plain += p.of_limit.plain * traction.shear_limit,
          limit_.times_s += p.of_limit.times_s * traction.shear_limit;
  }

  void in_fan_of(const FanShape& f)
    requires(Law::has_shear)
  {
    weight_.plain += f.weight[0], weight_.times_s += f.weight[1];
    for (int power = 0; power < 3; ++power) shear_x_[power] -= f.normal_y[power], shear_y_[power] += f.normal_x[power];
    gap_.plain += f.gap.plain, gap_.times_s += f.gap.times_s;
    if (!at_.moved) return;
    const Moments slip = motion_.in_fan(f);
    slip_.plain += slip.plain, slip_.times_s += slip.times_s;
  }

  void end() {
    for_each_lane(hit_, [&](int lane) {
      char& touched = scratch_.touched[static_cast<std::size_t>(pairs_->slave[lane])];
      totals_.segments += !touched, touched = 1;
      totals_.stored += stored_[lane], totals_.pressures += squares_[lane];
    });
    if constexpr (has_dashpot<Law>) add_in_order(damping_power_, totals_.damping_power);
    const Lanes tangent_x = pairs_->tangent_x, tangent_y = pairs_->tangent_y;
    const HatSums on_segments = HatSums(pressure_);
    const ForcePlaces places{hit_, pairs_->slave, pairs_->row, xi_};
    const PairForces forces{
        {in_fans_.x[0] + tangent_y * on_segments.first, in_fans_.x[1] + tangent_y * on_segments.second},
        {in_fans_.y[0] - tangent_x * on_segments.first, in_fans_.y[1] - tangent_x * on_segments.second}};
    if constexpr (Law::has_shear) {
      const Moments weight{weight_.plain + on_segments_[0], weight_.times_s + on_segments_[1]};
      HatSums(weight).add_to(scratch_.sums.weight, *pairs_, hit_);
      HatSums(limit_).add_to(scratch_.sums.shear_limit, *pairs_, hit_);
      if (at_.moved) HatSums(slip_).add_to(scratch_.sums.motion, *pairs_, hit_);
      if (scratch_.shearing.size() == scratch_.shearing_count) scratch_.shearing.emplace_back();
      ShearingPairs& s = scratch_.shearing[scratch_.shearing_count++];
      s.places = places, s.forces = forces, s.gap = gap_;
      s.tangent_x = tangent_x, s.tangent_y = tangent_y, s.inverse_length = pairs_->inverse_length;
      for (int power = 0; power < 3; ++power) {
        s.shear_x[power] = shear_x_[power] + tangent_x * on_segments_[power];
        s.shear_y[power] = shear_y_[power] + tangent_y * on_segments_[power];
      }
    } else {
      add_forces(at_, places, forces, {});
    }
  }

 private:
  template <class Point>
  Traction traction_at(const Point& p, Lanes normal_x, Lanes normal_y) {
    hit_ |= p.hit;
    Traction traction = law_(p.gap);
    if constexpr (has_dashpot<Law>) add_damping(p, normal_x, normal_y, traction);
    return traction;
  }

  /// Adds the dashpot's pressure and its friction.
  template <class Point>
  void add_damping(const Point& p, Lanes normal_x, Lanes normal_y, Traction& traction) {
    const Lanes rate = rates_.along(normal_x, normal_y, p.s, xi_.at(p.s));
    const Lanes damping = law_.damping_pressure(traction.pressure, p.gap, rate, at_.pass.damping, at_.pass.dt);
    add_pressure(law_, damping, traction);
    damping_power_ += select(p.hit & (p.gap < 0.0), -p.weight * damping * rate, Lanes{});
  }

  const Law& law_;
  const SegmentHalfPass& at_;
  PassScratch& scratch_;
  Totals& totals_;
  // For the current eight pairs:
  const SegmentPairs* pairs_ = nullptr;
  LaneBits hit_{};
  Linear xi_;
  Lanes stored_, squares_, damping_power_;
  Moments pressure_;    ///< on segments
  PairForces in_fans_;  ///< of pressures in vertex regions
  Moments weight_, limit_, slip_, gap_;
  Lanes on_segments_[3], shear_x_[3],
      shear_y_[3];  ///< weights on segments, tangents in vertex regions, times powers of s
  TangentialMotion motion_;
  SpeedPast rates_;
};

/// Updates the slip of each node. New length of contact is unstretched, and lost length takes its energy along, after
/// half of the step: forces at the start and at the end each do half of its work.
template <class Law>
void slide_nodes(const Law& law, const HalfPass& pass, const ContactHistory& from, ContactHistory& to, NodeSums& sums,
                 Totals& totals) {
  for (int i = 0; i < pass.nodes.count; i += lane_count) {
    const Lanes* before = from.at(pass.record + i);
    Lanes* after = to.at(pass.record + i);
    const LaneBits active = first_lanes(pass.nodes.count - i);
    const Lanes weight = select(active, load(&sums.weight[i]), Lanes{}), known = before[ContactHistory::weight],
                old_weight = select(active & (known == known), known, Lanes{}), old_slip = before[ContactHistory::slip];
    const LaneBits touching = weight > 0.0;
    const Lanes gone = max(old_weight - weight, Lanes{});
    const Lanes inverse = select(touching, 1.0 / select(touching, weight, broadcast(1)), Lanes{});
    const Lanes slip =
        select(weight > old_weight, old_slip * old_weight * inverse, select(touching, old_slip, Lanes{}));
    const Lanes motion = load(&sums.motion[i]) * inverse;
    Contact c{};
    slide(law, Traction{Lanes{}, load(&sums.shear_limit[i]) * inverse, Lanes{}}, touching, slip, slip + motion, c);
    const Lanes lost = 0.5 * law.shear_stiffness *
                       (old_weight * old_slip * old_slip - weight * slip * slip + gone * old_slip * motion);
    add_in_order(lost + weight * c.slip_work, totals.dissipated);
    add_in_order(weight * c.energy, totals.stored);
    add_in_order(weight * c.shear * c.shear, totals.shears);  // not less than the integral of the linear traction
    store(&sums.shear[i], select(touching, c.shear, Lanes{}));
    after[ContactHistory::weight] = weight;
    after[ContactHistory::slip] = select(touching, c.slip, Lanes{});
  }
}

template <class Law>
void integrate_half_pass(const Law& law, const SegmentHalfPass& at, const ContactHistory& from, ContactHistory& to,
                         Totals& totals) {
  thread_local PassScratch scratch;
  const HalfPass& pass = at.pass;
  TractionVisitor<Law> visitor(law, at, scratch, totals);
  SegmentQuadrature& quadrature = thread_quadrature();
  quadrature.run(pass, at.window, gap_ranges(law, at.window.depth()), visitor);
  totals.deepest = std::max(totals.deepest, quadrature.deepest() / at.window.longest());
  if constexpr (Law::has_shear) {
    NodeSums& sums = scratch.sums;
    const bool whole = pass.segments == pass.nodes.count;
    if (whole) sums.close(pass.segments);
    slide_nodes(law, pass, from, to, sums, totals);
    if (whole) sums.shear[pass.segments] = sums.shear[0];
    const double* shear = sums.shear.data();
    for (const ShearingPairs& s : std::span(scratch.shearing).first(scratch.shearing_count))
      s.put_out(at, gather(shear, s.places.slave), gather(shear + 1, s.places.slave));
  }
}

}  // namespace

double integrated_length(const PairView& view) {
  struct Length {
    Lanes sum{};
    void begin(const SegmentPairs&, const Linear&) {}
    void on_segment(const SegmentPoint& p) { sum += p.weight; }
    void in_fan(const FanPoint&) {}
    void in_fan_of(const FanShape& f) { sum += f.weight[0]; }
    void end() {}
  } length;
  for_each_half_pass(view, runs_in_table(view.contact_pair), [&](const HalfPass& pass, int) {
    thread_quadrature().run(pass, view.window, gap_ranges(Frictionless{}, view.window.depth()), length);
  });
  return sum(length.sum);
}

PairTotals integrate_pair(const PairView& view, const ForceRuns& runs, const ContactHistory& from, ContactHistory& to,
                          PairForceBuffer& forces) {
  Totals totals;
  const auto both_passes = [&]<class Law>(const Law& law) {
    double damping = 0;
    if constexpr (has_dashpot<Law>)
      if (const double length = integrated_length(view); length > 0) damping = law.root_damping / std::sqrt(length);
    thread_local PairMotion moved, speeds;
    for_each_half_pass(view, runs, [&](HalfPass& pass, int slave_side) {
      pass.damping = damping, pass.dt = view.dt;
      SegmentHalfPass at{pass, view.window, nullptr, nullptr, forces};
      if constexpr (Law::has_shear)
        if (view.before) moved.fill_displacements(view, slave_side), at.moved = &moved;
      if constexpr (has_dashpot<Law>) speeds.fill_velocities(view, slave_side), at.speeds = &speeds;
      integrate_half_pass(law, at, from, to, totals);
    });
  };
  std::visit(both_passes, view.contact_pair.law);
  PairTotals result{totals.stored, totals.dissipated, totals.damping_power, totals.deepest, totals.segments};
  std::visit(
      [&]<class Law>(const Law& law) {
        result.traction_norm = totals.pressures / law.normal_stiffness;
        if constexpr (Law::has_shear) result.traction_norm += totals.shears / law.shear_stiffness;
      },
      view.contact_pair.law);
  return result;
}

}  // namespace pliant
