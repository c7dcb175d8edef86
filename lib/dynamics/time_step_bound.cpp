#include "dynamics/time_step_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "bodies/body_view.hpp"
#include "bodies/damping_forces.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "contact/halo.hpp"
#include "core/parallel.hpp"
#include "dynamics/body_frame.hpp"
#include "dynamics/contact_frequency.hpp"

namespace pliant {
namespace {

/// Factor on w_b^2, which power iterations approach from below.
constexpr double internal_margin = 1.05;
constexpr int start_iterations = 60;
/// Finite-difference step of the internal forces over the nodal distance.
constexpr double probe_size = 1e-6;
/// Bound of w^2 dt^2 with mass damping of any rate c: the limit is z^2 (1 + e^-z) / (z - 1 + e^-z), z = c dt, whose
/// least value is 3.716, at z = 0.87.
constexpr double limit_with_damping = 3.7;
/// Steps per stable step of bodies whose contacts have dashpots. These pairs have no energy correction, and at the
/// limit the rebound would depend on the two steps that it lasts (docs/defaults.md).
constexpr double steps_with_dashpots = 2;
/// Factor on the number of steps from which a message mentions it.
constexpr double worth_naming = 1.1;

/// Start vectors of the power iterations, in each body's own frame: the same for all bodies of a shape, whatever their
/// position in the list.
std::vector<Lanes> start_directions(const Model& model) {
  int most_nodes = 0;
  for (const CompliantShape& shape : model.shapes) most_nodes = std::max(most_nodes, shape.nodes());
  std::mt19937_64 random(1);
  Points own(static_cast<std::size_t>(most_nodes));
  for (Vec2& d : own)
    for (int c = 0; c < 2; ++c) d[c] = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  Dofs start = zero_dofs(model);
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const BodyOffsets offsets(model, body);
    for (int i = 0; i < model.shape_of(body).nodes(); ++i)
      set_node(offsets, static_cast<std::size_t>(i), own[i], start);
  }
  fill_padding(model, start);
  return std::move(start.compliant);
}

/// Finite-difference step of each body in a batch, in its units.
Lanes probe_step(const Model& model, const Batch& batch) {
  return probe_size * (batch.layout == Layout::same_topology
                           ? model.same_topology_shapes[batch.tables].nodal_distance[0]
                           : broadcast(model.shape_of(batch).space.nodal_distance[0]));
}

/// Divides each body's vector by its largest nodal value.
void normalise(const Batch& batch, Lanes* u) {
  Lanes square = broadcast(1e-300);
  for (int i = 0; i < batch.slots; ++i) square = max(square, u[2 * i] * u[2 * i] + u[2 * i + 1] * u[2 * i + 1]);
  const Lanes scale = sqrt(largest_of_body(batch, square));
  for (int i = 0; i < 2 * batch.slots; ++i) u[i] /= scale;
}

/// sum over slots of a_i b_i w_i in each lane.
template <class Weight>
Lanes weighted_dot(const Lanes* a, const Lanes* b, const Weight* weight, int slots) {
  Lanes total{};
  for (int i = 0; i < slots; ++i) total += weight[i] * (a[2 * i] * b[2 * i] + a[2 * i + 1] * b[2 * i + 1]);
  return total;
}

/// Largest w^2 of a rigid body's rotation under a dead load, 1/s2. The moment sum r x f of its forces changes with the
/// angle by -sum r.f, of which rotations reach |sum (r.f, r x f)|.
double dead_load_frequency(const OutlinePressure& load, const RigidBody& rigid, const OutlineShape& outline) {
  Vec2 turned(0, 0);
  for (std::size_t i = 0; i < load.nodes.size(); ++i) {
    const Vec2 &r = outline.points[load.nodes[i].node], &f = load.dead_load[i];
    turned += Vec2(r.dot(f), r.x() * f.y() - r.y() * f.x());
  }
  return rigid.dof[2].inverse_mass * load.pressure.largest() * turned.norm();
}

/// D C D^-1 of a force, so that the subsequent division by the lumped mass gives the acceleration W f.
std::vector<Lanes> times_reciprocal_mass(const Model& model, const Batch& batch, std::vector<Lanes> force) {
  std::vector<Lanes> result(force.size());
  with_nodes(model, batch, [&](const auto& nodes) {
    for (std::size_t i = 0; i < force.size(); ++i) force[i] *= nodes.inverse_mass_at_unit_density[i / 2];
    apply_reciprocal_mass(model, batch, force.data(), result.data());
    for (std::size_t i = 0; i < force.size(); ++i) result[i] *= nodes.mass_at_unit_density[i / 2];
  });
  return result;
}

}  // namespace

TimeStepBound::TimeStepBound(const Model& model, const LawTable& laws) : model_(model), stiffness_(model) {
  direction_ = start_directions(model);
  internal_.assign(model.batches.size(), Lanes{});
  contact_.assign(model.bodies.size(), 0.0);
  for (const Body& body : model.bodies)
    compliance_.push_back(contact_frequency(model, body, model.outlines[body.outline].tributary_length.data()));
  contact_floor_.assign(model.bodies.size(), 0.0);
  bound_conditions();
  limit_ = limit(1);
  if (model.bodies.size() < 2 && !model.scene.contact.self_contact && !model.scene.is_periodic()) return;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    contact_floor_[b] = compliance_[b] * laws.largest_stiffness(static_cast<int>(b));
}

