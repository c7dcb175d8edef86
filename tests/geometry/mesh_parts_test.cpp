// Several bodies in one mesh. All EXACT but for rounding.
#include "geometry/mesh_parts.hpp"

#include <fmt/format.h>

#include "geometry/outline_files.hpp"

namespace pliant {
namespace {

using namespace scene_tests;

// Three squares of two triangles each: 1 and 2 share their border by two nodes each (5 and 6 at the places of 2 and 3),
// 3 lies apart.
const std::string squares_nodes =
    "$Nodes\n12\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 2 0 0\n6 2 2 0\n7 4 2 0\n8 4 0 0\n"
    "9 7 0 0\n10 9 0 0\n11 9 2 0\n12 7 2 0\n$EndNodes\n";
const std::string names_22 = "$PhysicalNames\n3\n1 7 \"side\"\n2 7 \"stone\"\n2 8 \"soft clay\"\n$EndPhysicalNames\n";

/// Of the groups of the three squares.
std::string squares(int first, int second, int third) {
  std::string text = "$Elements\n6\n";
  const int groups[3] = {first, second, third};
  const int corners[3][4] = {{1, 2, 3, 4}, {5, 8, 7, 6}, {9, 10, 11, 12}};
  int number = 0;
  for (int s = 0; s < 3; ++s)
    for (const int t : {1, 2})
      text +=
          fmt::format("{} 2 2 {} 1 {} {} {}\n", ++number, groups[s], corners[s][0], corners[s][t], corners[s][t + 1]);
  return text + "$EndElements\n";
}

std::vector<std::string> names_of_parts(const std::string& text) {
  const GmshMesh mesh = read_gmsh_file("a.msh", text);
  std::vector<std::string> names;
  for (const MeshPart& part : parts_of(mesh)) names.push_back(part.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(MeshParts, AreCalledByTheirGroups) {
  EXPECT_EQ(names_of_parts(head_22 + squares_nodes + squares(0, 0, 0)), (Names{"1", "2", "3"}));
  EXPECT_EQ(names_of_parts(head_22 + names_22 + squares_nodes + squares(7, 7, 8)),
            (Names{"stone.1", "stone.2", "soft clay"}));
  EXPECT_EQ(names_of_parts(head_22 + names_22 + squares_nodes + squares(8, 7, 9)),
            (Names{"soft clay", "stone", "group 9"}));
}

TEST(MeshParts, LieWhereTheFileHasThem) {
  const std::string text = head_22 + names_22 + squares_nodes + squares(7, 7, 8);
  const std::vector<Points> all = read_parts(".msh", text, "all", "mm");
  ASSERT_EQ(all.size(), 3U);
  const double left[3] = {0, 2, 7};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((polygon_properties(all[i]).centroid - 1e-3 * Vec2(left[i] + 1, 1)).norm(), 0, 1e-17);
    EXPECT_NEAR(signed_area(all[i]), 4e-6, 1e-20);
  }
  const std::vector<Points> stones = read_parts(".msh", text, "stone", "mm"),
                            second = read_parts(".msh", text, "stone.2", "mm");
  EXPECT_EQ(stones, (std::vector<Points>{all[0], all[1]}));
  EXPECT_EQ(second, (std::vector<Points>{all[1]}));
  EXPECT_EQ(read_parts(".msh", text, "soft clay", "mm"), (std::vector<Points>{all[2]}));
}

// A square of two groups that share their nodes is two bodies, or one.
TEST(MeshParts, OfTwoGroupsWithCommonNodes) {
  const std::string text = head_22 + nodes_22 +
                           "$Elements\n4\n1 2 2 1 1 1 2 9\n2 2 2 1 1 2 3 9\n3 2 2 2 1 3 4 9\n4 2 2 2 1 4 1 9\n"
                           "$EndElements\n";
  expect_refused(error_of_parts(".msh", text, ""), "8: 2 parts, \"group 1\", \"group 2\"",
                 "meet at 3 nodes, the first at (0, 0): if they are one body, take");
  const std::vector<Points> halves = read_parts(".msh", text, "all");
  ASSERT_EQ(halves.size(), 2U);
  EXPECT_NEAR(signed_area(halves[0]), 2, 1e-15);
  expect_square(read_parts(".msh", text, "merged").at(0), 1);
}

// Groups of format 4.1 are those of the surfaces, which may name them with a sign.
TEST(MeshParts, OfFormat41) {
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 5 \"left half\"\n$EndPhysicalNames\n"
      "$Entities\n1 1 2 0\n1 0 0 0 0\n1 0 0 0 2 0 0 1 3 2 1 1\n1 0 0 0 1 2 0 2 -5 6 0\n2 1 0 0 2 2 0 0 "
      "0\n$EndEntities\n"
      "$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n1 0 0\n1 2 0\n0 2 0\n5 0 0\n5 2 0\n$EndNodes\n"
      "$Elements\n3 3 1 3\n1 1 1 1\n1 1 2\n2 1 3 1\n2 1 2 3 4\n2 2 3 1\n3 2 5 6 3\n$EndElements\n";
  EXPECT_EQ(names_of_parts(text), (Names{"left half", "1"}));
  EXPECT_NEAR(signed_area(read_parts(".msh", text, "left half").at(0)), 2, 1e-15);
}

// gmsh writes an element once for each group that it is in.
TEST(MeshParts, AnElementInTwoGroupsIsOne) {
  const std::string text =
      head_22 + nodes_22 +
      "$Elements\n4\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n3 2 2 2 1 1 2 3\n4 2 2 2 1 1 3 4\n$EndElements\n";
  expect_square(read_parts(".msh", text, "").at(0), 1);
}

TEST(MeshParts, ChainsOfLinesArePartsToo) {
  const std::string chains =
      head_22 + squares_nodes +
      "$Elements\n8\n1 1 2 1 1 1 2\n2 1 2 2 1 2 3\n3 1 2 1 1 3 4\n4 1 2 1 1 4 1\n5 1 2 3 1 9 10\n6 1 2 3 1 10 11\n"
      "7 1 2 3 1 11 12\n8 1 2 3 1 12 9\n$EndElements\n";
  EXPECT_EQ(names_of_parts(chains), (Names{"1", "group 3"})) << "sides have groups of their own";
  EXPECT_EQ(read_parts(".msh", chains, "all").size(), 2U);
  expect_square(read_parts(".msh", chains, "1").at(0), 1);
  const std::string open = head_22 + squares_nodes + "$Elements\n3\n1 1 0 1 2\n2 1 0 5 6\n3 1 0 3 1\n$EndElements\n";
  expect_refused(error_of_parts(".msh", open, ""), "10: 2 parts", "they meet at 2 nodes");
  EXPECT_NEAR(signed_area(read_parts(".msh", open, "merged").at(0)), 2, 1e-15);
}

TEST(MeshParts, AChoiceIsAskedForWithTheNames) {
  const std::string text = head_22 + names_22 + squares_nodes + squares(7, 7, 8);
  expect_refused(error_of_parts(".msh", text, ""), "16: 3 parts, \"stone.1\", \"stone.2\", \"soft clay\"; allowed: one",
                 "they meet at 2 nodes, 2 of which the mesh has twice, the first at (2, 0): if they are one body, "
                 "merge them (in gmsh: Coherence");
  expect_refused(error_of_parts(".msh", text, "stone.3"), " no part \"stone.3\"",
                 "allowed: all, merged, stone, stone.1, stone.2, soft clay; nearest: stone.1");
  expect_refused(error_of_parts(".msh", text, "merged"), "20: a second outline", "share their nodes");
  expect_refused(error_of_parts(".csv", "0,0\n1,0\n0,1\n", "all"), " has no parts", ".msh");
  expect_refused(error_of_parts(".msh", head_22 + "$PhysicalNames\n1\n2 7 stone\n", ""), "6: found no physical group",
                 "\"name\"");
  expect_refused(error_of_parts(".msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0\n", ""),
                 "6: found no entity", "physical groups");
}

// A square whose two halves do not share the nodes of their border is one body, once they are merged; and so is one cut
// along a line within.
TEST(MeshParts, NodesAtOnePlaceAreSaidOrMerged) {
  const auto halves = [](const char* third) {
    return head_22 + "$Nodes\n6\n1 0 0 0\n2 2 0 0\n3 " + third + " 2 0\n4 0 2 0\n5 0 0 0\n6 2 2 0\n$EndNodes\n" +
           "$Elements\n2\n1 2 0 1 2 3\n2 2 0 5 6 4\n$EndElements\n";
  };
  expect_refused(error_of_parts(".msh", halves("2"), ""), "10: 2 parts, \"1\", \"2\"", "meet at 2 nodes");
  expect_square(read_parts(".msh", halves("2"), "merged").at(0), 1);
  expect_square(read_parts(".msh", halves("2.00000000000000001"), "merged").at(0), 1);
  expect_refused(error_of_parts(".msh", halves("1.999999"), "merged"), "6: node 1: 4 edges", "touch itself");
  // A chain of lines whose ends lie at one place.
  const std::string ends =
      head_22 + squares_nodes + "$Elements\n4\n1 1 0 2 3\n2 1 0 3 4\n3 1 0 4 1\n4 1 0 1 5\n$EndElements\n";
  expect_refused(error_of_parts(".msh", ends, ""), "10: a node lies on the outline at the place of another one",
                 "merged");
  expect_square(read_parts(".msh", ends, "merged").at(0), 1);
  // Four triangles around the middle, the first and the last not joined along the way from there to the corner.
  const std::string cut = head_22 + "$Nodes\n6\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 1 0\n6 0 0 0\n$EndNodes\n" +
                          "$Elements\n4\n1 2 0 1 2 5\n2 2 0 2 3 5\n3 2 0 3 4 5\n4 2 0 4 6 5\n$EndElements\n";
  expect_refused(error_of_parts(".msh", cut, ""),
                 "11: a node lies on the outline at the place of another one, the first, 6, at that of 1, (0, 0)",
                 "parts = \"merged\"");
  expect_square(read_parts(".msh", cut, "merged").at(0), 1);
}

TEST(MeshParts, AHoleIsThatOfItsPart) {
  // A square ring around a square, of eight and two triangles.
  std::string text = head_22 + "$Nodes\n8\n";
  int tag = 0;
  for (const double size : {2.0, 1.0})
    for (const Vec2& p : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
      text += fmt::format("{} {} {} 0\n", ++tag, size * p.x(), size * p.y());
  text += "$EndNodes\n$Elements\n10\n1 2 2 2 1 5 6 7\n1 2 2 2 1 5 7 8\n";
  for (int i = 0; i < 4; ++i) {
    const int a = i + 1, b = (i + 1) % 4 + 1;
    text += fmt::format("1 2 2 1 1 {0} {1} {2}\n1 2 2 1 1 {1} {3} {2}\n", a, b, a + 4, b + 4);
  }
  text += "$EndElements\n";
  expect_refused(error_of_parts(".msh", text, "all"), "10: the outline of part \"group 1\" has a hole", "fill it");
  EXPECT_NEAR(signed_area(read_parts(".msh", text, "group 2").at(0)), 4, 1e-15);
  EXPECT_NEAR(signed_area(read_parts(".msh", text, "merged").at(0)), 16, 1e-14);
}

}  // namespace
}  // namespace pliant
