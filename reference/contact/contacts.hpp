#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/vec2.hpp"
#include "reference/contact/periods.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// Outline of one body, for contact.
struct ContactOutline {
  int first = 0, count = 0;    ///< its nodes in the list of all outline nodes
  double turn_shift = 0;       ///< x offset after one turn: 0 for closed outlines, +- period for walls
  Points reference;            ///< [count], in its own size, m
  std::string material, name;  ///< name: of the grains or the wall that the body belongs to
  bool wall = false;
  BodyKind kind = BodyKind::rigid;
};

/// History variables of a slave node and one partner, at the last accepted state.
struct ContactMemory {
  bool beside = false;         ///< it had a projection onto the other body, so segment, xi and angle are known
  int segment = 0;             ///< of the partner's outline
  double xi = 0;               ///< in [0, 1] along it
  double angle = 0;            ///< beyond an end: from the segment's normal to the node's, rad, towards growing xi
  double height = 0, gap = 0;  ///< from the segment's line, from the outline, m
  double slip = 0;             ///< elastic, m
};

/// What a contact does to an image of the master, and across its gap.
struct ContactLever {
  Image image;          ///< of the master
  Vec2 residual{0, 0};  ///< on all of the master's nodes, N/m
  /// Sum of the residual on each of the master's nodes (x) its position from the slave's point in contact, J/m. It is
  /// the derivative of the energy of the contact by a homogeneous deformation of everything.
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();

  /// Adds the residual at a master's node that lies `from` the slave's point.
  void add(const Vec2& at_node, const Vec2& from) {
    residual += at_node;
    moment += at_node * from.transpose();
  }
};

/// Contact of one node with one segment: conservative and frictional part together.
struct ContactElement {
  std::array<int, 3> node;            ///< slave, first and second node of the segment in the list of all outline nodes
  Eigen::Matrix<double, 6, 1> force;  ///< residual: minus the forces on the three nodes, N/m
  Eigen::Matrix<double, 6, 6> tangent;      ///< of `force`, unsymmetric where it slips
  double gap = 0, pressure = 0, shear = 0;  ///< m, Pa, Pa (on the slave along the segment)
  double depth = 0;                         ///< penetration over the master's longest segment
  double compression = 0;                   ///< at the initial state: energy of penetration, J/m
  std::array<int, 2> body{};                ///< owner of the node, owner of the segment: numbers of outlines
  ContactLever lever;
  /// Additional columns of the tangent, for nodes that the slave passed since the last accepted state, on which the
  /// path length depends as well; empty while it stays on one segment. A node may occur more than once: columns add up.
  std::vector<std::pair<int, Eigen::Matrix<double, 6, 2>>> further;
};

/// Integrated contact of one body's segments with another, with all nodes on which it depends.
struct ContactPatch {
  std::vector<int> node;      ///< in the list of all outline nodes
  Eigen::VectorXd force;      ///< [2 nodes] residual, N/m
  Eigen::MatrixXd tangent;    ///< [2 nodes x 2 nodes] of `force`, unsymmetric where it slips
  std::array<int, 2> body{};  ///< owner of the segments, owner of the outline: numbers of outlines
  ContactLever lever;
  double deepest = 0;      ///< penetration of a Gauss point, m
  double depth = 0;        ///< the same over the master's longest segment
  double compression = 0;  ///< as in ContactElement
};

struct ContactResult {
  std::vector<ContactElement> elements;
  std::vector<ContactPatch> patches;  ///< of pairs with integrated contact
  double stored = 0;                  ///< J/m
  double dissipated = 0;              ///< from the last accepted state to this one, J/m
  std::size_t count() const { return elements.size() + patches.size(); }
};

/// Contact forces on the outline nodes, [nodes], N/m.
Points forces_on_nodes(const ContactResult& result, std::size_t nodes);

/// All contacts of a scene by brute force: every node of every body, or every segment for integrated contact, against
/// every segment of every other body, and of all periodic images (docs/method.md 4).
class Contacts {
 public:
  /// Throws InputError for features that this solver does not have (self-contact, dashpots, current lengths at nodes),
  /// for a range within which the law does not reach its strength, and for stiffness = "auto" between rigid bodies
  /// alone.
  Contacts(const Scene& scene, std::vector<ContactOutline> outlines);
  ~Contacts();

  /// Evaluates contacts at outline positions x [all outline nodes], m. Trial histories are kept beside the accepted
  /// ones. Every evaluation before the first accept() is of the initial state, without slip.
  ContactResult evaluate(const Points& x, const Periods& periods);
  ContactResult evaluate(const Points& x);  ///< with the periods at the start of the scene
  /// Accepts the trial histories of the last evaluation.
  void accept();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pliant::reference