/// Bounds of soft supports and dashpots that do not depend on the motion. Their sum bounds them together.
void TimeStepBound::bound_conditions() {
  support_.assign(model_.bodies.size(), 0.0);
  damping_.assign(model_.bodies.size(), 0.0);
  limit_square_.assign(model_.bodies.size(), 4.0);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    if (has_mass_damping(model_, model_.bodies[b])) limit_square_[b] = limit_with_damping;
  }
  for (const OutlineSupport& support : model_.supports) {
    const Body& body = model_.bodies[support.body];
    std::vector<double> length(static_cast<std::size_t>(model_.outlines[body.outline].count), 0.0);
    for (std::size_t i = 0; i < support.nodes.size(); ++i) length[support.nodes[i]] = support.length[i];
    const double frequency = contact_frequency(model_, body, length.data());
    support_[support.body] += support.stiffness * frequency;
    damping_[support.body] += support.damping * frequency;
  }
  for (const OutlinePressure& load : model_.pressures)
    if (const Body& body = model_.bodies[load.body]; body.kind == BodyKind::rigid && !load.dead_load.empty())
      support_[load.body] += dead_load_frequency(load, model_.rigid_bodies[body.rigid], model_.outlines[body.outline]);
  if (std::any_of(model_.batches.begin(), model_.batches.end(), [](const Batch& batch) { return batch.viscous; })) {
    viscous_.assign(model_.batches.size(), Lanes{});
    viscous_direction_ = direction_;
  }
}

void TimeStepBound::iterate_batch(int b, BatchMotion motion, int iterations) {
  const Batch& batch = model_.batches[b];
  const Lanes* position = motion.position;
  const std::size_t size = 2 * static_cast<std::size_t>(batch.slots);
  const std::vector<Lanes> centred = from_first_node(batch, position);
  std::vector<Lanes> at_rest(size, Lanes{}), probe(size), response(size);
  Lanes* u = &direction_[batch.offset];
  motion.position = centred.data();
  add_internal_forces(model_, batch, motion, at_rest.data());
  motion.position = probe.data();
  const Lanes step = probe_step(model_, batch);
  const BodyFrame frame(model_, batch, position);
  frame.into_space(batch, u);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    normalise(batch, u);
    for (std::size_t i = 0; i < size; ++i) probe[i] = centred[i] + step * u[i];
    std::fill(response.begin(), response.end(), Lanes{});
    add_internal_forces(model_, batch, motion, response.data());
    for (std::size_t i = 0; i < size; ++i) response[i] = (at_rest[i] - response[i]) / step;
    if (model_.has_reciprocal_mass) response = times_reciprocal_mass(model_, batch, response);
    with_nodes(model_, batch, [&](const auto& nodes) {
      const Lanes before = sum_over_body(batch, weighted_dot(u, u, nodes.mass_at_unit_density, batch.slots));
      const Lanes after = sum_over_body(
          batch, weighted_dot(response.data(), response.data(), nodes.inverse_mass_at_unit_density, batch.slots));
      internal_[b] = sqrt(after / before) * batch.inverse_density;
      for (std::size_t i = 0; i < size; ++i)
        u[i] = response[i] * nodes.inverse_mass_at_unit_density[i / 2] * batch.inverse_density;
    });
  }
  frame.into_body(batch, u);
}

/// The viscous forces are linear in the velocities, so that each iteration is exact.
void TimeStepBound::iterate_viscous(int b, const Lanes* position, int iterations) {
  const Batch& batch = model_.batches[b];
  std::vector<Lanes> response(2 * static_cast<std::size_t>(batch.slots));
  Lanes* v = &viscous_direction_[batch.offset];
  const BodyFrame frame(model_, batch, position);
  frame.into_space(batch, v);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    normalise(batch, v);
    std::fill(response.begin(), response.end(), Lanes{});
    add_internal_forces(model_, batch, {.position = position, .velocity = v, .elastic = false}, response.data());
    if (model_.has_reciprocal_mass) response = times_reciprocal_mass(model_, batch, response);
    with_nodes(model_, batch, [&](const auto& nodes) {
      const Lanes before = sum_over_body(batch, weighted_dot(v, v, nodes.mass_at_unit_density, batch.slots));
      const Lanes after = sum_over_body(
          batch, weighted_dot(response.data(), response.data(), nodes.inverse_mass_at_unit_density, batch.slots));
      const LaneBits damped = after > 0.0;  // a batch may contain bodies without viscosity
      viscous_[b] = select(damped, sqrt(after / before) * batch.inverse_density, Lanes{});
      for (std::size_t i = 0; i < response.size(); ++i)
        v[i] = select(damped, -response[i] * nodes.inverse_mass_at_unit_density[i / 2], v[i]);
    });
  }
  frame.into_body(batch, v);
}

