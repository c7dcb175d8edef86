#pragma once

#include <stdexcept>
#include <string>

namespace pliant {

/// A quantity that cannot be read; the message says why, the reader of the file adds the place.
struct UnitError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Number and unit such as "2 GPa", "87 um", "60 deg" or "10 m/s", converted to `unit` (UDUNITS-2 names; "1": no unit).
/// Throws UnitError for a bad number, an unknown unit, another dimension, an offset or logarithmic unit. Angles count
/// as a dimension here: where `unit` has none, units with rad, deg or turn are refused. Where it has one a number alone
/// is in rad, and "1/s" is "rad/s"; "Hz", which may be turns, is refused.
double parse_quantity(const std::string& text, const std::string& unit);

/// Whether a text is a number with a unit of angle, as "30 deg" is; no other text is one.
bool is_angle(const std::string& text);

/// A positive time of a command line option, such as "0.02 us"; a plain number means seconds, as in scene files. Throws
/// InputError, which names the option. `also`: what else the caller allows, for the message.
double parse_time(const char* option, const std::string& text, const char* also = "");

}  // namespace pliant
