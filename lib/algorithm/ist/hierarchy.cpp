#include <sixdof/algorithm/ist/hierarchy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_branching = 4;
constexpr int k_epochs = 20;  // T: beyond it clusters no longer change visibly
constexpr double k_lambda_start = k_branching / 2.0;
constexpr double k_lambda_end = 0.01;
constexpr std::size_t k_parallel_from = 2000;  // spheres below which a subtree is not worth a task

using Prototypes = std::array<Eigen::Vector3d, k_branching>;

/// Squared distances of the prototypes from a point, and each prototype's rank (0 = closest; ties by index).
struct Ranking {
  std::array<double, k_branching> squared;
  std::array<std::size_t, k_branching> rank{};

  Ranking(const Prototypes& prototypes, const Eigen::Vector3d& point) {
    for (std::size_t i = 0; i < k_branching; ++i) squared[i] = (prototypes[i] - point).squaredNorm();
    for (std::size_t i = 0; i < k_branching; ++i) {
      for (std::size_t j = 0; j < k_branching; ++j) {
        if (squared[j] < squared[i] || (squared[j] == squared[i] && j < i)) ++rank[i];
      }
    }
  }
  std::size_t closest() const {
    return static_cast<std::size_t>(std::min_element(rank.begin(), rank.end()) - rank.begin());
  }
};

/// Start: volume-weighted centre, pushed apart towards the four alternating corners of the spheres' box.
Prototypes initial_prototypes(std::span<const Sphere> spheres) {
  Eigen::AlignedBox3d box;
  for (const Sphere& s : spheres) box.extend(s.center);
  const Eigen::Vector3d h = 0.25 * box.sizes();
  const Eigen::Vector3d c = box.center();
  return {c + Eigen::Vector3d(h.x(), h.y(), h.z()), c + Eigen::Vector3d(h.x(), -h.y(), -h.z()),
          c + Eigen::Vector3d(-h.x(), h.y(), -h.z()), c + Eigen::Vector3d(-h.x(), -h.y(), h.z())};
}

Prototypes batch_neural_gas(std::span<const Sphere> spheres) {
  Prototypes prototypes = initial_prototypes(spheres);
  for (int epoch = 0; epoch < k_epochs; ++epoch) {
    const double lambda =
        k_lambda_start * std::pow(k_lambda_end / k_lambda_start, epoch / static_cast<double>(k_epochs));
    std::array<double, k_branching> influence;
    for (std::size_t k = 0; k < k_branching; ++k) influence[k] = std::exp(-static_cast<double>(k) / lambda);
    Prototypes sum;
    sum.fill(Eigen::Vector3d::Zero());
    std::array<double, k_branching> weight{};
    for (const Sphere& s : spheres) {
      const Ranking ranking(prototypes, s.center);
      const double v = s.volume();
      for (std::size_t i = 0; i < k_branching; ++i) {
        const double w = influence[ranking.rank[i]] * v;
        sum[i] += w * s.center;
        weight[i] += w;
      }
    }
    for (std::size_t i = 0; i < k_branching; ++i) {
      if (weight[i] > 0.0) prototypes[i] = sum[i] / weight[i];
    }
  }
  return prototypes;
}

/// Sorts `spheres` into up to four clusters and returns their ends. Falls back to equal parts along the longest axis
/// where the clusters do not separate the spheres (all centres equal).
std::vector<std::size_t> split(std::span<Sphere> spheres) {
  std::vector<std::size_t> ends;
  if (spheres.size() <= k_branching) {
    for (std::size_t i = 1; i <= spheres.size(); ++i) ends.push_back(i);
    return ends;
  }
  const Prototypes prototypes = batch_neural_gas(spheres);
  std::array<std::vector<Sphere>, k_branching> clusters;
  for (const Sphere& s : spheres) clusters[Ranking(prototypes, s.center).closest()].push_back(s);
  std::size_t end = 0;
  for (const auto& cluster : clusters) {
    if (cluster.size() == spheres.size()) {
      const std::size_t n = spheres.size();
      return {n / 4, n / 2, n / 4 + n / 2, n};
    }
    if (cluster.empty()) continue;
    std::copy(cluster.begin(), cluster.end(), spheres.begin() + static_cast<std::ptrdiff_t>(end));
    end += cluster.size();
    ends.push_back(end);
  }
  return ends;
}

/// A subtree under construction; flattened when all tasks are done.
struct Draft {
  SphereNode node{};
  std::array<std::unique_ptr<Draft>, k_branching> below;
};

std::unique_ptr<Draft> build(std::span<Sphere> spheres, std::size_t first_leaf) {
  auto draft = std::make_unique<Draft>();
  SphereNode& node = draft->node;
  node.r.fill(-std::numeric_limits<double>::infinity());
  node.child.fill(SphereNode::k_empty);
  const std::vector<std::size_t> ends = split(spheres);
  parallel::Tasks tasks;
  std::size_t begin = 0;
  for (std::size_t slot = 0; slot < ends.size(); ++slot) {
    const std::span<Sphere> part = spheres.subspan(begin, ends[slot] - begin);
    const Sphere bound = enclosing_sphere(part);
    node.x[slot] = bound.center.x();
    node.y[slot] = bound.center.y();
    node.z[slot] = bound.center.z();
    node.r[slot] = bound.radius;
    for (const Sphere& s : part) node.volume[slot] += s.volume();
    if (part.size() == 1) {
      node.child[slot] = ~static_cast<std::int32_t>(first_leaf + begin);
    } else if (part.size() >= k_parallel_from) {
      tasks.run([&draft, slot, part, leaf = first_leaf + begin] { draft->below[slot] = build(part, leaf); });
    } else {
      draft->below[slot] = build(part, first_leaf + begin);
    }
    begin = ends[slot];
  }
  tasks.wait();
  return draft;
}

std::int32_t flatten(const Draft& draft, std::vector<SphereNode>& nodes) {
  const auto index = static_cast<std::int32_t>(nodes.size());
  nodes.push_back(draft.node);
  for (std::size_t slot = 0; slot < k_branching; ++slot) {
    if (!draft.below[slot]) continue;
    const std::int32_t child = flatten(*draft.below[slot], nodes);
    nodes[static_cast<std::size_t>(index)].child[slot] = child;
  }
  return index;
}

}  // namespace

SphereTree build_sphere_tree(std::vector<Sphere> spheres) {
  if (spheres.empty()) throw BadArgument("inner sphere tree: no spheres");
  SphereTree tree;
  tree.bound = enclosing_sphere(spheres);
  const std::unique_ptr<Draft> root = build(spheres, 0);
  flatten(*root, tree.nodes);
  tree.leaves = std::move(spheres);
  for (const Sphere& s : tree.leaves) tree.volume += s.volume();
  return tree;
}

}  // namespace sixdof::ist
