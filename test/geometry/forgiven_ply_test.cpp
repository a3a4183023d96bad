// PLY files as other programs write them: what has one meaning is read, counted and said; what is cut off is refused.
#include "forgiving.h"

namespace sixdof {
namespace {

TEST_F(Forgiving, PlyValuesAreSeparatedByAnyWhiteSpace) {
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
  const std::string with_normals = "element vertex 8\n" + k_xyz + normals + "element face 12\n" + k_list;
  std::string wrapped;  // 11 values a line
  std::size_t n = 0;
  for (const char c : corners("", " ") + faces(" ")) wrapped += c == ' ' && ++n % 11 == 0 ? '\n' : c;
  std::string vertices_wrapped;  // five values a line, the last line has four
  n = 0;
  for (const char c : corners("", " ")) vertices_wrapped += c == ' ' && ++n % 5 == 0 ? '\n' : c;
  expect_cubes({
      // librealsense: each vertex on two lines
      {"a.ply", ply("ascii", with_normals, corners("", " \n0 0 1 \n") + faces()), Forgiven::loose_elements, 8,
       "line 14: vertex 0"},
      {"b.ply", ply("ascii", k_cube_elements, corners("", " ") + "\n" + faces(" ") + "\n"), Forgiven::loose_elements,
       18, "line 10: vertex 1"},
      {"c.ply", ply("ascii", k_cube_elements, corners("", " ") + faces(" ")), Forgiven::loose_elements, 19,
       "line 10: vertex 1"},
      {"d.ply", ply("ascii", k_cube_elements, replaced(corners() + faces(), " ", "\n")), Forgiven::loose_elements, 20,
       "line 12: vertex 0"},
      {"e.ply", ply("ascii", k_cube_elements, vertices_wrapped + "\n" + faces()), Forgiven::loose_elements, 6,
       "line 11: vertex 1"},
      // Blank lines and tabs are nothing to forgive.
      {"f.ply", ply("ascii", k_cube_elements, replaced(corners() + "\n\n \t\n" + faces(), " ", " \t")), {}},
  });
  std::string faces_wrapped;  // seven values a line
  n = 0;
  for (const char c : faces(" ")) faces_wrapped += c == ' ' && ++n % 7 == 0 ? '\n' : c;
  expect_cube({"h.ply", ply("ascii", k_cube_elements, corners() + faces_wrapped + "\n"), Forgiven::loose_elements, 10,
               "line 19: face 1"});
  // Two kinds of elements that are divided anywhere: a value too many would not show.
  EXPECT_THAT(message_of(write("g.ply", ply("ascii", k_cube_elements, wrapped))),
              HasSubstr("where another kind of element begins"));
}

TEST_F(Forgiving, ValuesTooManyOrTooFewAreFoundInAnyLayout) {
  const auto message = [&](const std::string& data) {
    return message_of(write("a.ply", ply("ascii", k_cube_elements, data)));
  };
  const std::string good = corners() + faces();
  EXPECT_EQ(message(good), "accepted");
  // In the middle, at the first line, and at the last line of a kind.
  for (const std::string line : {"0 1 0\n", "0 0 0\n", "1 1 1\n", "3 4 7 6\n", "3 0 2 3\n", "3 1 7 5\n"}) {
    const std::size_t at = good.find("\n" + line) == std::string::npos ? 0 : good.find("\n" + line) + 1;
    for (const std::string value : {"0", "1", "2", "3", "7", "0.5"}) {
      std::string more = good;
      more.insert(at + line.size() - 1, " " + value);
      EXPECT_NE(message(more), "accepted") << line << " and " << value;
    }
    std::string fewer = good;
    fewer.erase(at + line.size() - 3, 2);
    EXPECT_NE(message(fewer), "accepted") << line;
  }
  // A colour that the header does not announce, on every line.
  EXPECT_NE(message(corners("", " 255\n") + faces()), "accepted");
  EXPECT_NE(message(corners("", " 1 1 1\n") + faces()), "accepted");
}

TEST_F(Forgiving, PlyHeadersOfOtherPrograms) {
  const std::string cube = corners() + faces();
  const std::string good = ply("ascii", k_cube_elements, cube);
  expect_cubes({
      {"a.ply", replaced(good, "ply\n", "ply \t\n"), {}},
      {"b.ply", replaced(good, "element", "comment x\nobj_info y z\nelement"), {}},
      {"c.ply", "ply\ncomment first\nobj_info num_cols 2\n" + good.substr(4), {}},
      {"d.ply", replaced(replaced(good, "float", "float32"), "uchar int", "uint8 int64"), {}},
      {"e.ply", replaced(good, "uchar int", "long ulong"), {}},
      {"f.ply", replaced(good, "uchar int", "int8 uint64"), {}},
      {"g.ply", replaced(good, "float", "half"), {}},
      {"h.ply", replaced(good, "vertex_indices", "vertex_index"), {}},
      // Elements and properties that nobody needs, before, between and behind; colours and normals of other types.
      {"i.ply",
       ply("ascii",
           "element camera 1\nproperty float32 view_px\nproperty list ushort uchar tags\nelement vertex 8\n" + k_xyz +
               "property uint8 red\nproperty list uint8 float32 w\nproperty float nx\nelement edge 2\nproperty int "
               "vertex1\nproperty int vertex2\nelement face 12\nproperty list uchar float32 texcoord\n" +
               k_list + "property list int8 int16 extra\nelement material 1\nproperty uchar k\nelement none 0\n",
           "1.5 2 7 8\n" + corners("", " 0.25 1 0.5 nan\n") + "0 1\n1 2\n" +
               replaced("\n" + faces(" 1 -3\n"), "\n3 ", "\n2 0 0 3 ").substr(1) + "7\n"),
       {}},
  });
  // 8-byte integers in a binary file.
  std::string bytes = binary_cube(false);
  for (const auto& t : k_triangles) {
    bytes += little(std::uint8_t{3});
    for (const std::uint32_t v : t) bytes += little(std::uint64_t{v});
  }
  expect_cube(
      {"j.ply", ply("binary_little_endian", replaced(k_cube_elements, "uchar int", "uchar uint64"), bytes), {}});
}

TEST_F(Forgiving, PlyElementsComeInAnyOrder) {
  const std::string vertex = "element vertex 8\n" + k_xyz, face = "element face 12\n" + k_list;
  std::string quads;
  for (const auto& q : k_quads) {
    quads += "4";
    for (const std::uint32_t v : q) quads += " " + digit(v);
    quads += "\n";
  }
  const std::string binary = binary_cube();
  constexpr std::size_t k_vertex_bytes = 96;
  expect_cubes({
      {"a.ply", ply("ascii", face + vertex, faces() + corners()), {}},
      {"b.ply", ply("ascii", "element face 6\n" + k_list + vertex, quads + corners()), {}},
      {"c.ply", ply("ascii", face + "element edge 1\nproperty int a\n" + vertex, faces() + "1\n" + corners()), {}},
      {"d.ply",
       ply("binary_little_endian", face + vertex, binary.substr(k_vertex_bytes) + binary.substr(0, k_vertex_bytes)),
       {}},
  });
  EXPECT_THAT(message_of(write("e.ply", ply("ascii", face + vertex, replaced(faces(), "7", "8") + corners()))),
              HasSubstr("line 12: face 2: vertex index 8 of 8"));
  // A polygon that is not flat is said to be where it stands.
  const std::string warped = replaced(corners(), "1 1 1", "1 1 1.5");
  const Mesh mesh = load_mesh(write("f.ply", ply("ascii", "element face 6\n" + k_list + vertex, quads + warped)));
  EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::nonplanar_polygons).count, 1u);
  EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::nonplanar_polygons).first_place, "line 11: face 1");
}

