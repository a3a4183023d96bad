#include <sixdof/scene/scene.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "small_scenes.h"

namespace sixdof::scene {
namespace {

TEST(Scene, NamesWhatIsWrong) {
  const Scene good = row_of_spheres(4, 0.1, 0.01, 3, 0.2);
  EXPECT_NO_THROW(good.check());
  const auto refuses = [&](const auto& spoil) {
    Scene bad = good;
    spoil(bad);
    return message_of<BadArgument>([&] { bad.check(); });
  };
  EXPECT_EQ(refuses([](Scene& s) { s.bodies[1].id = 13; }), "two bodies have the identifier 13");
  EXPECT_EQ(refuses([](Scene& s) { s.bodies[2].mesh = 1; }), "body 2: mesh 1 of 1");
  EXPECT_EQ(refuses([](Scene& s) { s.bodies[3].fixed = true; }), "frame 1: body 10 is fixed and moves");
  EXPECT_EQ(refuses([](Scene& s) { s.frames[2].push_back(s.frames[2][0]); }), "frame 2: body 10 moves twice");
  EXPECT_EQ(refuses([](Scene& s) { s.frames[1][0].body = 4; }), "frame 1: body number 4 of 4");
  EXPECT_EQ(refuses([](Scene& s) { s.margin = -1.0; }), "margin -1");
  EXPECT_EQ(refuses([](Scene& s) { s.ignored = {{10, 99}}; }), "ignored pair: no body 99");
  EXPECT_EQ(refuses([](Scene& s) { s.ignored = {{11, 10}}; }), "ignored pair 11 10: not in order");
  EXPECT_EQ(refuses([](Scene& s) {
              s.ignored = {{10, 11}, {10, 11}};
            }),
            "the ignored pairs are not sorted, or one comes twice");
  EXPECT_EQ(refuses([](Scene& s) { s.frames[0] = s.frames[1]; }), "the first frame must move nothing");
  EXPECT_EQ(refuses([](Scene& s) { s.bodies.resize(1); }), "a scene of 1 bodies; it needs two");
  EXPECT_NE(refuses([](Scene& s) { s.frames[1][0].pose.numbers[0] = 7.0; }).find("frame 1, body 10: "),
            std::string::npos);
  EXPECT_EQ(refuses([](Scene& s) { s.bodies[0].pose.numbers[4] = NAN; }), "body 0: a number is not finite");
}

TEST(Scene, HashKnowsEveryNumber) {
  const Scene scene = row_of_spheres(4, 0.1, 0.01, 3, 0.2);
  Scene same = scene;
  same.name = "another";
  EXPECT_EQ(same.hash(), scene.hash());
  const auto differs = [&](const auto& change) {
    Scene other = scene;
    change(other);
    return other.hash() != scene.hash();
  };
  EXPECT_TRUE(differs([](Scene& s) { s.margin = std::nextafter(s.margin, 1.0); }));
  EXPECT_TRUE(differs([](Scene& s) { s.bodies[0].id = 99; }));
  EXPECT_TRUE(differs([](Scene& s) { s.bodies[0].fixed = true; }));
  EXPECT_TRUE(differs([](Scene& s) { s.bodies[2].pose.numbers[6] += 1e-12; }));
  EXPECT_TRUE(differs([](Scene& s) { s.frames[2][0].pose.numbers[5] += 1e-12; }));
  EXPECT_TRUE(differs([](Scene& s) { s.ignored = {{10, 11}}; }));
  EXPECT_TRUE(differs([](Scene& s) { s.meshes[0] = std::make_shared<const Mesh>(make_sphere({}, 500)); }));
}

TEST(PairFilter, LeavesOutFixedAndIgnoredPairs) {
  Scene scene = row_of_spheres(6, 0.1, 0.0, 1, 0.0);  // identifiers 15, 14, ..., 10
  scene.bodies[0].fixed = true;
  scene.bodies[2].fixed = true;
  scene.ignored = {{10, 12}, {13, 15}};
  scene.check();
  const PairFilter filter(scene);
  EXPECT_EQ(filter.pairs(), 15u - 1u - 1u);  // 13 and 15 are fixed: that pair counts once
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < 6; ++i) {
    for (std::uint32_t j = i + 1; j < 6; ++j) {
      EXPECT_EQ(filter.matters(i, j), filter.matters(j, i));
      count += filter.matters(i, j) ? 1 : 0;
    }
  }
  EXPECT_EQ(count, filter.pairs());
  EXPECT_FALSE(filter.matters(0, 2));
  EXPECT_FALSE(filter.matters(3, 5));
  EXPECT_TRUE(filter.matters(0, 1));
}

TEST(Shuffled, KeepsEveryBodyAndItsMotion) {
  const Scene scene = make_scene("cube", {.bodies = 40, .frames = 4, .moving = 0.5, .seed = 3});
  const Scene other = shuffled(scene, 8);
  other.check();
  EXPECT_NE(other.hash(), scene.hash());
  const auto by_id = [](const Scene& s) {
    std::vector<std::vector<std::pair<std::uint32_t, std::array<double, 7>>>> frames(1);
    for (const Body& body : s.bodies) frames[0].emplace_back(body.id, body.pose.numbers);
    for (const Frame& frame : s.frames) {
      frames.emplace_back();
      for (const Motion& motion : frame) frames.back().emplace_back(s.bodies[motion.body].id, motion.pose.numbers);
    }
    for (auto& frame : frames) std::ranges::sort(frame);
    return frames;
  };
  EXPECT_EQ(by_id(other), by_id(scene));
}

/// Where each body is in a frame, by identifier.
std::map<std::uint32_t, std::array<double, 7>> places(const Scene& scene, std::size_t frame) {
  std::map<std::uint32_t, std::array<double, 7>> poses;
  for (const Body& body : scene.bodies) poses[body.id] = body.pose.numbers;
  for (std::size_t f = 1; f <= frame; ++f) {
    for (const Motion& motion : scene.frames[f]) poses[scene.bodies[motion.body].id] = motion.pose.numbers;
  }
  return poses;
}

TEST(Excerpt, HasTheSamePosesInEveryFrame) {
  const Scene scene = shuffled(make_scene("cube", {.bodies = 30, .frames = 8, .moving = 0.5, .seed = 3}), 5);
  const std::vector<std::uint32_t> kept{scene.bodies[7].id, scene.bodies[2].id, scene.bodies[21].id};
  const Scene part = excerpt(scene, kept, 3, 6);
  part.check();
  ASSERT_EQ(part.bodies.size(), 3u);
  EXPECT_EQ(part.bodies[0].id, scene.bodies[2].id);
  ASSERT_EQ(part.frames.size(), 4u);
  for (std::size_t f = 0; f < part.frames.size(); ++f) {
    const auto now = places(part, f), whole = places(scene, 3 + f);
    for (const std::uint32_t id : kept) EXPECT_EQ(now.at(id), whole.at(id));
  }
  const Scene all = excerpt(scene, {}, 0, scene.frames.size() - 1);
  EXPECT_EQ(all.hash(), scene.hash());
}

TEST(Excerpt, KeepsPairsThatAreIgnoredAndRefusesWhatIsNotThere) {
  Scene scene = make_scene("cube", {.bodies = 10, .frames = 3, .seed = 3});
  const std::uint32_t a = scene.bodies[1].id, b = scene.bodies[4].id, c = scene.bodies[5].id;
  scene.ignored = {BodyPair::of(a, b), BodyPair::of(a, c)};
  std::ranges::sort(scene.ignored);
  const std::vector<std::uint32_t> kept{a, b};
  EXPECT_EQ(excerpt(scene, kept, 1, 1).ignored, std::vector{BodyPair::of(a, b)});
  EXPECT_THROW(excerpt(scene, {}, 0, 3), BadArgument);
  EXPECT_THROW(excerpt(scene, {}, 2, 1), BadArgument);
  EXPECT_THROW(excerpt(scene, std::vector{a, 4000000000u}, 0, 1), BadArgument);
}

/// Two spheres of one mesh, which deforms in frames 1 and 3 of 4.
Scene breathing_spheres() {
  Scene scene = row_of_spheres(2, 0.5, 0.1, 4, 0.0);
  scene.deformations.resize(4);
  for (const std::size_t f : {1u, 3u}) {
    std::vector<Eigen::Vector3d> vertices = scene.meshes[0]->vertices();
    for (Eigen::Vector3d& p : vertices) p *= 1.0 + 0.1 * static_cast<double>(f);
    scene.deformations[f].push_back({0, std::make_shared<const std::vector<Eigen::Vector3d>>(vertices)});
  }
  return scene;
}

TEST(Scene, OfBodiesThatDeformHasAHashOfItsVertices) {
  const Scene scene = breathing_spheres();
  scene.check();
  EXPECT_TRUE(scene.deforms(0));
  EXPECT_EQ(scene.shapes(), 2u);
  EXPECT_EQ(shapes_of(scene, 3).front().vertices.size(), scene.meshes[0]->vertices().size());
  EXPECT_TRUE(shapes_of(scene, 2).empty());
  Scene other = scene;
  std::vector<Eigen::Vector3d> vertices = *other.deformations[3][0].vertices;
  vertices[7].x() = std::nextafter(vertices[7].x(), 9.0);
  other.deformations[3][0].vertices = std::make_shared<const std::vector<Eigen::Vector3d>>(vertices);
  EXPECT_NE(other.hash(), scene.hash());
}

TEST(Scene, RefusesDeformationsThatAreNone) {
  const auto refusal = [](const auto& change) {
    Scene scene = breathing_spheres();
    change(scene);
    return message_of<BadArgument>([&] { scene.check(); });
  };
  EXPECT_EQ(refusal([](Scene& s) { s.deformations.pop_back(); }), "deformations of 3 frames in a scene of 4");
  EXPECT_EQ(refusal([](Scene& s) { s.deformations[0] = s.deformations[1]; }), "the first frame must deform nothing");
  EXPECT_EQ(refusal([](Scene& s) { s.deformations[1][0].mesh = 3; }), "frame 1, mesh 3: the scene has 1 meshes");
  EXPECT_EQ(refusal([](Scene& s) { s.deformations[3].push_back(s.deformations[3][0]); }),
            "frame 3, mesh 0: not in the order of meshes, or twice");
  EXPECT_EQ(refusal([](Scene& s) {
              std::vector<Eigen::Vector3d> vertices = *s.deformations[1][0].vertices;
              vertices[9] = vertices[4];
              s.deformations[1][0].vertices = std::make_shared<const std::vector<Eigen::Vector3d>>(vertices);
            }),
            "frame 1, mesh 0: vertices 4 and 9 are equal");
  EXPECT_EQ(refusal([](Scene& s) {
              s.deformations[1][0].vertices = std::make_shared<const std::vector<Eigen::Vector3d>>(5);
            }),
            "frame 1, mesh 0: 5 vertices for a mesh of 162");
  EXPECT_EQ(refusal([](Scene& s) { s.bodies[0].fixed = true; }), "body 11 is fixed, but its mesh 0 deforms");
}

TEST(Scene, ExcerptBeginsWithTheShapeOfItsFirstFrame) {
  const Scene scene = breathing_spheres();
  const Scene part = excerpt(scene, {}, 2, 3);
  EXPECT_EQ(part.meshes[0]->vertices(), *scene.deformations[1][0].vertices);
  ASSERT_EQ(part.deformations.size(), 2u);
  EXPECT_EQ(*part.deformations[1][0].vertices, *scene.deformations[3][0].vertices);
  EXPECT_FALSE(excerpt(scene, {}, 2, 2).deforms());
  part.check();
}

}  // namespace
}  // namespace sixdof::scene
