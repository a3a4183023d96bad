// Writes the first inputs of the fuzzers: `fuzz_seeds FOLDER` makes FOLDER/TARGET/NAME of small valid files, and of the
// numbers of the catalogue's hard cases. Inputs that were found by fuzzing stand beside them under other names.
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <span>
#include <sstream>

#include <sixdof/geometry/save.h>
#include <sixdof/process/protocol.h>

#include "../geometry/scene_files.h"
#include "fuzz.h"
#include "small_meshes.h"
#include "small_set.h"

namespace sixdof::fuzz {
namespace {

namespace fs = std::filesystem;

/// Coordinates that are hard to keep: of field cases, and next to the limits of the format.
Mesh hard_mesh() {
  return Mesh::build({{0.06999979436939574029, -1.708219171670e-8, 1.02781464659664711903},
                      {-0.40000020563060423306, -2.075754440556e-8, 1.02781464312938330963},
                      {5e-324, -0.0, 1e150},
                      {99.9999847, 0.946687222, -2.2250738585072014e-308}},
                     {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}}, "hard");
}

class Seeds {
 public:
  Seeds(fs::path folder, const char* target) : folder_(std::move(folder) / target) { fs::create_directories(folder_); }
  void add(const std::string& name, const std::string& bytes) const { write_bytes(folder_ / name, bytes); }

 private:
  fs::path folder_;
};

/// Files as other programs write them, and with damage that a repair mends (test/geometry/forgiven_test.cpp).
void write_meshes_of_other_programs(const Seeds& seeds) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  const std::string vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 4\nproperty list uchar int vertex_indices\n";
  const auto replaced = [](std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
      text.replace(at, what.size(), by);
    }
    return text;
  };
  const auto ply = [](const std::string& elements, const std::string& data) {
    return "0ply \nformat ascii 1.0\nobj_info x\n" + elements + "end_header\n" + data;
  };
  seeds.add("faces-first.ply", ply(face + vertex, faces + points));
  seeds.add("one-line.ply", ply(vertex + face, replaced(points + faces, "\n", " ")));
  seeds.add("a-value-a-line.ply", ply(vertex + face, replaced(points + faces, " ", "\n")));
  seeds.add("wrapped.ply", ply(vertex + face, "0 0 0 1 0\n0 0 1 0 0\n0 1\n3 0 2 1 3\n0 1 3 3 1\n2 3 3 0 3\n2\n"));
  seeds.add("returns.ply", replaced(ply(vertex + face, points + faces), "\n", "\r"));
  seeds.add("wide-integers.ply", ply(vertex + replaced(face, "uchar int", "long uint64"), points + faces));
  seeds.add("edges-as-faces.ply", ply(vertex + replaced(face, "face 4", "face 6"), points + faces + "2 0 1\n0\n"));
  seeds.add("unused-nan.ply", ply(replaced(vertex, "vertex 4", "vertex 5") + face, points + "nan inf -nan\n" + faces));
  seeds.add("used-nan.ply", ply(vertex + face, replaced(points, "0 1\n", "0 nan\n") + faces));
  const std::string strips = "element tristrips 2\nproperty list int int vertex_indices\n";
  seeds.add("strips.ply", ply(vertex + strips, points + "9 0 2 1 3 -1 0 2 3 -1\n3 0 1 3\n"));
  std::string binary = "0ply\rformat binary_little_endian 1.0\r" + replaced(vertex, "\n", "\r") +
                       "element tristrips 1\r" + "property list uchar int vertex_indices\rend_header\r";
  binary += std::string(48, '\n') + '\6';
  for (const char v : {'\0', '\2', '\1', '\3', '\0', '\2'}) binary += std::string{v, 0, 0, 0};
  seeds.add("returns-and-blanks-behind.ply", binary + "\r\n");
  seeds.add("undeclared.off", "1OFF\n4 4 0\n" + replaced(points, "\n", " 9 8 7 255\n") + faces);
  seeds.add("no-keyword.off", "14 4 0\n" + points + faces + "");
  seeds.add("glued-keyword.off", "1OFF4 4 0\n" + points + faces);
  seeds.add("homogeneous.off", "14OFF 4 4 0\n" + replaced(points, "\n", " 0.5\n") + faces);
  seeds.add("dimensions.off", "1STNCnOFF\n3\n4\n5\n0\n" + replaced(points, "\n", " 1 1 1\n") + faces + "2 0 1 0.5\n");
  seeds.add("returns.off", replaced("1OFF\n4 4 0\n" + replaced(points, " ", "\n") + faces, "\n", "\r"));
  const std::string vertices = "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nv 0 0 1\n";
  const std::string corners = "f 1// 3// 2//\nf 1/ 2/ 4/\nfo 2/1/ 3//1 4\nf -4 -1 -2\n";
  seeds.add("empty-numbers.obj", "2" + vertices + "v 9 9 9 2\nv nan 0 0\n" + replaced(corners, "-4 -1 -2", "-6 -3 -4"));
  seeds.add("late-vertices.obj", "2f 1 2\n" + replaced(corners, "-4 -1 -2", "1 4 3") + vertices);
  seeds.add("weights.obj", "2" + replaced(vertices, "0 0 1\n", "0 0 1 2\n") + corners);
  seeds.add("returns.obj", replaced("2" + vertices + replaced(corners, "f 1//", "f \\\n1//"), "\n", "\r"));
  const std::string facet =
      "facet normal nan nan nan\nouterloop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nEND loop\nend facet\n";
  seeds.add("other-words.stl", "3solid a b\n" + facet + "end solid a b\n# x\nSOLID\n" + facet + "endsolid\n\n# y\n");
  seeds.add("returns.stl", replaced("3solid\n" + facet + "endsolid\n", "\n", "\r"));
  seeds.add("nan-facet.stl", "3solid\n" + facet + replaced(facet, "1 0 0", "1.#QNAN 0 inf") + "endsolid\n");
  std::string stl = "3solid" + std::string(75, ' ') + std::string("\2\0\0\0", 4) + std::string(50, '\1');
  seeds.add("nan-facet-and-blanks.stl", stl + std::string(50, '\xFF') + "\r\n");
}

