#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace pliant {

using Vec2 = Eigen::Vector2d;
using Points = std::vector<Vec2>;
using Triangle = std::array<int, 3>;

/// z component of the cross product a x b.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace pliant
