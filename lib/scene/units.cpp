#include "scene/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>

#include "core/errors.hpp"
#include "core/floating_point_traps.hpp"
#include "scene/line_reader.hpp"

namespace pliant {

namespace {

template <class T, void (*release)(T*)>
struct Release {
  void operator()(T* pointer) const { release(pointer); }
};
using Unit = std::unique_ptr<ut_unit, Release<ut_unit, ut_free>>;
using Converter = std::unique_ptr<cv_converter, Release<cv_converter, cv_free>>;

/// The unit database, loaded once. UDUNITS-2 has no "deg", which everybody writes.
ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    ut_system* loaded = ut_read_xml(nullptr);
    if (!loaded)
      throw InputError("the unit database of UDUNITS-2 cannot be read: install the package libudunits2-data");
    const Unit degree(ut_parse(loaded, "degree", UT_UTF8));
    ut_map_name_to_unit("deg", UT_UTF8, degree.get());
    return loaded;
  }();
  return system;
}

/// UDUNITS-2 tolerates a stray ")", ignores what follows it, and takes "2 1000 kg" for a unit of 1000 kg. Of numbers
/// only the one of "1/s" may begin a unit.
bool well_formed(std::string_view unit) {
  if (unit.starts_with("1/")) unit.remove_prefix(2);
  if (!unit.empty() && std::string_view("0123456789.+-").find(unit.front()) != std::string_view::npos) return false;
  if (unit.find('@') != std::string_view::npos) return false;
  int depth = 0;
  for (const char c : unit) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth < 0) return false;
  }
  return depth == 0;
}

/// Same dimension, not the reciprocal one (which UDUNITS-2 also calls convertible: 1 MHz would pass for 1 us).
bool same_dimension(const ut_unit* a, const ut_unit* b) {
  const Unit ratio(ut_divide(a, b));
  const Unit one(ut_get_dimensionless_unit_one(unit_system()));
  return ratio && ut_are_convertible(ratio.get(), one.get());
}

/// UDUNITS-2 takes the radian for a number, but remembers in which power a unit has it.
struct AnglePower {
  const ut_unit* radian;
  int sum = 0;

  static int of(const ut_unit* unit) {
    static const Unit radian(ut_get_unit_by_name(unit_system(), "radian"));
    AnglePower power{radian.get()};
    ut_accept_visitor(unit, &visitor, &power);
    return power.sum;
  }

 private:
  static ut_status basic(const ut_unit* one, void* power) {
    const int once = 1;
    return product(one, 1, &one, &once, power);
  }
  static ut_status product(const ut_unit*, int count, const ut_unit* const* basics, const int* powers, void* power) {
    auto& [radian, sum] = *static_cast<AnglePower*>(power);
    for (int i = 0; i < count; ++i)
      if (ut_compare(basics[i], radian) == 0) sum += powers[i];
    return UT_SUCCESS;
  }
  static ut_status scaled(const ut_unit*, double, const ut_unit* underlying, double, void* power) {
    return ut_accept_visitor(underlying, &visitor, power);
  }
  static ut_status timestamp(const ut_unit*, const ut_unit*, double, void*) { return UT_SUCCESS; }
  static ut_status logarithmic(const ut_unit*, double, const ut_unit*, void*) { return UT_SUCCESS; }
  static constexpr ut_visitor visitor{basic, product, scaled, timestamp, logarithmic};
};

/// Throws UnitError where one unit counts an angle that the other does not.
void check_angles(const ut_unit* from, const std::string& from_text, const ut_unit* to) {
  const int has = AnglePower::of(from), wanted = AnglePower::of(to);
  if (has == wanted) return;
  if (wanted == 0) throw UnitError(fmt::format("unit \"{}\" of an angle, which is no number", from_text));
  const bool pure = same_dimension(to, Unit(ut_get_dimensionless_unit_one(unit_system())).get());
  if (has != 0 || (pure && !from_text.empty())) throw UnitError(fmt::format("wrong unit \"{}\"", from_text));
  if (from_text.find("Hz") != std::string::npos || from_text.find("hertz") != std::string::npos)
    throw UnitError(fmt::format("unit \"{}\", which may be turns or radians: write turn/s or rad/s", from_text));
}

double convert(const std::string& from_text, const std::string& to_text, double number) {
  const Unit from(well_formed(from_text) ? ut_parse(unit_system(), from_text.c_str(), UT_UTF8) : nullptr);
  if (!from) throw UnitError(fmt::format("unknown unit \"{}\"", from_text));
  const Unit to(ut_parse(unit_system(), to_text.c_str(), UT_UTF8));
  if (!same_dimension(from.get(), to.get())) {
    throw UnitError(from_text.empty() ? std::string("no unit") : fmt::format("wrong unit \"{}\"", from_text));
  }
  check_angles(from.get(), from_text, to.get());
  const Converter converter(ut_get_converter(from.get(), to.get()));
  if (!converter || cv_convert_double(converter.get(), 0.0) != 0) {
    throw UnitError(fmt::format("unit \"{}\" with an offset", from_text));
  }
  return cv_convert_double(converter.get(), number);
}

}  // namespace

bool is_angle(const std::string& text) {
  double number = 0;
  const std::string_view quantity = trimmed(text);
  if (std::from_chars(quantity.data(), quantity.data() + quantity.size(), number).ptr ==
      quantity.data() + quantity.size())
    return false;
  try {
    parse_quantity(text, "rad");
    return true;
  } catch (const UnitError&) {
    return false;
  }
}

double parse_quantity(const std::string& text, const std::string& unit) {
  const Untrapped untrapped;
  const std::string quantity(trimmed(text));
  const char* begin = quantity.data() + (quantity.starts_with('+') ? 1 : 0);
  const char* end = quantity.data() + quantity.size();
  double number = 0;
  const auto [rest, status] = std::from_chars(begin, end, number);
  if (status == std::errc::result_out_of_range) throw UnitError("a number that double precision cannot hold");
  if (status != std::errc{}) throw UnitError("no number at its start");
  if (!std::isfinite(number)) throw UnitError("a number that is not finite");
  const double converted = convert(std::string(trimmed({rest, static_cast<std::size_t>(end - rest)})), unit, number);
  if (!std::isfinite(converted)) throw UnitError("a number that double precision cannot hold");
  return converted;
}

double parse_time(const char* option, const std::string& text, const char* also) {
  double time = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
  const bool plain = error == std::errc() && end == text.data() + text.size();
  try {
    if (!plain) time = parse_quantity(text, "s");
  } catch (const UnitError& failure) {
    throw InputError(
        fmt::format("{} {}: {}; allowed: a positive time with a unit{}", option, text, failure.what(), also));
  }
  if (std::isfinite(time) && time > 0) return time;
  throw InputError(fmt::format("{0} {1}: must be a positive time, as in {0} \"0.02 us\"{2}", option, text, also));
}

}  // namespace pliant
