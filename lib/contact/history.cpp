#include "contact/history.hpp"

#include <limits>

namespace pliant {

const ContactHistory::Array ContactHistory::arrays[4] = {
    {&ContactHistory::place, std::numeric_limits<double>::quiet_NaN()},
    {&ContactHistory::slip, 0},
    {&ContactHistory::damage, 1},
    {&ContactHistory::opening, 0}};

}  // namespace pliant
