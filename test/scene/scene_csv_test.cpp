#include <sixdof/scene/scene_csv.h>

#include <fstream>

#include <sixdof/geometry/load.h>
#include <sixdof/geometry/save.h>
#include <sixdof/models/model_catalogue.h>
#include "../cli/scratch_folder.h"
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

class SceneCsv : public test::ScratchFolder {
 protected:
  SceneCsv() {
    save_mesh(make_sphere({}, 80), path("ball.ply"));
    save_mesh(make_box({}, 12), path("box.off"));
  }
  Scene read(const std::string& text) {
    std::ofstream(path("poses.csv")) << text;
    return read_scene_csv(folder(), path("poses.csv"), 0.25);
  }
  std::string refuses(const std::string& text) {
    const std::string message = message_of<BadFile>([&] { read(text); });
    const std::string file = path("poses.csv") + ": ";
    EXPECT_TRUE(message.starts_with(file)) << message;
    return message.substr(std::min(file.size(), message.size()));
  }
};

constexpr const char* k_header = "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz\n";
constexpr const char* k_start = "0,7,ball.ply,0,0,0,1,0,0,0\n0,3,box.off,1.5,-2,0.25,0,0,1,0\n";

TEST_F(SceneCsv, ReadsBodiesAndTheirMotion) {
  const Scene scene = read(std::string("# by hand\nbody, frame,mesh,qw,qx,qy,qz,tx,ty,tz,fixed\n") +
                           "7,0,ball.ply,1,0,0,0,0,0,0,1\n\n3,0,box.off,0,0,1,0,1.5,-2,0.25,0\r\n" +
                           "9,0,ball.ply,1,0,0,0,9,9,9,0\n9,2,,1,0,0,0,8,9,9,\n3,2,box.off,1,0,0,0,1,2,3,\n");
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.bodies[0].id, 7u);
  EXPECT_TRUE(scene.bodies[0].fixed);
  EXPECT_EQ(scene.bodies[1].pose.numbers, (std::array{0.0, 0.0, 1.0, 0.0, 1.5, -2.0, 0.25}));
  EXPECT_EQ(scene.bodies[2].mesh, scene.bodies[0].mesh);
  ASSERT_EQ(scene.frames.size(), 3u);
  EXPECT_TRUE(scene.frames[1].empty());
  ASSERT_EQ(scene.frames[2].size(), 2u);
  EXPECT_EQ(scene.frames[2][0].body, 2u);
  EXPECT_EQ(scene.frames[2][1].pose.numbers[6], 3.0);
  EXPECT_EQ(scene.margin, 0.25);
}

TEST_F(SceneCsv, AnotherFileOfTheSameTrianglesDeformsTheMesh) {
  const Mesh ball = load_mesh(path("ball.ply"));
  for (const int k : {1, 2}) {
    std::vector<Eigen::Vector3d> vertices = ball.vertices();
    for (Eigen::Vector3d& p : vertices) p.x() *= 1.0 + 0.25 * k;
    save_mesh(ball.with_vertices(vertices), path(k == 1 ? "ball1.ply" : "ball2.ply"));
  }
  const std::string start = std::string(k_header) + k_start + "0,9,ball.ply,5,0,0,1,0,0,0\n";
  const Scene scene =
      read(start + "1,7,ball1.ply,0,0,0,1,0,0,0\n1,9,ball1.ply,5,0,0,1,0,0,0\n" +
           "2,7,,0,1,0,1,0,0,0\n4,7,ball2.ply,0,0,0,1,0,0,0\n5,9,ball.ply,5,0,0,1,0,0,0\n" + "6,3,,1,1,1,1,0,0,0\n");
  EXPECT_EQ(scene.meshes.size(), 2u);
  ASSERT_EQ(scene.deformations.size(), 7u);
  EXPECT_EQ(scene.shapes(), 3u);
  EXPECT_EQ((*scene.deformations[1].at(0).vertices)[3].x(), 1.25 * ball.vertices()[3].x());
  EXPECT_EQ((*scene.deformations[4].at(0).vertices)[3].x(), 1.5 * ball.vertices()[3].x());
  EXPECT_EQ(*scene.deformations[5].at(0).vertices, ball.vertices());
  EXPECT_EQ(refuses(start + "1,7,ball1.ply,0,0,0,1,0,0,0\n1,9,ball2.ply,5,0,0,1,0,0,0\n"),
            "line 6, column mesh: ball.ply is ball1.ply in this frame already");
}

