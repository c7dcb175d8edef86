#pragma once

#include <map>
#include <optional>

#include "reference/contact/contact_samples.hpp"
#include "reference/contact/contacts.hpp"

namespace pliant::reference {

/// What a slave node remembers of one other body where contact is an integral, as of the last accepted state.
struct NodeSlip {
  double length = 0;  ///< integral of its hat function over what was in touch, m
  double slip = 0;    ///< elastic, m
};
using NodeSlips = std::map<int, NodeSlip>;  ///< by nodes of the slave, a wall's counted on

/// Both outlines as last accepted.
struct PastOutlines {
  const PresentOutline& slave;
  const PresentOutline& master;
};

/// One pass of an integrated contact: segments of the slave against one image of the master.
struct PassSetting {
  Sampling where;
  const Law& law;
  std::vector<int> segments;         ///< of the slave
  std::vector<double> lengths;       ///< [segments of the slave] of the reference shape, m; empty: present ones count
  std::optional<PastOutlines> past;  ///< none: nothing has moved yet
};

struct PassResult {
  ContactPatch patch;
  NodeSlips slips;        ///< of nodes in touch
  double stored = 0;      ///< J/m
  double dissipated = 0;  ///< since the last accepted state, J/m
};

/// `slips`: as of the last accepted state. Without contact there are no nodes in the patch.
PassResult integrated_pass(const PassSetting& setting, const NodeSlips& slips);

/// What a node loses that is no longer in touch, J/m.
double lost_slip(const Law& law, const NodeSlip& slip);

}  // namespace pliant::reference
