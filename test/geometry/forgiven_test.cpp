// Files as other programs write them: what has one meaning is read, counted and said; what is cut off is refused.
#include <sixdof/geometry/forgiven.h>

#include <bit>
#include <cstring>
#include <optional>
#include <set>

#include <gmock/gmock.h>

#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing_support::little;
using testing_support::message_of;

// A cube of volume 1. Corner i has the bits of i as coordinates.
constexpr std::uint32_t k_triangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
constexpr std::uint32_t k_quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

std::string digit(std::size_t n) { return std::to_string(n); }
std::string corner(std::size_t i) { return digit(i & 1) + " " + digit(i >> 1 & 1) + " " + digit(i >> 2 & 1); }

/// The corners, each between two texts.
std::string corners(const std::string& before = "", const std::string& behind = "\n") {
  std::string text;
  for (std::size_t i = 0; i < 8; ++i) text += before + corner(i) + behind;
  return text;
}

/// "3 0 2 3" and so on.
std::string faces(const std::string& behind = "\n") {
  std::string text;
  for (const auto& t : k_triangles) text += "3 " + digit(t[0]) + " " + digit(t[1]) + " " + digit(t[2]) + behind;
  return text;
}

/// "f 1 3 4 2" and so on. @param behind each number
std::string obj_faces(const std::string& behind = "") {
  std::string text;
  for (const auto& q : k_quads) {
    text += "f";
    for (const std::uint32_t v : q) text += " " + digit(v + 1) + behind;
    text += "\n";
  }
  return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

const std::string k_xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string k_list = "property list uchar int vertex_indices\n";

/// @param format "ascii"; the elements as they stand in the header; the data
std::string ply(const std::string& format, const std::string& elements, const std::string& data) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + data;
}
const std::string k_cube_elements = "element vertex 8\n" + k_xyz + "element face 12\n" + k_list;

std::string binary_cube(bool with_faces = true) {
  std::string bytes;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t k = 0; k < 3; ++k) bytes += little(static_cast<float>(i >> k & 1));
  }
  for (const auto& t : k_triangles) {
    if (!with_faces) break;
    bytes += little(std::uint8_t{3});
    for (const std::uint32_t v : t) bytes += little(v);
  }
  return bytes;
}

struct Case {
  std::string name;  ///< With the format's extension.
  std::string bytes;
  std::optional<Forgiven> kind;  ///< What must be forgiven, and nothing else.
  std::size_t count = 0;
  std::string first_place;
};

/// Fails the test unless each is read as the cube, and only what the case says was forgiven. Cut off anywhere, it is
/// refused or still the cube.
class Forgiving : public testing_support::TestFolder {
 protected:
  void expect_cube(const Case& c, bool cut_off = true) const {
    SCOPED_TRACE(c.name + "\n" + c.bytes.substr(0, 600));
    const auto file = write(c.name, c.bytes);
    ASSERT_EQ(message_of(file), "accepted");
    const Mesh mesh = load_mesh(file);
    EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
    EXPECT_EQ(mesh.triangles().size(), 12u);
    EXPECT_DOUBLE_EQ(mesh.volume(), 1.0);
    for (std::size_t k = 0; k < k_forgiven_kinds; ++k) {
      const bool expected = c.kind && static_cast<std::size_t>(*c.kind) == k;
      const FileRepairs& of_kind = mesh.repairs().forgiven.kinds[k];
      EXPECT_EQ(of_kind.count, expected ? c.count : 0) << key_of(static_cast<Forgiven>(k));
      EXPECT_EQ(of_kind.first_place, expected ? c.first_place : "") << key_of(static_cast<Forgiven>(k));
    }
    EXPECT_EQ(text_of(mesh.repairs().forgiven).empty(), !c.kind);
    for (std::size_t length = 0; cut_off && length < c.bytes.size(); ++length) {
      const auto cut = write("cut" + std::filesystem::path(c.name).extension().string(), c.bytes.substr(0, length));
      if (message_of(cut) == "accepted") {
        ASSERT_EQ(load_mesh(cut).hash(), mesh.hash()) << length << " of " << c.bytes.size() << " bytes";
      }
    }
  }
  void expect_cubes(const std::vector<Case>& cases) const {
    for (const Case& c : cases) expect_cube(c);
  }
};

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
