#pragma once

#include <iterator>

#include "contact/history.hpp"
#include "contact/laws/response.hpp"

namespace pliant {

/// What velocity Verlet does in a step is the mean of its two forces times the way. A law's energy changes by just that
/// wherever its pressure is linear in the gap: from in touch to in touch, and from out to out. Where a step crosses a
/// kink of the law, as where contact sets in or ends, the two differ, and contacts heat or cool: that is a debt of the
/// contact, J/m2, which a small additional pressure repays in the steps that follow. A record keeps its gap, its debt
/// and the additional pressure.

/// The most of it over what the stiffness makes of the way of the step: at rest there is none.
constexpr double repayment = 0.25;

template <class Law>
concept HasKinks = requires(const Law& law) { law.kinks(); };

/// Work of the mean pressure over a step's way less what the law's energy takes, J/m2.
template <class Law>
Lanes work_missed(const Law& law, Lanes before, Lanes now) {
  Lanes missed{};
  const Lanes way = before - now;
  for (const Kink& kink : law.kinks()) {
    const Lanes from = kink.gap - before, to = kink.gap - now;  // positive on the deeper side
    const LaneBits inward = (from < 0.0) & (to >= 0.0), outward = (from >= 0.0) & (to < 0.0);
    if (!any(inward | outward)) continue;
    const Lanes deep = select(inward, to, from);
    const Lanes size = -0.5 * kink.change * from * to + kink.jump * (0.5 * abs(way) - deep);
    missed += select(inward, size, select(outward, -size, Lanes{}));
  }
  return missed;
}

/// Of nodes that are not beside the master: what is owed then is lost.
inline void forget_kinks(ContactHistory& history, int record) {
  for (std::size_t k = 0; k < std::size(kinks_at_first); ++k)
    store(history.kinks(k) + record, broadcast(kinks_at_first[k]));
}

/// What records keep from step to step of eight nodes, and the additional pressure, 0 where gaps are not known.
template <class Law>
Lanes repay(const Law& law, const ContactHistory& from, ContactHistory& to, int record, Lanes gap, LaneBits beside) {
  const Lanes before = load(from.kinks(0) + record), owed = load(from.kinks(1) + record),
              repaid = load(from.kinks(2) + record);
  const Lanes way = before - gap;
  const LaneBits moved = beside & (before == before) & (way != 0.0);
  const Lanes debt = select(moved, owed + 0.5 * repaid * way + work_missed(law, before, gap), owed);
  const Lanes most = (repayment * law.normal_stiffness) * abs(way);
  const Lanes wanted = -debt / select(moved, way, broadcast(1));
  const Lanes pressure = select(moved, min(max(wanted, -most), most), Lanes{});
  store(to.kinks(0) + record, select(beside, gap, broadcast(kinks_at_first[0])));
  store(to.kinks(1) + record, select(beside, debt + select(moved, 0.5 * pressure * way, Lanes{}), Lanes{}));
  store(to.kinks(2) + record, pressure);
  return pressure;
}

}  // namespace pliant