TEST_F(Forgiving, FacesOfFewerThanThreeCornersAreSkipped) {
  const auto with = [](const std::string& count) { return replaced(k_cube_elements, "face 12", "face " + count); };
  const std::string vertices = corners("v ");
  expect_cubes({
      {"a.ply", ply("ascii", with("13"), corners() + faces() + "2 0 1\n"), Forgiven::faces_without_area, 1,
       "line 30: face 12"},
      {"b.ply", ply("ascii", with("15"), corners() + "0\n1 7\n2 0 1\n" + faces()), Forgiven::faces_without_area, 3,
       "line 18: face 0"},
      {"c.ply", ply("binary_little_endian", with("13"), binary_cube() + std::string(1, '\0')),
       Forgiven::faces_without_area, 1, "face 12"},
      {"d.off", "OFF\n8 14 0\n" + corners() + "2 0 1\n" + faces() + "1 3\n", Forgiven::faces_without_area, 2,
       "line 11"},
  });
  // OBJ holds no counts: cut off between two faces it is a file of fewer faces.
  expect_cube({"e.obj", vertices + "f 1 2\n" + obj_faces(), Forgiven::faces_without_area, 1, "line 9"}, false);
  EXPECT_THAT(message_of(write("f.obj", vertices + obj_faces() + "f 1")), HasSubstr("a face of 1 corners"));
  EXPECT_THAT(message_of(write("g.obj", vertices + obj_faces() + "f 1 2")), HasSubstr("line 15: a face of 2 corners"));
  EXPECT_THAT(message_of(write("h.ply", ply("ascii", with("12"), corners() + replaced(faces(), "3 1 7 5", "2 1 8")))),
              HasSubstr("vertex index 8 of 8"));
}

