#include <sixdof/geometry/load.h>

#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>

#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing_support::as_float;
using testing_support::little;
using testing_support::message_of;

class Load : public testing_support::TestFolder {};

// The tetrahedron of all small files; its volume is det / 6.
const std::string k_off =
    "OFF\n4 4 6\n0.3 -0.2 0.7\n2.7 -0.2 0.7\n0.9 1.5 0.7\n0.5 0.4 3.8\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const std::string k_obj =
    "v 0.3 -0.2 0.7\nv 2.7 -0.2 0.7\nv 0.9 1.5 0.7\nv 0.5 0.4 3.8\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST_F(Load, OffInItsVariants) {
  const Mesh mesh = load_mesh(write("a.off", k_off));
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  EXPECT_EQ(mesh.vertices()[1], Eigen::Vector3d(2.7, -0.2, 0.7));
  EXPECT_EQ(mesh.name(), "a");
  const std::string body = k_off.substr(k_off.find('\n') + 1);
  const std::string points = body.substr(6, body.find("3 0 2") - 6);
  const std::string faces = body.substr(body.find("3 0 2"));
  for (const std::string& variant : std::vector<std::string>{
           "OFF 4 4 6\n" + body.substr(6), "# made by hand\n\nOFF # keyword\n\n" + body, "OFF\n4 4\n" + points + faces,
           "COFF\n4 4 6\n0.3 -0.2 0.7 255 0 0 255\n2.7 -0.2 0.7 0 0 0 1\n0.9 1.5 0.7 1 1 1 1\n0.5 0.4 3.8 1 1 1 1\n" +
               faces,
           "OFF\n4 4 6\n" + points + "3 0 2 1 255 0 0\n3 0 1 3 0.1 0.2 0.3 1\n3 1 2 3 7\n3 2 0 3\n",
           "OFF\r\n4 4 6\r\n0.3 -.2 +0.7\r\n27e-1 -0.2 0.7\r\n0.9 1.5 0.7\r\n0.5 0.4 3.8 \r\n3 0 2 1\r\n3 0 1 3\r\n3 1 "
           "2 "
           "3\r\n3 2 0 3\r\n"}) {
    const auto file = write("b.OFF", variant);
    ASSERT_EQ(message_of(file), "accepted") << variant;
    EXPECT_EQ(load_mesh(file).hash(), mesh.hash()) << variant;
  }
}

TEST_F(Load, ObjInItsVariants) {
  const Mesh mesh = load_mesh(write("a.off", k_off));
  const std::string points = k_obj.substr(0, k_obj.find('f'));
  for (const std::string& variant :
       std::vector<std::string>{k_obj, points + "f -4 -2 -3\nf -4 -3 -1\nf 2 -2 4\nf 3 1 4\n",
                                "mtllib x.mtl\no thing\ng part\n" + points + "vt 0 0\nvn 0 0 1\ns off\nusemtl red\n" +
                                    "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 2/1 3/1 4/1\nf 3 1 \\\n 4\nl 1 2\np 3\n",
                                "v 0.3 -0.2 0.7 1\nv 2.7 -0.2 0.7 0.5 0.5 0.5\nv 0.9 1.5 0.7\nv 0.5 0.4 3.8\nf 1 3 "
                                "2\nf 1 2 4 # x\nf 2 3 4\nf "
                                "3 1 4\n"}) {
    const auto file = write("b.obj", variant);
    ASSERT_EQ(message_of(file), "accepted") << variant;
    EXPECT_EQ(load_mesh(file).hash(), mesh.hash()) << variant;
  }
}

std::string big(auto value) {
  std::string bytes = little(value);
  return {bytes.rbegin(), bytes.rend()};
}

