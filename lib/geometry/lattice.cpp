#include "geometry/lattice.hpp"

#include <cmath>
#include <utility>

namespace pliant {
namespace {

/// Number of vectors a that are to be taken from b; 0 for vectors that are no numbers.
int whole_share(const Vec2& b, const Vec2& a) {
  const double share = std::round(b.dot(a) / a.squaredNorm());
  constexpr double most = 1 << 28;
  return std::abs(share) < most ? static_cast<int>(share) : 0;
}

void take_from(LatticeBasis& basis, int times, const Lattice& given) {
  basis.b = basis.b - Images{times * basis.a.x, times * basis.a.y};
  const Vec2 b = given.shift(basis.b);  // from the given vectors, so that rounding does not add up
  basis.lattice.bx = b.x(), basis.lattice.by = b.y();
}

}  // namespace

LatticeBasis shortest_basis(const Lattice& lattice) {
  LatticeBasis basis{lattice};
  constexpr int rounds = 100;  // each makes a vector shorter
  for (int round = 0; round < rounds; ++round) {
    if (basis.lattice.b().squaredNorm() < basis.lattice.a().squaredNorm()) {
      std::swap(basis.a, basis.b);
      std::swap(basis.lattice.ax, basis.lattice.bx), std::swap(basis.lattice.ay, basis.lattice.by);
    }
    const int times = whole_share(basis.lattice.b(), basis.lattice.a());
    if (times == 0) break;
    take_from(basis, times, lattice);
  }
  return basis;
}

LatticeBasis upright_basis(const Lattice& lattice) {
  LatticeBasis basis{lattice};
  take_from(basis, whole_share(lattice.b(), lattice.a()), lattice);
  return basis;
}

}  // namespace pliant
