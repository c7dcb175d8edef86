#pragma once

#include <map>
#include <optional>

#include "reference/contact/contact_samples.hpp"
#include "reference/contact/contacts.hpp"

namespace pliant::reference {

/// History variables of a slave node and one partner in integrated contact, at the last accepted state.
struct NodeSlip {
  double length = 0;  ///< integral of its hat function over the length in contact, m
  double slip = 0;    ///< elastic, m
};
using NodeSlips = std::map<int, NodeSlip>;  ///< by nodes of the slave; those of a wall are numbered beyond its period

/// Both outlines at the last accepted state.
struct PastOutlines {
  const PresentOutline& slave;
  const PresentOutline& master;
  Vec2 shift;  ///< of the master's image, m
};

/// One half pass of an integrated contact: segments of the slave against one image of the master.
struct PassSetting {
  Sampling where;
  const Law& law;
  std::vector<int> segments;    ///< of the slave
  std::vector<double> lengths;  ///< [segments of the slave] in the reference shape, m; empty: current lengths count
  std::optional<PastOutlines> past;  ///< none: no displacement yet
};

struct PassResult {
  ContactPatch patch;
  NodeSlips slips;        ///< of nodes in contact
  double stored = 0;      ///< J/m
  double dissipated = 0;  ///< since the last accepted state, J/m
};

/// `slips`: those of the last accepted state. Without contact the patch has no nodes.
PassResult integrated_pass(const PassSetting& setting, const NodeSlips& slips);

/// Energy that a node loses at the end of contact, J/m.
double lost_slip(const Law& law, const NodeSlip& slip);

}  // namespace pliant::reference