TEST_F(Load, PlyInItsVariants) {
  const Mesh mesh = load_mesh(write("a.off", k_off));
  const std::string head = "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n";
  const std::string points = k_off.substr(k_off.find("0.3"), k_off.find("3 0 2") - k_off.find("0.3"));
  const std::string faces = k_off.substr(k_off.find("3 0 2"));
  const std::string list = "property list uchar int vertex_indices\nend_header\n";
  std::vector<std::string> variants;
  variants.push_back("ply\nformat ascii 1.0\ncomment end_header\nobj_info x\n" + head + "element face 4\n" + list +
                     points + faces);
  variants.push_back(
      "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float64 x\r\nproperty float64 y\r\n"
      "property float64 z\r\nelement face 4\r\nproperty list uint8 uint32 vertex_index\r\nend_header\r\n" +
      points + faces);
  // Other elements, other properties, another order of the axes, lists where nobody needs them.
  variants.push_back(
      "ply\nformat ascii 1.0\nelement camera 2\nproperty int id\nproperty list uchar float matrix\nelement vertex 4\n"
      "property uchar red\nproperty double z\nproperty double y\nproperty double x\nproperty list int int rings\n"
      "element face 4\nproperty int flags\nproperty list int ushort vertex_indices\nproperty list uchar float uv\n"
      "element edge 1\nproperty int vertex1\nend_header\n"
      "7 2 0.5 0.5\n8 0\n"
      "255 0.7 -0.2 0.3 0\n0 0.7 -0.2 2.7 2 5 6\n1 0.7 1.5 0.9 0\n2 3.8 0.4 0.5 1 9\n"
      "-1 3 0 2 1 0\n0 3 0 1 3 2 0.1 0.2\n0 3 1 2 3 0\n0 3 2 0 3 0\n5\n");
  for (const bool is_little : {true, false}) {
    std::string bytes = std::string("ply\nformat binary_") + (is_little ? "little" : "big") + "_endian 1.0\n" + head +
                        "property short s\nelement face 4\nproperty list ushort uint vertex_indices\n" +
                        "property list uchar double weights\nend_header\n";
    const auto put = [&](auto value) { bytes += is_little ? little(value) : big(value); };
    for (const auto& p : mesh.vertices()) {
      for (const double x : p) put(x);
      put(std::int16_t{-3});
    }
    for (const Triangle& t : mesh.triangles()) {
      put(std::uint16_t{3});
      for (const std::uint32_t v : t) put(v);
      put(std::uint8_t{1});
      put(0.25);
    }
    variants.push_back(bytes);
  }
  for (const std::string& variant : variants) {
    const auto file = write("b.ply", variant);
    ASSERT_EQ(message_of(file), "accepted") << variant;
    EXPECT_EQ(load_mesh(file).hash(), mesh.hash()) << variant;
  }
}

std::string binary_stl(const Mesh& mesh, std::string header, std::uint16_t attributes) {
  header.resize(80, ' ');
  std::string bytes = header + little(static_cast<std::uint32_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    for (int k = 0; k < 3; ++k) bytes += little(std::nanf(""));
    for (const std::uint32_t v : t) {
      for (const double x : mesh.vertices()[v]) bytes += little(static_cast<float>(x));
    }
    bytes += little(attributes);
  }
  return bytes;
}

TEST_F(Load, BinaryStlThatBeginsWithSolidAndHasAttributesAndNoNormals) {
  const Mesh mesh = load_mesh(write("a.off", k_off));
  for (const std::string header : {"solid made by a CAD program", "something", "solid"}) {
    const Mesh stl = load_mesh(write("b.stl", binary_stl(mesh, header, 0xFFFF)));
    EXPECT_TRUE(stl.solid()) << stl.why_not_solid();
    EXPECT_EQ(stl.triangles().size(), 4u);
    EXPECT_EQ(stl.repairs().welded_vertices, 8u);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(stl.vertices()[0][k], as_float(mesh.vertices()[0][k]));
  }
}

