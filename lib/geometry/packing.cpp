#include <fmt/format.h>

#include <cmath>

#include "core/errors.hpp"
#include "geometry/mesh.hpp"

namespace pliant {
namespace {

constexpr double rounding = 1e-9;  // relative; periods and pitches are decimal numbers of the user

void require_fit(const Packing& packing, double period) {
  const double width = packing.columns * packing.pitch;
  if (width > period * (1 + rounding))
    throw InputError(
        fmt::format("packing: {} columns of pitch {:.6g} m are {:.6g} m wide; the period is {:.6g} m: take "
                    "fewer columns or a smaller pitch",
                    packing.columns, packing.pitch, width, period));
  const bool closed = std::abs(width - period) <= period * rounding;
  if (packing.kind == PackingKind::hexagonal && closed && packing.columns % 2 == 1)
    throw InputError(
        fmt::format("packing: {} hexagonal columns fill the period, so that two unshifted ones meet at its "
                    "edge; take an even number",
                    packing.columns));
}

}  // namespace

Points packing_positions(const Packing& packing, const std::optional<double>& period) {
  if (packing.kind == PackingKind::positions) return packing.positions;
  if (packing.columns < 1 || packing.rows < 1 || !(packing.pitch > 0) || !(packing.row_pitch > 0))
    throw InputError(
        fmt::format("packing: {} columns of pitch {:.6g} m, {} rows of pitch {:.6g} m; all must be positive",
                    packing.columns, packing.pitch, packing.rows, packing.row_pitch));
  if (period) require_fit(packing, *period);
  Points centres;
  for (int row = 0; row < packing.rows; ++row)
    for (int column = 0; column < packing.columns; ++column) {
      const double shift = packing.kind == PackingKind::hexagonal && column % 2 == 1 ? 0.5 : 0.0;
      centres.push_back(packing.origin + Vec2(column * packing.pitch, (row + shift) * packing.row_pitch));
    }
  return centres;
}

}  // namespace pliant
