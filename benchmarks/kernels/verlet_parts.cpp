#include "benchmarks/kernels/verlet_parts.hpp"

namespace pliant::kernels {
namespace {

struct Predict {
  using Function = void (Verlet::*)(const State&, double);
  friend Function function(Predict);
};
struct FinishRegion {
  using Function = void (Verlet::*)(const State&, double, int);
  friend Function function(FinishRegion);
};

/// Explicit instantiations may name private members.
template <class Part, typename Part::Function found>
struct Reach {
  friend typename Part::Function function(Part) { return found; }
};
template struct Reach<Predict, &Verlet::predict>;
template struct Reach<FinishRegion, &Verlet::finish_region>;

}  // namespace

void predict(Verlet& verlet, const State& state, double dt) { (verlet.*function(Predict()))(state, dt); }
void finish_region(Verlet& verlet, const State& state, double dt, int region) {
  (verlet.*function(FinishRegion()))(state, dt, region);
}

}  // namespace pliant::kernels
