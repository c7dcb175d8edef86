#include "reference/contact/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <map>

#include "core/errors.hpp"
#include "reference/contact/integrated_contacts.hpp"
#include "reference/contact/law.hpp"
#include "reference/contact/pair_laws.hpp"
#include "reference/contact/projection.hpp"
#include "reference/contact/reference_outline.hpp"
#include "reference/contact/slip.hpp"

namespace pliant::reference {
namespace {

constexpr double deepest = 1.5;  ///< detection depth over the master's longest segment

/// Key of a history: a node of one body and a periodic image of another, or of its own.
struct Encounter {
  int slave = 0, node = 0;  ///< node: in the slave's own outline
  int master = 0;
  Image image;  ///< 0 for a wall, whose segments are numbered over all turns instead
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

/// Current configuration of one body.
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
  if (settings.self_contact) throw InputError("[contact] self_contact = true: not in the reference solver");
}

}  // namespace

struct Contacts::Implementation {
  Implementation(const Scene& scene, std::vector<ContactOutline> given)
      : outlines(std::move(given)), laws(scene, outlines), start(scene), periods(start) {
    refuse_settings(scene.contact);
    find_integrated(scene.contact.quadrature);
    if (scene.contact.length == ContactLength::current && !all_are_integrated())
      throw InputError(
          "[contact] length = \"current\" of contacts at nodes: the reference solver knows \"reference\" only there");
    integrals.emplace(scene, outlines, laws, [this](int a, int b) { return is_integrated(a, b); });
    double finest = std::numeric_limits<double>::infinity();
    for (const ContactOutline& outline : outlines) {
      lengths.push_back(tributary_lengths(outline));
      finest = std::min(finest, mean_spacing(outline));
    }
    skin = scene.skin * finest;
  }

  /// Finds integrated contacts: by default those with an outline that has corners. Bonds belong to nodes.
  void find_integrated(ContactQuadrature quadrature) {
    std::vector<bool> has_corners;
    for (const ContactOutline& outline : outlines) has_corners.push_back(ReferenceOutline(outline).has_corners());
    for (std::size_t a = 0; a < outlines.size(); ++a)
      for (std::size_t b = 0; b < outlines.size(); ++b) {
        const std::optional<Law>& law = laws.between(static_cast<int>(a), static_cast<int>(b));
        const bool wanted = quadrature == ContactQuadrature::segments ||
                            (quadrature == ContactQuadrature::automatic && (has_corners[a] || has_corners[b]));
        integrated.push_back(law && wanted);
      }
  }
  bool is_integrated(int a, int b) const {
    return integrated[static_cast<std::size_t>(a) * outlines.size() + static_cast<std::size_t>(b)];
  }
  bool all_are_integrated() const {
    for (int a = 0; a < static_cast<int>(outlines.size()); ++a)
      for (int b = 0; b < static_cast<int>(outlines.size()); ++b)
        if (laws.between(a, b) && !is_integrated(a, b)) return false;
    return true;
  }

  ContactResult evaluate(const Points& x, const Periods& present) {
    periods = present;
    evaluated = x;
    trial.clear();
    result = integrals->evaluate(x, periods);
    bodies.clear();
    for (const ContactOutline& outline : outlines) bodies.emplace_back(outline, x);
    const int count = static_cast<int>(outlines.size());
    for (int slave = 0; slave < count; ++slave)
      for (int master = 0; master < count; ++master)
        if (const std::optional<Law>& law = laws.between(slave, master); law && !is_integrated(slave, master))
          meet(slave, master, *law);
    for (const auto& [encounter, memory] : accepted)
      if (!trial.contains(encounter)) part(encounter, memory);
    return std::move(result);
  }

  /// Adds the energy that a node loses with its history when it no longer has a projection onto the other body.
  void part(const Encounter& encounter, const ContactMemory& memory) {
    result.dissipated +=
        weight(encounter) * parting_loss(*laws.between(encounter.slave, encounter.master), memory.slip);
  }

  /// Length of a node in one of the two half passes, m.
  double weight(const Encounter& encounter) const { return lengths[encounter.slave][encounter.node] / 2; }

  /// All nodes of one body against another and its periodic images.
  void meet(int slave, int master, const Law& law) {
    const Box &a = bodies[slave].box, &b = bodies[master].box;
    const double outward = law.reach + skin;
    // Heights grow slower than distances beyond an end. At tips sharper than 29 degrees nodes may be missed beyond this
    // margin, far from any contact.
    const double margin = 4 * outward;
    if (outlines[master].wall) {
      if (a.low.y() <= b.high.y() + margin && b.low.y() <= a.high.y() + margin) meet_wall(slave, master, law, outward);
      return;
    }
    const Vec2 around = Vec2::Constant(margin);
    for (const Image& image : periods.between(a.low - b.high - around, a.high - b.low + around))
      if (slave != master || image != Image{}) meet_image(slave, master, image, law, outward, margin);
  }

  void meet_image(int slave, int master, const Image& image, const Law& law, double outward, double margin) {
    const PresentBody& on = bodies[master];
    const Vec2 shift = periods.shift(image);
    for (int i = 0; i < outlines[slave].count; ++i) {
      const Vec2 point = bodies[slave].outline.node(i) - shift;
      if (!on.box.contains(point, margin)) continue;
      if (const auto nearest = nearest_segment(on.outline, 0, on.outline.count(), point, outward))
        stand_beside({slave, i, master, image}, *nearest, point, law, outward);
    }
  }

