#pragma once

// Small glTF and 3DS files, written by hand: an independent reading of the two formats.

#include <cstring>
#include <string>

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
inline std::string object_3ds(const Mesh& mesh) {
  std::string faces = little(static_cast<std::uint16_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) faces += little(static_cast<std::uint16_t>(v));
    faces += little(std::uint16_t{7});
  }
  std::string axes;
  for (int i = 0; i < 12; ++i) axes += little(0.3f + 1.7f * static_cast<float>(i * i));
  return chunk_3ds(0x4000,
                   std::string("part\0", 5) +
                       chunk_3ds(0x4100, chunk_3ds(0x4110, little(static_cast<std::uint16_t>(mesh.vertices().size())) +
                                                               float_points(mesh)) +
                                             chunk_3ds(0x4120, faces) + chunk_3ds(0x4160, axes)));
}

inline std::string file_3ds(const std::string& objects) {
  return chunk_3ds(0x4D4D,
                   chunk_3ds(0x0002, little(3u)) + chunk_3ds(0x3D3D, chunk_3ds(0x0100, little(25.4f)) + objects));
}

}  // namespace sixdof::testing_support
