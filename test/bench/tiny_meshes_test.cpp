// Every algorithm of this build on meshes of one or two triangles, without area or volume, tiny and huge, each in a
// process of its own: it refuses them with words, answers or fails. Its process never ends by that.

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/registry.h>
#include "bench/common/all_algorithms.h"

namespace sixdof {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::vector<Mesh> tiny_meshes() {
  const Points triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Points tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> one{{0, 1, 2}}, four{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto scaled = [](Points points, const Eigen::Vector3d& factors) {
    for (Eigen::Vector3d& p : points) p = p.cwiseProduct(factors);
    return points;
  };
  const auto all = [](double factor) { return Eigen::Vector3d::Constant(factor); };
  std::vector<Mesh> meshes;
  const auto add = [&](const char* name, const Points& points, const std::vector<Triangle>& triangles) {
    meshes.push_back(Mesh::build(points, triangles, name));
  };
  add("one-triangle", triangle, one);
  add("one-needle", scaled(triangle, {1, 1e-12, 1}), one);
  add("one-without-area", {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, one);
  add("one-tiny", scaled(triangle, all(1e-160)), one);
  add("one-huge", scaled(triangle, all(1e150)), one);
  add("two-with-an-edge", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}});
  add("two-apart", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 1}, {6, 0, 1}, {5, 1, 1}}, {{0, 1, 2}, {3, 4, 5}});
  add("two-back-to-back", triangle, {{0, 1, 2}, {0, 2, 1}});
  add("tetrahedron", tetrahedron, four);
  add("flat-tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, four);
  add("tiny-tetrahedron", scaled(tetrahedron, all(1e-100)), four);
  return meshes;
}

/// GTS ends its process by an assertion where faces of two solids lie in one plane, which nobody can foresee.
constexpr const char* k_aborts = "gts";

/// Some where they touch, cross, coincide, and one far away.
std::vector<Pose> poses() {
  return {Pose(), Pose{.t = {0.25, 0.25, 0}}, Pose::from_quaternion(0.7, 0.5, 0.5, 0.1, {0.1, 0.2, -0.1}),
          Pose{.t = {3, 4, 100}}};
}

class TinyMeshes : public ::testing::TestWithParam<std::string> {
 protected:
  /// Asks everything about a pair.
  void ask(const Mesh& a, const Mesh& b) {
    const std::string pair = GetParam() + ": " + a.name() + ", " + b.name();
    std::unique_ptr<Query> query;
    try {
      query = algorithm_->prepare(a, b, algorithm_->settings());
    } catch (const BadMesh& e) {
      EXPECT_STRNE(e.what(), "") << pair;
      return;
    } catch (const std::exception& e) {
      ADD_FAILURE() << pair << ": " << e.what();
      return;
    }
    const auto expect_alive = [&](Status status) {
      if (GetParam() == k_aborts && status == Status::crashed) return;
      for (const Status end : k_counted_statuses) EXPECT_NE(status, end) << pair << ": " << query->diagnosis();
    };
    const QuerySet answers = algorithm_->traits().answers;
    for (const Pose& X_AB : poses()) {
      if (answers.collide) expect_alive(query->collide(X_AB).status);
      if (answers.distance) expect_alive(query->distance(X_AB).status);
      if (answers.respond) expect_alive(query->respond(X_AB).status);
    }
  }

  std::unique_ptr<RemoteAlgorithm> algorithm_ = RemoteAlgorithm::external(
      GetParam(), std::string(SIXDOF_BENCH_PROGRAM) + " --serve-algorithm " + GetParam(), {.query_s = 60.0});
};

TEST_P(TinyMeshes, EndNoProcess) {
  const Mesh usual = load_model("sphere-1k");
  for (const Mesh& mesh : tiny_meshes()) {
    ask(mesh, mesh);
    ask(mesh, usual);
    ask(usual, mesh);
  }
  const std::vector<Mesh> meshes = tiny_meshes();
  for (std::size_t i = 1; i < meshes.size(); ++i) ask(meshes[i - 1], meshes[i]);
}

std::vector<std::string> names() {
  ::setenv("SIXDOF_RIVALS", "no-rivals",
           1);  // also where tests are listed: those of the user are tested in test/rivals
  Registry registry;
  register_all_algorithms(registry);
  std::vector<std::string> list;
  for (const auto& algorithm : registry.all()) list.push_back(algorithm->traits().name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(OfEveryAlgorithm, TinyMeshes, ::testing::ValuesIn(names()), [](const auto& made) {
  std::string name = made.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace sixdof
