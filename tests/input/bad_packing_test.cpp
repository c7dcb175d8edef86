#include <gtest/gtest.h>

#include "input/bad_scenes.hpp"

namespace pliant {
namespace {

using namespace scene_tests;

class BadPacking : public ::testing::TestWithParam<Bad> {};

TEST_P(BadPacking, IsRefusedWithPlaceAndReason) { expect_refused(GetParam()); }

const std::vector<Bad> bad_shapes{
    {"RoundingTooLarge", "[0, '1 um']]\n", "[0, '1 um']]\nrounding = '0.51 um'\n", "'0.51 um'",
     "'rounding' in [shapes.box] ... at most 5e-07 m"},
    {"RoundingOfDisc", "nodes = 168", "nodes = 168\nrounding = 1e-7", "rounding", "unknown key 'rounding'"},
    {"RoundedWithFewOutlineNodes", "spacing = '0.1 um'", "rounding = '0.2 um'\nspacing = '0.1 um'\noutline_nodes = 5",
     "5\n[[grains]]", "from 6 to"},
    {"FileMissing", "kind = 'disc'\ndiameter = '1 um'", "kind = 'file'\nfile = 'no_such.csv'", "'no_such.csv'",
     "'file' in [shapes.disc] ... no_such.csv is none"},
    {"FileUnit", "kind = 'disc'\ndiameter = '1 um'", "kind = 'file'\nfile = 'no_such.csv'\nunit = 's'", "'s'",
     "'unit' in [shapes.disc] ... a unit of length"},
    {"NoVariants", "kind = 'disc'", "kind = 'fourier'\ndescriptors = [0.1]\nvariants = 0", "0\ndiameter",
     "'variants' ... from 1 to"},
    {"VariantsWord", "kind = 'disc'", "kind = 'fourier'\ndescriptors = [0.1]\nvariants = 'every'", "'every'",
     "'variants' ... or \"each\""},
    {"VariantsOfDisc", "nodes = 168", "nodes = 168\nvariants = 3", "variants", "unknown key 'variants'"},
    {"VariantWithoutRadius", "kind = 'disc'", "kind = 'fourier'\ndescriptors = [0.9, 0.8]\nvariants = 3", "[0.9, 0.8]",
     "with seed 1 the radius is not positive"},
    {"FittedShapeOnALattice", "kind = 'disc'", "kind = 'fourier'\ndescriptors = [0.1]\nvariants = 'each'",
     "'disc'\npacking", "variants = \"each\" ... fourier-voronoi"},
};
INSTANTIATE_TEST_SUITE_P(Shapes, BadPacking, ::testing::ValuesIn(bad_shapes), name_of);

/// What grains of the good scene are made of, and one more key.
Bad bad_grains(const std::string& name, const std::string& line, const std::string& at, const std::string& message) {
  return {name, "seed = 7", "seed = 7\n" + line, at, message};
}
/// The good scene's first packing replaced.
Bad bad_packing(const std::string& name, const std::string& to, const std::string& at, const std::string& message) {
  return {name, "kind = 'hexagonal', columns = 10, rows = 4, pitch = '1 um', row_pitch = '1.1 um'", to, at, message};
}

const std::vector<Bad> bad_packings{
    {"BothShapes", "shape = 'disc'\n", "shapes = []\nshape = 'disc'\n", "'disc'\npacking", "both it and 'shapes'"},
    {"SharesOfShapes", "shape = 'disc'\n", "shapes = [{ shape = 'disc', share = 0.5 }]\n", "[{ shape",
     "'shapes' ... sum to 0.5 ... allowed: 1"},
    {"UnknownOfShapes", "shape = 'disc'\n", "shapes = [{ shape = 'disk', share = 1 }]\n", "'disk'",
     "unknown shape ... nearest: disc"},
    {"WideOfShapes", "shape = 'disc'\n",
     "shapes = [{ shape = 'disc', share = 1 }]\nsize = { distribution = 'list', factors = [11], shares = [1] }\n",
     "[{ shape", "the extent of 'disc' ... less than the period"},
    bad_grains("UnknownDistribution", "size = { distribution = 'gauss' }", "'gauss'", "uniform, normal, lognormal"),
    bad_grains("NoLimits", "size = { distribution = 'normal', low = 0.5 }", "{ distribution", "missing key 'high'"),
    bad_grains("LimitsReversed", "size = { distribution = 'uniform', low = 1.5, high = 0.5 }", "0.5 }\n[[", "> 1.5"),
    bad_grains("NegativeSize", "size = { distribution = 'uniform', low = -1, high = 1 }", "-1, high", "'low' ... > 0"),
    bad_grains("MeanBeyondLimits", "size = { distribution = 'normal', low = 0.5, high = 1, mean = 2, deviation = 0.1 }",
               "2, deviation", "'mean' ... >= 0.5 and <= 1"),
    bad_grains("NoDeviation", "size = { distribution = 'lognormal', low = 0.5, high = 2, median = 1, deviation = 0 }",
               "0 }\n[[", "'deviation' ... > 0"),
    bad_grains("MeanOfUniform", "size = { distribution = 'uniform', low = 1, high = 2, mean = 1 }", "mean",
               "unknown key"),
    bad_grains("SharesOfSizes", "size = { distribution = 'list', factors = [1, 2], shares = [0.5, 0.6] }", "[0.5, 0.6]",
               "sum to 1.1"),
    bad_grains("OneShareForTwoSizes", "size = { distribution = 'list', factors = [1, 2], shares = [1] }", "[1] }",
               "2 elements"),
    bad_grains("UnknownSpeciesOrder", "species_order = 'in turns'", "'in turns'",
               "'species_order' ... random, in turn"),
    {"SeedOfSpeciesInTurn", "angle = 'random'\nseed = 7", "species_order = 'in turn'\nseed = 7", "7\n[[grains]]",
     "nothing is random here ... species in random order"},
    {"SpeciesOrderWithoutSpecies", "angle = '45 deg'", "species_order = 'in turn'", "'in turn'",
     "'species_order' ... no 'species'"},
    {"InTurnAtRandomPlaces", "kind = 'hexagonal', columns = 10, rows = 4, pitch = '1 um', row_pitch = '1.1 um' }",
     "kind = 'random', bottom = 0, top = 1e-5, count = 8 }\nspecies_order = 'in turn'", "'in turn'",
     "'species_order' ... random places ... \"hexagonal\", \"grid\", \"positions\", \"file\""},
    bad_packing("CountAndFraction", "kind = 'random', bottom = 0, top = 1e-5, count = 3, solid_fraction = 0.5", "0.5 }",
                "both it and 'count'"),
    bad_packing("NeitherCountNorFraction", "kind = 'random', bottom = 0, top = 1e-5", "{ kind = 'random",
                "'count' (of grains)"),
    bad_packing("SolidFractionOne", "kind = 'random', bottom = 0, top = 1e-5, solid_fraction = 1", "1 }",
                "'solid_fraction' ... > 0 and < 1"),
    bad_packing("TopBelowBottom", "kind = 'random', bottom = 1, top = 0, count = 3", "0, count", "'top' ... > 1"),
    bad_packing("NotEvenOneGrain", "kind = 'random', bottom = 0, top = 1e-7, solid_fraction = 0.1", "0.1 }",
                "one grain has 0.785 of the region"),
    bad_packing("TooManyGrains", "kind = 'random', bottom = 0, top = 1, solid_fraction = 0.5", "0.5 }",
                "6.37e+06 grains ... at most 1000000"),
    bad_packing("SidesOfAStrip", "kind = 'random', bottom = 0, top = 1e-5, left = 0, count = 3", "left",
                "unknown key 'left'"),
    bad_packing("VoronoiWithoutFraction", "kind = 'fourier-voronoi', bottom = 0, top = 1e-5, count = 3",
                "{ kind = 'fourier", "missing key 'solid_fraction'"),
    bad_packing("InPlaceOfADisc", "kind = 'in place'", "'in place'",
                "'kind' in packing of [[grains]] 1 ... 'disc' says nowhere where it lies ... polygons"),
    bad_packing("GrainFileMissing", "kind = 'file', file = 'no_such.csv'", "'no_such.csv'",
                "'file' in packing of [[grains]] 1 ... is none"),
    {"InPlaceTurned", "kind = 'positions', positions = [['2 um', '8 um'], ['5 um', '8 um']]", "kind = 'in place'",
     "'45 deg'", "'angle' in [[grains]] 2 ... in place"},
    {"VoronoiWithAngle", "positions', positions = [['2 um', '8 um'], ['5 um', '8 um']]",
     "fourier-voronoi', bottom = 0, top = 1e-5, solid_fraction = 0.3", "'45 deg'", "'angle' ... turns each grain"},
    {"RandomWithoutSeed", "positions', positions = [['2 um', '8 um'], ['5 um', '8 um']]",
     "random', bottom = 0, top = 1e-5, solid_fraction = 0.3", "[[grains]]\nname", "missing key 'seed'"},
};
INSTANTIATE_TEST_SUITE_P(Packings, BadPacking, ::testing::ValuesIn(bad_packings), name_of);

TEST(BadPackingPlaces, VoronoiCellsTurnGrains) {
  // EXACT: no key 'angle' stands there to be named.
  const std::string text = edited({{"\"neo-hookean\"", "\"linear-elastic\""},
                                   {"\"hexagonal\", columns = 10, rows = 4, pitch = \"1 um\", row_pitch = \"1.1 um\"",
                                    "\"fourier-voronoi\", bottom = 0, top = 1e-5, solid_fraction = 0.3"},
                                   {"angle = \"random\"\n", ""}});
  EXPECT_NE(error_of(text).find("'packing' in [[grains]] 1: it turns its grains: the law \"linear-elastic\""),
            std::string::npos)
      << error_of(text);
}

TEST(BadPackingPlaces, VoronoiCellsNeedAPeriod) {
  // EXACT
  const std::string message = error_of(stones + R"(seed = 1
packing = { kind = "fourier-voronoi", bottom = 0, top = 9, solid_fraction = 0.5 }
[[contacts]]
between = "all"
law = "frictionless"
stiffness = 1
)");
  EXPECT_TRUE(message.starts_with("15:20: 'kind' in packing of [[grains]] 1: the scene has no period")) << message;
}

}  // namespace
}  // namespace pliant
