#pragma once

#include <string>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

/// A compliant body whose outline crosses itself.
struct Fold {
  int body;
  Vec2 place;  ///< node beside the crossing, m
};

/// All such bodies. Their material overlaps itself there, although J > 0. None with self-contact: the overlaps that a
/// penalty needs look like folds that are too narrow for it.
std::vector<Fold> find_folds(const Model& model, const OutlineField& position);

/// Text that names the first of these bodies, at least one, and says what to change. `time`: of the simulation, s.
std::string fold_warning(const Model& model, const std::vector<Fold>& folds, double time);

}  // namespace pliant