TEST_F(Forgiving, VerticesThatAreNotFiniteHarmNobodyIfNobodyUsesThem) {
  const std::string nine = replaced(k_cube_elements, "vertex 8", "vertex 9");
  std::string binary = binary_cube();
  binary.insert(0, little(std::nanf("")) + little(1.0F) + little(2.0F));
  for (std::size_t i = 108, k = 0; k < 12; ++k, i += 13) {
    for (std::size_t c = 0; c < 3; ++c) ++binary[i + 1 + 4 * c];
  }
  const Forgiven kind = Forgiven::unused_bad_vertices;
  expect_cubes({
      {"a.ply", ply("ascii", nine, corners() + "nan nan nan\n" + faces()), kind, 1, "line 18"},
      {"b.ply", ply("ascii", nine, corners() + "-1.#IND 1.#QNAN0 1.#INF\n" + faces()), kind, 1, "line 18"},
      {"c.ply", ply("binary_little_endian", nine, binary), kind, 1, "vertex 0"},
      {"d.off", "OFF\n9 12 0\n" + corners() + "0 inf 0\n" + faces(), kind, 1, "line 11"},
  });
  expect_cube({"e.obj", corners("v ") + "v nan 0 -inf\n" + obj_faces(), kind, 1, "line 9"}, false);
  // Cut-offs of the vertex line itself are finite: "1.#INF" without its end.
  for (const std::string bad : {"nan", "-inf", "1.#IND"}) {
    const std::string text = ply("ascii", k_cube_elements, replaced(corners(), "1 0 0", "1 " + bad + " 0") + faces());
    EXPECT_THAT(message_of(write("f.ply", text)),
                AllOf(HasSubstr("line 11: coordinates (1, "), HasSubstr("not finite; sixdof repair drops such faces")));
  }
}

