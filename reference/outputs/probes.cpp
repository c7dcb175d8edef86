#include "reference/outputs/probes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "reference/outputs/cell_stress.hpp"
#include "scene/quantities.hpp"

namespace pliant::reference {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Values = std::vector<double>;
/// Rows of a reduction: one per body or point, with weights for the mean.
struct Rows {
  std::vector<Values> values;
  std::vector<double> weights;
  void add(const Values& row, double weight = 1) { values.push_back(row), weights.push_back(weight); }
};
using Measurement = std::function<Rows(const View&, const Probe&, const std::vector<const Body*>&)>;

Values reduced(const Rows& rows, Reduction how, std::size_t columns) {
  Values result(columns, rows.values.empty() && how != Reduction::sum ? none : 0.0);
  for (std::size_t c = 0; c < columns && !rows.values.empty(); ++c) {
    double sum = 0, whole = 0, least = rows.values[0][c], largest = least;
    for (std::size_t i = 0; i < rows.values.size(); ++i) {
      const double value = rows.values[i][c], weight = how == Reduction::mean ? rows.weights[i] : 1;
      sum += weight * value, whole += weight;
      least = std::min(least, value), largest = std::max(largest, value);
    }
    result[c] = how == Reduction::sum   ? sum
                : how == Reduction::min ? least
                : how == Reduction::max ? largest
                                        : sum / whole;
  }
  return result;
}

/// Vector of each body's nodes, or of the body as a whole.
template <class AtNodes, class OfBody>
Rows motion(const View& view, const Probe& probe, const std::vector<const Body*>& bodies, AtNodes&& at_nodes,
            OfBody&& of_body, const Vector* angles) {
  Rows rows;
  for (const Body* body : bodies) {
    const Vec2 value =
        probe.node ? (view.*at_nodes)(*body)[static_cast<std::size_t>(*probe.node)] : Vec2(of_body(*body));
    Values row{value.x(), value.y()};
    if (angles) row.push_back(body->compliant() ? none : (*angles)[body->first_dof + 2]);
    rows.add(row);
  }
  return rows;
}

Rows position(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  return motion(
      view, probe, bodies, &View::positions_of, [&](const Body& b) { return view.mean(b, view.positions()); },
      &view.positions());
}

Rows velocity(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  return motion(
      view, probe, bodies, &View::velocities_of, [&](const Body& b) { return view.mean(b, view.velocities()); },
      &view.velocities());
}

Rows acceleration(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  return motion(
      view, probe, bodies, &View::accelerations_of, [&](const Body& b) { return view.mean(b, view.accelerations()); },
      nullptr);
}

Rows displacement(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  Rows rows;
  for (const Body* body : bodies) {
    Vec2 moved = view.mean(*body, view.positions()) - body->placed.centre;
    if (probe.node) {
      const auto node = static_cast<std::size_t>(*probe.node);
      moved = view.positions_of(*body)[node] - view.start_of(*body)[node];
    }
    rows.add({moved.x(), moved.y()});
  }
  return rows;
}

Vec2 contact_force(const View& view, const Body& body) {
  const Points forces = view.contact_forces();
  Vec2 sum(0, 0);
  for (std::size_t k = 0; k < body.outline.size(); ++k) sum += forces[static_cast<std::size_t>(body.first_outline) + k];
  return sum;
}

Rows force(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  Rows rows;
  for (const Body* body : bodies) {
    const Vec2 f = probe.node ? view.contact_forces()[static_cast<std::size_t>(body->first_outline + *probe.node)]
                              : contact_force(view, *body);
    rows.add({f.x(), f.y()});
  }
  return rows;
}

Rows friction_factor(const View& view, const Probe&, const std::vector<const Body*>& bodies) {
  Rows rows;
  for (const Body* body : bodies) {
    const Vec2 f = contact_force(view, *body);
    rows.add({f.y() == 0 ? none : f.x() / std::abs(f.y())});
  }
  return rows;
}

/// Sum of all contact forces over the sum of their magnitudes.
double momentum_error(const View& view) {
  Vec2 sum(0, 0);
  double magnitude = 0;
  for (const Vec2& f : view.contact_forces()) sum += f, magnitude += f.lpNorm<1>();
  return magnitude > 0 ? sum.lpNorm<1>() / magnitude : 0.0;
}

Rows energy(const View& view, const Probe&, const std::vector<const Body*>&) {
  const EnergyBalance& balance = view.run().balance();
  Rows rows;
  rows.add({balance.kinetic, balance.strain, balance.contact, balance.boundary, balance.dissipated(),
            balance.external_work(), balance.balance_error(), momentum_error(view)});
  return rows;
}

Rows works(const View& view, const Probe&, const std::vector<const Body*>&) {
  const EnergyBalance& balance = view.run().balance();
  Rows rows;
  rows.add({balance.work_of_loads, balance.work_of_gravity, balance.dissipated_by_contact,
            balance.dissipated_by_damping, balance.dissipated_by_plasticity, balance.dissipated_by_bonds});
  return rows;
}

Rows bonds(const View& view, const Probe&, const std::vector<const Body*>&) {
  const BondCounts counts = view.system().bonds().counts();
  Rows rows;
  rows.add(
      {static_cast<double>(counts.whole), static_cast<double>(counts.softening), static_cast<double>(counts.torn)});
  return rows;
}

Rows kinetic_energy(const View& view, const Probe&, const std::vector<const Body*>& bodies) {
  Rows rows;
  for (const Body* body : bodies) rows.add({view.kinetic_energy(*body)});
  return rows;
}

Rows energy_of_strain(const View& view, const Probe&, const std::vector<const Body*>& bodies) {
  Rows rows;
  for (const Body* body : bodies) {
    const std::vector<PointStress> points = view.stresses_of(*body);
    double energy = 0;
    for (std::size_t g = 0; g < points.size(); ++g)
      energy += view.weights_of(*body)[static_cast<Eigen::Index>(g)] * points[g].energy;
    rows.add({energy});
  }
  return rows;
}

Rows area(const View& view, const Probe&, const std::vector<const Body*>& bodies) {
  const Points x = view.bodies().outline_positions(view.positions());
  Rows rows;
  for (const Body* body : bodies) {
    const auto first = x.begin() + body->first_outline;
    rows.add({polygon_properties(Points(first, first + static_cast<std::ptrdiff_t>(body->outline.size()))).area});
  }
  return rows;
}

Rows diameter(const View& view, const Probe&, const std::vector<const Body*>& bodies) {
  const Points x = view.bodies().outline_positions(view.positions());
  Rows rows;
  for (const Body* body : bodies) {
    Vec2 low = x[static_cast<std::size_t>(body->first_outline)], high = low;
    for (std::size_t k = 0; k < body->outline.size(); ++k) {
      const Vec2& p = x[static_cast<std::size_t>(body->first_outline) + k];
      low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    rows.add({high.x() - low.x(), high.y() - low.y()});
  }
  return rows;
}

/// Value at each integration point. Means of J are over reference area, those of stresses over current area.
Measurement at_points(double (*value)(const PointStress&), bool present) {
  return [=](const View& view, const Probe&, const std::vector<const Body*>& bodies) {
    Rows rows;
    for (const Body* body : bodies) {
      const std::vector<PointStress> points = view.stresses_of(*body);
      for (std::size_t g = 0; g < points.size(); ++g)
        rows.add({value(points[g])},
                 view.weights_of(*body)[static_cast<Eigen::Index>(g)] * (present ? points[g].jacobian : 1));
    }
    return rows;
  };
}

Rows stress_of_cell(const View& view, const Probe&, const std::vector<const Body*>&) {
  const CellStress stress = cell_stress(view);
  const Eigen::Matrix2d &k = stress.kinetic, s = stress.contact + k;
  Rows rows;
  rows.add({s(0, 0), s(0, 1), s(1, 0), s(1, 1), k(0, 0), k(0, 1), k(1, 0), k(1, 1), -s.trace() / 2});
  return rows;
}

Rows gradient_of_cell(const View& view, const Probe&, const std::vector<const Body*>&) {
  const Periods now = view.system().periods(view.run().motion().time);
  const Vec2 start = view.bodies().scene().cell->periods;
  const Eigen::Matrix2d f = now.vectors() * start.cwiseInverse().asDiagonal();
  Rows rows;
  rows.add({f(0, 0), f(0, 1), f(1, 0), f(1, 1), now.area()});
  return rows;
}

/// In the whole of a cell.
Rows solid_fraction(const View& view, const Probe& probe, const std::vector<const Body*>& bodies) {
  double solid = 0;
  for (const Values& one : area(view, probe, bodies).values) solid += one[0];
  Rows rows;
  rows.add({solid / view.system().periods(view.run().motion().time).area()});
  return rows;
}

const std::map<std::string, Measurement>& measures() {
  static const std::map<std::string, Measurement> all{
      {"position", position},
      {"velocity", velocity},
      {"acceleration", acceleration},
      {"displacement", displacement},
      {"force", force},
      {"friction_factor", friction_factor},
      {"energy", energy},
      {"works", works},
      {"bonds", bonds},
      {"kinetic_energy", kinetic_energy},
      {"strain_energy", energy_of_strain},
      {"area", area},
      {"diameter", diameter},
      {"cell_stress", stress_of_cell},
      {"cell_gradient", gradient_of_cell},
      {"solid_fraction", solid_fraction},
      {"von_mises", at_points(von_mises, true)},
      {"plastic_strain", at_points([](const PointStress& s) { return s.plastic_strain; }, false)},
      {"jacobian", at_points([](const PointStress& s) { return s.jacobian; }, false)}};
  return all;
}

/// Whether a probe is measured: a solid fraction that of a whole cell.
bool is_measured(const Probe& probe, const Scene& scene) {
  if (probe.quantity == "solid_fraction" && (!scene.cell || probe.box || !probe.between.empty())) return false;
  return measures().contains(probe.quantity);
}

/// Whether a body is among those that a probe names.
bool is_named(const Bodies& bodies, const Body& body, const Probe& probe) {
  const std::string& of = probe.of;
  if (probe_quantity(probe.quantity).of == ProbeQuantity::Of::compliant && !body.compliant()) return false;
  if (body.placed.name == of) return true;
  if (body.placed.wall) return false;
  return of == "all" || of == (body.compliant() ? "compliant" : "rigid") ||
         of == bodies.scene().grains[body.placed.grains].name;
}

}  // namespace

ProbeFile::ProbeFile(const Bodies& bodies, const std::filesystem::path& folder)
    : file_(folder / "probes.csv", choose(bodies)) {}

std::vector<std::string> ProbeFile::choose(const Bodies& bodies) {
  std::vector<std::string> columns{"time [s]"};
  for (const Probe& probe : bodies.scene().probes) {
    if (!is_measured(probe, bodies.scene())) {
      left_out_.push_back(probe.name);
      continue;
    }
    Entry entry{.probe = probe, .bodies = {}};
    for (std::size_t b = 0; b < bodies.all().size(); ++b)
      if (is_named(bodies, bodies.all()[b], probe)) entry.bodies.push_back(static_cast<int>(b));
    for (const std::string& column : probe_quantity(probe.quantity).columns)
      columns.push_back(probe.name + "." + column);
    entry.columns = probe_quantity(probe.quantity).columns.size();
    entries_.push_back(std::move(entry));
  }
  return columns;
}

double ProbeFile::next_time() const {
  double next = std::numeric_limits<double>::infinity();
  for (const Entry& entry : entries_) next = std::min(next, static_cast<double>(entry.count) * entry.probe.period);
  return next;
}

void ProbeFile::record_due(const View& view) {
  const double time = view.run().motion().time;
  if (time < next_time() * (1 - 1e-12)) return;
  Values row{time};
  for (Entry& entry : entries_) {
    Values values(entry.columns, none);
    if (time >= static_cast<double>(entry.count) * entry.probe.period * (1 - 1e-12)) {
      std::vector<const Body*> chosen;
      for (const int b : entry.bodies) chosen.push_back(&view.bodies().all()[static_cast<std::size_t>(b)]);
      const auto& reductions = probe_quantity(entry.probe.quantity).reductions;
      const Reduction how = entry.probe.reduce.value_or(reductions.empty() ? Reduction::sum : reductions.front());
      values = reduced(measures().at(entry.probe.quantity)(view, entry.probe, chosen), how, entry.columns);
      ++entry.count;
    }
    row.insert(row.end(), values.begin(), values.end());
  }
  file_.row(row);
  file_.flush();
}

}  // namespace pliant::reference
