#pragma once

#include <bit>
#include <cstring>
#include <optional>
#include <set>

#include <gmock/gmock.h>

#include <sixdof/geometry/forgiven.h>

#include "mesh_files.h"
#include "scene_files.h"

/// A cube as other programs write it, and the test that it is read.

namespace sixdof {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing_support::little;
using testing_support::message_of;

// A cube of volume 1. Corner i has the bits of i as coordinates.
constexpr std::uint32_t k_triangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
constexpr std::uint32_t k_quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

inline std::string digit(std::size_t n) { return std::to_string(n); }
inline std::string corner(std::size_t i) { return digit(i & 1) + " " + digit(i >> 1 & 1) + " " + digit(i >> 2 & 1); }

/// The corners, each between two texts.
inline std::string corners(const std::string& before = "", const std::string& behind = "\n") {
  std::string text;
  for (std::size_t i = 0; i < 8; ++i) text += before + corner(i) + behind;
  return text;
}

/// "3 0 2 3" and so on.
inline std::string faces(const std::string& behind = "\n") {
  std::string text;
  for (const auto& t : k_triangles) text += "3 " + digit(t[0]) + " " + digit(t[1]) + " " + digit(t[2]) + behind;
  return text;
}

/// "f 1 3 4 2" and so on. @param behind each number
inline std::string obj_faces(const std::string& behind = "") {
  std::string text;
  for (const auto& q : k_quads) {
    text += "f";
    for (const std::uint32_t v : q) text += " " + digit(v + 1) + behind;
    text += "\n";
  }
  return text;
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

const std::string k_xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string k_list = "property list uchar int vertex_indices\n";

/// @param format "ascii"; the elements as they stand in the header; the data
inline std::string ply(const std::string& format, const std::string& elements, const std::string& data) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + data;
}
const std::string k_cube_elements = "element vertex 8\n" + k_xyz + "element face 12\n" + k_list;

inline std::string binary_cube(bool with_faces = true) {
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

}  // namespace sixdof