TEST_F(Load, TextStlInItsVariants) {
  const auto facets = [](const Mesh& mesh, bool capitals) {
    std::string text;
    for (const Triangle& t : mesh.triangles()) {
      text += capitals ? " FACET NORMAL nan nan nan\n  OUTER LOOP\n" : "facet normal 0 0 1\nouter loop\n";
      for (const std::uint32_t v : t) {
        const auto& p = mesh.vertices()[v];
        char line[200];
        std::snprintf(line, sizeof(line), "vertex %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
        text += line;
      }
      text += "endloop\nendfacet\n";
    }
    return text;
  };
  const Mesh mesh = load_mesh(write("a.off", k_off));
  const Mesh moved = load_mesh(write("moved.off",
                                     "OFF\n4 4 6\n10.3 -0.2 0.7\n12.7 -0.2 0.7\n10.9 1.5 0.7\n10.5 0.4 3.8\n"
                                     "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"));
  const Mesh text = load_mesh(write("b.stl", "solid a name of words\n" + facets(mesh, true) + "endsolid a name"));
  EXPECT_TRUE(text.solid());
  // The vertices appear in another order, but with the same bits.
  EXPECT_EQ(text.volume(), mesh.volume());
  EXPECT_EQ(text.vertices()[1], mesh.vertices()[2]);
  const Mesh two = load_mesh(
      write("c.stl", "solid\n" + facets(mesh, false) + "endsolid\nsolid x\n" + facets(moved, false) + "endsolid x\n"));
  EXPECT_EQ(two.topology().components, 2u);
  EXPECT_TRUE(two.solid());
}

TEST_F(Load, ConcaveFacesAreTriangulatedAsTheirOwnSurface) {
  // A prism over an arrow head, whose ends a fan from the first corner would fold.
  const std::string text =
      "v 0 0 0\nv 2 -1 0\nv 0.7 0 0\nv 2 1 0\nv 0 0 1\nv 2 -1 1\nv 0.7 0 1\nv 2 1 1\n"
      "f 4 3 2 1\nf 6 7 8 5\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Mesh mesh = load_mesh(write("a.obj", text));
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  constexpr double k_rounding = 1e-14;
  EXPECT_NEAR(mesh.volume(), 0.7, k_rounding);
  const double sides = 2.0 * std::hypot(2.0, 1.0) + 2.0 * std::hypot(1.3, 1.0);
  EXPECT_NEAR(mesh.area(), 2.0 * 0.7 + sides, k_rounding);
}

TEST_F(Load, WhatValidationDroppedIsReported) {
  const Mesh mesh = load_mesh(write("a.off",
                                    "OFF\n6 5 0\n0.3 -0.2 0.7\n2.7 -0.2 0.7\n0.9 1.5 0.7\n0.5 0.4 3.8\n9 9 9\n0.5 0.4 "
                                    "3.8\n3 0 2 1\n3 0 1 3\n3 1 2 5\n3 2 0 3\n3 3 5 1\n"));
  EXPECT_EQ(mesh.repairs().welded_vertices, 1u);
  EXPECT_EQ(mesh.repairs().unreferenced_vertices, 1u);
  EXPECT_EQ(mesh.repairs().collapsed_triangles, 1u);
  EXPECT_TRUE(mesh.solid());
}

/// A pyramid in each format that holds polygons, with a base of four corners.
struct PolygonFile {
  const char* name;
  std::string begin, base, end;  ///< Around the third corner of the base, and behind it.
  const char* place;             ///< Of the base in the file.
};

std::vector<PolygonFile> pyramid_files() {
  const std::string tail = "\n0 2 1\n1 1 3\n";
  const std::string faces = "4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
  return {{"a.off", "OFF\n5 5 0\n0 0 1\n2 0 1\n", "2 2 1", tail + faces, "line 8"},
          {"a.obj", "v 0 0 1\nv 2 0 1\nv ", "2 2 1",
           "\nv 0 2 1\nv 1 1 3\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", "line 6"},
          {"a.ply",
           "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 5\nproperty list uchar int vertex_indices\nend_header\n0 0 1\n2 0 1\n",
           "2 2 1", tail + faces, "line 15: face 0"}};
}

TEST_F(Load, PolygonsThatAreNotFlatAreCountedWithTheirPlace) {
  for (const PolygonFile& file : pyramid_files()) {
    const Mesh flat = load_mesh(write(file.name, file.begin + file.base + file.end));
    EXPECT_EQ(flat.repairs().forgiven.of(Forgiven::nonplanar_polygons).count, 0u) << file.name;
    EXPECT_EQ(flat.repairs().forgiven.of(Forgiven::nonplanar_polygons).first_place, "");
    // Six digits are flat enough, a corner lifted by a hundredth is not.
    EXPECT_EQ(load_mesh(write(file.name, file.begin + "2 2 1.00001" + file.end))
                  .repairs()
                  .forgiven.of(Forgiven::nonplanar_polygons)
                  .count,
              0u);
    const Mesh warped = load_mesh(write(file.name, file.begin + "2 2 1.01" + file.end));
    EXPECT_EQ(warped.repairs().forgiven.of(Forgiven::nonplanar_polygons).count, 1u) << file.name;
    EXPECT_EQ(warped.repairs().forgiven.of(Forgiven::nonplanar_polygons).first_place, file.place) << file.name;
    EXPECT_EQ(warped.repairs().forgiven.of(Forgiven::crossing_polygons).count, 0u) << file.name;
    EXPECT_TRUE(warped.solid()) << warped.why_not_solid();
  }
}

TEST_F(Load, PolygonsThatCrossThemselvesAreCountedWithTheirPlace) {
  const Mesh face = load_mesh(std::filesystem::path(SIXDOF_TEST_DATA) / "repaired" / "crossing_face.obj");
  EXPECT_EQ(face.triangles().size(), 3u);
  EXPECT_EQ(face.repairs().forgiven.of(Forgiven::crossing_polygons).count, 1u);
  EXPECT_EQ(face.repairs().forgiven.of(Forgiven::crossing_polygons).first_place, "line 6");
  // A prism over two triangles that touch in their tips; the second, of unequal triangles.
  for (const char* corner : {"2 2", "2 3"}) {
    const std::string foot = std::string("v 0 0 0\nv ") + corner + " 0\nv 2 0 0\nv 0 2 0\n";
    const std::string top = std::string("v 0 0 1\nv ") + corner + " 1\nv 2 0 1\nv 0 2 1\n";
    const Mesh mesh =
        load_mesh(write("a.obj", foot + top + "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 4 3 2 1\nf 5 6 7 8\n"));
    EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::crossing_polygons).count, 2u) << corner;
    EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::crossing_polygons).first_place, "line 13") << corner;
    EXPECT_EQ(mesh.triangles().size(), 12u) << corner;
    EXPECT_TRUE(mesh.topology().closed) << corner;
    EXPECT_TRUE(mesh.topology().oriented) << corner;
  }
}

