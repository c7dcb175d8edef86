#include "geometry/grain_diagram.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/polygon_rules.hpp"

namespace pliant {

PointLinks links_of(const PointLoop& loop) {
  PointLinks links;
  for (std::size_t i = 0; i < loop.size(); ++i) links.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
  return links;
}

std::vector<PointLoop> loops_of(PointLinks links) {
  std::sort(links.begin(), links.end());
  PointLinks left;
  for (const PointLink& link : links)
    if (!std::binary_search(links.begin(), links.end(), reverse(link))) left.push_back(link);
  std::vector<char> used(left.size(), 0);
  std::vector<PointLoop> found;
  for (std::size_t start = 0; start < left.size(); ++start) {
    if (used[start]) continue;
    found.emplace_back();
    for (std::size_t i = start; !used[i];) {
      used[i] = 1;
      found.back().push_back(left[i].first);
      i = std::lower_bound(left.begin(), left.end(), PointLink(left[i].second, 0)) - left.begin();
    }
  }
  return found;
}

bool CellFaces::is_polygon(const PointLoop& loop) const {
  const Points corners = polygon(loop);
  return loop.size() > 2 && signed_area(corners) > 0 && polygon_defect(corners).text.empty();
}

LinkSides CellFaces::sides() const {
  LinkSides found;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const PointLink& link : links_of(faces[f].loop)) found[link] = f;
  return found;
}

namespace {

/// One generator after another takes from the cells so far what is nearer to it. Each
/// point is judged once and each edge is cut once for all cells, so that rounding opens no gap.
class GrainDiagram {
 public:
  GrainDiagram(const Points& outline, const Points& generators, const std::vector<double>& weights)
      : generators_(generators), weights_(weights), least_(outline.size(), std::numeric_limits<double>::infinity()) {
    all_.points = outline;
    all_.faces.push_back({0, PointLoop(outline.size())});
    std::iota(all_.faces[0].loop.begin(), all_.faces[0].loop.end(), 0);
    for (int g = 0; g < static_cast<int>(generators.size()); ++g) insert(g);
  }
  const CellFaces& faces() const { return all_; }

 private:
  double power(int generator, const Vec2& x) const {
    return (x - generators_[generator]).squaredNorm() - weights_[generator];
  }

  void insert(int generator) {
    excess_.clear();
    for (std::size_t i = 0; i < least_.size(); ++i) {
      const double own = power(generator, all_.points[i]);
      excess_.push_back(own - least_[i]);
      least_[i] = std::min(least_[i], own);
    }
    cuts_.clear();
    PointLinks taken;
    std::vector<CellFace> kept;
    for (CellFace& face : all_.faces) {
      if (std::none_of(face.loop.begin(), face.loop.end(), [&](int i) { return excess_[i] < 0; }))
        kept.push_back(std::move(face));
      else
        for (PointLoop& loop : divide(face, generator, taken)) kept.push_back({face.generator, std::move(loop)});
    }
    for (PointLoop& loop : loops_of(taken)) kept.push_back({generator, std::move(loop)});
    all_.faces = std::move(kept);
    for (std::size_t i = least_.size(); i < all_.points.size(); ++i) least_.push_back(power(generator, all_.points[i]));
  }

  /// Adds the part of a face that is nearer to the generator to `taken`, and returns the rest.
  std::vector<PointLoop> divide(const CellFace& face, int generator, PointLinks& taken) {
    PointLinks rest;
    PointLoop exits, entries;  // of the part that is taken, along the face
    for (const auto& [a, b] : links_of(face.loop)) {
      const bool takes_a = excess_[a] < 0, takes_b = excess_[b] < 0;
      if (takes_a == takes_b) {
        (takes_a ? taken : rest).emplace_back(a, b);
        continue;
      }
      const int middle = cut(a, b);
      (takes_a ? taken : rest).emplace_back(a, middle);
      (takes_b ? taken : rest).emplace_back(middle, b);
      (takes_a ? exits : entries).push_back(middle);
    }
    // Along the cut, with the generator on the left, each exit is followed by its entry.
    const Vec2 centre = generators_[generator], across = centre - generators_[face.generator];
    const auto before = [&](int a, int b) {
      return cross(all_.points[a] - centre, across) < cross(all_.points[b] - centre, across);
    };
    std::sort(exits.begin(), exits.end(), before);
    std::sort(entries.begin(), entries.end(), before);
    for (std::size_t i = 0; i < exits.size(); ++i) {
      taken.emplace_back(exits[i], entries[i]);
      rest.emplace_back(entries[i], exits[i]);
    }
    return loops_of(rest);
  }

  /// Number of the point where an edge is as near to the generator as to that of its cell.
  int cut(int a, int b) {
    const auto [at, is_new] = cuts_.try_emplace(std::minmax(a, b), static_cast<int>(all_.points.size()));
    if (is_new) {
      const Vec2 from = all_.points[a], to = all_.points[b];
      all_.points.push_back(from + excess_[a] / (excess_[a] - excess_[b]) * (to - from));
    }
    return at->second;
  }

  const Points& generators_;
  const std::vector<double>& weights_;
  CellFaces all_;
  std::vector<double> least_;      ///< of each point: squared distance to its generator, less the weight
  std::vector<double> excess_;     ///< of each point: the same for the new generator, less that
  std::map<PointLink, int> cuts_;  ///< by the new generator
};

}  // namespace

CellFaces grain_diagram(const Points& outline, const Points& generators, const std::vector<double>& weights) {
  return GrainDiagram(outline, generators, weights).faces();
}

}  // namespace pliant
