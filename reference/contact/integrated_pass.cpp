#include "reference/contact/integrated_pass.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using PointVector = Eigen::Matrix<double, 8, 1>;  ///< by the coordinates of a sample's four nodes
using PointMatrix = Eigen::Matrix<double, 8, 8>;

/// Number at a sample with its derivatives.
struct Valued {
  double value = 0;
  PointVector by = PointVector::Zero();
};

/// Sample with the response of the law there.
struct Touch {
  const ContactSample* sample;
  int segment;             ///< of the slave, numbered over all turns
  double weight = 0;       ///< of a point or a limit, m
  PointVector stretching;  ///< derivatives of the weight over the weight, 1/m; 0 with reference lengths
  Response normal;         ///< without shear
  Valued limit;            ///< of shear, Pa
  Valued moved;            ///< along the master since the last accepted state, m
  PointVector gap_by;
  PointMatrix gap_by_twice;
  PointVector rate;  ///< of motion along the master
  PointMatrix rate_by;
};

/// Integral with its derivatives by the coordinates of all nodes of the half pass.
struct Sum {
  double value = 0;
  VectorXd by;
};

/// Integrals with the hat function of one of the slave's nodes.
struct NodeSums {
  Sum length, limit, moved;  ///< m, N/m, m2
  VectorXd way;              ///< integral of the rates of motion: force of a unit of shear, m
  MatrixXd way_by;
  ContactLever lever;  ///< of a unit of shear
};

class Pass {
 public:
  Pass(const PassSetting& setting, const NodeSlips& slips) : of_(setting), slips_(slips) {}