void write_meshes(const fs::path& folder) {
  using namespace testing_support;
  const Seeds seeds(folder, "mesh_file");
  const auto saved = [&](const Mesh& mesh, const char* extension) {
    const auto file = scratch_folder() / (std::string("seed") + extension);
    save_mesh(mesh, file);
    return read_bytes(file);
  };
  const Mesh box_mesh = box();
  seeds.add("box.ply", "0" + saved(box_mesh, ".ply"));
  seeds.add("hard.ply", "0" + saved(hard_mesh(), ".ply"));
  seeds.add("hard.off", "1" + saved(hard_mesh(), ".off"));
  seeds.add("hard.obj", "2" + saved(hard_mesh(), ".obj"));
  seeds.add("box.stl", "3" + saved(box_mesh, ".stl"));
  seeds.add("text.stl",
            "3solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e-9 0\nendloop\nendfacet\n"
            "endsolid a\n");
  seeds.add(
      "text.ply",
      "0ply\nformat ascii 1.0\ncomment c\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0.5 0.2 0\n0 0 1\n"
      "4 0 1 2 3\n3 0 1 4\n");
  seeds.add(
      "big-endian.ply",
      "0ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty short y\nproperty short z\n"
      "element face 1\nproperty list uchar ushort vertex_index\nend_header\n" +
          std::string("\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\3\0\0\0\1\0\2", 25));
  seeds.add("polygons.obj",
            "2# c\nmtllib x.mtl\no a\nv 0 0 0\nv 2 0 0\nv 2 2 0 1.0\nv 1 0.5 0\nv 0 2 0\nvt 0 0\nvn 0 0 1\ng b\ns 1\n"
            "usemtl m\nf 1/1/1 2/1/1 \\\n3//1 4 5\nf -5 -4 -1\nl 1 2\n");
  seeds.add("coloured.off",
            "1COFF\n# c\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n4 0 1 2 3 9\n3 0 2 1\n");
  write_meshes_of_other_programs(seeds);
  seeds.add("box.glb", "4" + glb(gltf_json(box_mesh, "", R"([{"mesh":0}])"), gltf_data(box_mesh)));
  const std::string data = R"(,"uri":"data:;base64,)" + base64(gltf_data(box_mesh)) + '"';
  seeds.add("box.gltf",
            "5" + gltf_json(box_mesh, data, R"([{"children":[1],"scale":[1,1,-1]},{"mesh":0,"translation":[1,2,3]}])"));
  const auto gltf = [&](const std::string& nodes, const std::string& positions, const std::string& more) {
    const std::string points = R"({"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"})";
    std::string json = gltf_json(box_mesh, data, nodes);
    json.replace(json.find(points), points.size(), positions);
    return "5" + json.insert(json.size() - 1, more);
  };
  const std::string plain_node = R"([{"mesh":0}])";
  seeds.add("instances.gltf",
            gltf(R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0,"SCALE":0}}}}])",
                 R"({"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"})",
                 R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])"));
  seeds.add("integers.gltf",
            gltf(plain_node, R"({"bufferView":0,"componentType":5122,"normalized":true,"count":8,"type":"VEC3"})",
                 R"(,"extensionsUsed":["KHR_mesh_quantization"])"));
  seeds.add("sparse.gltf", gltf(plain_node,
                                R"({"componentType":5126,"count":8,"type":"VEC3","sparse":{"count":4,"indices":)"
                                R"({"bufferView":1,"componentType":5123},"values":{"bufferView":0}}})",
                                ""));
  seeds.add("box.3ds", "6" + file_3ds(object_3ds(box_mesh, {0, 3})));
}

