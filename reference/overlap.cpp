#include "reference/overlap.hpp"

#include <set>
#include <utility>

#include <fmt/format.h>

namespace pliant::reference {
namespace {

constexpr double touching = 1e-9;  ///< share of a segment up to which penetration of touching faces is rounding

}  // namespace

Overlap find_overlap(const Bodies& bodies, const Forces& start) {
  Overlap overlap;
  std::set<std::pair<int, int>> pairs;
  /// Counts a node or a half pass, by its depth in m and over a segment.
  const auto count = [&](const auto& contact, double depth) {
    if (contact.depth <= touching) return;
    pairs.insert(std::minmax(contact.body[0], contact.body[1]));
    overlap.stored += contact.compression;
    if (depth <= overlap.depth) return;
    overlap.depth = depth, overlap.share = contact.depth;
    const auto [first, second] = std::minmax(contact.body[0], contact.body[1]);
    overlap.first = bodies.all()[static_cast<std::size_t>(first)].placed.name;
    overlap.second = bodies.all()[static_cast<std::size_t>(second)].placed.name;
  };
  for (const ContactElement& element : start.contacts.elements) count(element, -element.gap);
  for (const ContactPatch& patch : start.contacts.patches) count(patch, patch.deepest);
  overlap.pairs = static_cast<int>(pairs.size());
  return overlap;
}

std::string advice_on(const Overlap& overlap) {
  if (overlap.pairs == 0) return {};
  return fmt::format(
      "overlap at the start: {} pair{} of bodies, '{}' and '{}' by {:.3g} m, {:.2g} of a segment, and {:.3g} J/m "
      "stored: "
      "give them that much more room (a larger pitch, other positions), unless the scene is meant to start pressed "
      "together",
      overlap.pairs, overlap.pairs == 1 ? "" : "s", overlap.first, overlap.second, overlap.depth, overlap.share,
      overlap.stored);
}

}  // namespace pliant::reference
