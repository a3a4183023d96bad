#include <sixdof/algorithm/ist/hierarchy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_branching = 4;
constexpr int k_epochs = 20;  // T: beyond it clusters no longer change visibly
constexpr double k_lambda_start = k_branching / 2.0;
constexpr double k_lambda_end = 0.01;
constexpr std::size_t k_evenly_to = k_branching * k_branching;  // spheres that are shared out evenly
constexpr std::size_t k_parallel_from = 2000;                   // spheres below which a subtree is not worth a task

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

/// Sorts `spheres` into `parts` of nearly equal number, by halves across the longest axis, and appends their ends.
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

/// Sorts `spheres` into up to four clusters and returns their ends. A few spheres are shared out evenly, so that nodes
/// of leaves are nearly full: clusters would leave two leaves in a node of four. Falls back to equal parts along the
/// longest axis where the clusters do not separate the spheres (all centres equal).
std::vector<std::size_t> split(std::span<Sphere> spheres) {
  std::vector<std::size_t> ends;
  if (spheres.size() <= k_branching) {
    for (std::size_t i = 1; i <= spheres.size(); ++i) ends.push_back(i);
    return ends;
  }
  if (spheres.size() <= k_evenly_to) {
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

/// A subtree under construction; flattened when all tasks are done.
struct Draft {
  struct Child {
    Sphere ball;
    double volume = 0.0;
    std::unique_ptr<Draft> below;  ///< None if this node's children are leaves.
  };
  std::vector<Child> children;
  std::size_t first_leaf = 0;
};

std::unique_ptr<Draft> build(std::span<Sphere> spheres, std::size_t first_leaf) {
  auto draft = std::make_unique<Draft>();
  draft->first_leaf = first_leaf;
  const bool of_leaves = spheres.size() <= k_branching;
  const std::vector<std::size_t> ends = split(spheres);
  draft->children.resize(ends.size());
  parallel::Tasks tasks;
  std::size_t begin = 0;
  for (std::size_t slot = 0; slot < ends.size(); ++slot) {
    const std::span<Sphere> part = spheres.subspan(begin, ends[slot] - begin);
    Draft::Child& child = draft->children[slot];
    child.ball = enclosing_sphere(part);
    for (const Sphere& s : part) child.volume += s.volume();
    if (!of_leaves) {
      const std::size_t leaf = first_leaf + begin;
      if (part.size() >= k_parallel_from) {
        tasks.run([&child, part, leaf] { child.below = build(part, leaf); });
      } else {
        child.below = build(part, leaf);
      }
    }
    begin = ends[slot];
  }
  tasks.wait();
  return draft;
}

/// Rounded to single precision, relative to `bound`; the radius makes up for all rounding.
void set_ball(SphereNode& node, std::size_t slot, const Sphere& ball, const Sphere& bound) {
  // Coordinates and radii are at most about 1: each is rounded by 2^-25 at most, the place by sqrt(3) times that.
  constexpr double k_rounding_up = 2.0 / (1 << 23);
  const Eigen::Vector3f place = ((ball.center - bound.center) / bound.radius).cast<float>();
  node.x[slot] = place.x();
  node.y[slot] = place.y();
  node.z[slot] = place.z();
  node.r[slot] = static_cast<float>(ball.radius / bound.radius + k_rounding_up);
}

/// Writes the subtree's root to `index`, which is there already, and all below it behind the last node.
void flatten(const Draft& draft, std::size_t index, SphereTree& tree) {
  SphereNode node{};
  node.r.fill(-std::numeric_limits<float>::infinity());
  std::array<double, SphereNode::k_slots> volumes{};
  for (std::size_t slot = 0; slot < draft.children.size(); ++slot) {
    set_ball(node, slot, draft.children[slot].ball, tree.bound);
    volumes[slot] = draft.children[slot].volume;
  }
  tree.nodes[index] = node;
  tree.volumes[index] = volumes;
  if (!draft.children.front().below) {
    tree.below[index] = ~static_cast<std::int32_t>(draft.first_leaf);
    return;
  }
  const std::size_t first = tree.nodes.size(), after = first + draft.children.size();
  tree.below[index] = static_cast<std::int32_t>(first);
  tree.nodes.resize(after);
  tree.below.resize(after);
  tree.volumes.resize(after);
  for (std::size_t slot = 0; slot < draft.children.size(); ++slot) {
    flatten(*draft.children[slot].below, first + slot, tree);
  }
}

}  // namespace

SphereTree build_sphere_tree(std::vector<Sphere> spheres) {
  if (spheres.empty()) throw BadArgument("inner sphere tree: no spheres");
  SphereTree tree;
  tree.bound = enclosing_sphere(spheres);
  const std::unique_ptr<Draft> root = build(spheres, 0);
  tree.nodes.resize(1);
  tree.below.resize(1);
  tree.volumes.resize(1);
  flatten(*root, 0, tree);
  tree.leaves = std::move(spheres);
  for (const Sphere& s : tree.leaves) tree.volume += s.volume();
  return tree;
}

void set_shares(SphereTree& tree, std::vector<double> shares) {
  tree.shares = std::move(shares);
  tree.volume = 0.0;
  // Children come after their parents, so backwards all sums below a node are there before its own.
  for (std::size_t node = tree.nodes.size(); node-- > 0;) {
    const std::int32_t below = tree.below[node];
    for (std::size_t slot = 0; slot < tree.children(node); ++slot) {
      double& volume = tree.volumes[node][slot];
      if (below < 0) {
        const std::size_t leaf = static_cast<std::size_t>(~below) + slot;
        volume = tree.shares[leaf] * tree.leaves[leaf].volume();
      } else {
        const auto& sums = tree.volumes[static_cast<std::size_t>(below) + slot];
        volume = std::accumulate(sums.begin(), sums.end(), 0.0);
      }
    }
  }
  for (const double volume : tree.volumes.front()) tree.volume += volume;
}

}  // namespace sixdof::ist
