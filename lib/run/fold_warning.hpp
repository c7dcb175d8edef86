#pragma once

#include <string>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

/// A compliant body whose outline crosses itself.
struct Fold {
  int body;
  Vec2 place;  ///< start of a segment that crosses another one, m
};

/// All such bodies. Material overlaps there, which no Jacobian shows. None with self-contact: the overlaps that it needs
/// cannot be told from folds that are too narrow for it.
std::vector<Fold> find_folds(const Model& model, const OutlineField& position);

/// Names such bodies and says what to change; empty without any.
std::string fold_warning(const Model& model, const std::vector<Fold>& folds);

}  // namespace pliant
