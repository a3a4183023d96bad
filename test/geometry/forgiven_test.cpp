// Files as other programs write them: what has one meaning is read, counted and said; what is cut off is refused.
#include "forgiving.h"

namespace sixdof {
namespace {

TEST_F(Forgiving, LinesMayEndInCarriageReturns) {
  const auto returns = [](const std::string& text) { return replaced(text, "\n", "\r"); };
  const std::string text_ply = ply("ascii", k_cube_elements, corners() + faces());
  const std::string head = ply("binary_little_endian", k_cube_elements, "");
  std::string stl = "solid\n";
  for (const auto& t : k_triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) stl += "vertex " + corner(v) + "\n";
    stl += "endloop\nendfacet\n";
  }
  stl += "endsolid\n";
  const Forgiven kind = Forgiven::lone_returns;
  expect_cubes({
      {"a.ply", returns(text_ply), kind, 29, "line 1"},
      {"b.ply", returns(head) + binary_cube(), kind, 9, "line 1"},
      {"c.off", returns("OFF\n8 12 0\n" + corners() + faces()), kind, 22, "line 1"},
      {"d.stl", returns(stl), kind, 86, "line 1"},
      {"e.ply", replaced(text_ply, "\n", "\r\n"), {}},
      {"f.ply", replaced(head, "\n", "\r\n") + binary_cube(), {}},
      // Mixed: only the vertices' lines.
      {"g.off", "OFF\n8 12 0\r\n" + returns(corners()) + faces(), kind, 8, "line 3"},
  });
  expect_cube({"h.obj", returns("# made by hand\n" + corners("v ") + obj_faces()), kind, 15, "line 1"}, false);
  expect_cube({"i.obj", returns(replaced(corners("v ") + obj_faces(), "f 1 3", "f 1 \\\n3")), kind, 15, "line 1"},
              false);
  // Data of a binary file that begin with a line feed belong to the data, whatever the header's lines end in.
  const std::string low = little(std::bit_cast<float>(std::uint32_t{0x0A0A0A0A}));
  for (const std::string end : {"\r", "\r\n", "\n"}) {
    std::string bytes = binary_cube();
    std::memcpy(bytes.data(), low.data(), 4);
    const auto file = write("j.ply", replaced(head, "\n", end) + bytes);
    ASSERT_EQ(message_of(file), "accepted") << end;
    EXPECT_EQ(load_mesh(file).vertices()[0].x(), std::bit_cast<float>(std::uint32_t{0x0A0A0A0A}));
  }
}

TEST_F(Forgiving, BlankBytesBehindBinaryData) {
  const std::string file = ply("binary_little_endian", k_cube_elements, binary_cube());
  const std::string place = "byte " + std::to_string(file.size());
  std::string stl = "solid made by a CAD program";
  stl.resize(80, ' ');
  stl += little(std::uint32_t{12});
  for (const auto& t : k_triangles) {
    stl += std::string(12, '\0');
    for (const std::uint32_t v : t) {
      for (std::size_t k = 0; k < 3; ++k) stl += little(static_cast<float>(v >> k & 1));
    }
    stl += std::string(2, '\0');
  }
  const Forgiven kind = Forgiven::trailing_blanks;
  expect_cubes({
      {"a.ply", file + "\n", kind, 1, place},
      {"b.ply", file + "\r\n", kind, 2, place},
      {"c.ply", file + "\n \n", kind, 3, place},
      {"d.stl", stl + "\n", kind, 1, "byte 684"},
      {"e.stl", stl + "\r\n\r\n", kind, 4, "byte 684"},
      {"f.ply", ply("ascii", k_cube_elements, corners() + faces() + "\n \t\n"), {}},
  });
  EXPECT_THAT(message_of(write("g.ply", file + "\nx")), HasSubstr("2 bytes behind the last element"));
  EXPECT_THAT(message_of(write("h.stl", stl + "\n0")), HasSubstr("602 follow"));
}

TEST_F(Forgiving, ObjCornersWithEmptyNumbers) {
  const std::string head = corners("v ") + "vt 0 0\nvn 0 0 1\n";
  const Forgiven kind = Forgiven::empty_numbers;
  const std::vector<Case> cases{
      {"a.obj", head + obj_faces("//"), kind, 24, "line 11"},
      {"b.obj", head + obj_faces("/"), kind, 24, "line 11"},
      {"c.obj", head + obj_faces("/1/"), kind, 24, "line 11"},
      {"d.obj", head + obj_faces("//1"), {}},
      {"e.obj", head + obj_faces("/1"), {}},
      {"f.obj", head + obj_faces("/-1/-1"), {}},
      {"g.obj", head + replaced(obj_faces(), "f 1 3 4 2", "f 1// 3//1 4/ 2"), kind, 2, "line 11"},
  };
  for (const Case& c : cases) expect_cube(c, false);
  for (const std::string bad : {"f //1 2 3", "f / 2 3", "f 1/x 2 3", "f 1//x 2 3", "f 1/2/3/4 2 3", "f 1 / 2 3"}) {
    EXPECT_NE(message_of(write("h.obj", head + bad + "\n")), "accepted") << bad;
  }
}

TEST_F(Forgiving, ObjVerticesWithWeightsAndColours) {
  const auto all = [](const std::string& behind) { return corners("v ", behind + "\n") + obj_faces(); };
  for (const std::string behind : {"", " 1", " 1.0", " 0.5 0.25 0.125", " 128 200 12", " 1 0.5 0.5 0.5"}) {
    expect_cube({"a.obj", all(behind), {}}, false);
  }
  // ZBrush: colours in comments; control points of a curve beside the cube may have any weight.
  expect_cube({"b.obj", "#MRGB ffff0a0bff0a0b0c\n" + all(""), {}}, false);
  expect_cube({"c.obj", all("") + "v 1 2 3 0.5\nv 2 2 2 2\n", {}}, false);
  for (const std::string weight : {"2.0", "0", "-1", "0.5", "nan"}) {
    EXPECT_THAT(message_of(write("d.obj", all(" " + weight))),
                AllOf(HasSubstr("line 1: a vertex of weight "), HasSubstr("which faces use (line 9)")));
  }
}

TEST_F(Forgiving, ObjFilesOfOtherPrograms) {
  const std::string faces_first = obj_faces() + corners("v ");
  const std::string blender = "# Blender 4.2.3\n# www.blender.org\nmtllib cube.mtl\no Cube\n" + corners("v ") +
                              "vn 0 0 1\nvt 0 0\ns 0\nusemtl Material\n" + obj_faces("/1/1");
  std::string relative = replaced("\n" + obj_faces(), "\n", " \n");
  for (std::size_t v = 1; v <= 8; ++v) relative = replaced(relative, " " + digit(v) + " ", " -" + digit(9 - v) + "  ");
  const std::string curve = "cstype bspline\ndeg 3\nvp 0.5\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\n";
  const std::vector<Case> cases{
      {"a.obj", blender, {}},
      {"b.obj", faces_first, Forgiven::late_vertices, 6, "line 1"},
      {"c.obj", corners("v ").substr(0, 40) + obj_faces() + corners("v ").substr(40), Forgiven::late_vertices, 5,
       "line 7"},
      {"d.obj", corners("v ") + relative, {}},
      {"e.obj", corners("v ") + replaced(obj_faces(), "f ", "fo "), {}},
      {"f.obj", corners("v ") + replaced(obj_faces(), " 4", " \\\n 4"), {}},
      {"g.obj", corners("v ") + "g onshape\nusemtl red # dark\n" + replaced(obj_faces(), "\n", "\ng part\n"), {}},
      {"h.obj", corners("v ") + obj_faces() + curve + "l 1 2 3\np 1\n", Forgiven::skipped_statements, 5, "line 15"},
      {"i.obj", replaced(corners("v\t"), "1", "1.000000e+00") + obj_faces(), {}},
  };
  for (const Case& c : cases) expect_cube(c, false);
  EXPECT_THAT(message_of(write("j.obj", replaced(faces_first, "v 1 1 1\n", ""))),
              HasSubstr("line 2: vertex 8 of the 7 in the file"));
}

TEST_F(Forgiving, OffInItsDialects) {
  const auto off = [](const std::string& keyword, const std::string& vertex_end, const std::string& counts = "8 12 0") {
    return keyword + "\n" + counts + "\n" + corners("", vertex_end + "\n") + faces();
  };
  const Forgiven undeclared = Forgiven::undeclared_values, keyword = Forgiven::off_keyword;
  std::string coloured = "OFF\n8 12 0\n" + corners();
  const char* const colours[] = {" 255 0 0\n", " 0.5 0.5 0.5 1\n", " 3\n", "\n"};
  for (std::size_t i = 0; i < 12; ++i) {
    for (const std::uint32_t v : k_triangles[i]) coloured += (v == k_triangles[i][0] ? "3 " : " ") + digit(v);
    coloured += colours[i % 4];
  }
  expect_cubes({
      {"a.off", off("OFF", " 10 20 30 255"), undeclared, 8, "line 3"},
      {"b.off", off("OFF", " 0.5 0.5 0.5"), undeclared, 8, "line 3"},
      {"c.off", off("OFF", " 0 0 1 10 20 30 255"), undeclared, 8, "line 3"},
      {"d.off", off("COFF", " 10 20 30 255"), {}},
      {"e.off", off("COFF", " 0.5 0.25 1"), {}},
      {"f.off", off("NOFF", " 0 0 1"), {}},
      {"g.off", off("NCOFF", " 0 0 1 1 1 1 1"), {}},  // MeshLab
      {"h.off", off("STCNOFF", " 1 1 1 1 0 0 1 0.5 0.5"), {}},
      {"i.off", off("4OFF", " 1"), {}},
      {"j.off", replaced(off("4OFF", " 1"), "1 1 1 1\n", "2 2 2 2\n"), {}},
      {"k.off", off("nOFF 3", ""), {}},
      {"l.off", off("nOFF\n3", ""), {}},
      {"m.off", coloured, {}},
      {"n.off", replaced(off("OFF", ""), "OFF\n", "OFF "), {}},
      {"o.off", replaced(off("OFF", ""), "OFF\n", "OFF"), keyword, 1, "line 1"},  // ModelNet
      {"p.off", replaced(off("OFF", ""), "OFF\n", ""), keyword, 1, "line 1"},
      {"q.off", off("OFF", "", "8\n12\n0"), {}},
      {"r.off", off("OFF", "", "8 12"), {}},
      {"s.off", "# x\nOFF # y\n# z\n8 12 0 # w\n\n" + corners("", " # v\n") + "# t\n" + faces(), {}},
      {"t.off", "OFF\n8 12 0\n" + corners("", " ") + "\n" + faces(), Forgiven::loose_elements, 7, "line 3: vertex 1"},
      {"u.off", "OFF\n8 12 0\n" + replaced(corners(), " ", "\n") + faces(), Forgiven::loose_elements, 8,
       "line 5: vertex 0"},
  });
  EXPECT_THAT(message_of(write("v.off", off("OFF", " 7"))), HasSubstr("line 3: vertex 0 has 4 values, not 3"));
  EXPECT_THAT(message_of(write("v.off", off("OFF", " 7 8"))), HasSubstr("line 3: vertex 0 has 5 values, not 3"));
  EXPECT_THAT(message_of(write("v.off", replaced(off("OFF", " 1 1 1 1"), "1 1 1 1 1 1 1", "1 1 1"))),
              HasSubstr("vertex 7 has 3 values, not 7"));
  EXPECT_THAT(message_of(write("v.off", replaced(off("4OFF", " 1"), "1 1 1 1", "1 1 1 0"))), HasSubstr("not finite"));
  EXPECT_THAT(message_of(write("v.off", off("nOFF\n4", " 1"))), HasSubstr("4 dimensions are not supported"));
  EXPECT_THAT(message_of(write("v.off", off("4nOFF\n3", " 1"))), HasSubstr("4nOFF is not supported"));
  EXPECT_THAT(message_of(write("v.off", off("COFF BINARY", " 1"))), HasSubstr("binary OFF is not supported"));
}

TEST_F(Forgiving, StlTextsOfOtherPrograms) {
  const auto stl = [](const std::string& begin, const std::string& end) {
    std::string text = begin;
    for (const auto& t : k_triangles) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const std::uint32_t v : t) text += "vertex " + corner(v) + "\n";
      text += "endloop\nendfacet\n";
    }
    return text + end;
  };
  const std::string good = stl("solid t\n", "endsolid t\n");
  const Forgiven keywords = Forgiven::stl_keywords, outside = Forgiven::outside_solids;
  expect_cubes({
      {"a.stl", replaced(replaced(good, "endloop", "end loop"), "endfacet", "end facet"), keywords, 24, "line 7"},
      {"b.stl", stl("solid t\n", "end solid t\n"), keywords, 1, "line 86"},
      {"c.stl", replaced(good, "outer loop", "outerloop"), keywords, 12, "line 3"},
      {"d.stl", replaced(good, "end", "END "), keywords, 25, "line 7"},
      {"e.stl", good + "\n# exported by x\n", outside, 1, "line 88"},
      {"f.stl", good + "End of file\n\nsolids: 1\n", outside, 2, "line 87"},
      {"g.stl", stl("solid\n", "endsolid"), {}},
      {"h.stl",
       replaced(replaced(good, "facet normal 0 0 0", "  FACET NORMAL nan -nan(ind) 1.#QNAN"), "1", "1.000000e+000"),
       {}},
      {"i.stl", replaced(good, "solid t", "solid  a name: of (some) words"), {}},
      {"j.stl", "\n\n" + good, {}},
      {"k.stl", replaced(good, "\n", "\r\n"), {}},
  });
  // Several solids, with a comment between them.
  const std::size_t half = good.find("\nfacet", good.size() / 2) + 1;
  expect_cube(
      {"l.stl", good.substr(0, half) + "endsolid t\n# next\nsolid\n" + good.substr(half), outside, 1,
       "line " + std::to_string(2 + std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(half), '\n'))},
      false);
  // Cut off: between two facets, in a keyword, before the second solid's name; and facets outside of a solid.
  EXPECT_THAT(message_of(write("m.stl", good.substr(0, half))), HasSubstr("the file ends within a solid"));
  EXPECT_THAT(message_of(write("m.stl", good.substr(0, good.size() - 6))), HasSubstr("or 'endsolid', is expected"));
  EXPECT_THAT(message_of(write("m.stl", good + "sol")), HasSubstr("line 87: the file ends within the word 'solid'"));
  EXPECT_THAT(message_of(write("m.stl", good + good.substr(8))), HasSubstr("line 87: 'solid' is expected"));
}

TEST(ForgivenText, NamesCountKindAndPlace) {
  ForgivenKinds forgiven;
  EXPECT_EQ(text_of(forgiven), "");
  for (const char* line : {"line 3", "line 7"}) forgiven.add(Forgiven::lone_returns, [&] { return std::string(line); });
  forgiven.add(Forgiven::off_keyword, [] { return std::string("line 1"); });
  EXPECT_EQ(text_of(forgiven),
            "2 lines that end in a carriage return alone (first: line 3); 1 keyword OFF missing or without a blank "
            "behind it (line 1)");
  std::set<std::string> keys;
  for (std::size_t k = 0; k < k_forgiven_kinds; ++k) keys.insert(key_of(static_cast<Forgiven>(k)));
  EXPECT_EQ(keys.size(), k_forgiven_kinds);
}

}  // namespace
}  // namespace sixdof