TEST_F(SceneCsv, NamesTheLineThatIsWrong) {
  const std::string good = std::string(k_header) + k_start;
  EXPECT_EQ(refuses("frame,body,mesh,x\n"),
            "line 1: no column 'x'; there are frame, body, mesh, qw, qx, qy, qz, tx, ty, tz, fixed, ignored");
  EXPECT_EQ(refuses("frame,body,mesh,tx,ty,tz,qw,qx,qy\n"), "line 1: the column qz is missing");
  EXPECT_EQ(refuses("frame,frame\n"), "line 1: column frame comes twice");
  EXPECT_EQ(refuses(good + "1,7,,0,0,0,1,0,0\n"), "line 4: 9 cells, not 10");
  EXPECT_EQ(refuses(good + "1,7,,0,0,zero,1,0,0,0\n"), "line 4, column tz: 'zero' is not a number");
  EXPECT_EQ(refuses(good + "1,7,,0,0,inf,1,0,0,0\n"), "line 4, column tz: is not finite");
  EXPECT_EQ(refuses(good + "1,-7,,0,0,0,1,0,0,0\n"), "line 4, column body: '-7' is not a count");
  EXPECT_EQ(refuses(good + "1,8,,0,0,0,1,0,0,0\n"), "line 4: body 8 is not in frame 0");
  EXPECT_EQ(
      refuses(good + "1,7,box.off,0,0,0,1,0,0,0\n"),
      "line 4, column mesh: box.off does not have the triangles of ball.ply, which the body has in frame 0; a mesh "
      "deforms if its vertices move");
  EXPECT_EQ(refuses(good + "1,7,,0,0,0,1,0,0,0\n1,7,,0,0,0,1,0,0,0\n"), "line 5: body 7 comes twice in frame 1");
  EXPECT_EQ(refuses(good + "2,7,,0,0,0,1,0,0,0\n1,7,,0,0,0,1,0,0,0\n"), "line 5: frame 1 after frame 2");
  EXPECT_EQ(refuses(good + "0,7,ball.ply,0,0,0,1,0,0,0\n"), "line 4: body 7 comes twice in frame 0");
  EXPECT_EQ(refuses(good + "0,4,,0,0,0,1,0,0,0\n"), "line 4, column mesh: body 4 has none");
  EXPECT_EQ(refuses(good + "0,4,cone.ply,0,0,0,1,0,0,0\n"), "line 4, column mesh: no file " + path("cone.ply"));
  const std::string too_long = std::string(300, 'x').append(".off");
  EXPECT_EQ(refuses(good + "0,4," + too_long + ",0,0,0,1,0,0,0\n"), "line 4, column mesh: no file " + path(too_long));
  EXPECT_EQ(refuses(std::string(k_header) + "1,7,ball.ply,0,0,0,1,0,0,0\n"), "line 2: the first frame is 1, not 0");
  EXPECT_NE(refuses(good + "1,7,,0,0,0,2,0,0,0\n").find("line 4: "), std::string::npos);
  EXPECT_EQ(refuses(""), "has no rows");
  EXPECT_EQ(refuses(k_header), "has no rows");
}

TEST_F(SceneCsv, ReadsNumbersAsProgramsWriteThem) {
  const Scene scene = read(std::string(k_header) +
                           "0,7,ball.ply,+0.5,-.25,5.,1,0,0,0\n0.0,3.0,box.off,1e-1,+1.5E+2,\"2\",1.0,+0,-0,0\n"
                           "1e0,\"7\",,  0.125 ,0,0,1,0,0,0\n");
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].pose.numbers, (std::array{1.0, 0.0, 0.0, 0.0, 0.5, -0.25, 5.0}));
  EXPECT_EQ(scene.bodies[1].id, 3u);
  EXPECT_EQ(scene.bodies[1].pose.numbers, (std::array{1.0, 0.0, 0.0, 0.0, 0.1, 150.0, 2.0}));
  ASSERT_EQ(scene.frames.size(), 2u);
  EXPECT_EQ(scene.frames[1][0].pose.numbers[4], 0.125);
  const std::string good = std::string(k_header) + k_start;
  EXPECT_EQ(refuses(good + "1,7,,\"0,5\",0,0,1,0,0,0\n"),
            "line 4, column tx: '0,5' is not a number; decimals are written with a point");
  EXPECT_EQ(refuses(good + "1.5,7,,0,0,0,1,0,0,0\n"), "line 4, column frame: '1.5' is not a count");
  EXPECT_EQ(refuses(good + "1,4294967296,,0,0,0,1,0,0,0\n"), "line 4, column body: '4294967296' is not a count");
  EXPECT_EQ(refuses(good + "1,7,,+-1,0,0,1,0,0,0\n"), "line 4, column tx: '+-1' is not a number");
  EXPECT_EQ(refuses(good + "1,7,,1 2,0,0,1,0,0,0\n"), "line 4, column tx: '1 2' is not a number");
}