void write_sets(const fs::path& folder) {
  const Seeds seeds(folder, "configuration_set");
  seeds.add("set", "s" + read_bytes(write_small_set(scratch_folder())));
  seeds.add("shard", "S" + read_bytes(write_small_shard(scratch_folder())));
  seeds.add("flipped-byte", std::string("e\0\0\x40\x02\x10", 6));
  seeds.add("cut-off", std::string("e\0\xF0\x00\x02", 5));
  // What is edited: object, kind of edit, and what it needs (hdf5_edit.cpp).
  for (char object = 0; object < 16; ++object) {
    for (char kind = 0; kind < 6; ++kind) {
      if ((object + kind) % 4 != 0) continue;
      std::ostringstream name;
      name << "edit-" << int{object} << "-" << int{kind};
      const std::string edit{object, kind, 3, 9, 2, 1, 8, 0};
      seeds.add(name.str(), (object % 8 < 4 ? "e\1" : "E\1") + edit + "0123456789abcdef");
    }
  }
  seeds.add("huge-dataset", std::string("e\1\4\4\4\xE4\xE4\1\1", 9));
}

void write_structures(const fs::path& folder) {
  const Seeds seeds(folder, "cached_structure");
  for (char file = 0; file < 10; ++file) {
    const std::string number = std::to_string(int{file});
    seeds.add("flipped-byte-" + number, std::string{file, 'd', 0, 0, 0x40, 8, 0x10});
    seeds.add("edited-" + number, std::string{file, 'd', 1, 2, 4, 4, 3, 2, 1, 5, 6, 7});
    seeds.add("forged-" + number, std::string{file, 'f', 1, 1, 0, 0, 1, 1, 2, 3, 1, 2, 9, 0, '\x80', '\x7F'});
  }
}

