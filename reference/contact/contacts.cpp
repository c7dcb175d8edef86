#include "reference/contact/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <map>

#include "core/errors.hpp"
#include "reference/contact/corners.hpp"
#include "reference/contact/integrated_contacts.hpp"
#include "reference/contact/law.hpp"
#include "reference/contact/pair_laws.hpp"
#include "reference/contact/projection.hpp"
#include "reference/contact/slip.hpp"

namespace pliant::reference {
namespace {

constexpr double deepest = 1.5;  ///< that contact sees, over the master's longest segment

/// A node of one body and a periodic image of another, or of its own.
struct Encounter {
  int slave = 0, node = 0;    ///< node: of the slave's own outline
  int master = 0, image = 0;  ///< image: 0 for a wall, whose segments are counted on instead
  auto operator<=>(const Encounter&) const = default;
};
using Memories = std::map<Encounter, ContactMemory>;

struct Box {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec2& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
  bool contains(const Vec2& point, double margin) const {
    return (point - low).minCoeff() >= -margin && (high - point).minCoeff() >= -margin;
  }
};

/// One body as it is now.
struct PresentBody {
  PresentOutline outline;
  Box box;
  double longest = 0;  ///< segment, m

  PresentBody(const ContactOutline& of, const Points& x) : outline(of, x) {
    for (int i = 0; i < of.count; ++i) {
      box.add(outline.node(i));
      longest = std::max(longest, outline.length(i));
    }
  }
};

void refuse_settings(const ContactSettings& settings) {
  if (settings.length == ContactLength::current && settings.quadrature == ContactQuadrature::nodes)
    throw InputError(
        "[contact] length = \"current\" with quadrature = \"nodes\": the reference solver knows \"reference\" only");
  if (settings.self_contact) throw InputError("[contact] self_contact = true: not in the reference solver");
}

}  // namespace

struct Contacts::Implementation {
  Implementation(const Scene& scene, std::vector<ContactOutline> given)
      : outlines(std::move(given)), laws(scene, outlines), period(scene.period.value_or(0)) {
    refuse_settings(scene.contact);
    if (scene.contact.quadrature == ContactQuadrature::segments) integrated.emplace(scene, outlines, laws);
    double finest = std::numeric_limits<double>::infinity();
    for (const ContactOutline& outline : outlines) {
      lengths.push_back(tributary_lengths(outline));
      corners.emplace_back(outline);
      finest = std::min(finest, mean_spacing(outline));
    }
    skin = scene.skin * finest;
  }

  ContactResult evaluate(const Points& x) {
    if (integrated) return integrated->evaluate(x);
    trial.clear();
    result = {};
    bodies.clear();
    for (const ContactOutline& outline : outlines) bodies.emplace_back(outline, x);
    const int count = static_cast<int>(outlines.size());
    for (int slave = 0; slave < count; ++slave)
      for (int master = 0; master < count; ++master)
        if (const std::optional<Law>& law = laws.between(slave, master)) meet(slave, master, *law);
    for (const auto& [encounter, memory] : accepted)
      if (!trial.contains(encounter)) part(encounter, memory);
    return std::move(result);
  }

  /// What a node remembers is lost when it is no longer beside the other body. Past a corner its length has come to
  /// nothing.
  void part(const Encounter& encounter, const ContactMemory& memory) {
    if (corners[encounter.master].any()) return;
    result.dissipated +=
        weight(encounter) * parting_loss(*laws.between(encounter.slave, encounter.master), memory, std::nullopt);
  }

  /// Of a node in one of the two passes, m.
  double weight(const Encounter& encounter) const { return lengths[encounter.slave][encounter.node] / 2; }

  /// All nodes of one body against another and its periodic images.
  void meet(int slave, int master, const Law& law) {
    const Box &a = bodies[slave].box, &b = bodies[master].box;
    const double outward = law.reach + skin;
    // Heights grow slower than distances beyond an end: of tips sharper than 29 degrees something may be missed beyond
    // this, far from any contact.
    const double margin = 4 * outward;
    if (a.low.y() > b.high.y() + margin || b.low.y() > a.high.y() + margin) return;
    if (period == 0) return meet_image(slave, master, 0, law, outward, margin);
    if (outlines[master].wall) return meet_wall(slave, master, law, outward);
    const int first = static_cast<int>(std::ceil((a.low.x() - b.high.x() - margin) / period));
    const int last = static_cast<int>(std::floor((a.high.x() - b.low.x() + margin) / period));
    for (int image = first; image <= last; ++image)
      if (slave != master || image != 0) meet_image(slave, master, image, law, outward, margin);
  }