TEST_F(Forgiving, FacesOfVerticesThatAreNotFiniteAreDroppedOnRequest) {
  const LoadOptions drop{.drop_faces_not_finite = true};
  const std::string nine = replaced(replaced(k_cube_elements, "vertex 8", "vertex 9"), "face 12", "face 13");
  const std::string facet =
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 nan\nvertex 0 1 0\nendloop\nendfacet\n";
  std::string text = "solid\n" + facet;
  std::string binary(80, ' ');
  binary += little(std::uint32_t{13});
  for (const auto& t : k_triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    binary += std::string(12, '\0');
    for (const std::uint32_t v : t) {
      text += "vertex " + corner(v) + "\n";
      for (std::size_t k = 0; k < 3; ++k) binary += little(static_cast<float>(v >> k & 1));
    }
    text += "endloop\nendfacet\n";
    binary += std::string(2, '\0');
  }
  text += "endsolid\n";
  binary += std::string(12, '\0') + little(std::nanf("")) + std::string(34, '\1');
  const struct {
    const char* name;
    std::string bytes;
    const char* place;
    std::size_t unused;
  } cases[] = {
      {"a.ply", ply("ascii", nine, corners() + "nan 0 0\n" + faces() + "3 0 1 8\n"), "line 31: face 12", 1},
      {"b.off", "OFF\n9 13 0\n" + corners() + "0 0 inf\n3 8 1 2\n" + faces(), "line 12", 1},
      {"c.obj", corners("v ") + "v nan 0 0\n" + obj_faces() + "f 1 9 2\n", "line 16", 1},
      {"d.stl", text, "line 5", 0},
      {"e.stl", binary, "triangle 12", 0},
  };
  for (const auto& c : cases) {
    const auto file = write(c.name, c.bytes);
    EXPECT_THAT(message_of(file), HasSubstr("not finite; sixdof repair drops such faces"));
    const Mesh mesh = load_mesh(file, drop);
    EXPECT_TRUE(mesh.solid()) << c.name << mesh.why_not_solid();
    EXPECT_DOUBLE_EQ(mesh.volume(), 1.0);
    const ForgivenKinds& forgiven = mesh.repairs().forgiven;
    EXPECT_EQ(forgiven.of(Forgiven::dropped_faces).count, 1u) << c.name;
    EXPECT_EQ(forgiven.of(Forgiven::dropped_faces).first_place, c.place) << c.name;
    EXPECT_EQ(forgiven.of(Forgiven::unused_bad_vertices).count, c.unused) << c.name;
  }
  // A weight is no damage that could be left out.
  EXPECT_THROW(load_mesh(write("w.obj", replaced(corners("v "), "1 1 1", "1 1 1 2") + obj_faces()), drop), BadFile);
}

TEST_F(Forgiving, PlyTriangleStrips) {
  const std::string vertex = "element vertex 8\n" + k_xyz;
  const std::string strip = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::vector<int> indices{0, 2, 1, 3, -1, 4, 5, 6, 7, -1, 0, 1, 4, 5, -1,
                                 2, 6, 3, 7, -1, 0, 4, 2, 6, -1, 1, 3, 5, 7, -1};
  std::string words = std::to_string(indices.size()), bytes = little(static_cast<std::int32_t>(indices.size())), lists;
  for (const int i : indices) {
    words += " " + std::to_string(i);
    bytes += little(i);
  }
  for (std::size_t i = 0; i < indices.size(); i += 5) {
    lists += "4";
    for (std::size_t k = 0; k < 4; ++k) lists += " " + std::to_string(indices[i + k]);
    lists += "\n";
  }
  // Two sides in one strip, led on by triangles that repeat a vertex.
  const std::string stitched = "10 0 2 1 3 3 4 4 5 6 7\n4 0 1 4 5\n4 2 6 3 7\n4 0 4 2 6\n4 1 3 5 7\n";
  const auto strips = [&](const char* count) { return replaced(strip, "strips 1", std::string("strips ") + count); };
  expect_cubes({
      {"a.ply", ply("binary_little_endian", vertex + strip, binary_cube(false) + bytes), {}},
      {"b.ply", ply("ascii", vertex + strip, corners() + words + "\n"), {}},
      {"c.ply", ply("ascii", vertex + strips("6"), corners() + lists), {}},
      {"d.ply", ply("ascii", strips("5") + vertex, stitched + corners()), {}},
      // Some sides as faces, the others as a strip.
      {"f.ply",
       ply("ascii", vertex + "element face 4\n" + k_list + strips("4"),
           corners() + faces().substr(0, 32) + lists.substr(20)),
       {}},
  });
  // Cut off in its last number, it would have one more triangle.
  expect_cube(
      {"e.ply",
       ply("ascii", vertex + replaced(strip, "int int", "int uint"), corners() + replaced(words, "-1", "4294967295")),
       {}},
      false);
}

}  // namespace
}  // namespace sixdof
