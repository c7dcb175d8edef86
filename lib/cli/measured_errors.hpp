#pragma once

#include "scene/scene.hpp"

namespace pliant {

// FROZEN: written by `./pliant bench error --keep`, which prints what it changes. Errors in three of its scenes, in two
// digits.
inline constexpr int measured_nodes[] = {40, 84, 168, 340, 700, 1400};

struct MeasuredErrors {
  DiscretisationMethod method;
  Mass mass;
  double oscillation[6], plates[6], impact[6];
};

inline constexpr MeasuredErrors measured_errors[] = {
    {DiscretisationMethod::mls,
     Mass::lumped,
     {0.52, 0.2, 0.12, 0.071, 0.04, 0.019},
     {0.048, 0.035, 0.019, 0.012, 0.011, 0.0079},
     {0.035, 0.015, 0.0092, 0.0057, 0.0026, 0.0025}},
    {DiscretisationMethod::mls,
     Mass::corrected,
     {0.095, 0.019, 0.013, 0.0043, 0.002, 0.0011},
     {0.048, 0.035, 0.019, 0.012, 0.011, 0.0079},
     {0.013, 0.0063, 0.0045, 0.004, 0.0033, 0.0022}},
    {DiscretisationMethod::mls_gauss,
     Mass::lumped,
     {0.35, 0.21, 0.13, 0.074, 0.043, 0.021},
     {0.081, 0.032, 0.016, 0.012, 0.011, 0.0081},
     {0.027, 0.016, 0.0078, 0.0058, 0.0031, 0.0026}},
    {DiscretisationMethod::mls_gauss,
     Mass::corrected,
     {0.23, 0.022, 0.022, 0.0085, 0.0031, 0.0012},
     {0.081, 0.032, 0.016, 0.012, 0.011, 0.0081},
     {0.022, 0.0038, 0.0043, 0.0045, 0.0035, 0.0024}},
    {DiscretisationMethod::t3,
     Mass::lumped,
     {0.16, 0.066, 0.031, 0.013, 0.0053, 0.0023},
     {0.084, 0.033, 0.018, 0.012, 0.0097, 0.0071},
     {0.036, 0.01, 0.0039, 0.0034, 0.0031, 0.0026}},
    {DiscretisationMethod::t3,
     Mass::corrected,
     {0.28, 0.15, 0.077, 0.036, 0.017, 0.0088},
     {0.084, 0.033, 0.018, 0.012, 0.0097, 0.0071},
     {0.045, 0.016, 0.0094, 0.005, 0.0036, 0.0027}},
    {DiscretisationMethod::es_t3,
     Mass::lumped,
     {0.43, 0.15, 0.085, 0.05, 0.023, 0.011},
     {0.042, 0.043, 0.03, 0.016, 0.013, 0.0095},
     {0.021, 0.011, 0.0085, 0.0055, 0.0042, 0.0029}},
    {DiscretisationMethod::es_t3,
     Mass::corrected,
     {0.039, 0.014, 0.0039, 0.0011, 0.00058, 0.00028},
     {0.042, 0.043, 0.03, 0.016, 0.013, 0.0095},
     {0.013, 0.0086, 0.0081, 0.0053, 0.0038, 0.0031}},
};

}  // namespace pliant
