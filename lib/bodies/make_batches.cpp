#include "bodies/make_batches.hpp"

#include <algorithm>
#include <map>

#include "bodies/node_arrays.hpp"
#include "bodies/nodewise_shape.hpp"
#include "bodies/own_bodies.hpp"
#include "bodies/same_topology_shapes.hpp"
#include "materials/with_law.hpp"

namespace pliant {
namespace {

void set_constants(const Scene& scene, const Body& body, bool counts, int lane, Batch& batch) {
  const Material& material = scene.materials[body.material];
  set_law_constants(material, lane, batch.constants);
  with_law(material, [&](const auto& law) {
    const auto [mu, lambda] = law.small_strains();
    batch.mu[lane] = mu, batch.lambda[lane] = lambda;
  });
  batch.density[lane] = material.density * body.scale * body.scale;
  batch.inverse_density[lane] = 1 / batch.density[lane];
  batch.scale[lane] = body.scale;
  batch.inverse_scale[lane] = 1 / body.scale;
  batch.scaled |= body.scale != 1;
  batch.weight[lane] = counts ? body.scale * body.scale : 0;
  batch.viscosity[lane] = material.viscosity;
  batch.mass_damping[lane] = material.mass_damping;
  batch.centre_x[lane] = body.centre.x();
  batch.centre_y[lane] = body.centre.y();
}

class BatchMaker {
 public:
  explicit BatchMaker(Model& model) : model_(model) {}

  void make(bool nodewise) {
    std::vector<std::pair<int, int>> alone;  // group and index in it of bodies to be vectorised nodewise
    for (int g = 0; g < static_cast<int>(model_.groups.size()); ++g) {
      const int count = static_cast<int>(model_.groups[g].bodies.size());
      for (int first = 0; first < count; first += lane_count) {
        const int bodies = std::min(lane_count, count - first);
        if (!nodewise || bodies > sparse_bodies)
          add(g, first, bodies, Layout::shared);
        else
          for (int i = 0; i < bodies; ++i) alone.emplace_back(g, first + i);
      }
    }
    model_.lane_batches = static_cast<int>(model_.batches.size());
    for (const auto& [group, body] : alone) add(group, body, 1, Layout::nodewise);
  }

 private:
  void add(int group, int first, int count, Layout layout) {
    const int* members = &model_.groups[group].bodies[first];
    const auto body_in = [&](int lane) -> Body& { return model_.bodies[members[std::min(lane, count - 1)]]; };
    Batch batch{};
    batch.group = group, batch.first = first, batch.count = count;
    batch.offset = model_.compliant_size;
    batch.shape = body_in(0).compliant_shape;
    batch.layout = layout;
    bool alike = true;
    for (int lane = 0; lane < lane_count; ++lane) {
      Body& body = body_in(lane);
      alike &= body.compliant_shape == batch.shape;
      set_constants(model_.scene, body, lane < count || layout == Layout::nodewise, lane, batch);
      if (lane < count) body.batch = static_cast<int>(model_.batches.size()), body.lane = lane;
    }
    batch.viscous = largest(batch.viscosity) > 0;
    batch.mass_damped = largest(batch.mass_damping) > 0;
    batch.slots = model_.shape_of(batch).nodes();
    if (layout == Layout::nodewise) make_nodewise(batch);
    if (!alike) store_by_lane(batch, body_in);
    model_.compliant_size += 2 * static_cast<std::size_t>(batch.slots);
    lay_out_memory(batch);
    add_regions(batch);
    model_.batches.push_back(batch);
  }

  void lay_out_memory(Batch& batch) {
    batch.points = batch.layout == Layout::nodewise
                       ? model_.nodewise_shape_of(batch).points() / lane_count
                       : static_cast<int>(
                             with_tables(model_, batch, [](const auto& tables) { return tables.table.weight.size(); }));
    batch.memory = model_.material_memory;
    with_law_type<Lanes>(model_.groups[batch.group].law, [&]<class Law>(std::type_identity<Law>) {
      model_.material_memory += internal_variable_count<Law> * static_cast<std::size_t>(batch.points);
    });
  }

  void make_nodewise(Batch& batch) {
    const auto [found, is_new] = nodewise_.try_emplace(batch.shape, static_cast<int>(model_.nodewise_shapes.size()));
    if (is_new) model_.nodewise_shapes.push_back(make_nodewise_shape(model_.shape_of(batch).space));
    batch.tables = found->second;
    batch.slots = model_.nodewise_shape_of(batch).slots();
  }

  template <class BodyIn>
  void store_by_lane(Batch& batch, BodyIn&& body_in) {
    const Discretisation* shapes[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) shapes[lane] = &model_.shape_of(body_in(lane)).space;
    batch.layout = Layout::same_topology;
    batch.tables = static_cast<int>(model_.same_topology_shapes.size());
    model_.same_topology_shapes.push_back(unite(shapes));
  }

  void add_regions(Batch& batch) {
    const int number = static_cast<int>(model_.batches.size());
    batch.first_region = static_cast<int>(model_.regions.size());
    if (batch.layout != Layout::nodewise) return model_.regions.push_back({number, 0, 0, batch.slots});
    const auto cut = [&](int total, int step, auto add) {
      for (int first = 0; first < total; first += step) add(first, std::min(total, first + step));
    };
    cut(batch.slots, NodewiseShape::region_slots, [&](int first, int last) {
      model_.regions.push_back({number, first / NodewiseShape::region_slots, first, last});
    });
    batch.regions = static_cast<int>(model_.regions.size()) - batch.first_region;
    cut(model_.nodewise_shape_of(batch).points(), NodewiseShape::chunk_points,
        [&](int first, int last) { model_.point_chunks.push_back({number, first, last}); });
    cut(model_.outlines[model_.shape_of(batch).outline].count, NodewiseShape::chunk_nodes,
        [&](int first, int last) { model_.outline_chunks.push_back({number, first, last}); });
  }

  Model& model_;
  std::map<int, int> nodewise_;  ///< by compliant shape: index of its nodewise shape
};

/// Number of nodes of bodies that would leave most of their lanes empty.
int sparse_nodes(const Model& model) {
  int nodes = 0;
  for (const CompliantGroup& group : model.groups)
    if (const int rest = static_cast<int>(group.bodies.size()) % lane_count; rest <= sparse_bodies)
      nodes += rest * model.shapes[group.shape].nodes();
  return nodes;
}

}  // namespace

void make_batches(Model& model, int least_sparse_nodes) {
  BatchMaker(model).make(sparse_nodes(model) >= std::max(1, least_sparse_nodes));
  model.own = all_bodies(model);
}

}  // namespace pliant
