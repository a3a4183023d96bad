#pragma once

// Small files of the formats that assimp reads, written by hand.

#include <cstring>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof::testing_support {

/// Bytes of a value, lowest first (the tests run on little-endian machines).
std::string little(auto value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

/// x rounded to single precision. Not inlined: gcc 12 drops vectorised conversions to float and back at -O3.
[[gnu::noinline]] inline double as_float(double x) { return static_cast<double>(static_cast<float>(x)); }

inline std::string float_points(const Mesh& mesh) {
  std::string bytes;
  for (const auto& p : mesh.vertices()) {
    for (const double x : p) bytes += little(static_cast<float>(x));
  }
  return bytes;
}

template <class Index>
std::string indices(const Mesh& mesh) {
  std::string bytes;
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) bytes += little(static_cast<Index>(v));
  }
  return bytes;
}

inline std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63u];
  }
  return text;
}

/// The JSON of a mesh with 16-bit indices whose positions begin at byte 0 of buffer 0.
/// @param buffer what is in the buffer beside its length, e.g. R"(,"uri":"x.bin")".
/// @param nodes the list of nodes; the scene's root is node 0.
inline std::string gltf_json(const Mesh& mesh, const std::string& buffer, const std::string& nodes) {
  const std::size_t n = mesh.vertices().size();
  const std::size_t m = 3 * mesh.triangles().size();
  const auto s = [](std::size_t i) { return std::to_string(i); };
  return R"({"asset":{"version":"2.0","generator":"a test"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)" +
         R"("materials":[{"name":"red"}],"accessors":[)" + R"({"bufferView":0,"componentType":5126,"count":)" + s(n) +
         R"(,"type":"VEC3"},)" + R"({"bufferView":1,"componentType":5123,"count":)" + s(m) + R"(,"type":"SCALAR"}],)" +
         R"("bufferViews":[{"buffer":0,"byteLength":)" + s(12 * n) + R"(},{"buffer":0,"byteOffset":)" + s(12 * n) +
         R"(,"byteLength":)" + s(2 * m) + R"(}],"buffers":[{"byteLength":)" + s(12 * n + 2 * m) + buffer + "}]}";
}

inline std::string gltf_data(const Mesh& mesh) { return float_points(mesh) + indices<std::uint16_t>(mesh); }

inline std::string glb(std::string json, std::string data) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4, '\0');
  return "glTF" + little(std::uint32_t{2}) + little(static_cast<std::uint32_t>(28 + json.size() + data.size())) +
         little(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
         little(static_cast<std::uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
}

inline std::string chunk_3ds(unsigned id, const std::string& contents) {
  return little(static_cast<std::uint16_t>(id)) + little(static_cast<std::uint32_t>(6 + contents.size())) + contents;
}

/// A 3DS object "part" with its vertices and faces, and what else a file may hold.
/// @param red numbers of the faces that have the material "red".
inline std::string object_3ds(const Mesh& mesh, const std::vector<std::uint16_t>& red = {}) {
  std::string faces = little(static_cast<std::uint16_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) faces += little(static_cast<std::uint16_t>(v));
    faces += little(std::uint16_t{7});
  }
  if (!red.empty()) {
    std::string numbers = std::string("red\0", 4) + little(static_cast<std::uint16_t>(red.size()));
    for (const std::uint16_t face : red) numbers += little(face);
    faces += chunk_3ds(0x4130, numbers);
  }
  std::string axes;
  for (int i = 0; i < 12; ++i) axes += little(0.3f + 1.7f * static_cast<float>(i * i));
  return chunk_3ds(0x4000,
                   std::string("part\0", 5) +
                       chunk_3ds(0x4100, chunk_3ds(0x4110, little(static_cast<std::uint16_t>(mesh.vertices().size())) +
                                                               float_points(mesh)) +
                                             chunk_3ds(0x4120, faces) + chunk_3ds(0x4160, axes)));
}

/// @param key_framer the chunk behind the objects, or nothing.
inline std::string file_3ds(const std::string& objects, const std::string& key_framer = {}) {
  return chunk_3ds(0x4D4D, chunk_3ds(0x0002, little(3u)) +
                               chunk_3ds(0x3D3D, chunk_3ds(0x0100, little(25.4f)) + objects) + key_framer);
}

/// A pyramid over a square of side 2 whose tip points along -z, translated by (10, 0, 0) and mirrored in z.
/// @param corner the base's corner (2, 2, 0) before its translation to (12, 2, 0).
inline std::string collada_pyramid(const std::string& corner) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="pa" count="15">0 0 0 2 0 0 )" +
         corner + R"( 0 2 0 1 1 -3</float_array>
      <technique_common><accessor source="#pa" count="5" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <polylist count="5"><input semantic="VERTEX" source="#v" offset="0"/>
      <vcount>4 3 3 3 3</vcount><p>0 1 2 3 4 1 0 4 2 1 4 3 2 4 0 3</p></polylist>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n"><translate>10 0 0</translate><scale>1 1 -1</scale>
    <instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

inline std::string x3d_pyramid() {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<X3D profile="Interchange" version="3.0"><Scene><Transform translation="10 0 0"><Shape>
<IndexedFaceSet coordIndex="3 2 1 0 -1 0 1 4 -1 1 2 4 -1 2 3 4 -1 3 0 4 -1">
<Coordinate point="0 0 0 2 0 0 2 2 0 0 2 0 1 1 3"/></IndexedFaceSet></Shape></Transform></Scene></X3D>
)";
}

/// @param last_corner of the first triangle: -5 stands for vertex 4, the tip.
inline std::string fbx_pyramid(const std::string& last_corner) {
  return R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
Definitions:  {
	Version: 100
	Count: 0
}
Objects:  {
	Geometry: 100, "Geometry::g", "Mesh" {
		Vertices: *15 {
			a: 0,0,0,2,0,0,2,2,0,0,2,0,1,1,3
		}
		PolygonVertexIndex: *16 {
			a: 3,2,1,-1,0,1,)" +
         last_corner + R"(,1,2,-5,2,3,-5,3,0,-5
		}
		GeometryVersion: 124
	}
	Model: 200, "Model::m", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",10,0,0
		}
	}
}
Connections:  {
	C: "OO",200,0
	C: "OO",100,200
}
)";
}

}  // namespace sixdof::testing_support
