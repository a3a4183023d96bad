#include <sixdof/oracle/candidates.h>

namespace sixdof {
namespace {

struct FloatBox {
  std::array<float, 3> lower, upper;
};

FloatBox child_box(const Tree::Node& node, std::size_t lane) {
  FloatBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] = node.lower[k][lane];
    box.upper[k] = node.upper[k][lane];
  }
  return box;
}

bool meet(const FloatBox& x, const FloatBox& y) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (x.lower[k] > y.upper[k] || x.upper[k] < y.lower[k]) return false;
  }
  return true;
}

/// Boxes of B's tree as boxes of A's tree: both relative to their tree's centre.
class BoxPlacement {
 public:
  BoxPlacement(const Tree& a, const Tree& b, const Pose& X_AB) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // Single-precision rounding of a dozen operations on lengths of this size; double rounding of far-off origins.
    constexpr double k_float_rounding = 1e-6;
    constexpr double k_double_rounding = 1e-14;
    slack_ =
        static_cast<float>(k_float_rounding * (a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>()) +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        r_[i][k] = static_cast<float>(X_AB.R(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      }
      d_[i] = static_cast<float>(d[static_cast<Eigen::Index>(i)]);
    }
  }
  FloatBox operator()(const FloatBox& b) const {
    FloatBox box;
    for (std::size_t i = 0; i < 3; ++i) {
      float center = d_[i];
      float half = slack_;
      for (std::size_t k = 0; k < 3; ++k) {
        center += r_[i][k] * (0.5f * (b.lower[k] + b.upper[k]));
        half += std::abs(r_[i][k]) * (0.5f * (b.upper[k] - b.lower[k]));
      }
      box.lower[i] = center - half;
      box.upper[i] = center + half;
    }
    return box;
  }

 private:
  std::array<std::array<float, 3>, 3> r_;
  std::array<float, 3> d_;
  float slack_;
};

}  // namespace

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs) {
  pairs.clear();
  const BoxPlacement placed(a, b, X_AB);
  const auto visit = [&](auto&& self, const Tree::Node& na, const Tree::Node& nb) -> void {
    for (std::size_t j = 0; j < nb.child_count; ++j) {
      const FloatBox box_b = placed(child_box(nb, j));
      for (std::size_t i = 0; i < na.child_count; ++i) {
        if (!meet(child_box(na, i), box_b)) continue;
        const Tree::Child ca = na.child[i], cb = nb.child[j];
        if (!ca.is_leaf() && !cb.is_leaf()) {
          self(self, a.nodes()[ca.node()], b.nodes()[cb.node()]);
        } else {
          const std::uint32_t fa = ca.is_leaf() ? ca.first() : a.nodes()[ca.node()].first_triangle;
          const std::uint32_t la = fa + (ca.is_leaf() ? ca.count() : a.nodes()[ca.node()].triangle_count);
          const std::uint32_t fb = cb.is_leaf() ? cb.first() : b.nodes()[cb.node()].first_triangle;
          const std::uint32_t lb = fb + (cb.is_leaf() ? cb.count() : b.nodes()[cb.node()].triangle_count);
          for (std::uint32_t t = fa; t < la; ++t) {
            for (std::uint32_t x = fb; x < lb; ++x) pairs.push_back({t, x});
          }
        }
      }
    }
  };
  visit(visit, a.nodes()[0], b.nodes()[0]);
}

void find_in_box(const Tree& tree, const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  FloatBox target;
  // Rounding to float and of the difference from the tree's centre.
  const double slack = 1e-6 * (tree.radius() + box.diagonal().norm()) + 1e-15 * tree.center().lpNorm<1>();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    target.lower[k] = static_cast<float>(box.min()[i] - tree.center()[i] - slack);
    target.upper[k] = static_cast<float>(box.max()[i] - tree.center()[i] + slack);
  }
  const auto visit = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (!meet(child_box(node, i), target)) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) triangles.push_back(t);
    }
  };
  visit(visit, tree.nodes()[0]);
}

}  // namespace sixdof