  /// Contact with a wall, which is periodic: its segments are numbered so that each node has one turn of it to either
  /// side.
  void meet_wall(int slave, int master, const Law& law, double outward) {
    const PresentBody& on = bodies[master];
    const double middle = (on.box.low.x() + on.box.high.x()) / 2;
    for (int i = 0; i < outlines[slave].count; ++i) {
      const Vec2 point = bodies[slave].outline.node(i);
      const int turn = static_cast<int>(std::lround((point.x() - middle) / on.outline.turn_shift())),
                count = on.outline.count();
      if (const auto nearest = nearest_segment(on.outline, (turn - 1) * count, 3 * count, point, outward))
        stand_beside({slave, i, master, {}}, *nearest, point, law, outward);
    }
  }

  void stand_beside(const Encounter& encounter, const Nearest& nearest, const Vec2& point, const Law& law,
                    double outward) {
    const PresentBody& on = bodies[encounter.master];
    if (nearest.height > outward || nearest.height < -deepest * on.longest) return;
    const Projection at = project(point, on.outline.node(nearest.segment), on.outline.node(nearest.segment + 1));
    const auto found = accepted.find(encounter);
    const ContactMemory before = found == accepted.end() ? ContactMemory() : found->second;
    ContactMemory& memory = trial[encounter];
    memory.beside = true;
    memory.segment = nearest.segment;
    memory.xi = at.xi.value;
    memory.angle = at.angle.value;
    memory.height = at.height.value;
    memory.gap = at.gap.value;
    if (at.gap.value < law.reach)
      touch(encounter, at, law, before, memory);
    else
      result.dissipated += weight(encounter) * parting_loss(law, before.slip);
  }

  void touch(const Encounter& encounter, const Projection& at, const Law& law, const ContactMemory& before,
             ContactMemory& memory) {
    const int segment = memory.segment;
    const PresentBody& on = bodies[encounter.master];
    MotionAlong motion;
    if (before.beside && law.shears())
      motion = motion_along(on.outline, {outlines[encounter.master], past}, before, segment, at);
    const Response response = respond(law, before.slip, at.gap.value, motion.by_element.value);
    memory.slip = response.slip;
    const double length = weight(encounter);
    result.stored += length * response.stored;
    result.dissipated += length * response.dissipated;
    ContactElement element = make_element(on.outline, at, motion, response, length);
    const PresentOutline& slave = bodies[encounter.slave].outline;
    element.node = {slave.index(encounter.node), on.outline.index(segment), on.outline.index(segment + 1)};
    element.body = {encounter.slave, encounter.master};
    element.lever.image = encounter.image;
    const Vec2 point = slave.node(encounter.node) - periods.shift(encounter.image);
    for (const int end : {0, 1})
      element.lever.add(element.force.segment<2>(2 + 2 * end), on.outline.node(segment + end) - point);
    element.depth = std::max(0.0, -at.gap.value) / on.longest;
    if (initial && element.depth > 0) element.compression = length * (response.stored - respond(law, 0, 0, 0).stored);
    result.elements.push_back(std::move(element));
  }

  static ContactElement make_element(const PresentOutline& master, const Projection& at, const MotionAlong& motion,
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

  std::vector<ContactOutline> outlines;
  PairLaws laws;
  std::vector<bool> integrated;  ///< [bodies x bodies] whether contact is integrated, not collocated at nodes
  std::optional<IntegratedContacts> integrals;
  Periods start, periods;                    ///< at the start of the scene, of the current evaluation
  double skin = 0;                           ///< m
  std::vector<std::vector<double>> lengths;  ///< [bodies][nodes], m
  Memories accepted, trial;
  Points evaluated, past;  ///< outlines of the last evaluation, and of the last accepted one, m
  bool initial = true;     ///< nothing accepted yet

  // Of the current evaluation.
  std::vector<PresentBody> bodies;
  ContactResult result;
};

Points forces_on_nodes(const ContactResult& result, std::size_t nodes) {
  Points forces(nodes, Vec2(0, 0));
  for (const ContactElement& element : result.elements)
    for (int i = 0; i < 3; ++i) forces[static_cast<std::size_t>(element.node[i])] -= element.force.segment<2>(2 * i);
  for (const ContactPatch& patch : result.patches)
    for (std::size_t i = 0; i < patch.node.size(); ++i)
      forces[static_cast<std::size_t>(patch.node[i])] -= patch.force.segment<2>(2 * static_cast<Eigen::Index>(i));
  return forces;
}

Contacts::Contacts(const Scene& scene, std::vector<ContactOutline> outlines)
    : implementation_(std::make_unique<Implementation>(scene, std::move(outlines))) {}

Contacts::~Contacts() = default;

ContactResult Contacts::evaluate(const Points& x, const Periods& periods) {
  return implementation_->evaluate(x, periods);
}

ContactResult Contacts::evaluate(const Points& x) { return evaluate(x, implementation_->start); }

void Contacts::accept() {
  implementation_->integrals->accept();
  implementation_->accepted = implementation_->trial;
  implementation_->past = implementation_->evaluated;
  implementation_->initial = false;
}

}  // namespace pliant::reference
