#pragma once

#include "contact/laws/cohesive_fatigue.hpp"
#include "contact/slip.hpp"

namespace pliant {

/// Eight bonds as the history has them, from a record on.
inline CohesiveFatigue::Bond load_bond(const ContactHistory& history, int record) {
  return {load(&history.damage[record]), load(&history.opening[record]), load(&history.slip[record])};
}

template <class Law>
constexpr bool keeps_damage = requires { Law::has_damage; };
template <class Law>
constexpr bool has_dashpot = requires { Law::has_damping; };

/// Traction of eight nodes, with the tangential part, and damage, brought up to date.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes slip, slip_work;          ///< slip_work: dissipated per length, by damage too, J/m2
};

/// The tangential part of a contact that slips beyond its limit.
template <class Law>
void slide(const Law& law, const Traction& traction, LaneBits touching, Lanes old_slip, Lanes trial, Contact& c) {
  const Lanes largest = select(touching, traction.shear_limit * (1 / law.shear_stiffness), Lanes{});
  c.slip = min(max(trial, -largest), largest);
  c.shear = -law.shear_stiffness * c.slip;
  // Mean of the old and the new traction times the plastic slip: what the tangential forces do, less what is stored.
  c.slip_work = (0.5 * law.shear_stiffness) * (old_slip + c.slip) * (trial - c.slip);
  c.energy += 0.5 * law.shear_stiffness * c.slip * c.slip;
}

/// `traction`: the law's answer to the gap, and its dashpot's.
template <class Law>
Contact respond(const Law& law, const MasterWindow& window, const Projection& p, LaneBits touching, Lanes place,
                Lanes old_place, Lanes old_slip, Traction traction) {
  Contact c{traction.pressure, {}, traction.energy, {}, {}};
  if constexpr (Law::has_shear) {
    const Lanes trial = old_slip + moved_along(window, p, touching & (old_place == old_place), old_place, place);
    slide(law, traction, touching, old_slip, trial, c);
  }
  return c;
}

/// As respond, for bonds: where the old damage was below 1. Nodes that are no longer beside the master tear off.
inline Contact respond_bonded(const CohesiveFatigue& law, const Projection& p, const CohesiveFatigue::Bond& bond,
                              Lanes slip, Lanes& damage) {
  const Lanes opening = select(p.hit, max(p.gap, Lanes{}), bond.opening);
  damage = select(p.hit, law.damage(bond, opening, slip), broadcast(1));
  const LaneBits torn = damage >= 1.0;
  const Lanes intact = 1.0 - damage, depth = min(p.gap, Lanes{});
  const Traction left = law.broken(p.gap);
  const Lanes pressed = 0.5 * law.normal_stiffness * depth * depth;
  Contact c;
  c.pressure = select(torn, left.pressure, -law.normal_stiffness * (depth + intact * opening));
  c.slip = select(torn, Lanes{}, slip);
  c.shear = -law.shear_stiffness * intact * c.slip;
  c.energy = select(
      torn, left.energy,
      pressed + 0.5 * intact * (law.normal_stiffness * opening * opening + law.shear_stiffness * c.slip * c.slip));
  // A torn bond leaves the residual attraction, whose energy counts from separated surfaces.
  const Lanes left_over = select(torn & p.hit, pressed - left.energy, Lanes{});
  c.slip_work = law.damage_work(bond, damage, opening, slip) + left_over;
  return c;
}

/// Bonds where there are some, and what is left of them elsewhere.
inline Contact respond_with_damage(const CohesiveFatigue& law, const MasterWindow& window, const Projection& p,
                                   LaneBits touching, Lanes place, Lanes old_place, const CohesiveFatigue::Bond& bond,
                                   Lanes& damage) {
  const LaneBits bonded = bond.damage < 1.0;
  const Lanes moved = moved_along(window, p, touching & (old_place == old_place), old_place, place);
  const Traction traction = law.broken(p.gap);
  Contact c{traction.pressure, {}, traction.energy, {}, {}};
  slide(law, traction, touching, bond.slip, bond.slip + moved, c);
  damage = broadcast(1);
  if (!any(bonded)) return c;
  const Contact b = respond_bonded(law, p, bond, bond.slip + moved, damage);
  damage = select(bonded, damage, broadcast(1));
  return {select(bonded, b.pressure, c.pressure), select(bonded, b.shear, c.shear), select(bonded, b.energy, c.energy),
          select(bonded, b.slip, c.slip), select(bonded, b.slip_work, c.slip_work)};
}

}  // namespace pliant
