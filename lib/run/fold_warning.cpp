#include "run/fold_warning.hpp"

#include <string>

#include <fmt/format.h>

#include "geometry/polygon_rules.hpp"

namespace pliant {

std::vector<Fold> find_folds(const Model& model, const OutlineField& position) {
  std::vector<Fold> folds;
  if (model.scene.contact.self_contact) return folds;
  Points outline;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].rigid >= 0) continue;
    outline.clear();
    for (int i = 0; i < model.outline_of(b).count; ++i) outline.push_back(position.at(model.outline_offset[b] + i));
    if (const PolygonDefect defect = polygon_defect(outline); !defect.text.empty())
      folds.push_back({b, outline[defect.point]});
  }
  return folds;
}

std::string fold_warning(const Model& model, const std::vector<Fold>& folds, double time) {
  const auto& [body, place] = folds.front();
  const std::string others = folds.size() == 1   ? ""
                             : folds.size() == 2 ? ", and another body has"
                                                 : fmt::format(", and {} other bodies have", folds.size() - 1);
  return fmt::format(
      "{} has folded through itself near ({:.4g}, {:.4g}) m by t = {:.6g} s{}: it overlaps itself there, and contact "
      "is wrong; more outline nodes or [contact] self_contact = true may help (docs/limits.md, \"Creases\")",
      model.bodies[body].name, place.x(), place.y(), time, others);
}

}  // namespace pliant
