#include "geometry/outline_files.hpp"

namespace pliant {
namespace {

using namespace scene_tests;

Points outline_in(const std::string& extension, const std::string& text, const std::string& unit = "") {
  return read_parts(extension, text, "", unit).at(0);
}

std::string outline_error(const std::string& extension, const std::string& text, const std::string& unit = "") {
  return error_of_parts(extension, text, "", unit);
}

// EXACT: separators, comments, a header, a closing point, either orientation; tolerance: rounding of the unit.
TEST(OutlineFile, ColumnsInAllForms) {
  expect_square(outline_in(".csv", "0,0\n2,0\n2,2\n0,2\n"), 1);
  expect_square(outline_in(".csv", "# a square\nx [mm], y [mm]\n0, 0\n2, 0 # corner\n\n2, 2\n0, 2\n0, 0\n"), 1e-3);
  expect_square(outline_in(".csv", "x;y\r\n0;0\r\n0;2\r\n2;2\r\n2;0\r\n", "um"), 1e-6);
  expect_square(outline_in(".txt", "  0   0\n2 0\n 2\t2 \n0 2"), 1);
  expect_square(outline_in(".csv", "X [cm]\tY [cm]\n0\t0\n+2\t0\n2e0\t2\n0\t2\n"), 1e-2);
}

// EXACT: names and unit in a comment before the first point; other comments mean nothing.
TEST(OutlineFile, ACommentBeforeTheNumbersMayNameTheColumns) {
  const std::string points = "0 0\n2 0\n2 2\n0 2\n";
  expect_square(outline_in(".csv", "# x [mm], y [mm]\n" + points), 1e-3);
  expect_square(outline_in(".csv", "# a square\n# x [mm] y [mm]\n" + points), 1e-3);
  expect_square(outline_in(".csv", "# x [mm], mass\n" + points), 1);
  expect_square(outline_in(".csv", "0 0\n# x [mm], y [mm]\n2 0\n2 2\n0 2\n"), 1);
  expect_square(outline_in(".csv", "x [mm] y [mm]\n" + points), 1e-3);
  expect_refused(outline_error(".csv", "# x [mm], y [cm]\n" + points), "1: the columns have different units",
                 "one unit");
  expect_refused(outline_error(".csv", "x_mm,y_mm\n" + points), "1: found \"x_mm,y_mm\"", "write \"x [mm]\"");
  expect_refused(outline_error(".csv", "0;0\n0,5;0\n"), "2: found \"0,5;0\"", "decimal comma");
  expect_refused(outline_error(".csv", "0,0\n1e200,0\n1e200,1e200\n"), "2: the point (1e+200, 0) is out of range",
                 "at most 1e+12 m");
}

// EXACT: a byte-order mark before a point, a header or a section; the last point off the first by rounding.
TEST(OutlineFile, MarksAndClosingPointsAreReadPast) {
  const std::string mark = "\xEF\xBB\xBF";
  expect_square(outline_in(".csv", mark + "0,0\n2,0\n2,2\n0,2\n"), 1);
  expect_square(outline_in(".csv", mark + "x [mm],y [mm]\n0,0\n2,0\n2,2\n0,2\n"), 1e-3);
  expect_square(outline_in(".csv", "2,0\n2,2\n0,2\n0,0\n2,-4.9e-16\n"), 1);
  expect_square(outline_in(".csv", "2,0\n2,2\n2,2\n0,2\n1e-6,2\n0,0\n2,-1e-6\n2,0\n"), 1);
  expect_square(outline_in(".msh", mark + head_22 + nodes_22 + elements_22), 1);
  expect_refused(outline_error(".csv", mark + "0;a\n"), "1: found \"0;a\"", "two numbers");
  expect_refused(outline_error(".csv", "0,0\n1,0\n0,1e-12\n"), "2: an outline of 2 points", "at least 3");
  expect_refused(outline_error(".csv", "2,0\n2,2\n0,2\n0,0\n2,-1e-5\n2,-4\n"), "6: edges", "cross or touch");
}

TEST(OutlineFile, BadColumnsAreRefusedWithTheirLine) {
  // EXACT: place and words of the message.
  expect_refused(outline_error(".csv", "0,0\n1,0\n"), "2: an outline of 2 points", "at least 3");
  expect_refused(outline_error(".csv", ""), "1: an outline of 0 points", "at least 3");
  expect_refused(outline_error(".csv", "0,0\n1,0\n1,0\n0,1e-7\n0,0\n"), "2: an outline of 2 points", "at least 3");
  expect_refused(outline_error(".csv", "0,0\n1,1\n1,0\n0,1\n"), "3: edges 1 and 3 cross", "closed outline");
  expect_refused(outline_error(".csv", "0,0\n1,0\n1,x\n"), "3: found \"1,x\"", "two numbers");
  expect_refused(outline_error(".csv", "0,0\n1,0,3\n"), "2: found \"1,0,3\"", "two numbers");
  expect_refused(outline_error(".csv", "0,0\n1,nan\n"), "2: found \"1,nan\"", "two numbers");
  expect_refused(outline_error(".csv", "x,z\n0,0\n"), "1: found \"x,z\"", "names of the columns");
  expect_refused(outline_error(".csv", "x [s],y [s]\n0,0\n"), "1: column x: wrong unit", "a unit of length");
  expect_refused(outline_error(".csv", "x [mm],y [m]\n0,0\n"), "1: the columns have different units", "one unit");
  expect_refused(outline_error(".csv", "x [mm],y [mm]\n0,0\n1,0\n0,1\n", "um"), " its columns have a unit",
                 "remove one");
  expect_refused(outline_error(".csv", "0,0\n9,0\n9,9\n0,0\n2,1\n3,1\n3,2\n2,1\n"), "5: a point behind line 4",
                 "no holes");
  std::string many;
  for (int i = 0; i < 101; ++i) many += std::to_string(i) + "," + std::to_string(i * i) + "\n";
  expect_refused(outline_error(".csv", many), "101: an outline of 101 points", "at most 100");
}

// EXACT: the boundary of the elements, inner nodes and lines left out; or the chain of lines; unknown sections skipped.
TEST(OutlineFile, GmshInBothFormats) {
  expect_square(
      outline_in(".msh", head_22 + "$PhysicalNames\n1\n2 1 \"grain\"\n$EndPhysicalNames\n" + nodes_22 + elements_22,
                 "mm"),
      1e-3);
  expect_square(outline_in(".msh", head_22 + nodes_22 +
                                       "$Elements\n4\n1 1 2 0 1 1 2\n2 1 2 0 1 3 2\n3 1 2 0 1 3 4\n"
                                       "4 1 2 0 1 4 1\n$EndElements\n"),
                1);
  expect_square(outline_in(".msh", head_22 + nodes_22 + "$Elements\n1\n1 3 0 1 2 3 4\n$EndElements\n"), 1);
  expect_square(
      outline_in(".msh",
                 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0 0 0\n$EndEntities\n"
                 "$Nodes\n2 5 1 5\n0 1 0 1\n1\n0 0 0\n2 1 0 4\n2\n3\n4\n5\n2 0 0\n2 2 0\n0 2 0\n1 1 0\n$EndNodes\n"
                 "$Elements\n2 5 1 5\n0 1 15 1\n1 1\n2 1 2 4\n2 1 2 5\n3 2 3 5\n4 3 4 5\n5 4 1 5\n$EndElements\n"),
      1);
}

TEST(OutlineFile, BadGmshIsRefusedWithItsLine) {
  // EXACT: place and words of the message.
  const auto lines = [](const std::string& elements) {
    return head_22 + nodes_22 + "$Elements\n" + elements + "$EndElements\n";
  };
  expect_refused(outline_error(".msh", "$MeshFormat\n4.1 1 8\n"), "2: a binary file", "Mesh.Binary = 0");
  expect_refused(outline_error(".msh", "$MeshFormat\n4 0 8\n"), "2: found the format \"4 0 8\"", "gmsh 2.2 or 4.1");
  expect_refused(outline_error(".msh", nodes_22), "1: found $Nodes", "$MeshFormat first");
  expect_refused(outline_error(".msh", "0,0\n1,0\n1,1\n"), "1: found text outside of a section", "$MeshFormat");
  expect_refused(outline_error(".msh", head_22 + "$Nodes\n2\n1 0 0 0\n"), "6: the file ends within a section", "");
  expect_refused(outline_error(".msh", head_22 + nodes_22), "1: no triangles", "closed outline");
  expect_refused(outline_error(".msh", head_22 + "$Nodes\n2\n1 0 0 0\n2 0 0 1\n$EndNodes\n"), "7: a node at z = 1",
                 "one plane");
  expect_refused(outline_error(".msh", head_22 + "$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n"), "7: a second node 1", "");
  expect_refused(outline_error(".msh", head_22 + "$Nodes\n1\n1 0 nan 0\n$EndNodes\n"), "6: found no node",
                 "three coordinates");
  expect_refused(outline_error(".msh", lines("1\n1 9 0 1 2 3 4 5 6\n")), "14: an element of type 9", "first order");
  expect_refused(outline_error(".msh", lines("1\n1 2 0 1 2\n")), "14: found 5 numbers", "3 of them nodes");
  expect_refused(outline_error(".msh", lines("1\n1 2 0 1 2 7\n")), "14: unknown node 7", "");
  expect_refused(outline_error(".msh", lines("2\n1 1 0 1 2\n2 1 0 2 3\n")), "6: node 1: 1 edges", "a closed outline");
  // Two triangles that share a corner only.
  expect_refused(error_of_parts(".msh", lines("2\n1 2 0 1 2 9\n2 2 0 3 4 9\n"), "merged"), "10: node 9: 4 edges",
                 "touch itself");
}

TEST(OutlineFile, HolesAreRefused) {
  // EXACT: a square ring of eight triangles, and the same triangles apart from each other.
  const auto ring = [](double inner, double shift) {
    std::string text = head_22 + "$Nodes\n8\n";
    int tag = 0;
    for (const double size : {2.0, inner})
      for (const Vec2& p : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
        text += std::to_string(++tag) + " " + std::to_string(size * p.x() + (size == inner ? shift : 0)) + " " +
                std::to_string(size * p.y()) + " 0\n";
    return text + "$EndNodes\n$Elements\n8\n";
  };
  std::string elements;
  for (int i = 0; i < 4; ++i) {
    const int a = i + 1, b = (i + 1) % 4 + 1;
    elements += "1 2 0 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(a + 4) + "\n";
    elements += "1 2 0 " + std::to_string(b) + " " + std::to_string(b + 4) + " " + std::to_string(a + 4) + "\n";
  }
  expect_refused(outline_error(".msh", ring(1, 0) + elements + "$EndElements\n"), "10: the outline has a hole",
                 "fill it");
  const std::string apart = "1 1 0 1 2\n1 1 0 2 3\n1 1 0 3 4\n1 1 0 4 1\n1 1 0 5 6\n1 1 0 6 7\n1 1 0 7 8\n1 1 0 8 5\n";
  expect_refused(outline_error(".msh", ring(1, 9) + apart + "$EndElements\n"), "10: 2 parts, \"1\", \"2\"",
                 "parts = \"all\"");
}

}  // namespace
}  // namespace pliant