  void meet_image(int slave, int master, int image, const Law& law, double outward, double margin) {
    const PresentBody& on = bodies[master];
    const Vec2 shift(image * period, 0);
    for (int i = 0; i < outlines[slave].count; ++i) {
      const Vec2 point = bodies[slave].outline.node(i) - shift;
      if (!on.box.contains(point, margin)) continue;
      if (const auto nearest = nearest_segment(on.outline, 0, on.outline.count(), point, outward))
        stand_beside({slave, i, master, image}, *nearest, point, law, outward);
    }
  }

  /// A wall goes on and on: its segments are counted so that each node sees one turn of it to either side.
  void meet_wall(int slave, int master, const Law& law, double outward) {
    const PresentBody& on = bodies[master];
    const double middle = (on.box.low.x() + on.box.high.x()) / 2;
    for (int i = 0; i < outlines[slave].count; ++i) {
      const Vec2 point = bodies[slave].outline.node(i);
      const int turn = static_cast<int>(std::lround((point.x() - middle) / on.outline.turn_shift())),
                count = on.outline.count();
      if (const auto nearest = nearest_segment(on.outline, (turn - 1) * count, 3 * count, point, outward))
        stand_beside({slave, i, master, 0}, *nearest, point, law, outward);
    }
  }

  void stand_beside(const Encounter& encounter, const Nearest& nearest, const Vec2& point, const Law& law,
                    double outward) {
    const PresentBody& on = bodies[encounter.master];
    if (corners[encounter.master].any()) outward += tie * on.longest;
    if (nearest.height > outward || nearest.height < -deepest * on.longest) return;
    const SlaveNode node = slave_node(encounter, point);
    const Face face{on.outline, corners[encounter.master],
                    std::min(corners[encounter.slave].longest(), corners[encounter.master].longest())};
    const std::optional<Footing> stand = footing(face, nearest.segment, node, outward);
    if (!stand) return;
    const auto& [segment, length] = *stand;
    const Projection at = project(point, on.outline.node(segment), on.outline.node(segment + 1));
    const auto found = accepted.find(encounter);
    ContactMemory before = found == accepted.end() ? ContactMemory() : found->second;
    if (initial && law.bonds() && at.gap.value <= law.bond_gap) before.damage = 0;
    ContactMemory& memory = trial[encounter];
    memory.beside = true;
    memory.segment = segment;
    memory.xi = at.xi.value;
    memory.angle = at.angle.value;
    if (at.gap.value < law.reach)
      touch(encounter, length, at, law, before, memory);
    else
      result.dissipated += length.value.value / 2 * parting_loss(law, before, at.gap.value);
  }

  /// `point`: where the master sees it.
  SlaveNode slave_node(const Encounter& encounter, const Vec2& point) const {
    const PresentOutline& outline = bodies[encounter.slave].outline;
    const Corners& own = corners[encounter.slave];
    const int i = encounter.node;
    const Vec2 shift = point - outline.node(i);
    return {outline.node(i - 1) + shift,
            point,
            outline.node(i + 1) + shift,
            own.length(i - 1),
            own.length(i),
            own.at(i),
            own.any() && own.at(i - 1),
            own.any() && own.at(i + 1)};
  }

  void touch(const Encounter& encounter, const NodeLength& whole, const Projection& at, const Law& law,
             const ContactMemory& before, ContactMemory& memory) {
    const int segment = memory.segment;
    const PresentBody& on = bodies[encounter.master];
    Motion motion;
    if (before.beside && law.shears()) motion = motion_along(on.outline, before, segment, at);
    const Response response = respond(law, before, at.gap.value, motion.by_element.value, initial);
    memory.slip = response.slip;
    memory.friction_slip = response.friction_slip;
    memory.damage = response.damage;
    memory.opening = response.opening;
    const auto length = whole.value * 0.5;  // one of two passes
    result.stored += length.value * response.stored;
    result.dissipated += length.value * response.dissipated;
    ContactElement element = make_element(on.outline, at, motion, response, length.value);
    const PresentOutline& slave = bodies[encounter.slave].outline;
    element.node = {slave.index(encounter.node), on.outline.index(segment), on.outline.index(segment + 1)};
    if (!length.gradient.isZero(0)) {
      result.lengths.push_back(make_length_element(length, response.stored, element));
      result.lengths.back().node = {slave.index(encounter.node - 1),
                                    element.node[0],
                                    slave.index(encounter.node + 1),
                                    element.node[1],
                                    element.node[2],
                                    on.outline.index(segment - 1),
                                    on.outline.index(segment + 2),
                                    on.outline.index(whole.corner[0]),
                                    on.outline.index(whole.corner[1])};
    }
    element.body = {encounter.slave, encounter.master};
    element.depth = std::max(0.0, -at.gap.value) / on.longest;
    if (initial && element.depth > 0)
      element.compression = length.value * (response.stored - respond(law, before, 0, 0, true).stored);
    result.elements.push_back(std::move(element));
  }

