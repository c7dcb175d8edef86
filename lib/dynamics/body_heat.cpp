#include "dynamics/body_heat.hpp"

#include <algorithm>
#include <limits>

namespace pliant {
namespace {

const Material& material_of(const Model& model, int body) {
  return model.scene.materials[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(body)].material)];
}

/// Calls visit(body, heat) for the bodies of which the dissipation of a batch or chunk is.
template <class Visit>
void for_each_body(const Model& model, const MaterialDissipation& material, double dt, Visit&& visit) {
  const std::size_t count = std::max(material.power.size(), material.loss.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Lanes power = material.power.empty() ? Lanes{} : material.power[i];
    const Lanes loss = material.loss.empty() ? Lanes{} : material.loss[i];
    const bool is_chunk = i >= static_cast<std::size_t>(model.lane_batches);
    const std::size_t chunk = i - (is_chunk ? static_cast<std::size_t>(model.lane_batches) : 0);
    const Batch& batch = model.batches[is_chunk ? static_cast<std::size_t>(model.point_chunks[chunk].batch) : i];
    const std::vector<int>& bodies = model.groups[batch.group].bodies;
    const auto of = [&](int body, double work, double lost) {
      visit(body, dt * work + material_of(model, body).taylor_quinney * lost);
    };
    if (is_chunk)
      of(bodies[batch.first], sum(power), sum(loss));
    else
      for (int lane = 0; lane < batch.count; ++lane) of(bodies[batch.first + lane], power[lane], loss[lane]);
  }
}

}  // namespace

bool tracks_heat(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& material) { return material.heat_capacity > 0; });
}

void add_heat(const Model& model, const MaterialDissipation& material, const std::vector<ContactPair>& pairs,
              const std::vector<PairTotals>& totals, double dt, std::vector<double>& heat) {
  if (dt == 0) return;
  for_each_body(model, material, dt,
                [&](int body, double of_body) { heat[static_cast<std::size_t>(body)] += of_body; });
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const double half = 0.5 * (totals[p].dissipated + dt * totals[p].damping_power);
    heat[static_cast<std::size_t>(pairs[p].first)] += half;
    heat[static_cast<std::size_t>(pairs[p].second)] += half;
  }
}

double temperature_rise(const Model& model, int body, const std::vector<double>& heat) {
  const double capacity = material_of(model, body).heat_capacity;
  if (!(capacity > 0) || heat.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto b = static_cast<std::size_t>(body);
  return heat[b] / (model.bodies[b].mass * capacity);
}

}  // namespace pliant