TEST_F(Load, UnknownObjStatementsAreSkippedAndCounted) {
  const Mesh mesh = load_mesh(std::filesystem::path(SIXDOF_TEST_DATA) / "repaired" / "free_form.obj");
  EXPECT_EQ(mesh.hash(), load_mesh(write("a.off", k_off)).hash());
  EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::skipped_statements).count, 6u);
  EXPECT_EQ(mesh.repairs().forgiven.of(Forgiven::skipped_statements).first_place, "line 15");
  EXPECT_EQ(mesh.repairs().unreferenced_vertices, 3u);
  EXPECT_EQ(
      load_mesh(write("a.obj", "o a\nvn 0 0 1\n" + k_obj)).repairs().forgiven.of(Forgiven::skipped_statements).count,
      0u);
}

TEST_F(Load, AByteOrderMarkBeforeATextIsSkipped) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const PolygonFile& file : pyramid_files()) {
    const std::string text = file.begin + file.base + file.end;
    const std::string hash = load_mesh(write(file.name, text)).hash();
    EXPECT_EQ(load_mesh(write(file.name, mark + text)).hash(), hash) << file.name;
  }
  const std::string stl =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\nendloop\nendfacet\nendsolid";
  EXPECT_EQ(load_mesh(write("a.stl", mark + stl)).hash(), load_mesh(write("b.stl", stl)).hash());
  EXPECT_EQ(load_mesh(write("c.stl", binary_stl(load_mesh(path("a.stl")), mark, 0))).hash(),
            load_mesh(path("a.stl")).hash());
  EXPECT_THAT(message_of(write("d.off", mark)), HasSubstr("no data"));
}