  static ContactElement make_element(const PresentOutline& master, const Projection& at, const Motion& motion,
                                     const Response& response, double length) {
    const Jet<6>::Gradient by_gap = at.gap.gradient, by_motion = motion.by_element.gradient, rate = at.rate();
    const double p = length * response.pressure, shear = length * response.shear;
    const Response::Gradient dp = length * response.pressure_by, dshear = length * response.shear_by;
    ContactElement element;
    element.force = -p * by_gap + shear * rate;
    element.tangent = -p * at.gap.hessian + shear * at.rate_derivative() -
                      by_gap * (dp[0] * by_gap + dp[1] * by_motion).transpose() +
                      rate * (dshear[0] * by_gap + dshear[1] * by_motion).transpose();
    for (const auto& [node, derivative] : motion.others)
      element.further.emplace_back(master.index(node), (dshear[1] * rate - dp[1] * by_gap) * derivative.transpose());
    element.gap = at.gap.value;
    element.pressure = response.pressure;
    element.shear = -response.shear;
    return element;
  }

  /// Of the energy length x stored; the element's forces are length x what they are a unit of it.
  static LengthElement make_length_element(const Jet<LengthElement::size>& length, double stored,
                                           const ContactElement& element) {
    constexpr int own[6] = {2, 3, 6, 7, 8, 9};  // places of the element's coordinates among the length's
    Eigen::Matrix<double, LengthElement::size, 1> of_unit_length;
    of_unit_length.setZero();
    if (length.value > 0)
      for (int i = 0; i < 6; ++i) of_unit_length[own[i]] = element.force[i] / length.value;
    LengthElement result;
    result.force = stored * length.gradient;
    result.tangent = stored * length.hessian + length.gradient * of_unit_length.transpose() +
                     of_unit_length * length.gradient.transpose();
    return result;
  }

  std::vector<ContactOutline> outlines;
  std::vector<Corners> corners;  ///< [bodies]
  PairLaws laws;
  std::optional<IntegratedContacts> integrated;  ///< in place of all that follows
  double period = 0, skin = 0;                   ///< m
  std::vector<std::vector<double>> lengths;      ///< [bodies][nodes], m
  Memories accepted, trial;
  bool initial = true;  ///< nothing accepted yet

  // Of the evaluation at hand.
  std::vector<PresentBody> bodies;
  ContactResult result;
};

Points forces_on_nodes(const ContactResult& result, std::size_t nodes) {
  Points forces(nodes, Vec2(0, 0));
  for (const ContactElement& element : result.elements)
    for (int i = 0; i < 3; ++i) forces[static_cast<std::size_t>(element.node[i])] -= element.force.segment<2>(2 * i);
  for (const LengthElement& element : result.lengths)
    for (int i = 0; i < LengthElement::size / 2; ++i)
      forces[static_cast<std::size_t>(element.node[i])] -= element.force.segment<2>(2 * i);
  for (const ContactPatch& patch : result.patches)
    for (std::size_t i = 0; i < patch.node.size(); ++i)
      forces[static_cast<std::size_t>(patch.node[i])] -= patch.force.segment<2>(2 * static_cast<Eigen::Index>(i));
  return forces;
}

Contacts::Contacts(const Scene& scene, std::vector<ContactOutline> outlines)
    : implementation_(std::make_unique<Implementation>(scene, std::move(outlines))) {}

Contacts::~Contacts() = default;

ContactResult Contacts::evaluate(const Points& x) { return implementation_->evaluate(x); }

void Contacts::accept() {
  if (implementation_->integrated) implementation_->integrated->accept();
  implementation_->accepted = implementation_->trial;
  implementation_->initial = false;
}

}  // namespace pliant::reference