void write_lines(const fs::path& folder) {
  using namespace protocol;
  const Seeds seeds(folder, "protocol");
  Pose X_AB;
  X_AB.t = {0.1, -5e-324, std::numeric_limits<double>::infinity()};
  const MeshPlace place{"a", "/vertices", "/triangles", 4, 4};
  const std::string hello = to_line(Hello{}), prepare = to_line(Prepare{place, place, {}, "/progress"});
  std::string session = "s" + hello + "\n" + prepare + "\n";
  for (const char* query : {"collide", "distance", "respond"}) {
    seeds.add(std::string("ask-") + query, "q" + to_line(Ask{query, X_AB}));
    session += to_line(Ask{query, Pose()}) + "\n";
    session += to_line(Time{query, {Pose(), X_AB}, 2, true, 64}) + "\n";
  }
  seeds.add("hello", "q" + hello);
  seeds.add("prepare", "q" + prepare);
  seeds.add("time", "q" + to_line(Time{"distance", {Pose(), X_AB}, 3, false, 0}));
  seeds.add("session", session + "nonsense\n{}\n");
  seeds.add("many-vertices",
            "s" + prepare + "\n" + to_line(Prepare{{"a", "", "", std::size_t{1} << 60, 4}, place, {}, ""}) + "\n");
  seeds.add("asked-before-prepared", "s" + to_line(Ask{"distance", Pose()}) + "\n");
  const Separation gap{0.25, true, {0.1, 0.2, 0.3}, {1e-300, 2, 3}, 7, 4294967294u};
  seeds.add("collides", "c" + to_line(Asked<bool>{true, "", 12.5, {}}));
  seeds.add("distance", "d" + to_line(Asked<Separation>{gap, "", 12.5, {{"points", 1.0, 3.0}}}));
  seeds.add("distance-not-finite", R"(d{"distance":"nan"})");
  seeds.add("distance-of-text", R"(d{"distance":"0.5"})");
  seeds.add("distance-of-fractional-triangle", R"(d{"distance":1,"triangle_a":1.5})");
  seeds.add("distance-of-negative-triangle", R"(d{"distance":1,"triangle_b":-1})");
  seeds.add("answer-to-another-query", R"(d{"collide":true})");
  seeds.add("response", "r" + to_line(Asked<Response>{Response{1, 2, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, "", {}, {}}));
  seeds.add("no-answer", "r" + to_line(Asked<Response>{Status::failed, "no \xFF convergence", {}, {}}));
  seeds.add("no-answer-that-prints",
            "c"
            R"({"status":"failed","words":"\u001b]0;t\u0007 \ud800 \u202e)"
            "\xC2\x9B\x1B\xFF\"}");
  seeds.add("counts-that-do-not-print", R"(p{"prepared":true,"counts":{"\u001b[31m\n\u2028":3}})");
  seeds.add("greeting-that-does-not-print",
            R"(h{"protocol":1,"name":"\u001b","version":"\udc80","answers":["collide"],"summary":"\u0000"})");
  seeds.add("times", "t" + to_line(Timed{{1, 2}, {1, 1.5}, 0, 0, {{1, Status::non_finite, "nan"}}}));
  seeds.add("times-together", R"(T{"wall_ns":8,"cpu_ns":7})");
  seeds.add("times-negative", R"(T{"wall_ns":-8,"cpu_ns":"inf"})");
  seeds.add("times-failed-twice", R"(T{"wall_ns":8,"cpu_ns":7,"failed":[[1,"failed",""],[1,"failed",""]]})");
  seeds.add("times-place-out-of-range", R"(T{"wall_ns":8,"cpu_ns":7,"failed":[[1e300,"failed",""]]})");
  seeds.add("greeting",
            "h" + to_line(Greeting{{.name = "x",
                                    .version = "1.5",
                                    .summary = "s",
                                    .answers = {.collide = true, .respond = true},
                                    .law = ResponseLaw::volume,
                                    .parameters = {Parameter::count("n", "how many", "5", 1, 9).swept({"1", "5"}),
                                                   Parameter::choice("mode", "which", "b", {"a", "b"})}},
                                   true,
                                   false}));
  seeds.add("prepared", "p" + to_line(Prepared{5.0, 4.0, {.bytes = 9, .counts = {{"z", 1}, {"a", 2.5}}}}));
  seeds.add("refusal", "p" + to_line(Refusal{Refusal::Kind::bad_mesh, "open"}));
  seeds.add("deep", "d" + std::string(2000, '[') + std::string(2000, ']'));
}

void write_pose_tables(const fs::path& folder) {
  const Seeds seeds(folder, "pose_table");
  const std::string header = "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz";
  const std::string rows = "0,1,a.off,0,0,0,1,0,0,0\n0,2,b.off,1.5,-2e-3,+.25,0.8,0.36,0.48,0\n1,2,,1,2,3,0,0,1,0\n";
  const auto separated = [&](char separator, const std::string& text) {
    std::string out = text;
    std::replace(out.begin(), out.end(), ',', separator);
    return out;
  };
  seeds.add("plain", header + "\n" + rows);
  seeds.add("byte-order-mark", "\xEF\xBB\xBF" + header + "\n" + rows);
  seeds.add("utf-16", std::string("\xFF\xFE"
                                  "f\0r\0",
                                  6));
  std::string of_returns = header + "\n" + rows;
  std::replace(of_returns.begin(), of_returns.end(), '\n', '\r');
  seeds.add("carriage-returns", of_returns);
  seeds.add("semicolons", separated(';', header + "\n" + rows));
  seeds.add("excel", "sep=;\n" + separated(';', header + "\n" + rows));
  seeds.add("tabs", separated('\t', header + "\n" + rows));
  seeds.add("two-separators", header + ";fixed\n" + rows);
  seeds.add("quotes",
            "\"frame\",\"body\",mesh,tx,ty,tz,qw,qx,qy,qz\n\"0\",1,\"a.off\",\"+0.5\",0,0,1,0,0,0\n"
            "0,2,\"b\"\".off\",0,0,0,1,0,0,0\n");
  seeds.add("open-quote", header + "\n0,1,\"a.off,0,0,0,1,0,0,0\n");
  seeds.add("floats-as-counts", header + "\n0.0,1.0,a.off,0,0,0,1.0,0,0,0\n0e0,2.0,b.off,1,1,1,1,0,0,0\n");
  seeds.add("decimal-commas", separated(';', header) + "\n0;1;a.off;0,5;0;0;1;0;0;0\n");
  seeds.add("comments-and-blanks", "# c\n\n" + header + ",\n , ,\n" + rows + "#\n,,,\n");
  seeds.add("ignored-and-fixed", header +
                                     ",fixed,ignored\n0,1,a.off,0,0,0,1,0,0,0,TRUE,\n"
                                     "0,2,b.off,0,0,0,1,0,0,0,,\"1, 3\"\n0,3,b.off,9,0,0,1,0,0,0,0,2 1\n");
  seeds.add("ignored-of-none", header + ",ignored\n0,1,a.off,0,0,0,1,0,0,0,9\n0,2,b.off,0,0,0,1,0,0,0,2\n");
  seeds.add("huge-frame", header + "\n" + rows + "20000,1,,0,0,0,1,0,0,0\n4294967295,1,,0,0,0,1,0,0,0\n");
  seeds.add("no-such-column", header + ",name\n");
}

