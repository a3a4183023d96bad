#include <sixdof/algorithm/ist/hierarchy.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_branching = 4;
constexpr int k_epochs = 20;  // T in the formula of build_sphere_tree()
constexpr double k_lambda_start = k_branching / 2.0;
constexpr double k_lambda_end = 0.01;
constexpr std::size_t k_max_even_split = k_branching * k_branching;  // spheres that are split evenly, at most
constexpr std::size_t k_min_task = 2000;                             // spheres of a subtree that is built in parallel

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

/// Half-way from the centre of the box of the spheres' centres to four alternating corners of it.
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

/// Sorts `spheres` into `parts` ranges of nearly equal size across the longest axes, and appends their ends.
void split_evenly(std::span<Sphere> spheres, std::size_t parts, std::size_t begin, std::vector<std::size_t>& ends) {
  if (parts == 1) {
    ends.push_back(begin + spheres.size());
    return;
  }
  Eigen::AlignedBox3d box;
  for (const Sphere& s : spheres) box.extend(s.center);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t low = (parts + 1) / 2, middle = (spheres.size() * low + parts - 1) / parts;
  std::nth_element(spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(middle), spheres.end(),
                   [&](const Sphere& p, const Sphere& q) { return p.center[axis] < q.center[axis]; });
  split_evenly(spheres.first(middle), low, begin, ends);
  split_evenly(spheres.subspan(middle), parts - low, begin + middle, ends);
}

/// Sorts `spheres` into up to four clusters and returns their ends. If one cluster takes all spheres (equal centres),
/// they are split in the present order.
std::vector<std::size_t> split(std::span<Sphere> spheres) {
  std::vector<std::size_t> ends;
  if (spheres.size() <= k_branching) {
    for (std::size_t i = 1; i <= spheres.size(); ++i) ends.push_back(i);
    return ends;
  }
  if (spheres.size() <= k_max_even_split) {
    split_evenly(spheres, (spheres.size() + k_branching - 1) / k_branching, 0, ends);
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

/// A node under construction. Subtrees are built in any order; flatten() then appends them to the tree.
struct BuildNode {
  struct Child {
    Sphere ball;
    double volume = 0.0;
    std::unique_ptr<BuildNode> node;  ///< None if this node's children are leaves.
  };
  std::vector<Child> children;
  std::size_t first_leaf = 0;
};

std::unique_ptr<BuildNode> build(std::span<Sphere> spheres, std::size_t first_leaf) {
  auto result = std::make_unique<BuildNode>();
  result->first_leaf = first_leaf;
  const bool of_leaves = spheres.size() <= k_branching;
  const std::vector<std::size_t> ends = split(spheres);
  result->children.resize(ends.size());
  const auto build_child = [&](std::size_t slot) {
    const std::size_t begin = slot == 0 ? 0 : ends[slot - 1];
    const std::span<Sphere> part = spheres.subspan(begin, ends[slot] - begin);
    BuildNode::Child& child = result->children[slot];
    child.ball = enclosing_sphere(part);
    child.volume = total_volume(part);
    if (!of_leaves) child.node = build(part, first_leaf + begin);
  };
  if (spheres.size() >= k_min_task) {
    parallel::for_each(ends.size(), build_child);
  } else {
    for (std::size_t slot = 0; slot < ends.size(); ++slot) build_child(slot);
  }
  return result;
}

/// Rounded to single precision, relative to `bound`; the radius is enlarged by all rounding errors.
void set_ball(SphereNode& node, std::size_t slot, const Sphere& ball, const Sphere& bound) {
  // Coordinates and radii are at most about 1: each is rounded by 2^-25 at most, a position by sqrt(3) times that.
  constexpr double k_rounding_up = 2.0 / (1 << 23);
  const Eigen::Vector3f center = ((ball.center - bound.center) / bound.radius).cast<float>();
  node.x[slot] = center.x();
  node.y[slot] = center.y();
  node.z[slot] = center.z();
  node.r[slot] = static_cast<float>(ball.radius / bound.radius + k_rounding_up);
}

void append_nodes(SphereTree& tree, std::size_t count) {
  const std::size_t size = tree.nodes.size() + count;
  tree.nodes.resize(size);
  tree.first_child.resize(size);
  tree.volumes.resize(size);
}

/// Writes `from` to the existing node `index` and appends the nodes below it.
void flatten(const BuildNode& from, std::size_t index, SphereTree& tree) {
  SphereNode node{};
  node.r.fill(-std::numeric_limits<float>::infinity());
  std::array<double, SphereNode::k_slots> volumes{};
  for (std::size_t slot = 0; slot < from.children.size(); ++slot) {
    set_ball(node, slot, from.children[slot].ball, tree.bound);
    volumes[slot] = from.children[slot].volume;
  }
  tree.nodes[index] = node;
  tree.volumes[index] = volumes;
  if (!from.children.front().node) {
    tree.first_child[index] = ~static_cast<std::int32_t>(from.first_leaf);
    return;
  }
  const std::size_t first = tree.nodes.size();
  tree.first_child[index] = static_cast<std::int32_t>(first);
  append_nodes(tree, from.children.size());
  for (std::size_t slot = 0; slot < from.children.size(); ++slot) {
    flatten(*from.children[slot].node, first + slot, tree);
  }
}

}  // namespace

SphereTree build_sphere_tree(std::vector<Sphere> spheres) {
  if (spheres.empty()) throw BadArgument("inner sphere tree: no spheres");
  SphereTree tree;
  tree.bound = enclosing_sphere(spheres);
  const std::unique_ptr<BuildNode> root = build(spheres, 0);
  append_nodes(tree, 1);
  flatten(*root, 0, tree);
  tree.leaves = std::move(spheres);
  tree.volume = total_volume(tree.leaves);
  return tree;
}

void set_weights(SphereTree& tree, std::vector<double> weights) {
  tree.weights = std::move(weights);
  tree.volume = 0.0;
  // Children come after their parents, so in reverse order the sums below a node are computed before its own.
  for (std::size_t node = tree.nodes.size(); node-- > 0;) {
    const std::int32_t first = tree.first_child[node];
    for (std::size_t slot = 0; slot < tree.children(node); ++slot) {
      double& volume = tree.volumes[node][slot];
      if (first < 0) {
        const std::size_t leaf = static_cast<std::size_t>(~first) + slot;
        volume = tree.weights[leaf] * tree.leaves[leaf].volume();
      } else {
        const auto& sums = tree.volumes[static_cast<std::size_t>(first) + slot];
        volume = std::accumulate(sums.begin(), sums.end(), 0.0);
      }
    }
  }
  for (const double volume : tree.volumes.front()) tree.volume += volume;
}

}  // namespace sixdof::ist