TEST_F(Load, TheLastLineNeedsNoLineBreak) {
  for (const PolygonFile& file : pyramid_files()) {
    const std::string text = file.begin + file.base + file.end;
    ASSERT_EQ(text.back(), '\n');
    const std::string hash = load_mesh(write(file.name, text)).hash();
    EXPECT_EQ(load_mesh(write(file.name, text.substr(0, text.size() - 1))).hash(), hash) << file.name;
  }
}

TEST_F(Load, BytesThatDoNotPrintAreShown) {
  EXPECT_THAT(message_of(write("a.obj",
                               "v 0 0\xC2\xA0"
                               "1 0\n")),
              HasSubstr("line 1: '0\\xC2\\xA01' is not a number"));
  EXPECT_THAT(message_of(write("a.off", "\xE2\x80\x8BOFF\n")), HasSubstr("begins with '\\xE2\\x80\\x8BOFF'"));
  EXPECT_THAT(message_of(write("a.ply", "\xEF\xBB\xBF\xEF\xBB\xBFply\n")), HasSubstr("'\\xEF\\xBB\\xBFply'"));
  for (const char* name : {"u.off", "u.obj", "u.ply", "u.stl"}) {
    EXPECT_THAT(message_of(write(name, std::string("\xFF\xFEO\0F\0F\0\n\0", 10))), HasSubstr("UTF-16")) << name;
  }
}

TEST_F(Load, WhatIsNoMeshFileIsNamed) {
  EXPECT_THAT(message_of(path("missing.ply")), HasSubstr("missing.ply: cannot be read: No such file"));
  EXPECT_THAT(message_of(write("a.txt", "x")), HasSubstr("a.txt: '.txt' is no mesh format"));
  EXPECT_THAT(message_of(write("noextension", "x")),
              HasSubstr("noextension: has no extension, which would say its mesh format (.ply, .obj, .stl, .off"));
  std::filesystem::create_directory(path("folder.ply"));
  EXPECT_THAT(message_of(path("folder.ply")), HasSubstr("not a regular file"));
  for (const char* name : {"empty.ply", "empty.off", "empty.obj", "empty.stl"}) {
    EXPECT_THAT(message_of(write(name, "")), HasSubstr("is empty")) << name;
  }
  // A device that never ends, and a pipe that nobody writes to.
  std::filesystem::create_symlink("/dev/zero", path("zero.ply"));
  EXPECT_THAT(message_of(path("zero.ply")), HasSubstr("not a regular file"));
  ASSERT_EQ(::mkfifo(path("pipe.off").c_str(), 0600), 0);
  EXPECT_THAT(message_of(path("pipe.off")), HasSubstr("not a regular file"));
}

struct BadCase {
  const char* file;
  const char* place;  // "" where the whole file is at fault
  const char* cause;
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.file; }

class BadMeshFile : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadMeshFile, IsRefusedNamingFilePlaceAndCause) {
  const auto file = std::filesystem::path(SIXDOF_TEST_DATA) / "bad" / GetParam().file;
  ASSERT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_THAT(message_of(file),
              AllOf(StartsWith(file.string() + ": "), HasSubstr(GetParam().place), HasSubstr(GetParam().cause)));
}

