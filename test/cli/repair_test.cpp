// `sixdof repair`, and the messages that name it.

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "mesh_files.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Repair : public test::ScratchFolder {
 protected:
  Repair() {
    // A unit cube: one triangle is missing, one is there twice, one is turned.
    std::vector<Eigen::Vector3d> vertices;
    std::vector<Triangle> triangles;
    test::add_box({0, 0, 0}, {1, 1, 1}, vertices, triangles);
    triangles.push_back(triangles[3]);
    std::swap(triangles[5][0], triangles[5][1]);
    triangles.erase(triangles.begin() + 8);
    save_mesh(Mesh::build(vertices, triangles, "damaged"), path("damaged.off"));
    // Without one side, whose border has four edges.
    triangles.clear();
    vertices.clear();
    test::add_box({0, 0, 0}, {1, 1, 1}, vertices, triangles);
    triangles.resize(10);
    save_mesh(Mesh::build(vertices, triangles, "tray"), path("tray.off"));
  }

  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("cd " + folder().string() + " && SIXDOF_CACHE=" + path("cache") + " " + SIXDOF_PROGRAM +
                             " " + arguments);
  }
  nlohmann::json json_of(const std::string& arguments, int exit_code = 0) const {
    const auto result = run(arguments + " --json");
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return nlohmann::json::parse(result.out);
  }
  std::string bytes(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Repair, MendsAndSaysWhat) {
  const auto text = run("repair damaged.off -o mended.ply");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("before   12 triangles, no solid: not closed"));
  EXPECT_THAT(text.out, HasSubstr("1 duplicate triangles dropped, at (0.666667, 0.666667, 1)"));
  EXPECT_THAT(text.out, HasSubstr("1 triangles turned, at "));
  EXPECT_THAT(text.out, HasSubstr("1 holes filled, at "));
  EXPECT_THAT(text.out, HasSubstr("after    12 triangles, a solid of volume 1\n"));
  const auto info = json_of("info mended.ply");
  EXPECT_EQ(info.at("solid"), true);
  EXPECT_EQ(info.at("volume"), 1.0);
  EXPECT_EQ(run("info mended.ply --check").exit_code, 0);

  const auto json = json_of("repair damaged.off -o mended.obj");
  EXPECT_EQ(json.at("repairs").at("duplicate_triangles").at("count"), 1);
  EXPECT_EQ(json.at("repairs").at("duplicate_triangles").at("first").size(), 1u);
  EXPECT_EQ(json.at("repairs").at("welded_vertices").at("count"), 0);
  EXPECT_EQ(json.at("before").at("solid"), false);
  EXPECT_EQ(json.at("after").at("solid"), true);
  EXPECT_EQ(json.at("converged"), true);
  EXPECT_EQ(json_of("info mended.obj").at("hash"), json.at("after").at("hash"));
}

TEST_F(Repair, OfTheResultDoesNothing) {
  ASSERT_EQ(run("repair damaged.off -o once.ply").exit_code, 0);
  const auto again = run("repair once.ply -o twice.ply");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("nothing to repair"));
  EXPECT_EQ(bytes("once.ply"), bytes("twice.ply"));
}

TEST_F(Repair, GivesASoundMeshBack) {
  ASSERT_EQ(run("models make torus-1k -o torus.ply").exit_code, 0);
  ASSERT_EQ(run("repair torus.ply -o same.ply").exit_code, 0);
  EXPECT_EQ(bytes("torus.ply"), bytes("same.ply"));
}

/// Other commands refuse a file with a face that is not finite, and name the one that drops it.
TEST_F(Repair, DropsFacesThatAreNotFiniteAndSaysSo) {
  std::string text = bytes("tray.off");
  text.replace(text.find("OFF\n8 10 "), 9, "OFF\n9 13 ");
  text.insert(text.find("\n3 ") + 1, "nan 0 0\n");
  std::ofstream(path("nan.off")) << text << "3 1 3 5\n3 3 7 5\n3 0 1 8\n";
  const std::string hint = "not finite; sixdof repair drops such faces";
  for (const char* command : {"info nan.off", "query --a nan.off --b cone-1k --pose '0.9 0 0.1 1 0 0 0'"}) {
    const auto refused = run(command);
    EXPECT_EQ(refused.exit_code, k_exit_error) << command;
    EXPECT_THAT(refused.err, HasSubstr(hint)) << command;
  }
  const auto repaired = run("repair nan.off -o mended.off");
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  const std::string forgiven = "1 face with a corner that is not finite, dropped (line 24)";
  EXPECT_THAT(repaired.out, HasSubstr("forgiven 1 unused vertex that is not finite, dropped (line 11); " + forgiven));
  EXPECT_EQ(json_of("info mended.off").at("volume"), 1.0);
  EXPECT_THAT(json_of("repair nan.off -o mended.off").at("forgiven").get<std::string>(), HasSubstr(forgiven));
}

