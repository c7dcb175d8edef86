#include "reference/system.hpp"

#include <limits>

namespace pliant::reference {
namespace {

/// Appends entries of a sparse matrix, to be added to others from row and column `first` on.
void append(const SparseMatrix& matrix, int first, Triplets& entries) {
  for (int column = 0; column < matrix.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      entries.emplace_back(first + static_cast<int>(entry.row()), first + column, entry.value());
}

SparseMatrix assembled(const Triplets& entries, int size) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Residual of an image on the vectors of the periods that lead to it.
Eigen::Matrix2d pull_of_image(const ContactLever& lever) {
  return lever.residual * Vec2(lever.image.x, lever.image.y).transpose();
}

}  // namespace

System::System(const Scene& scene)
    : bodies_(scene),
      loads_(bodies_),
      contacts_(bodies_.scene(), bodies_.contact_outlines()),
      bonds_(bodies_.scene(), bodies_.contact_outlines()) {
  for (const Body& body : bodies_.all())
    if (body.compliant())
      internal_.emplace_back(bodies_.space_of(body), bodies_.material_of(body), body.placed.scale, body.placed.angle);
  histories_.resize(internal_.size());
  make_bonds({.q = bodies_.initial_positions(), .v = {}});
}

void System::make_bonds(const Motion& accepted) {
  bonds_.make(bodies_.outline_positions(accepted.q), periods(accepted.time), accepted.time);
}

void System::accept() {
  contacts_.accept();
  bonds_.accept();
  for (std::size_t i = 0; i < internal_.size(); ++i) internal_[i].accept(histories_[i]);
  accepted_ = evaluated_;
}

Forces System::evaluate(const Motion& motion, bool tangent) {
  Forces forces;
  forces.residual = forces.magnitude = forces.damping = Vector::Zero(bodies_.dofs());
  Triplets entries, rates;
  add_internal(motion, tangent, forces, entries);
  if (!(forces.least_jacobian > 0)) return forces;
  const SparseMatrix jacobian = bodies_.outline_jacobian(motion.q);
  add_outlines(motion, jacobian, tangent, forces, entries);
  add_applied(motion, forces);
  if (motion.moves) {
    add_dashpots(motion, jacobian, tangent, forces, rates);
    add_viscosity(motion, tangent, forces, entries, rates);
    forces.residual += forces.damping;
    forces.magnitude += forces.damping.cwiseAbs();
  }
  if (!tangent) return forces;
  forces.stiffness = assembled(entries, bodies_.dofs());
  forces.viscosity = assembled(rates, bodies_.dofs());
  return forces;
}

void System::add_internal(const Motion& motion, bool tangent, Forces& forces, Triplets& entries) {
  std::size_t number = 0;
  evaluated_ = motion.time;
  const double elapsed = motion.moves ? motion.time - accepted_ : std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < bodies_.all().size(); ++b) {
    const Body& body = bodies_.all()[b];
    if (!body.compliant()) continue;
    const int first = body.first_dof;
    const InternalState internal = internal_[number].evaluate(motion.q.segment(first, body.dofs), tangent, elapsed);
    histories_[number] = internal.history;
    forces.symmetric &= internal_[number++].has_potential();
    forces.creep_power += internal.power;
    forces.plastic_loss += internal.loss;
    if (internal.least_jacobian < forces.least_jacobian) {
      forces.least_jacobian = internal.least_jacobian;
      forces.worst_body = static_cast<int>(b);
    }
    if (!(internal.least_jacobian > 0)) return;
    forces.strain += internal.energy;
    forces.residual.segment(first, body.dofs) += internal.residual;
    forces.magnitude.segment(first, body.dofs) += internal.residual.cwiseAbs();
    if (tangent) append(internal.tangent, first, entries);
  }
}

/// Adds contacts, bonds, pressures and supports, which act on outlines and through them on the bodies.
void System::add_outlines(const Motion& motion, const SparseMatrix& jacobian, bool tangent, Forces& forces,
                          Triplets& entries) {
  const Points x = bodies_.outline_positions(motion.q);
  OutlineResidual outlines = loads_.outlines(x, motion.instant());
  forces.boundary = outlines.stored;
  // At rest the loss of a step is what its flow takes from the energy: rates do not count.
  forces.potential += forces.strain + forces.plastic_loss + outlines.stored + outlines.potential;
  forces.contacts = contacts_.evaluate(x, periods(motion.time));
  forces.bonds = bonds_.evaluate(x, periods(motion.time));
  forces.contact = forces.contacts.stored + forces.bonds.stored;
  forces.potential += forces.contact;
  forces.dissipated = forces.contacts.dissipated;
  forces.bond_loss = forces.bonds.dissipated;
  Vector magnitude = outlines.residual.cwiseAbs();
  add_contacts(tangent, outlines, magnitude, forces);
  add_bonds(tangent, outlines, magnitude, forces);
  forces.symmetric &= outlines.symmetric;
  const SparseMatrix back = jacobian.transpose();
  forces.residual += back * outlines.residual;
  forces.magnitude += back.cwiseAbs() * magnitude;
  if (!tangent) return;
  append(back * assembled(outlines.tangent, 2 * bodies_.outline_nodes()) * jacobian, 0, entries);
  bodies_.add_turning(motion.q, outlines.residual, entries);
}

void System::add_contacts(bool tangent, OutlineResidual& outlines, Vector& magnitude, Forces& forces) const {
  for (const ContactElement& element : forces.contacts.elements) {
    forces.deepest = std::max(forces.deepest, element.depth);
    forces.on_periods += pull_of_image(element.lever);
    for (int i = 0; i < 6; ++i) {
      const int row = 2 * element.node[i / 2] + i % 2;
      outlines.residual[row] += element.force[i];
      magnitude[row] += std::abs(element.force[i]);
      for (int j = 0; tangent && j < 6; ++j)
        outlines.tangent.emplace_back(row, 2 * element.node[j / 2] + j % 2, element.tangent(i, j));
      for (const auto& [passed, columns] : element.further)
        for (int j = 0; tangent && j < 2; ++j) outlines.tangent.emplace_back(row, 2 * passed + j, columns(i, j));
    }
    forces.symmetric &= element.further.empty() && element.tangent.isApprox(element.tangent.transpose(), 1e-13);
  }
  for (const ContactPatch& patch : forces.contacts.patches) {
    forces.deepest = std::max(forces.deepest, patch.depth);
    forces.on_periods += pull_of_image(patch.lever);
    const auto place = [&](Eigen::Index i) {
      return 2 * patch.node[static_cast<std::size_t>(i / 2)] + static_cast<int>(i % 2);
    };
    for (Eigen::Index i = 0; i < patch.force.size(); ++i) {
      outlines.residual[place(i)] += patch.force[i];
      magnitude[place(i)] += std::abs(patch.force[i]);
      for (Eigen::Index j = 0; tangent && j < patch.force.size(); ++j)
        outlines.tangent.emplace_back(place(i), place(j), patch.tangent(i, j));
    }
    forces.symmetric &= patch.tangent.isApprox(patch.tangent.transpose(), 1e-12);
  }
}

void System::add_bonds(bool tangent, OutlineResidual& outlines, Vector& magnitude, Forces& forces) const {
  for (const BondElement& element : forces.bonds.elements) {
    forces.on_periods += pull_of_image(element.lever);
    const auto place = [&](int i) { return 2 * element.node[static_cast<std::size_t>(i / 2)] + i % 2; };
    for (int i = 0; i < 12; ++i) {
      outlines.residual[place(i)] += element.force[i];
      magnitude[place(i)] += std::abs(element.force[i]);
      for (int j = 0; tangent && j < 12; ++j) outlines.tangent.emplace_back(place(i), place(j), element.tangent(i, j));
    }
  }
  forces.symmetric &= !forces.bonds.damages;
}

void System::add_applied(const Motion& motion, Forces& forces) const {
  const Vector applied = loads_.applied(motion.instant()) + loads_.gravity(motion.time);
  forces.residual -= applied;
  forces.potential -= applied.dot(motion.q);
  forces.magnitude += applied.cwiseAbs();
}

void System::add_dashpots(const Motion& motion, const SparseMatrix& jacobian, bool tangent, Forces& forces,
                          Triplets& rates) const {
  const Vector own = loads_.load_dashpots(motion.instant());
  const Dashpots outline = loads_.dashpots(motion.instant());
  const SparseMatrix back = jacobian.transpose();
  forces.outline_velocity = jacobian * motion.v;
  forces.damping +=
      own.cwiseProduct(motion.v) + back * (outline.coefficient.cwiseProduct(forces.outline_velocity) - outline.pull);
  if (!tangent) return;
  for (int i = 0; i < own.size(); ++i)
    if (own[i] != 0) rates.emplace_back(i, i, own[i]);
  if (!outline.coefficient.isZero(0)) append(back * outline.coefficient.asDiagonal() * jacobian, 0, rates);
}

void System::add_viscosity(const Motion& motion, bool tangent, Forces& forces, Triplets& entries,
                           Triplets& rates) const {
  std::size_t number = 0;
  for (const Body& body : bodies_.all()) {
    if (!body.compliant()) continue;
    const InternalForces& internal = internal_[number++];
    if (bodies_.material_of(body).viscosity == 0) continue;
    const int first = body.first_dof;
    const ViscousState viscous =
        internal.damping(motion.q.segment(first, body.dofs), motion.v.segment(first, body.dofs), tangent);
    forces.damping.segment(first, body.dofs) += viscous.residual;
    forces.symmetric &= motion.v.segment(first, body.dofs).isZero(0);
    if (!tangent) continue;
    append(viscous.by_positions, first, entries);
    append(viscous.by_velocities, first, rates);
  }
}

}  // namespace pliant::reference
