#pragma once

#include <string>
#include <vector>

#include "contact/law_table.hpp"

namespace pliant {

/// Largest pressure that a wall brings onto the grains until the end of the scene, Pa: its pressure, or its normal
/// force over the period. 0 without one.
double largest_pressure(const Scene& scene);

/// How two kinds of body touch.
struct PairEstimate {
  std::string first, second;  ///< materials; "soft (rigid)" for rigid grains of what could be compliant, "wall of hard"
  std::string law;            ///< as in scene files
  bool automatic = false;     ///< the stiffness
  double stiffness = 0;       ///< kn, Pa/m
  double shear_stiffness = 0;  ///< kt, Pa/m; 0 for frictionless contact
  double friction = 0;         ///< coefficient; 0: none
  double strength = 0;         ///< cohesive: normal strength, Pa
  double reach = 0;            ///< m
  double spacing = 0;          ///< h of the finer outline, m
  double curvature = 0;        ///< of both faces where neither body gives way, 1/m; 0: they touch flat
  double width = 0;            ///< diameter of the smaller disc, for such pairs, m

  /// Depth at which the pair carries a pressure, m. Bodies that flatten share it evenly: p / kn. Rigid discs side by
  /// side touch near a point, and the force F = p x width comes from the segment that overlaps:
  /// (3 F / (4 kn sqrt(2/curvature)))^(2/3).
  double penetration(double pressure) const;
};

/// The pairs of the scene that can meet, each once but for rounding: walls do not meet each other, nor a single body
/// itself.
std::vector<PairEstimate> pair_estimates(const Model& model, const LawTable& laws);

/// Files of a run, in bytes.
struct OutputSize {
  std::int64_t frames = 0, probe_rows = 0, step_rows = 0;
  double frames_h5 = 0, frames_xdmf = 0, probes_csv = 0, steps_csv = 0;
  double total() const { return frames_h5 + frames_xdmf + probes_csv + steps_csv; }
};

/// Number of outputs of a period in [0, end], the first at 0; a last one that rounding puts behind the end counts.
std::int64_t output_count(double period, double end);
/// Size of one frame in memory, bytes: positions and fields in single precision.
double frame_bytes(const Model& model);
OutputSize output_size(const Model& model, double steps);

/// Least number of steps over `time`, none longer than `largest_dt`, that stop where the scene's outputs ask for it.
double least_steps(const Scene& scene, double time, double largest_dt);

}  // namespace pliant
