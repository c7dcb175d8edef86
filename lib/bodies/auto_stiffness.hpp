#pragma once

namespace pliant {

/// Stiffness `auto` of contacts and soft supports, 8 E/h, Pa/m: a penetration of 6 to 8 % of h at p = E/2
/// (docs/method.md 4). young: Pa; spacing h: of the outline, m.
inline double auto_stiffness(double young, double spacing) { return 8 * young / spacing; }

}  // namespace pliant
