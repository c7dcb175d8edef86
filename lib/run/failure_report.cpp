#include "run/failure_report.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace pliant {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(Failure::Cause cause) {
  switch (cause) {
    case Failure::Cause::inverted:
      return "inverted";
    case Failure::Cause::not_finite:
      return "not finite";
    case Failure::Cause::contact_lost:
      return "contact lost";
    case Failure::Cause::not_followed:
      return "not followed";
  }
  return "";
}

/// Null for a number that is none, which JSON does not know.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json point(const Vec2& x) { return {number(x.x()), number(x.y())}; }

Json outline(const Simulation& simulation, int body) {
  const Model& model = simulation.model();
  Json points = Json::array();
  for (int i = 0; i < model.outline_of(body).count; ++i)
    points.push_back(point(simulation.state().outlines.position.at(model.outline_offset[body] + i)));
  return points;
}

}  // namespace

std::string failure_json(const Failure& failure, const Simulation& simulation, const std::string& message) {
  const std::vector<Body>& bodies = simulation.model().bodies;
  Json json;
  json["message"] = message;
  json["cause"] = name_of(failure.cause);
  json["bodies"] = Json::array();
  for (const int body : failure.bodies) json["bodies"].push_back(bodies[body].name);
  json["node"] = failure.node ? Json(*failure.node) : Json();
  json["place"] = failure.place ? point(*failure.place) : Json();
  json["time"] = failure.time;
  json["dt"] = failure.dt;
  json["largest_dt"] = number(failure.largest_dt);
  json["governed_by"] = failure.governed_by;
  json["error"] = number(failure.error);
  Json& good = json["last_good_state"];
  good["step"] = simulation.state().steps;
  good["time"] = simulation.state().time;
  if (const LeastJacobian& least = failure.least_jacobian; least.body >= 0)
    good["least_jacobian"] = {{"value", least.value}, {"body", bodies[least.body].name}, {"point", least.point}};
  if (const DeepestNode& deepest = failure.deepest; deepest.depth > 0)
    good["deepest_contact"] = {{"bodies", {bodies[deepest.slave].name, bodies[deepest.master].name}},
                               {"node", deepest.node},
                               {"place", point(deepest.position)},
                               {"depth", deepest.depth},
                               {"depth_over_segment", deepest.depth / deepest.segment_length}};
  std::vector<int> shown = failure.bodies;
  if (shown.empty() && failure.deepest.depth > 0) shown = {failure.deepest.slave, failure.deepest.master};
  good["outlines"] = Json::object();
  for (const int body : shown) good["outlines"][bodies[body].name] = outline(simulation, body);
  return json.dump(1) + "\n";
}

}  // namespace pliant