void TimeStepBound::update_internal(const Dofs& position, const Memory& memory, int iterations) {
  const std::vector<int>& batches = model_.own.batches;
  const bool first = !batches.empty() && internal_[batches[0]][0] == 0;
  for_each_batch(model_, [&](int b) {
    iterate_batch(b, motion_of(model_.batches[b], position, memory), first ? start_iterations : iterations);
    if (model_.batches[b].viscous)
      iterate_viscous(b, &position.compliant[model_.batches[b].offset], first ? start_iterations : iterations);
  });
  limit_ = limit(1);
}

void TimeStepBound::update_contact(const ContactSystem& contact, const BondSystem& bonds) {
  std::vector<int> changed = stiffness_.update(contact, compliance_);
  for (const int b : bonds.turned())
    if (std::ranges::find(changed, b) == changed.end()) changed.push_back(b);
  if (bonds_seen_ != bonds.version()) {
    changed.resize(model_.bodies.size());
    std::iota(changed.begin(), changed.end(), 0);
    bonds_seen_ = bonds.version();
  }
  const auto add_stiffness = [&](int body, double* to, int stride) {
    stiffness_.add_of_body(contact, body, to, stride);
    bonds.add_stiffness(body, compliance_, to, stride);
  };
  find_contact_frequencies(model_, changed, add_stiffness, contact_);
  const std::vector<double> damping = contact.damping_ratios();
  for (const int b : changed) {
    contact_[b] = std::max(contact_floor_[b], contact_[b]);
    if (!shortened_.empty()) shortened_[b] = 1;
    // A dashpot reduces the longest stable step of its spring by the factor sqrt(1 + 4 z^2) - 2 z: see largest_dt_of.
    if (const double z = 2 * damping[b]; z > 0) {
      shortened_.resize(model_.bodies.size(), 1.0);
      shortened_[b] = steps_with_dashpots * (std::sqrt(1 + z * z) + z);
      contact_[b] *= shortened_[b] * shortened_[b];
    }
  }
  limit_ = limit(1);
}

double TimeStepBound::total(std::size_t b, double contact_factor) const {
  const Body& body = model_.bodies[b];
  return contact_factor * contact_[b] + support_[b] +
         (body.kind == BodyKind::compliant ? internal_margin * internal_[body.batch][body.lane] : 0.0);
}

double TimeStepBound::damping(std::size_t b) const {
  const Body& body = model_.bodies[b];
  const bool viscous = body.kind == BodyKind::compliant && model_.batches[body.batch].viscous;
  return damping_[b] + (viscous ? internal_margin * viscous_[body.batch][body.lane] : 0.0);
}

/// Dashpots use the velocity v + dt a that the first acceleration a of the step predicts for its end. A mode x of rate
/// c then follows x+ - 2 x + x- + w^2 dt^2 x + c dt (3 (x - x-) - (x- - x--)) / 2 = 0 and grows from
/// w^2 dt^2 + 4 c dt = 4 on: dt = 2/w (sqrt(1 + 4 z^2) - 2 z), c = 2 z w. The forms of stiffness, damping and mass are
/// symmetric, so the largest w^2 and the largest c bound all modes.
double TimeStepBound::largest_dt_of(std::size_t b, double contact_factor) const {
  const double w2 = total(b, contact_factor), c = damping(b);
  const double square = limit_square_[b], rate = 2 * c + std::sqrt(4 * c * c + square * w2);
  return rate > 0 ? model_.scene.time.safety * square / rate : std::numeric_limits<double>::infinity();
}

TimeStepBound::Limit TimeStepBound::limit(double contact_factor) const {
  Limit least{0, std::numeric_limits<double>::infinity()};
  for (const int own : model_.own.bodies) {
    const auto b = static_cast<std::size_t>(own);
    if (const double dt = largest_dt_of(b, contact_factor); dt < least.dt) least = {b, dt};
  }
  if (model_.halo) least.dt = -model_.halo->largest(-least.dt);
  return least;
}

std::string TimeStepBound::governing() const {
  const std::size_t b = limit_.body;
  const double w2 = total(b, 1), c = damping(b);
  std::string text =
      fmt::format("{} (contact {:.0f} % of w^2", model_.bodies[b].name, w2 > 0 ? 100 * contact_[b] / w2 : 0.0);
  if (b < shortened_.size() && shortened_[b] > 1) {
    const double without = w2 - contact_[b] * (1 - 1 / (shortened_[b] * shortened_[b]));
    text += fmt::format(", dashpots of restitution take {:.2g} times as many steps", std::sqrt(w2 / without));
  }
  if (c > 0) {
    const double undamped = std::sqrt(limit_square_[b] * w2);
    text += fmt::format(", damping {:.3g} /s", c);
    const double rate = 2 * c + std::hypot(2 * c, undamped);
    if (undamped > 0 && rate > worth_naming * undamped)
      text += fmt::format(" takes {:.2g} times as many steps", rate / undamped);
  }
  return text + ")";
}

}  // namespace pliant