void write_command_lines(const fs::path& folder) {
  const Seeds seeds(folder, "command_line");
  constexpr std::array k_lines{
      "--version",
      "--help",
      "models\nlist",
      "models\nlist\n--json",
      "models\nmake\ncone-1k\n--triangles\n40\n-o\nx.ply",
      "info\na.ply",
      "info\na.ply\n--check\n--json",
      "info\nset.h5",
      "info\nset.h5\n--json",
      "info\nshard.h5",
      "info\nempty.ply",
      "info\nabsent.off",
      "info\nr.json",
      "repair\nopen.off\n-o\nx.obj\n--max-hole\n3",
      "repair\nb.obj\n-o\nb.obj",
      "repair\nc.stl\n-o\nx.off\n--weld\n1e-6\n--json",
      "algorithms",
      "algorithms\n--json",
      "query\n--a\na.ply\n--b\nb.obj\n--pose\n0.9 0 0.1 1 0 0 0",
      "query\n--a\na.ply\n--b\nb.obj\n--pose\n0.9 0 0.1 1 0 0 0\n--algorithm\nexact\n--json",
      "query\n--a\na.ply\n--b\nopen.off\n--pose\n0,9 0 0,1 1 0 0 0",
      "query\n--a\na.ply\n--b\nb.obj\n--pose\n1e400 nan 0 0 0 0 0\n--set\ntolerance=1",
      "show\n--algorithm\nexact\n--model\na.ply\n-o\nx.ply",
      "quality\n--scenario\nII\n--algorithm\nexact",
      "generate\n--a\na.ply\n--b\nb.obj\n--grid\n90\n--distances\n0,5\n-o\nx.h5",
      "generate\n--a\na.ply\n--grid\nso3:10:5\n--volumes\n0.5\n-o\nx.h5\n--shards\n3\n--shard\n2",
      "merge\n.\n-o\nx.h5",
      "verify\nset.h5\n--a\na.ply\n--b\nb.obj\n--sample\n3",
      "agree\n--set\nset.h5",
      "table\nr.json",
      "table\nr.json\n--markdown",
      "table\nr.json\n--json",
      "table\na.ply",
      "precision\n--a\na.ply\n--b\nb.obj\n--budget\n1s",
      "recommend\n--a\na.ply\n--deadline\n1ms",
      "equivalent\n--tau\n1us",
      "stress\n--effort\nquick\n--seed\n1",
      "new-algorithm\nmine\n-o\nfolder",
      "new-algorithm\n9bad name",
      "gird",
      "query\n--gird\n5",
      "\xC3\xA9t\xC3\xA9\n\xFF\xFE",
      "",
      "completion\nbash",
      "query\n--a\na.ply\n--b\nopen.off\n--pose\n0\n0\n0\n1\n0\n0\n0\n--only\ndistance,collide",
      "scene\nmake\ncube\n-n\n3\n--frames\n2\n-o\ns.h5",
      "scene\nmake\n--poses\nposes.csv\n-o\ns.h5",
      "scene\nplay\ns.h5\n--list\n--json"};
  for (std::size_t i = 0; i < k_lines.size(); ++i) seeds.add("line-" + std::to_string(i), k_lines[i]);
}

}  // namespace
}  // namespace sixdof::fuzz

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  using namespace sixdof::fuzz;
  const std::filesystem::path folder = words[1];
  write_meshes(folder);
  write_sets(folder);
  write_structures(folder);
  write_lines(folder);
  write_pose_tables(folder);
  write_command_lines(folder);
  return 0;
}