constexpr BadCase k_bad_cases[] = {
    {"negative_index.obj", "line 6: ", "vertex -5 of the 4 read so far"},
    {"zero_index.obj", "line 5: ", "vertex 0 of the 4"},
    {"index_seven_of_six.obj", "line 8: ", "vertex 7 of the 6"},
    {"cut_off_face.obj", "line 5: ", "a face of 2 corners"},
    {"weight.obj", "line 4: ", "a vertex of weight 2, which faces use (line 6)"},
    {"comma.obj", "line 1: ", "'0,3' is not a number"},
    {"not_a_number.obj", "line 4: ", "nan) of a face's corner are not finite"},
    {"huge_index.obj", "line 5: ", "out of range"},
    {"overflow.obj", "line 4: ", "outside the range of double"},
    {"free_form.obj", "line 5: ", "no triangles: the file has no faces"},
    {"no_faces.obj", "", "no triangles"},
    {"one_word.off", "line 1: ", "216 vertices do not fit"},
    {"huge_counts.off", "line 2: ", "4294967295 vertices do not fit"},
    {"overflowing_counts.off", "line 2: ", "out of range"},
    {"negative_count.off", "line 2: ", "-4 vertices do not fit"},
    {"fewer_vertices.off", "line 5: ", "ends after 2 of 4 vertices"},
    {"fewer_faces.off", "line 10: ", "ends after 3 of 4 faces"},
    {"more_faces.off", "line 10: ", "behind the last element"},
    {"index_out_of_range.off", "line 9: ", "vertex index 4 of 4"},
    {"negative_index.off", "line 9: ", "vertex index -2 of 4"},
    {"list_longer_than_line.off", "line 9: ", "face 2 has 7 corners, but 3 indices"},
    {"infinite.off", "line 6: ", "inf) of a face's corner are not finite"},
    {"other_keyword.off", "line 1: ", "begins with 'GOFF', not OFF, COFF"},
    {"binary.off", "line 1: ", "binary OFF is not supported"},
    {"count_against_size.stl", "byte 80: ", "the count is 1769221948 triangles"},
    {"count_too_large.stl", "byte 80: ", "the count is 5 triangles, which take 250 bytes, but 200 follow"},
    {"bytes_behind_end.stl", "byte 80: ", "which take 200 bytes, but 203 follow"},
    {"empty_text.stl", "", "no triangles"},
    {"no_triangles.stl", "", "no triangles"},
    {"not_finite.stl", "triangle 3: ", "not finite"},
    {"too_short.stl", "", "too few"},
    {"text_cut_off.stl", "line 13: ", "ends within a solid"},
    {"four_corners.stl", "line 7: ", "'endloop'"},
    {"comma.stl", "line 6: ", "'1,5' is not a number"},
    {"no_end_header.ply", "", "no 'end_header'"},
    {"unknown_type.ply", "line 6: ", "'quad' is no type"},
    {"index_out_of_range.ply", "line 16: face 2: ", "vertex index 4 of 4"},
    {"list_longer_than_data.ply", "line 17: face 3: ", "a list of 200 values, but at most 3 follow"},
    {"list_shorter_than_line.ply", "line 16: face 2: ", "5 values where 4 are expected"},
    {"negative_list.ply", "line 16: face 2: ", "a list of -3 values"},
    {"nan.ply", "line 13: ", "not finite"},
    {"fewer_faces.ply", "line 17: ", "ends before face 3 of 4"},
    {"more_faces.ply", "line 18: ", "behind the last element"},
    {"no_faces.ply", "", "no element face"},
    {"huge_counts.ply", "line 3: ", "out of range"},
    {"counts_beyond_size.ply", "element face: ", "1000000000000 of at least"},
    {"size_overflow.ply", "element vertex: ", "357913942 of at least 12 bytes"},
    {"binary_list_longer_than_data.ply", "face 0: ", "a list of 4294967295 values"},
    {"binary_negative_list.ply", "face 0: ", "a list of -3 values"},
    {"binary_index.ply", "face 3: ", "vertex index 4 of 4"},
    {"binary_negative_index.ply", "face 3: ", "vertex index -1 of 4"},
    {"binary_nan.ply", "vertex 3: ", "not finite"},
    {"binary_cut_off.ply", "face 3: ", "bytes are left"},
    {"binary_bytes_behind_end.ply", "", "1 bytes behind the last element"},
    {"tristrips.ply", "line 14: tristrips 0: ", "vertex index 4 of 4"},
    {"binary_long.ply", "element face: ", "programs do not agree on the bytes of 'long'"},
    {"float_indices.ply", "element face: ", "no list of integers"},
    {"no_properties.ply", "element ghost: ", "has no properties"},
    {"missing_axis.ply", "element vertex: ", "has no properties x, y and z"},
};

INSTANTIATE_TEST_SUITE_P(Data, BadMeshFile, ::testing::ValuesIn(k_bad_cases), [](const auto& case_info) {
  std::string name = case_info.param.file;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

TEST(BadMeshFiles, EveryFileOfTheFolderIsTested) {
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(SIXDOF_TEST_DATA) / "bad")) {
    ++files;
  }
  EXPECT_EQ(files, std::size(k_bad_cases));
}

}  // namespace
}  // namespace sixdof
