#include "geometry/species_in_turn.hpp"

namespace pliant {

std::vector<int> take_turns(const std::vector<double>& shares, int count) {
  constexpr double clearly = 1 + 1e-9;  // shares are decimal numbers: equal needs agree to rounding only
  std::vector<int> taken(shares.size(), 0), choice;
  const auto need = [&](std::size_t m) { return shares[m] / (2 * taken[m] + 1); };
  for (int i = 0; i < count; ++i) {
    std::size_t next = 0;
    for (std::size_t m = 1; m < shares.size(); ++m)
      if (need(m) > clearly * need(next)) next = m;
    ++taken[next];
    choice.push_back(static_cast<int>(next));
  }
  return choice;
}

std::vector<int> species_in_turn(const std::vector<double>& shares, const Packing& packing) {
  const std::vector<int> turns = take_turns(shares, static_cast<int>(packing.grain_count()));
  if (packing.kind == PackingKind::positions) return turns;
  std::vector<int> choice(turns.size());
  auto turn = turns.begin();
  for (int column = 0; column < packing.columns; ++column)
    for (int row = 0; row < packing.rows; ++row) choice[row * packing.columns + column] = *turn++;  // numbered by rows
  return choice;
}

}  // namespace pliant
