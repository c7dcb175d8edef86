#include "bonds/bond_system.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "bonds/bond_search.hpp"
#include "core/archive.hpp"
#include "core/errors.hpp"
#include "core/located.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

namespace pliant {
namespace {

/// Numbers of one bond in the force buffer: x and y of the forces on the ends of its segment and on the masters.
constexpr std::size_t forces_per_bond = 8;
constexpr std::uint64_t random_purpose = 7;  ///< of the strengths, see random_stream

double friction_of(const ContactLaw& law) {
  return std::visit(
      []<class Law>(const Law& l) {
        if constexpr (requires { l.friction; })
          return static_cast<double>(l.friction);
        else
          return 0.0;
      },
      law);
}

double shear_stiffness_of(const ContactLaw& law) {
  return std::visit(
      []<class Law>(const Law& l) {
        if constexpr (Law::has_shear)
          return static_cast<double>(l.shear_stiffness);
        else
          return 0.0;
      },
      law);
}

std::pair<int, int> key_of(const Bond& bond) { return std::minmax(bond.slave, bond.master); }

/// Strength factors of pairs of bodies, of mean 1, in the order of the pairs.
void spread_strengths(double modulus, std::uint64_t seed, std::vector<Bond>& bonds) {
  std::mt19937_64 random = random_stream(seed, random_purpose);
  std::map<std::pair<int, int>, double> factors;
  for (const Bond& bond : bonds) factors[key_of(bond)] = 1;
  for (auto& [pair, factor] : factors)
    factor = std::pow(-std::log(1 - uniform_number(random)), 1 / modulus) / std::tgamma(1 + 1 / modulus);
  for (Bond& bond : bonds) bond.strength_factor = factors[key_of(bond)];
}

void set(BondLaw<Lanes>& eight, int lane, const BondLaw<double>& law) {
  const auto both = [](auto& l) {
    return std::tie(l.normal_stiffness, l.shear_stiffness, l.strength, l.cohesion, l.friction, l.energy_1, l.energy_2,
                    l.threshold, l.rate_1, l.rate_2, l.bears_pressure, l.contact_stiffness, l.contact_shear,
                    l.contact_friction);
  };
  std::apply([&](auto&... to) { std::apply([&](const auto&... from) { ((to[lane] = from), ...); }, both(law)); },
             both(eight));
}

struct PointLanes {
  Lanes x{}, y{};
};
PointLanes operator+(const PointLanes& a, const PointLanes& b) { return {a.x + b.x, a.y + b.y}; }
PointLanes operator-(const PointLanes& a, const PointLanes& b) { return {a.x - b.x, a.y - b.y}; }
PointLanes operator*(const Lanes& f, const PointLanes& a) { return {f * a.x, f * a.y}; }
Lanes dot(const PointLanes& a, const PointLanes& b) { return a.x * b.x + a.y * b.y; }

PointLanes points_of(const OutlineField& field, LaneBits index) {
  return {gather(field.x.data(), index), gather(field.y.data(), index)};
}

}  // namespace

BondSystem::BondSystem(const Model& model, const LawTable& laws)
    : model_(model), laws_(laws), made_(model.scene.bonds.size(), 0) {
  index();
}

BondLaw<double> BondSystem::law_of(const Bond& bond) const {
  const BondRule& rule = model_.scene.bonds[bond.rule];
  const ContactLaw contact = laws_.between(bond.slave, bond.master);
  const double w = bond.strength_factor;
  BondLaw<double> law{};
  law.contact_stiffness = normal_stiffness_of(contact);
  law.contact_shear = shear_stiffness_of(contact);
  law.contact_friction = friction_of(contact);
  law.normal_stiffness = rule.stiffness.value_or(law.contact_stiffness);
  law.shear_stiffness = rule.shear_stiffness.value_or(law.normal_stiffness);
  law.strength = w * rule.strength;
  law.cohesion = w * rule.cohesion.value_or(rule.strength);
  law.friction = rule.friction.value_or(law.contact_friction);
  // The process zone E' G/strength^2 is that of all bonds.
  law.energy_1 = w * w * rule.fracture_energy;
  law.energy_2 = w * w * rule.shear_fracture_energy.value_or(rule.fracture_energy);
  // Stresses of fatigue are over the strengths, which Weibull's factor multiplies.
  law.threshold = rule.fatigue_threshold / rule.strength;
  law.rate_1 = rule.fatigue_rate * rule.strength;
  law.rate_2 = rule.shear_fatigue_rate * rule.cohesion.value_or(rule.strength);
  law.bears_pressure = rule.gap > 0 ? 1 : 0;
  return law;
}

void BondSystem::refuse_unfit(const BondRule& rule, const BondLaw<double>& law) const {
  const auto check = [&](const char* key, double energy, double strength, double stiffness) {
    if (const double stored = strength * strength / (2 * stiffness); energy <= stored)
      throw InputError(fmt::format(
          "'{}' in [[bonds]] is less than the energy that a bond stores at its strength, strength^2 / (2 stiffness) = "
          "{:.4g} J/m2 with a stiffness of {:.4g} Pa/m; allowed: more; take a larger energy, a lower strength, finer "
          "outlines or a higher 'stiffness'",
          key, stored, stiffness));
  };
  located(rule.where, [&] {
    if (law.friction < law.contact_friction)
      throw InputError(fmt::format("'friction' in [[bonds]] is {}; allowed: at least that of the contacts, {}",
                                   law.friction, law.contact_friction));
    check("fracture_energy", law.energy_1, law.strength, law.normal_stiffness);
    check("shear_fracture_energy", law.energy_2, law.cohesion, law.shear_stiffness);
  });
}

bool BondSystem::make(const OutlineField& position, double time, BondHistory& history) {
  const std::size_t before = bonds_.size();
  for (std::size_t r = 0; r < made_.size(); ++r) {
    const BondRule& rule = model_.scene.bonds[r];
    if (made_[r] || time < rule.from) continue;
    made_[r] = 1;
    std::vector<Bond> found = find_bonds(model_, position, static_cast<int>(r));
    std::set<std::tuple<int, int, int>> bonded;
    for (const Bond& bond : bonds_) bonded.insert({bond.slave, bond.master, bond.segment});
    std::erase_if(found, [&](const Bond& bond) { return bonded.contains({bond.slave, bond.master, bond.segment}); });
    if (found.empty() && rule.from == 0)
      throw InputError(fmt::format(
          "{}: [[bonds]] between '{}' and '{}' find nothing to bond: no segment of an outline has both ends within {} "
          "of another one; move bodies together, give a 'gap', or take finer outlines",
          rule.where.empty() ? model_.scene.file.string() : rule.where, rule.first, rule.second,
          rule.gap > 0 ? fmt::format("{} m", rule.gap) : "rounding"));
    for (const Bond& bond : found) refuse_unfit(rule, law_of(bond));
    if (rule.weibull_modulus) spread_strengths(*rule.weibull_modulus, rule.seed, found);
    bonds_.insert(bonds_.end(), found.begin(), found.end());
  }
  if (bonds_.size() == before) return false;
  ++version_;
  index();
  history.ends.resize(eights_.size());
  for (std::size_t i = before; i < eights_.size() * lane_count; ++i)
    for (BondEnd& end : history.ends[i / lane_count])
      end.damage[i % lane_count] = i < bonds_.size() ? 0 : 1,
                     end.opening[i % lane_count] = end.slip[i % lane_count] = 0;
  measure_turning(position, history);
  return true;
}

void BondSystem::inherit(const InheritedBonds& from, BondHistory& history) {
  if (from.made.size() > made_.size()) throw ArchiveError("bonds have other rules");
  for (const Bond& bond : from.bonds)
    if (std::max(bond.slave, bond.master) >= static_cast<int>(model_.bodies.size()) ||
        bond.rule >= static_cast<int>(made_.size()))
      throw ArchiveError("bonds have other bodies");
  std::copy(from.made.begin(), from.made.end(), made_.begin());
  bonds_ = from.bonds;
  history = from.history;
  ++version_;
  index();
  if (history.ends.size() != eights_.size()) throw ArchiveError("bonds have another history");
}

/// Sets what follows from the list of bonds.
void BondSystem::index() {
  eights_.assign((bonds_.size() + lane_count - 1) / lane_count, Eight{});
  buffer_.assign(eights_.size() * forces_per_bond, Lanes{});
  totals_.assign(eights_.size(), {});
  turning_.assign(eights_.size(), broadcast(1));
  for (std::size_t i = 0; i < eights_.size() * lane_count; ++i) add_to_eight(i);
  std::vector<std::vector<Receipt>> of_body(model_.bodies.size());
  for (std::size_t i = 0; i < bonds_.size(); ++i) {
    const Bond& bond = bonds_[i];
    const BondLaw<double> law = law_of(bond);
    const double stiffness = 0.5 * bond.length * std::max(law.normal_stiffness, law.shear_stiffness);
    const std::size_t first = i / lane_count * forces_per_bond * lane_count + i % lane_count;
    const auto add = [&](int body, int node, std::size_t vector, double share, int other) {
      const int base = model_.outline_offset[body] + node % model_.outline_of(body).count;
      of_body[body].push_back({base, static_cast<std::int32_t>(first + 2 * vector * lane_count), share,
                               share * stiffness, other, static_cast<std::int32_t>(i)});
    };
    for (int end = 0; end < 2; ++end) {
      add(bond.slave, bond.segment + end, end, 1, bond.master);
      add(bond.master, bond.master_segment[end], 2 + end, 1 - bond.xi[end], bond.slave);
      if (bond.xi[end] > 0) add(bond.master, bond.master_segment[end] + 1, 2 + end, bond.xi[end], bond.slave);
    }
  }
  receipts_.clear(), receipt_begin_.assign(1, 0);
  for (const std::vector<Receipt>& receipts : of_body) {
    receipts_.insert(receipts_.end(), receipts.begin(), receipts.end());
    receipt_begin_.push_back(static_cast<int>(receipts_.size()));
  }
}

/// Sets a lane of an eight. Lanes beyond the last bond repeat it without weight.
void BondSystem::add_to_eight(std::size_t number) {
  const Bond& bond = bonds_[std::min(number, bonds_.size() - 1)];
  Eight& eight = eights_[number / lane_count];
  const int lane = static_cast<int>(number % lane_count);
  for (int end = 0; end < 2; ++end) {
    const int master = model_.outline_offset[bond.master] + bond.master_segment[end];
    eight.nodes.end[end][lane] = model_.outline_offset[bond.slave] + bond.segment + end;
    eight.nodes.master[end][lane] = master;
    eight.nodes.next[end][lane] = master + 1;
    eight.xi[end][lane] = bond.xi[end];
    eight.rest_gap[end][lane] = bond.rest_gap[end];
    eight.rest_slip[end][lane] = bond.rest_slip[end];
  }
  eight.shift[0][lane] = bond.images.x;
  eight.shift[1][lane] = bond.images.y;
  eight.weight[lane] = number < bonds_.size() ? 0.5 * bond.length : 0;
  set(eight.law, lane, law_of(bond));
}

/// Frame of eight bonds, which turns with their middle lines, and the vectors from their ends to their masters.
struct BondSystem::Frame {
  PointLanes apart[2], tangent, normal;
  Lanes inverse_length;  ///< of the middle lines, 1/m
};

BondSystem::Frame BondSystem::frame_of(const Eight& eight, const OutlineField& position) {
  const Lattice& lattice = position.lattice;
  const PointLanes shift{eight.shift[0] * lattice.ax + eight.shift[1] * lattice.bx,
                         eight.shift[0] * lattice.ay + eight.shift[1] * lattice.by};
  Frame frame;
  PointLanes at[2];
  for (int end = 0; end < 2; ++end) {
    at[end] = points_of(position, eight.nodes.end[end]);
    const PointLanes first = points_of(position, eight.nodes.master[end]),
                     next = points_of(position, eight.nodes.next[end]);
    frame.apart[end] = first + eight.xi[end] * (next - first) + shift - at[end];
  }
  const PointLanes middle = at[1] - at[0] + broadcast(0.5) * (frame.apart[1] - frame.apart[0]);
  frame.inverse_length = inverse_sqrt(dot(middle, middle));
  frame.tangent = frame.inverse_length * middle, frame.normal = {frame.tangent.y, -frame.tangent.x};
  return frame;
}

/// A motion of a node along the normal turns the frame by half of it over the length of the middle line, and so moves
/// either end of the bond by c of it, with c = sqrt(gap^2 + along^2)/(2 length). The row sums of |B|^T k |B| grow by
/// (1 + 2 c)^2. A bond that is torn at both ends exerts no force any more.
void BondSystem::measure_turning(const OutlineField& position, const BondHistory& history) {
  turned_.clear();
  std::vector<char> changed(eights_.size(), 0);
  parallel_for(static_cast<int>(eights_.size()), [&](int i) {
    const LaneBits cement = eights_[i].law.bears_pressure > 0.0;
    if (!any(cement)) return;
    const Frame frame = frame_of(eights_[i], position);
    const Lanes square = max(dot(frame.apart[0], frame.apart[0]), dot(frame.apart[1], frame.apart[1]));
    const Lanes root = 1.0 + sqrt(square) * frame.inverse_length;
    const auto& [first, second] = history.ends[i];
    const LaneBits whole = min(first.damage, second.damage) < 1.0;
    const Lanes now = select(cement, select(whole, root * root, Lanes{}), broadcast(1));
    changed[i] = any(now != turning_[i]);
    turning_[i] = now;
  });
  std::set<int> bodies;
  for (std::size_t i = 0; i < bonds_.size(); ++i)
    if (changed[i / lane_count]) bodies.insert({bonds_[i].slave, bonds_[i].master});
  turned_.assign(bodies.begin(), bodies.end());
}

BondTotals BondSystem::forces_of_eight(std::size_t number, const OutlineField& position, const BondHistory& from,
                                       BondHistory& to) {
  const Eight& eight = eights_[number];
  const auto [apart, tangent, normal, inverse_length] = frame_of(eight, position);
  Lanes* force = &buffer_[number * forces_per_bond];
  Lanes turning{}, stored{}, loss{};  // turning: the derivative of the energy by the angle of the frame
  for (int end = 0; end < 2; ++end) {
    const Lanes gap = dot(normal, apart[end]), along = dot(tangent, apart[end]);
    const BondEnd& old = from.ends[number][end];
    BondEnd& now = to.ends[number][end];
    now.opening = gap - eight.rest_gap[end], now.slip = along - eight.rest_slip[end];
    const auto response = eight.law.respond(gap, old, now);
    const PointLanes traction = eight.weight * (response.pull * normal + response.shear * tangent);
    force[2 * end] = traction.x, force[2 * end + 1] = traction.y;
    force[4 + 2 * end] = -traction.x, force[4 + 2 * end + 1] = -traction.y;
    turning += eight.weight * (response.pull * along - response.shear * gap);
    stored += eight.weight * response.energy, loss += eight.weight * response.loss;
  }
  // The frame turns with the middle line: half of it with the slave's segment, half with the masters.
  const PointLanes couple = (0.5 * inverse_length * turning) * normal;
  for (int side = 0; side < 2; ++side) {
    Lanes* of_side = force + 4 * side;
    of_side[0] -= couple.x, of_side[1] -= couple.y, of_side[2] += couple.x, of_side[3] += couple.y;
  }
  return {sum(stored), sum(loss)};
}

BondTotals BondSystem::add_forces(const OutlineField& position, const BondHistory& from, BondHistory& to,
                                  OutlineField& force) {
  to.ends.resize(eights_.size());
  parallel_for(static_cast<int>(eights_.size()),
               [&](int i) { totals_[i] = forces_of_eight(static_cast<std::size_t>(i), position, from, to); });
  const double* numbers = reinterpret_cast<const double*>(buffer_.data());
  parallel_for(static_cast<int>(model_.bodies.size()), [&](int b) {
    for (int i = receipt_begin_[b]; i < receipt_begin_[b + 1]; ++i) {
      const Receipt& receipt = receipts_[i];
      force.x[receipt.node] += receipt.share * numbers[receipt.from];
      force.y[receipt.node] += receipt.share * numbers[receipt.from + lane_count];
    }
  });
  BondTotals total;
  for (const BondTotals& of_eight : totals_) total.stored += of_eight.stored, total.loss += of_eight.loss;
  if (model_.scene.cell) force.lattice = force.lattice + forces_on_images();
  return total;
}

Lattice BondSystem::forces_on_images() const {
  Lattice total;
  for (std::size_t i = 0; i < eights_.size(); ++i) {
    const Lanes* force = &buffer_[i * forces_per_bond];
    const Lanes x = force[4] + force[6], y = force[5] + force[7], *n = eights_[i].shift;
    total = total + Lattice{sum(n[0] * x), sum(n[0] * y), sum(n[1] * x), sum(n[1] * y)};
  }
  return total;
}

void BondSystem::add_stiffness(int body, const std::vector<double>& compliance, double* to, int stride) const {
  for (int i = receipt_begin_[body]; i < receipt_begin_[body + 1]; ++i) {
    const Receipt& receipt = receipts_[i];
    const double own = compliance[body], other = compliance[receipt.other];
    if (own > 0)
      to[stride * (receipt.node - model_.outline_offset[body])] +=
          (1 + other / own) * receipt.stiffness * turning_[receipt.bond / lane_count][receipt.bond % lane_count];
  }
}

}  // namespace pliant
