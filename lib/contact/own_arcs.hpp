#pragma once

#include <vector>

#include "contact/patch.hpp"

namespace pliant {

/// Which segments of its own outline a body's nodes may touch: all but those always near along it, and the far side of
/// the limb that a node stands on, which contact would take for a surface that the node has come through.
/// A segment is on that far side if the node sees it from inside in the reference shape, at a sine of 1/4 or more,
/// and no further off than six times what contact sees into a body. A limb must bend on itself within four times its
/// thickness for such two to touch, and is strained by 40 % and more then.
class OwnArcs {
 public:
  /// Nodes whose arcs are one, and segments on either side of them that are always near.
  static constexpr int together = 2, unseen = 2;

  /// `skin`: m. Nothing where bodies do not touch themselves.
  OwnArcs(const Model& model, double skin);

  /// For nodes [begin, begin + together) of an outline; begin is a multiple of `together`.
  const std::vector<Arc>& of(int outline, int begin) const { return arcs_[outline][begin / together]; }

 private:
  std::vector<std::vector<std::vector<Arc>>> arcs_;  ///< [outlines][nodes/together]
};

}  // namespace pliant
