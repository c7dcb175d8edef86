#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "input/bad_scenes.hpp"

namespace pliant {
namespace {

using scene_tests::Bad;
using scene_tests::error_of;
using scene_tests::stones;

class BadInput : public ::testing::TestWithParam<Bad> {};

// EXACT: place and words of the message.
TEST_P(BadInput, IsRefusedWithPlaceAndReason) { scene_tests::expect_refused(GetParam()); }

const std::vector<Bad> bad_values{
    {"UnknownKey", "support = 9", "suport = 9", "suport",
     "unknown key 'suport' ... [discretisation] ... nearest: support"},
    {"UnknownTable", "[frames]", "[frame]", "frame]", "unknown key 'frame' ... the scene ... nearest: frames"},
    {"UnknownKeyInInlineTable", "rows = 4", "rows = 4, lines = 3", "lines",
     "unknown key 'lines' ... packing of [[grains]] 1 ... row_pitch"},
    {"MisspeltRequiredKey", "diameter = '1 um'\nnodes", "diametre = '1 um'\nnodes", "diametre",
     "unknown key 'diametre' in [shapes.disc] ... perhaps meant as 'diameter', which is missing ... a quantity in m"},
    {"MissingKey", "density = '1200 kg/m3'\n", "", "[materials.soft]", "missing key 'density' ... kg/m3 ... > 0"},
    {"MissingTable", "[time]\nend = '2 us'\ntolerance = 1e-2\n", "", "title", "missing key 'time' ... [time]"},
    {"WrongTypeString", "young = '2 GPa'", "young = true", "true", "'young' in [materials.soft] ... found true ... Pa"},
    {"WrongTypeTable", "period = '0.1 us'", "period = { a = 1 }", "{ a = 1 }", "found a table ... in s"},
    {"WrongTypeInteger", "nodes = 168", "nodes = 168.0", "168.0", "found the number 168.0 ... an integer from 7"},
    {"SettingsAsRules", "[contact]", "[[contact]]", "[[contact]]", "'contact' in the scene ... a table [contact]"},
    {"WrongTypeTitle", "title = 'Good'", "title = 3", "3", "found the integer 3 ... a string"},
    {"WrongTypeArray", "gravity = ['0 m/s2', -9.81]", "gravity = -9.81", "-9.81", "found the number -9.81 ... [x, y]"},
    {"WrongLengthArray", "gravity = ['0 m/s2', -9.81]", "gravity = [1, 2, 3]", "[1, 2, 3]",
     "an array of 3 elements ... [x, y]"},
    {"WrongUnit", "'2 GPa'", "'2 GPa/m'", "'2 GPa/m'", "wrong unit \"GPa/m\" ... a quantity in Pa"},
    {"AngleAsNumber", "poisson = 0.4", "poisson = '20 deg'", "'20 deg'", "'poisson' ... which is no number"},
    {"AngularRateAsRate", "poisson = 0.4", "poisson = 0.4\nmass_damping = '20 rad/s'", "'20 rad/s'",
     "'mass_damping' ... \"rad/s\" of an angle, which is no number ... a quantity in 1/s"},
    {"DegreesBeyondARange", "['30 deg', 0.5]", "[30, 0.5]", "30, 0.5",
     "radians; did you mean \"30 deg\"? ... rad, > 0"},
    {"UnknownUnit", "'2 GPa'", "'2 GPax'", "'2 GPax'", "unknown unit \"GPax\" ... a quantity in Pa"},
    {"MissingUnit", "'2 GPa'", "'2'", "'2'", "no unit ... a quantity in Pa"},
    {"ReciprocalUnit", "end = '2 us'", "end = '2 MHz'", "'2 MHz'", "wrong unit ... a quantity in s"},
    {"NotANumber", "poisson = 0.4", "poisson = nan", "nan", "found the number nan ... >= 0 and < 0.5"},
    {"Infinite", "young = '2 GPa'", "young = inf", "inf", "found the number inf ... > 0"},
    {"InfiniteGravity", "-9.81", "-inf", "-inf", "found the number -inf"},
    {"NotANumberInText", "'2 GPa'", "'nan GPa'", "'nan GPa'", "not finite"},
    {"TooLargeNumber", "'2 GPa'", "'1e300 YPa'", "'1e300 YPa'", "double precision"},
    {"NegativeDensity", "'1200 kg/m3'", "'-1 kg/m3'", "'-1 kg/m3'", "'density' in [materials.soft] ... > 0"},
    {"ZeroDensity", "density = 1200\n", "density = 0\n", "0\n[shapes", "'density' in [materials.hard] ... > 0"},
    {"PoissonOneHalf", "poisson = 0.4", "poisson = 0.5", "0.5\n[materials.hard]",
     "found the number 0.5 ... >= 0 and < 0.5"},
    {"PoissonNegative", "poisson = 0.4", "poisson = -0.1", "-0.1", "-0.1 ... >= 0 and < 0.5"},
    {"YieldMissing", "law = 'neo-hookean'", "law = 'von-mises'", "[materials.soft]", "missing key 'yield' ... in Pa"},
    {"YieldOfElastic", "poisson = 0.4", "poisson = 0.4\nyield = '1 MPa'", "yield", "unknown key 'yield'"},
    {"YieldBeyondAThird", "law = 'neo-hookean'", "law = 'von-mises'\nyield = '0.7 GPa'", "'0.7 GPa'",
     "'yield' in [materials.soft] ... at most a third of 'young', 666666666"},
    {"SofteningAlone", "law = 'neo-hookean'", "law = 'von-mises'\nyield = '1 MPa'\nhardening = '-1 MPa'", "'-1 MPa'",
     "'hardening' ... localises ... at least 0 Pa, or 'viscoplastic_time' > 0"},
    {"SaturationBelowYield", "law = 'neo-hookean'",
     "law = 'von-mises'\nyield = '2 MPa'\nsaturation = '1 MPa'\nsaturation_rate = 3", "'1 MPa'",
     "'saturation' ... localises ... at least 'yield', 2000000 Pa"},
    {"RateWithoutSaturation", "law = 'neo-hookean'", "law = 'von-mises'\nyield = '1 MPa'\nsaturation_rate = 3", "3",
     "'saturation_rate'"},
    {"CohesionMissing", "law = 'neo-hookean'", "law = 'drucker-prager'", "[materials.soft]",
     "missing key 'cohesion' ... in Pa"},
    {"DilatancyBeyondFriction", "law = 'neo-hookean'",
     "law = 'drucker-prager'\ncohesion = 1\nfriction_angle = '30 deg'\ndilatancy_angle = '40 deg'", "'40 deg'",
     "'dilatancy_angle' ... would make energy ... at most 'friction_angle', 0.52"},
    {"SofteningCohesion", "law = 'neo-hookean'",
     "law = 'drucker-prager'\ncohesion = 1\nfriction_angle = '30 deg'\nhardening = -1", "-1", "at least 0 Pa"},
    {"EndZero", "end = '2 us'", "end = 0", "0\ntolerance", "'end' in [time] ... > 0"},
    {"EndNegative", "end = '2 us'", "end = '-2 us'", "'-2 us'", "'end' in [time] ... > 0"},
    {"GrainWithoutRadius", "kind = 'disc'", "kind = 'fourier'\ndescriptors = [0.9, 0.8]", "[0.9, 0.8]",
     "'descriptors' in [shapes.disc] ... the radius is not positive all round"},
    {"FlatEllipse", "kind = 'disc'", "kind = 'ellipse'\nwidth = 1\nheight = 0", "0\ndiameter", "'height'"},
    {"TwoSides", "kind = 'disc'", "kind = 'regular'\nsides = 2", "2\ndiameter", "'sides' ... from 3"},
    {"SupportTooLarge", "support = 9", "support = 15", "15", "from 7 to 14"},
    {"GaussPointsOfMls", "support = 9", "gauss_points = 3", "gauss_points", "unknown key 'gauss_points'"},
    {"LightRim", "support = 9", "mass_scaling = 0.5", "0.5", "'mass_scaling' in [discretisation] ... >= 1"},
    {"RimOfCorrectedMass", "support = 9", "mass = 'corrected'\nmass_scaling = 2", "mass_scaling",
     "unknown key 'mass_scaling'"},
    {"UnknownMass", "method = 'mls'", "method = 'mls'\nmass = 'correct'", "'correct'", "lumped, corrected"},
    {"GaussPointsBetween", "method = 'mls'", "method = 'mls-gauss'\ngauss_points = 4", "4\nsupport", "1, 3 or 6"},
    {"UnknownEnum", "method = 'mls'", "method = 'msl-gauss'", "'msl-gauss'",
     "allowed: mls, mls-gauss ... nearest: mls-gauss"},
    {"KeyOfOtherIntegrator", "tolerance = 1e-2", "alpha = 2", "alpha", "unknown key 'alpha' ... [time]"},
    {"Skin", "skin = 0.4", "skin = -0.4", "-0.4", "'skin' in [contact] ... > 0"},
    {"SkinTooLarge", "skin = 0.4", "skin = 4.1", "4.1", "'skin' in [contact] ... <= 4"},
    {"GravityRow", "['0 m/s2', -9.81]", "[[0, [0, -1]], [1, -2]]", "-2]", "'gravity' in [domain] ... [x, y]"},
    {"GravityTimes", "['0 m/s2', -9.81]", "[[1, [0, -1]], [1, [0, -2]]]", "1, [0, -2]", "after the one before"},
    {"GravityNone", "['0 m/s2', -9.81]", "[[]]", "[]", "[time, value]"},
    {"DuplicateKey", "seed = 7", "seed = 7\nseed = 8", "8\n[[grains]]", "not valid TOML ... cannot redefine"},
    {"DuplicateMaterial", "[materials.hard]", "[materials.soft]", "[materials.soft]\nlaw = 'rigid'",
     "not valid TOML ... cannot redefine"},
    {"TooManyFrames", "period = '0.1 us'", "period = 1e-30", "1e-30", "'period' in [frames] ... outputs"},
    {"UnknownField", "'von_mises'", "'von_mise'", "'von_mise'", "unknown field ... nearest: von_mises"},
    {"FieldTwice", "'von_mises'", "'velocity'", "['velocity', 'velocity']", "twice"},
};
/// A key that must be there, under a wrong name: the wrong name is shown with its place, and what it is likely meant
/// as.
Bad misspelt(const std::string& name, const std::string& from, const std::string& to, const std::string& key,
             const std::string& meant) {
  return {name, from, to, key, "unknown key '" + key + "' ... perhaps meant as '" + meant + "', which is missing"};
}

const std::vector<Bad> misspelt_keys{
    misspelt("LetterMissing", "density = '1200", "densty = '1200", "densty", "density"),
    misspelt("LettersSwapped", "young =", "yuong =", "yuong", "young"),
    misspelt("ShortKeySwapped", "end = '2", "ned = '2", "ned", "end"),
    misspelt("AnotherWord", "density = '1200", "rho = '1200", "rho", "density"),
    misspelt("Symbol", "poisson = 0.4", "nu = 0.4", "nu", "poisson"),
    misspelt("LongerWord", "young = ", "youngs_modulus = ", "youngs_modulus", "young"),
    misspelt("NearestOfSeveral", "young = ", "colour = 3\nyougn = ", "yougn", "young"),
    misspelt("OtherCase", "diameter = '1 um'\nnodes", "Diameter = '1 um'\nnodes", "Diameter", "diameter"),
    misspelt("Table", "[time]", "[tmie]", "tmie", "time"),
    misspelt("InInlineTable", "columns = 10", "colums = 10", "colums", "columns"),
    misspelt("InAnArrayOfTables", "of = 'floor'", "off = 'floor'", "off", "of"),
};
INSTANTIATE_TEST_SUITE_P(MisspeltKeys, BadInput, ::testing::ValuesIn(misspelt_keys), scene_tests::name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadInput, ::testing::ValuesIn(bad_values), scene_tests::name_of);

const std::vector<Bad> bad_bodies{
    {"YoungOfRigid", "law = 'rigid'", "law = 'rigid'\nyoung = 3", "young = 3",
     "unknown key 'young' ... [materials.hard]"},
    {"MaterialCalledAll", "[materials.hard]", "[materials.all]", "[materials.all]", "'all'"},
    {"MaterialName", "[materials.hard]", "[materials.'../x']", "[materials.'../x']", "a name of 1 to 64 letters"},
    {"NodesAndSpacing", "nodes = 168", "nodes = 168\nspacing = 1e-7", "1e-7", "both it and 'nodes'"},
    {"NeitherNodesNorSpacing", "nodes = 168\n", "", "[shapes.disc]", "'nodes' (a number) or 'spacing'"},
    {"TooManyNodes", "nodes = 168", "nodes = 1000000000", "1000000000", "from 7 to 200000"},
    {"NodesBeyondInt", "nodes = 168", "nodes = 5000000000", "5000000000", "from 7 to 200000"},
    {"SpacingTooFine", "spacing = '0.1 um'", "spacing = '0.1 nm'", "'0.1 nm'", "nodes in the shape ... at most 200000"},
    {"SpacingTooCoarse", "spacing = '0.1 um'", "spacing = '1 um'", "'1 um'\n[[grains", "at most half"},
    {"SelfIntersectingPolygon", "['1 um', 0], ['1 um', '1 um']", "['1 um', '1 um'], ['1 um', 0]", "[[0, 0]",
     "edges 1 and 3 cross"},
    {"FlatPolygon", "['1 um', '1 um'], [0, '1 um']]", "['2 um', 0]]", "[[0, 0]", "fold back"},
    {"PolygonOfTwoPoints", ", ['1 um', '1 um'], [0, '1 um']]", "]", "[[0, 0]", "at least 3"},
    {"PointsOfDisc", "diameter = '1 um'\nnodes", "points = [[0, 0]]\ndiameter = '1 um'\nnodes", "points",
     "unknown key 'points' ... [shapes.disc]"},
    {"UnknownShape", "shape = 'disc'", "shape = 'disk'", "'disk'", "unknown shape ... nearest: disc"},
    {"UnknownMaterial", "material = 'soft', share", "material = 'sofd', share", "'sofd'",
     "unknown material ... nearest: soft"},
    {"CompliantOfRigidMaterial", "material = 'soft', share", "material = 'hard', share", "'hard', share",
     "law \"rigid\" ... elastic"},
    {"SharesDoNotSumToOne", "share = 0.75", "share = 0.7", "[{ body", "sum to 0.95 ... allowed: 1"},
    {"SpeciesAndBody", "seed = 7", "seed = 7\nbody = 'rigid'", "'rigid'\n[[grains]]", "both it and 'species'"},
    {"NeitherSpeciesNorBody", "body = 'compliant'\nmaterial = 'soft'\n", "", "[[grains]]\nname",
     "'body' and 'material', or 'species'"},
    {"MissingSeed", "seed = 7\n", "", "[[grains]]", "missing key 'seed'"},
    {"IdleSeed", "angle = '45 deg'", "seed = 3", "3\nvelocity", "nothing is random"},
    {"NegativeSeed", "seed = 7", "seed = -7", "-7", "an integer from 0"},
    {"MisspeltRandom", "angle = 'random'", "angle = 'randon'", "'randon'", "\"random\" or a quantity in rad"},
    {"TableForAnArray", "[[probes]]", "[probes]", "[probes]", "found a table ... an array of tables [[probes]]"},
    {"TooWidePacking", "columns = 10", "columns = 11", "11", "11 columns ... at most the period"},
    {"OddClosedHexagonalPacking", "columns = 10, rows = 4, pitch = '1 um'", "columns = 5, rows = 4, pitch = '2 um'",
     "5, rows", "5 hexagonal columns ... an even number"},
    {"TooFewNodes", "nodes = 168", "nodes = 6", "6\n[shapes.box]", "from 7 to"},
    {"TooFewOutlineNodes", "spacing = '0.1 um'", "spacing = '0.1 um'\noutline_nodes = 3", "3\n[[grains]]", "from 4 to"},
    {"HugeInteger", "poisson = 0.4", "poisson = 9223372036854775807", "9223372036854775807", "< 0.5"},
    {"TooManyBodies", "rows = 4", "rows = 900000", "{ kind = 'hexagonal'", "9000000 bodies ... at most 1000000"},
    {"TooManyFieldNodes", "rows = 4", "rows = 90000", "{ kind = 'hexagonal'", "field nodes ... at most 100000000"},
    {"BodyWiderThanPeriod", "diameter = '1 um'\nnodes", "diameter = '10 um'\nnodes", "'disc'\npacking",
     "the extent of 'disc' ... less than the period"},
    {"PositionsOfLattice", "rows = 4", "rows = 4, positions = [[0, 0]]", "positions", "unknown key 'positions'"},
    {"GradientOfRigid", "seed = 7", "seed = 7\nvelocity = { gradient = [[0, 0], [0, 0]] }", "[[0, 0], [0, 0]]",
     "compliant bodies only"},
    {"GradientRow", "[[0, '1 s-1'], [0, 0]]", "[[0, '1 s-1'], 0]", "0] }", "[x, y]"},
    {"DuplicateGrainsName", "name = 'boxes'", "name = 'grains'", "[[grains]]\nname", "'grains' ... taken"},
    {"ReservedGrainsName", "name = 'boxes'", "name = 'rigid'", "[[grains]]\nname", "'rigid' ... taken"},
    {"GrainsName", "name = 'boxes'", "name = 'a/b'", "'a/b'", "a name of 1 to 64 letters"},
};
INSTANTIATE_TEST_SUITE_P(Bodies, BadInput, ::testing::ValuesIn(bad_bodies), scene_tests::name_of);

const std::vector<Bad> bad_walls_and_contacts{
    {"WallWithoutPeriod", "period = '10 um'\n", "", "[[walls]]", "wall 'floor' ... add [domain] period"},
    {"DuplicateWallName", "name = 'lid'", "name = 'floor'",
     "[[walls]]\nname = 'floor'\nmaterial = 'hard'\nsolid = 'above'", "'floor' ... taken"},
    {"WallNamedAsGrains", "name = 'lid'", "name = 'boxes'", "[[walls]]\nname = 'boxes'", "'boxes' ... taken"},
    {"WallsInterchanged", "level = '12 um'", "level = '-2 um'", "'-2 um'", "allowed: > ... wall 'floor'"},
    {"PressureAlongTheWall", "x = { velocity = '10 m/s' }", "x = { pressure = 1 }", "pressure",
     "unknown key 'pressure' ... force, from, until, velocity"},
    {"TwoDrives", "{ velocity = '10 m/s' }", "{ velocity = '10 m/s', force = 1 }", "1 }\ny", "only one of"},
    {"NoDrive", "{ velocity = '10 m/s' }", "{ }", "{ }", "nothing is prescribed for"},
    {"UnknownDrive", "{ velocity = '10 m/s' }", "'fixd'", "'fixd'", "nearest: fixed"},
    {"DriveIsANumber", "{ velocity = '10 m/s' }", "3.5", "3.5", "\"fixed\", \"free\" or a table"},
    {"DriveUnit", "velocity = '10 m/s'", "velocity = '10 m'", "'10 m'", "wrong unit ... m/s"},
    {"HistoryNotIncreasing", "['1 us', '1 GPa']", "['0 us', '1 GPa']", "'0 us', '1 GPa'",
     "a time after the one before it"},
    {"HistoryRow", "['1 us', '1 GPa']", "['1 us']", "['1 us']", "[time, value]"},
    {"HistoryEmpty", "[['0 us', 0], ['1 us', '1 GPa']]", "[]", "[]", "found an array of 0 elements"},
    {"NoThickness", "thickness = '5 um'\n", "", "[[walls]]\nname = 'lid'", "missing key 'thickness'"},
    {"WideAsperities", "count = 10", "count = 25", "['30 deg', 0.5]", "side by side ... less than period / count"},
    {"CapHalfAngle", "0.5] }", "'90 deg'] }", "'90 deg'", "'half_angles' ... > 0"},
    {"CapCountZero", "count = 10", "count = 0", "0, first", "an integer from 1"},
    {"UnknownLaw", "law = 'cohesive'", "law = 'cohesiv'", "'cohesiv'", "nearest: cohesive"},
    {"FrictionOfCohesive", "strength = '200 MPa'", "strength = '200 MPa'\nfriction = 0.3", "friction = 0.3",
     "unknown key 'friction' ... strength"},
    {"NegativeFriction", "friction = 0.3", "friction = -0.3", "-0.3", "'friction' in [[contacts]] 2 ... >= 0"},
    {"ContactWithUnknownMaterial", "['soft', 'hard']", "['soft', 'hart']", "'hart'",
     "unknown material ... nearest: hard"},
    {"ContactOfOne", "['soft', 'hard']", "['soft']", "['soft']", "an array of 2 elements"},
    {"ContactWord", "between = 'all'", "between = 'soft'", "'soft'\nlaw = 'mohr", "allowed: all"},
    {"SecondRule", "between = 'all'", "between = ['hard', 'soft']", "['hard', 'soft']",
     "a second rule for hard and soft"},
    {"PairWithoutRule", "between = 'all'", "between = ['soft', 'soft']", "[[contacts]]\nbetween = ['soft', 'soft']",
     "no contact rule ... 'hard' and 'hard'"},
    {"RangeWithinTheElasticPart", "strength = '200 MPa'", "strength = 2e8\nstiffness = 1e15\nrange = 1e-7", "1e-7",
     "more than strength / stiffness"},
    {"MisspeltAuto", "strength = '200 MPa'", "strength = 2e8\nstiffness = 'aut'", "'aut'",
     "\"auto\" or a quantity in Pa/m"},
    {"ProbeOfUnknown", "of = 'floor'", "of = 'flor'", "'flor'", "unknown wall or grains ... nearest: floor"},
    {"ProbeOfGrainsNotWall", "of = 'floor'", "of = 'boxes'", "'boxes'\nperiod", "allowed: floor, lid"},
    {"ProbeWithoutTarget", "of = 'floor'\n", "", "[[probes]]", "missing key 'of'"},
    {"EnergyOfWall", "'friction_factor'", "'energy'", "of = 'floor'", "unknown key 'of'"},
    {"DuplicateProbe", "[frames]", "[[probes]]\nname = 'drag'\nquantity = 'energy'\nperiod = 1\n[frames]",
     "[[probes]]\nname = 'drag'\nquantity = 'energy'", "'drag' ... taken"},
};
INSTANTIATE_TEST_SUITE_P(WallsAndContacts, BadInput, ::testing::ValuesIn(bad_walls_and_contacts), scene_tests::name_of);

TEST(BadInputPlaces, AreThoseOfTheFile) {
  // EXACT: counted by hand, so that line_and_column is not trusted alone.
  EXPECT_TRUE(error_of("title = \"x\"\n\n[time]\nend = \"2 m\"\n").starts_with("4:7: 'end' in [time]: found \"2 m\""));
  EXPECT_TRUE(error_of("[time]\nend = 1\nfoo = 2\n").starts_with("3:1: unknown key 'foo' in [time]"));
  EXPECT_TRUE(error_of("title = \"x\"\n").starts_with("1:1: missing key 'time' in the scene"));
  EXPECT_TRUE(error_of("[time]\nend = 1\n[material.soft]\n")
                  .starts_with("3:2: unknown key 'material' in the scene, perhaps meant as 'materials'"));
  EXPECT_TRUE(error_of("title = \n").starts_with("1:9: not valid TOML"));
}

TEST(BadInputPlaces, AutomaticStiffnessNeedsACompliantBody) {
  // EXACT
  const std::string message = error_of(stones + R"(packing = { kind = "grid", columns = 2, rows = 1, pitch = 2 }
[[contacts]]
between = "all"
law = "frictionless"
)");
  EXPECT_TRUE(message.starts_with("15:1: the stiffness between 'stone' and 'stone' cannot be automatic")) << message;
}

}  // namespace
}  // namespace pliant
