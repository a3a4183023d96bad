#include <sixdof/scene/scene_csv.h>

#include <fstream>

#include <sixdof/geometry/save.h>
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

TEST_F(SceneCsv, NamesTheLineThatIsWrong) {
  const std::string good = std::string(k_header) + k_start;
  EXPECT_EQ(refuses("frame,body,mesh,x\n"),
            "line 1: no column 'x'; there are frame, body, mesh, qw, qx, qy, qz, tx, ty, tz, fixed");
  EXPECT_EQ(refuses("frame,body,mesh,tx,ty,tz,qw,qx,qy\n"), "line 1: the column qz is missing");
  EXPECT_EQ(refuses("frame,frame\n"), "line 1: column frame comes twice");
  EXPECT_EQ(refuses(good + "1,7,,0,0,0,1,0,0\n"), "line 4: 9 cells, not 10");
  EXPECT_EQ(refuses(good + "1,7,,0,0,zero,1,0,0,0\n"), "line 4: tz 'zero' is not a number");
  EXPECT_EQ(refuses(good + "1,7,,0,0,inf,1,0,0,0\n"), "line 4: tz is not finite");
  EXPECT_EQ(refuses(good + "1,-7,,0,0,0,1,0,0,0\n"), "line 4: body '-7' is not a count");
  EXPECT_EQ(refuses(good + "1,8,,0,0,0,1,0,0,0\n"), "line 4: body 8 is not in frame 0");
  EXPECT_EQ(refuses(good + "1,7,box.off,0,0,0,1,0,0,0\n"), "line 4: body 7 has another mesh in frame 0");
  EXPECT_EQ(refuses(good + "1,7,,0,0,0,1,0,0,0\n1,7,,0,0,0,1,0,0,0\n"), "line 5: body 7 comes twice in frame 1");
  EXPECT_EQ(refuses(good + "2,7,,0,0,0,1,0,0,0\n1,7,,0,0,0,1,0,0,0\n"), "line 5: frame 1 after frame 2");
  EXPECT_EQ(refuses(good + "0,7,ball.ply,0,0,0,1,0,0,0\n"), "line 4: body 7 comes twice in frame 0");
  EXPECT_EQ(refuses(good + "0,4,,0,0,0,1,0,0,0\n"), "line 4: body 4 has no mesh");
  EXPECT_EQ(refuses(good + "0,4,cone.ply,0,0,0,1,0,0,0\n"), "line 4: no file " + path("cone.ply"));
  EXPECT_EQ(refuses(std::string(k_header) + "1,7,ball.ply,0,0,0,1,0,0,0\n"), "line 2: the first frame is 1, not 0");
  EXPECT_NE(refuses(good + "1,7,,0,0,0,2,0,0,0\n").find("line 4: "), std::string::npos);
  EXPECT_EQ(refuses(""), "has no rows");
  EXPECT_EQ(refuses(k_header), "has no rows");
}

}  // namespace
}  // namespace sixdof::scene