TEST_F(Repair, DropsFinsWallsAndStrayTriangles) {
  std::string text = bytes("tray.off");
  text.replace(text.find("OFF\n8 10 "), 9, "OFF\n12 15 ");
  text.insert(text.find("\n3 ") + 1, "0.5 -0.3 -0.3\n2 0 0\n2 0.2 0\n2 0 0.1\n");
  std::ofstream(path("odd.off")) << text << "3 1 3 5\n3 3 7 5\n3 1 2 4\n3 0 1 8\n3 9 10 11\n";
  const auto json = json_of("repair odd.off -o mended.off");
  EXPECT_EQ(json.at("after").at("volume"), 1.0);
  for (const char* kind : {"fins", "inner_walls", "stray_triangles"}) {
    EXPECT_EQ(json.at("repairs").at(kind).at("count"), 1) << kind;
  }
  EXPECT_THAT(run("repair odd.off -o mended.off").out, HasSubstr("1 triangles of fins dropped, at (0.5, -0.1, -0.1)"));
  EXPECT_EQ(json_of("repair odd.off -o kept.off --max-fin 0", k_exit_defects).at("repairs").at("fins").at("count"), 0);
}

/// What cannot be mended is written as far as it is, and the exit code says so.
TEST_F(Repair, SaysWhatIsLeft) {
  const auto open = run("repair tray.off -o open.ply --max-hole 3");
  EXPECT_EQ(open.exit_code, k_exit_defects);
  EXPECT_EQ(open.err, "sixdof: open.ply: written, but still no solid: not closed: 4 border edges\n");
  EXPECT_THAT(open.out, HasSubstr("nothing to repair"));
  EXPECT_THAT(open.out, HasSubstr("gaps     4 open edges; their middles are 0.29 of the diagonal (median; largest "
                                  "0.29) from the next\n"));
  EXPECT_THAT(open.out, HasSubstr("tried    as it is: no solid, 4 open edges\n"));
  EXPECT_THAT(open.out, HasSubstr("advice   add --max-hole 128\n"));
  EXPECT_EQ(json_of("info open.ply").at("border_edges"), 4);
  EXPECT_EQ(run("repair tray.off -o closed.ply --max-hole 4").exit_code, 0);
  EXPECT_EQ(json_of("info closed.ply").at("volume"), 1.0);
  const auto json = json_of("repair tray.off -o open.ply --max-hole 0", k_exit_defects);
  EXPECT_EQ(json.at("after").at("why_not_solid"), "not closed: 4 border edges");
  EXPECT_EQ(json.at("advice").at("add"), "--max-hole 128");
  EXPECT_EQ(json.at("advice").at("gaps").at("edges"), 4);
  EXPECT_EQ(json.at("advice").at("tried").front().at("options"), "");
}

TEST_F(Repair, RefusesInWordsAndWritesNothing) {
  const std::string before = bytes("damaged.off");
  const auto refuses = [&](const std::string& arguments, int exit_code, const std::string& words) {
    const auto result = run("repair " + arguments);
    EXPECT_EQ(result.exit_code, exit_code) << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder()), fs::directory_iterator()), 2) << arguments;
  };
  refuses("damaged.off -o damaged.off", k_exit_error, "is the input, which is not overwritten");
  refuses("damaged.off -o ../" + folder().filename().string() + "/damaged.off", k_exit_error, "is the input");
  refuses("damaged.off -o mended.xyz", k_exit_error, "mended.xyz: '.xyz'");
  refuses("damaged.off -o no/such/mended.ply", k_exit_error, "no/such");
  refuses("missing.off -o mended.ply", k_exit_error, "missing.off");
  refuses("damaged.off", k_exit_usage, "--output");
  refuses("damaged.off -o mended.ply --weld 0.5", k_exit_error, "must be from 0 to 0.1");
  refuses("damaged.off -o mended.ply --max-fin -1", k_exit_error, "must be from 0 to 1");
  refuses("damaged.off -o mended.ply --max-hole 100000", k_exit_error, "100000 were asked for");
  EXPECT_EQ(bytes("damaged.off"), before);
}

/// Whoever needs a solid names the command.
TEST_F(Repair, IsNamedWhereASolidIsNeeded) {
  const std::string hint = "not closed: 4 border edges; `sixdof repair IN -o OUT` may mend it";
  const auto volumes = run("generate --a tray.off --grid 90 --volumes 1 -o set.h5");
  EXPECT_EQ(volumes.exit_code, k_exit_error);
  EXPECT_THAT(volumes.err, HasSubstr("tray: an overlap volume needs a solid: " + hint));
  for (const char* algorithm : {"ist", "vps"}) {
    const auto query =
        run(std::string("query --a tray.off --b cone-1k --pose '0.9 0 0.1 1 0 0 0' --algorithm ") + algorithm);
    EXPECT_EQ(query.exit_code, k_exit_error) << algorithm;
    EXPECT_THAT(query.err, HasSubstr(hint)) << algorithm;
  }
  const auto exact = run("query --a tray.off --b cone-1k --pose '0.9 0 0.1 1 0 0 0' --algorithm exact");
  EXPECT_THAT(exact.out + exact.err, HasSubstr(hint));
}

}  // namespace
}  // namespace sixdof