  PassResult run() {
    std::vector<ContactSamples> all;
    for (const int segment : of_.segments) all.push_back(sample_contact(of_.where, segment));
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (const ContactSample& sample : all[k].points) points_.push_back(touch(sample, of_.segments[k]));
      for (const ContactSample& sample : all[k].limits) limits_.push_back(touch(sample, of_.segments[k]));
    }
    if (points_.empty()) return {};
    number_nodes();
    result_.patch.force = VectorXd::Zero(size());
    result_.patch.tangent = MatrixXd::Zero(size(), size());
    press();
    if (of_.law.shears()) shear();
    return std::move(result_);
  }

 private:
  Touch touch(const ContactSample& sample, int segment) const {
    Touch result{};
    result.sample = &sample;
    result.segment = segment;
    const bool present = of_.lengths.empty();
    const PresentOutline& slave = of_.where.slave;
    const double length = present ? slave.length(segment) : of_.lengths[within(segment)];
    result.weight = sample.weight * length / 2;  // one of two half passes
    result.stretching.setZero();
    if (present) {
      const Vec2 t = slave.tangent(segment) / length;
      result.stretching.head<4>() << -t, t;
    }
    const Eigen::Matrix<double, 6, 8> spread = sample.spread();
    const auto spread_out = [&](const Jet<6>::Gradient& by) -> PointVector { return spread.transpose() * by; };
    const Projection& at = sample.at;
    result.normal = respond(of_.law, 0, at.gap.value, 0);
    result.gap_by = spread_out(at.gap.gradient);
    result.gap_by_twice = spread.transpose() * at.gap.hessian * spread;
    if (!of_.law.shears()) return result;
    result.rate = spread_out(at.rate());
    result.rate_by = spread.transpose() * at.rate_derivative() * spread;
    const Jet<2> limit = shear_limit(of_.law, {at.gap.value, 0});
    result.limit = {limit.value, limit.gradient[0] * result.gap_by};
    if (of_.past) {
      const Jet<6> moved = motion_of(sample, segment);
      result.moved = {moved.value, spread_out(moved.gradient)};
    }
    return result;
  }

  std::size_t within(int i) const {
    const int count = of_.where.slave.count();
    return static_cast<std::size_t>(((i % count) + count) % count);
  }

  /// Slip increment, from the former position of the same point of the slave over the same segment of the master: in
  /// the mean of that segment's former and present lengths, or around its first node.
  Jet<6> motion_of(const ContactSample& sample, int segment) const {
    const auto& [slave, master, shift] = *of_.past;
    const int j = sample.nearby.segment;
    const Vec2 point = (1 - sample.s) * slave.node(segment) + sample.s * slave.node(segment + 1) - shift;
    const Vec2 from = point - master.node(j), t = master.tangent(j);
    const double along = from.dot(t), height = from.dot(Vec2(t.y(), -t.x()));
    const Projection& now = sample.at;
    const double length = master.length(j);
    if (!sample.nearby.at_node) return 0.5 * (now.length + length) * (now.xi - along / length);
    const double side =
        now.gap.value * now.height.value < 0 ? -1 : 1;  // side of the line relative to that of the outline
    return side * (sin(now.angle) * height - cos(now.angle) * along);
  }

  void number_nodes() {
    for (const Touch& touch : points_)
      for (const int node : touch.sample->node) number_.try_emplace(node, 0);
    for (const Touch& touch : limits_)
      for (const auto& [node, by] : touch.sample->moves) number_.try_emplace(node, 0);
    for (auto& [node, number] : number_) {
      number = static_cast<int>(result_.patch.node.size());
      result_.patch.node.push_back(node);
    }
  }
  Eigen::Index size() const { return 2 * static_cast<Eigen::Index>(number_.size()); }
  Eigen::Index place(const Touch& touch, int i) const {
    return 2 * number_.at(touch.sample->node[static_cast<std::size_t>(i / 2)]) + i % 2;
  }

  void add(const Touch& touch, double factor, const PointVector& part, VectorXd& to) const {
    for (int i = 0; i < 8; ++i) to[place(touch, i)] += factor * part[i];
  }
  void add(const Touch& touch, double factor, const PointMatrix& part, MatrixXd& to) const {
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) to(place(touch, i), place(touch, j)) += factor * part(i, j);
  }
  /// Adds a force on the four nodes to a lever.
  void add(const Touch& touch, double factor, const PointVector& part, ContactLever& to) const {
    const PresentOutline &slave = of_.where.slave, &master = of_.where.master;
    const ContactSample& sample = *touch.sample;
    const Vec2 point =
        (1 - sample.s) * slave.node(touch.segment) + sample.s * slave.node(touch.segment + 1) - of_.where.shift;
    for (const int end : {0, 1})
      to.add(factor * part.segment<2>(4 + 2 * end), master.node(sample.nearby.segment + end) - point);
  }
  /// Derivatives of the position of a limit.
  VectorXd move(const Touch& touch) const {
    VectorXd by = VectorXd::Zero(size());
    for (const auto& [node, part] : touch.sample->moves) by.segment<2>(2 * number_.at(node)) += part;
    return by;
  }

  /// Adds the gradient of the integral of the normal energy, and its derivative.
  void press() {
    ContactPatch& patch = result_.patch;
    const double untouched = respond(of_.law, 0, 0, 0).stored;
    for (const Touch& touch : points_) {
      const Response& law = touch.normal;
      const PointVector force = -law.pressure * touch.gap_by;
      result_.stored += touch.weight * law.stored;
      add(touch, touch.weight, force, patch.force);
      add(touch, touch.weight, force, patch.lever);
      add(touch, touch.weight,
          PointMatrix(-law.pressure * touch.gap_by_twice -
                      law.pressure_by[0] * touch.gap_by * touch.gap_by.transpose() +
                      force * touch.stretching.transpose()),
          patch.tangent);
      const double depth = -touch.sample->at.gap.value;
      if (depth <= 0) continue;
      patch.deepest = std::max(patch.deepest, depth);
      patch.compression += touch.weight * (law.stored - untouched);
    }
    for (const Touch& touch : limits_) {
      VectorXd force = VectorXd::Zero(size());
      add(touch, touch.weight, PointVector(-touch.normal.pressure * touch.gap_by), force);
      patch.tangent += force * move(touch).transpose();
    }
  }

  void gather(const Touch& touch, double hat, const Valued& what, Sum& sum) const {
    sum.value += touch.weight * hat * what.value;
    add(touch, touch.weight * hat, PointVector(what.by + what.value * touch.stretching), sum.by);
  }

  std::map<int, NodeSums> sum_over_nodes() const {
    std::map<int, NodeSums> nodes;
    const auto sums_of = [&](const Touch& touch, int end) -> NodeSums& {
      const VectorXd zero = VectorXd::Zero(size());
      // Nodes of a wall are numbered over all turns, unless the other is a wall too.
      const bool counts_on = !of_.where.slave.closed() && of_.where.master.closed();
      const int number = touch.segment + end, node = counts_on ? number : static_cast<int>(within(number));
      return nodes
          .try_emplace(node, NodeSums{{0, zero}, {0, zero}, {0, zero}, zero, MatrixXd::Zero(size(), size()), {}})
          .first->second;
    };
    for (const Touch& touch : points_)
      for (const int end : {0, 1}) {
        NodeSums& sums = sums_of(touch, end);
        const double hat = end == 0 ? 1 - touch.sample->s : touch.sample->s;
        gather(touch, hat, {1, PointVector::Zero()}, sums.length);
        gather(touch, hat, touch.limit, sums.limit);
        gather(touch, hat, touch.moved, sums.moved);
        add(touch, touch.weight * hat, touch.rate, sums.way);
        add(touch, touch.weight * hat, touch.rate, sums.lever);
        add(touch, touch.weight * hat, PointMatrix(touch.rate_by + touch.rate * touch.stretching.transpose()),
            sums.way_by);
      }
    for (const Touch& touch : limits_)
      for (const int end : {0, 1}) {
        NodeSums& sums = sums_of(touch, end);
        const double share = touch.weight * (end == 0 ? 1 - touch.sample->s : touch.sample->s);
        const VectorXd moves = move(touch);
        sums.length.by += share * moves;
        sums.limit.by += share * touch.limit.value * moves;
        sums.moved.by += share * touch.moved.value * moves;
        VectorXd rate = VectorXd::Zero(size());
        add(touch, share, touch.rate, rate);
        sums.way_by += rate * moves.transpose();
      }
    return nodes;
  }

  /// Updates the slip of slave nodes (docs/method.md 4): reduced by new length in contact, advanced by the slip
  /// increment, and cut at the limit.
  void shear() {
    const double kt = of_.law.kt;
    for (const auto& [node, sums] : sum_over_nodes()) {
      const double w = sums.length.value;
      if (!(w > 0)) continue;
      const auto found = slips_.find(node);
      const NodeSlip old = found == slips_.end() ? NodeSlip{} : found->second;
      const bool grows = w > old.length;
      const double share = grows ? old.length / w : 1, start = share * old.slip, motion = sums.moved.value / w,
                   tried = start + motion;
      VectorXd slip_by = (sums.moved.by - (tried - (grows ? 0 : start)) * sums.length.by) / w;
      const double most = sums.limit.value / (kt * w);
      double slip = tried;
      if (std::abs(tried) > most) {
        slip = std::copysign(most, tried);
        slip_by = std::copysign(1, tried) * (sums.limit.by / kt - most * sums.length.by) / w;
      }
      result_.slips[node] = {w, slip};
      result_.stored += kt / 2 * w * slip * slip;
      if (of_.past)
        result_.dissipated += kt / 2 * (old.length * old.slip * old.slip - w * start * start) +
                              kt / 2 * std::max(old.length - w, 0.0) * old.slip * motion +
                              kt / 2 * w * (start + slip) * (tried - slip);
      result_.patch.force += kt * slip * sums.way;
      result_.patch.lever.residual += kt * slip * sums.lever.residual;
      result_.patch.lever.moment += kt * slip * sums.lever.moment;
      result_.patch.tangent += kt * (slip * sums.way_by + sums.way * slip_by.transpose());
    }
  }

  const PassSetting& of_;
  const NodeSlips& slips_;
  std::vector<Touch> points_, limits_;
  std::map<int, int> number_;  ///< of nodes in the patch
  PassResult result_;
};

}  // namespace

PassResult integrated_pass(const PassSetting& setting, const NodeSlips& slips) { return Pass(setting, slips).run(); }

double lost_slip(const Law& law, const NodeSlip& slip) { return law.kt / 2 * slip.length * slip.slip * slip.slip; }

}  // namespace pliant::reference