TEST_F(SceneCsv, ReadsModelsByTheirNames) {
  const Scene scene = read(std::string(k_header) +
                           "0,1,torus-1k,0,0,0,1,0,0,0\n0,2,\"cone-1k\",9,0,0,1,0,0,0\n0,3,./ball.ply,5,0,0,1,0,0,0\n"
                           "0,4,torus-1k,5,5,0,1,0,0,0\n");
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.meshes[0]->hash(), load_model("torus-1k").hash());
  EXPECT_EQ(scene.bodies[3].mesh, scene.bodies[0].mesh);
  const std::string rows = std::string(k_header) + k_start;
  const std::string message = refuses(rows + "0,4,torsu-1k,0,0,0,1,0,0,0\n");
  EXPECT_TRUE(message.starts_with("line 4, column mesh: no file " + path("torsu-1k") + ", and: ")) << message;
  EXPECT_NE(message.find("torus"), std::string::npos) << message;
  // A file comes first.
  std::filesystem::copy_file(path("box.off"), path("torus-1k"));
  EXPECT_EQ(refuses(rows + "0,4,./torus,0,0,0,1,0,0,0\n"), "line 4, column mesh: no file " + path("./torus"));
}

TEST_F(SceneCsv, NamesPairsThatDoNotMatter) {
  const std::string header = "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz,ignored\n";
  const auto row = [](int body, const std::string& others) {
    return "0," + std::to_string(body) + ",ball.ply,0,0,0,1,0,0,0," + others + "\n";
  };
  const Scene scene = read(header + row(1, "") + row(5, "1") + row(2, "\"5, 1\"") + row(3, " 2  5 ") +
                           row(4, "\"5;3\"") + "1,5,,1,0,0,1,0,0,0,\n");
  EXPECT_EQ(scene.ignored, (std::vector<BodyPair>{{1, 2}, {1, 5}, {2, 3}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}));
  // Each of two may name the other.
  EXPECT_EQ(read(header + row(1, "2") + row(2, "1 1.0")).ignored, (std::vector<BodyPair>{{1, 2}}));
  EXPECT_EQ(refuses(header + row(1, "") + row(2, "1 9") + row(3, "")),
            "line 3, column ignored: body 9 is not in frame 0");
  EXPECT_EQ(refuses(header + row(1, "") + row(2, "2")), "line 3, column ignored: body 2 is no pair with itself");
  EXPECT_EQ(refuses(header + row(1, "") + row(2, "1,x")), "line 3: 12 cells, not 11");
  EXPECT_EQ(refuses(header + row(1, "") + row(2, "x")), "line 3, column ignored: 'x' is not a count");
  EXPECT_EQ(refuses(header + row(1, "") + row(2, "") + "1,1,,0,0,0,1,0,0,0,2\n"),
            "line 4, column ignored: pairs are ignored in all frames; name them in frame 0");
}

TEST_F(SceneCsv, ReadsEveryWayOfWritingTheSameTable) {
  const std::string table = std::string(k_header) + k_start + "1,7,,0.25,0,0,1,0,0,0\n";
  const std::string hash = read(table).hash();
  const auto with = [&](const char* from, const std::string& to) {
    std::string text;
    for (const char c : table) c == * from ? text += to : text += c;
    return text;
  };
  std::string quoted("\"");
  quoted += with(",", "\",\"");
  for (std::size_t at = 0; (at = quoted.find('\n', at)) + 1 < quoted.size(); at += 3) quoted.replace(at, 1, "\"\n\"");
  quoted.replace(quoted.size() - 1, 1, "\"\n");
  const std::string trailing = "# all\n\n  \n" + with("\n", " , ,\n,,,\n#\n");
  for (const std::string& text :
       {"\xEF\xBB\xBF" + table, with("\n", "\r\n"), with("\n", "\r"), with(",", ";"), with(",", "\t"), with(",", " , "),
        "sep=;\r\n" + with(",", ";"), "\xEF\xBB\xBFsep=,\n" + table, quoted, trailing,
        table.substr(0, table.size() - 1),
        std::string("Frame,Body,MESH,Tx,ty,tz,qW,qx,qy,qz\n") + table.substr(table.find('\n') + 1)}) {
    EXPECT_EQ(read(text).hash(), hash) << text;
  }
}

}  // namespace
}  // namespace sixdof::scene
