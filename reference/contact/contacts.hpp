#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// The outline of one body as contact sees it.
struct ContactOutline {
  int first = 0, count = 0;    ///< its nodes in the list of all outline nodes
  double turn_shift = 0;       ///< x offset after one turn: 0 for closed outlines, +- period for walls
  Points reference;            ///< [count], in its own size, m
  std::string material, name;  ///< name: of the grains or the wall that the body belongs to
  bool wall = false;
  BodyKind kind = BodyKind::rigid;
};

/// What a slave node remembers of one other body, as of the last accepted state.
struct ContactMemory {
  bool beside = false;       ///< it stood beside the other body: then place is known
  int segment = 0;           ///< of the other's outline
  double xi = 0;             ///< in [0, 1] along it
  double angle = 0;          ///< beyond an end: from the segment's normal to the node's, rad, towards growing xi
  double slip = 0;           ///< elastic, m; of a bond: since it was made
  double friction_slip = 0;  ///< elastic slip of a bond's broken share, m
  double damage = 1;         ///< of a bond
  double opening = 0;        ///< of a bond, m
};

/// One node against one segment: conservative and frictional part together.
struct ContactElement {
  std::array<int, 3> node;            ///< slave, first and second node of the segment in the list of all outline nodes
  Eigen::Matrix<double, 6, 1> force;  ///< residual: minus the forces on the three nodes, N/m
  Eigen::Matrix<double, 6, 6> tangent;      ///< of `force`, unsymmetric where it slips
  double gap = 0, pressure = 0, shear = 0;  ///< m, Pa, Pa (on the slave along the segment)
  double depth = 0;                         ///< penetration over the master's longest segment
  double compression = 0;                   ///< of the initial state: energy that penetration stores, J/m
  std::array<int, 2> body{};                ///< whose node, whose segment: numbers of outlines
  /// More columns of the tangent, for nodes of the outline that the slave passed since the last accepted state, as the
  /// way along it depends on them too; empty while it stays on one segment. A node may occur more than once: columns
  /// add up.
  std::vector<std::pair<int, Eigen::Matrix<double, 6, 2>>> further;
};

/// One body's segments against another, where contact is an integral: all nodes that it depends on together.
struct ContactPatch {
  std::vector<int> node;      ///< in the list of all outline nodes
  Eigen::VectorXd force;      ///< [2 nodes] residual, N/m
  Eigen::MatrixXd tangent;    ///< [2 nodes x 2 nodes] of `force`, unsymmetric where it slips
  std::array<int, 2> body{};  ///< whose segments, against whose outline: numbers of outlines
  double deepest = 0;         ///< penetration of a Gauss point, m
  double depth = 0;           ///< the same over the master's longest segment
  double compression = 0;     ///< as of ContactElement
};

struct ContactResult {
  std::vector<ContactElement> elements;
  std::vector<ContactPatch> patches;  ///< of pairs whose contact is an integral
  double stored = 0;                  ///< J/m
  double dissipated = 0;              ///< from the last accepted state to this one, J/m
  std::size_t count() const { return elements.size() + patches.size(); }
};

/// Contact forces on the outline nodes, [nodes], N/m.
Points forces_on_nodes(const ContactResult& result, std::size_t nodes);

/// All contacts of a scene by brute force: every node of every body, or every segment where contact is an integral,
/// against every segment of every other, and of its own periodic images (docs/method.md 4).
class Contacts {
 public:
  /// Throws InputError for what this solver does not have (self-contact, dashpots, lengths of the present outline at
  /// nodes), for a range within which the law does not reach its strength, and for stiffness =
  /// "auto" between rigid bodies alone.
  Contacts(const Scene& scene, std::vector<ContactOutline> outlines);
  ~Contacts();

  /// At outline positions x [all outline nodes], m. Trial memories are kept beside the accepted ones. Every evaluation
  /// before the first accept() is of the initial state: it finds which nodes are bonded, without slip.
  ContactResult evaluate(const Points& x);
  /// The trial memories of the last evaluation become the accepted ones.
  void accept();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pliant::reference
