#include "bonds/fragments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace pliant {
namespace {

bool holds(const BondHistory& history, std::size_t bond) {
  return history.damage(bond, 0) < 1 || history.damage(bond, 1) < 1;
}

/// Body that a bond which holds links to another.
struct LinkedBody {
  int body;
  Images images;
};

std::vector<std::vector<LinkedBody>> links(const Model& model, const BondSystem& bonds, const BondHistory& history) {
  std::vector<std::vector<LinkedBody>> of_body(model.bodies.size());
  for (std::size_t i = 0; i < bonds.bonds().size(); ++i) {
    const Bond& bond = bonds.bonds()[i];
    if (!holds(history, i) || model.bodies[bond.master].wall) continue;
    of_body[bond.slave].push_back({bond.master, bond.images});
    of_body[bond.master].push_back({bond.slave, -bond.images});
  }
  return of_body;
}

/// Integrals over a polygon: area, first and second moments about the origin.
struct AreaMoments {
  double area = 0;
  Vec2 first{0, 0};
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();

  void add_triangle(const Vec2& a, const Vec2& b) {  // with the origin
    const double part = 0.5 * (a.x() * b.y() - a.y() * b.x());
    area += part;
    first += part / 3 * (a + b);
    second += part / 12 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
};

}  // namespace

double Fragment::diameter() const { return std::sqrt(4 / std::numbers::pi * area); }

std::vector<Fragment> find_fragments(const Model& model, const BondSystem& bonds, const BondHistory& history) {
  const std::vector<std::vector<LinkedBody>> neighbours = links(model, bonds, history);
  std::vector<char> seen(model.bodies.size(), 0);
  std::vector<Fragment> fragments;
  for (int start = 0; start < static_cast<int>(model.bodies.size()); ++start) {
    if (seen[start] || model.bodies[start].wall) continue;
    std::vector<LinkedBody> members{{start, {}}};
    seen[start] = 1;
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const LinkedBody& link : neighbours[members[i].body])
        if (!seen[link.body]) {
          seen[link.body] = 1;
          members.push_back({link.body, members[i].images + link.images});
        }
    std::ranges::sort(members, {}, &LinkedBody::body);
    Fragment& fragment = fragments.emplace_back();
    for (const LinkedBody& member : members) {
      fragment.bodies.push_back(member.body);
      fragment.images.push_back(member.images);
      fragment.mass += model.bodies[member.body].mass, fragment.area += model.bodies[member.body].area;
    }
  }
  return fragments;
}

std::vector<int> fragment_numbers(const Model& model, const std::vector<Fragment>& fragments) {
  std::vector<int> numbers(model.bodies.size(), -1);
  for (const Fragment& fragment : fragments)
    for (const int body : fragment.bodies) numbers[body] = fragment.bodies[0];
  return numbers;
}

double aspect_ratio(const Model& model, const OutlineField& position, const Fragment& fragment) {
  const Vec2 origin = position.at(model.outline_offset[fragment.bodies[0]]);
  AreaMoments moments;
  for (std::size_t i = 0; i < fragment.bodies.size(); ++i) {
    const int body = fragment.bodies[i], first = model.outline_offset[body];
    const Vec2 shift = position.lattice.shift(fragment.images[i]) - origin;
    for (int k = first; k < model.outline_end(body); ++k)
      moments.add_triangle(position.at(k) + shift, position.at(k + 1) + shift);
  }
  const Eigen::Matrix2d central =
      moments.second / moments.area - moments.first * moments.first.transpose() / (moments.area * moments.area);
  const Eigen::Vector2d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(central, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(principal[1] / principal[0]);
}

double grading_diameter(const std::vector<Fragment>& fragments, double passing) {
  std::vector<std::pair<double, double>> sizes;  // diameter, mass
  double total = 0;
  for (const Fragment& fragment : fragments)
    sizes.emplace_back(fragment.diameter(), fragment.mass), total += fragment.mass;
  std::ranges::sort(sizes);
  double passed = 0;
  for (const auto& [diameter, mass] : sizes)
    if ((passed += mass) >= passing * total) return diameter;
  return sizes.empty() ? 0 : sizes.back().first;
}

std::vector<double> damage_at_nodes(const Model& model, const BondSystem& bonds, const BondHistory& history) {
  std::vector<double> sum(static_cast<std::size_t>(model.outline_offset.back()), 0.0), count = sum;
  const auto add = [&](int body, int node, double damage) {
    const int at = model.outline_offset[body] + node % model.outline_of(body).count;
    sum[at] += damage, count[at] += 1;
  };
  for (std::size_t i = 0; i < bonds.bonds().size(); ++i) {
    const Bond& bond = bonds.bonds()[i];
    for (int end = 0; end < 2; ++end) {
      add(bond.slave, bond.segment + end, history.damage(i, end));
      add(bond.master, bond.master_segment[end] + (bond.xi[end] > 0.5 ? 1 : 0), history.damage(i, end));
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] = count[i] > 0 ? sum[i] / count[i] : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

BondCounts count_bonds(const BondSystem& bonds, const BondHistory& history) {
  BondCounts counts;
  for (std::size_t i = 0; i < bonds.bonds().size(); ++i) {
    const double first = history.damage(i, 0), second = history.damage(i, 1);
    ++(first == 0 && second == 0 ? counts.whole : first == 1 && second == 1 ? counts.torn : counts.softening);
  }
  return counts;
}

}  // namespace pliant
