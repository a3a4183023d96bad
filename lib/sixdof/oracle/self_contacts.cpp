#include <sixdof/oracle/self_contacts.h>

#include <algorithm>
#include <atomic>
#include <tuple>

#include <sixdof/base/parallel.h>

namespace sixdof {
namespace {

/// Counts of a range of leaves, with the first contacts among them.
struct Found {
  SelfContacts contacts;

  void add(const SelfContact& contact) {
    switch (contact.kind) {
      case ContactKind::crossing:
        ++contacts.crossing;
        break;
      case ContactKind::coplanar:
        ++contacts.coplanar;
        break;
      case ContactKind::coincident:
        ++contacts.coincident;
        break;
    }
    contacts.first.push_back(contact);
    if (contacts.first.size() >= 4 * SelfContacts::k_listed) shorten();
  }

  void shorten() {
    std::sort(contacts.first.begin(), contacts.first.end(),
              [](const SelfContact& x, const SelfContact& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    if (contacts.first.size() > SelfContacts::k_listed) contacts.first.resize(SelfContacts::k_listed);
  }

  static Found join(Found x, const Found& y) {
    x.contacts.crossing += y.contacts.crossing;
    x.contacts.coplanar += y.contacts.coplanar;
    x.contacts.coincident += y.contacts.coincident;
    x.contacts.first.insert(x.contacts.first.end(), y.contacts.first.begin(), y.contacts.first.end());
    x.shorten();
    return x;
  }
};

class Search {
 public:
  Search(const Mesh& mesh, const Tree& tree, std::span<const std::uint32_t> group, const RunOptions& options)
      : mesh_(mesh),
        tree_(tree),
        group_(group),
        options_(options),
        boxes_(tree.corners().size()),
        collinear_(boxes_.size()) {
    parallel::for_each(boxes_.size(), [this](std::size_t i) {
      const Tree::Corners& c = tree_.corners()[i];
      boxes_[i] = {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])};
      collinear_[i] = is_collinear(c[0], c[1], c[2]) ? 1 : 0;
    });
    touched_.resize(boxes_.size());
  }

  SelfContacts run() {
    constexpr std::size_t k_leaves_per_step = 256;
    Found all = parallel::reduce<Found>(
        tree_.leaves().size(), k_leaves_per_step,
        [this](std::size_t begin, std::size_t end) {
          options_.check_cancelled();
          Found found;
          for (std::size_t leaf = begin; leaf < end; ++leaf) {
            compare(tree_.leaves()[leaf].child, tree_.leaves()[leaf].child, found);
            descend(tree_.nodes()[0], static_cast<std::uint32_t>(leaf), found);
          }
          return found;
        },
        Found::join);
    all.shorten();
    all.contacts.touched = std::move(touched_);
    return std::move(all.contacts);
  }

 private:
  /// Compares a leaf with those after it whose boxes overlap its own.
  void descend(const Tree::Node& node, std::uint32_t leaf, Found& found) {
    const Tree::Volume& box = tree_.leaves()[leaf].volume;
    for (std::size_t i = 0; i < node.child_count; ++i) {
      bool apart = false;
      for (std::size_t k = 0; k < 3; ++k) {
        apart = apart || node.lower[k][i] > box.upper[k] || node.upper[k][i] < box.lower[k];
      }
      if (apart) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        descend(tree_.nodes()[child.node()], leaf, found);
      } else if (node.leaf(i) > leaf) {
        compare(tree_.leaves()[leaf].child, child, found);
      }
    }
  }

  void compare(Tree::Child x, Tree::Child y, Found& found) {
    const bool same = x.first() == y.first();
    for (std::uint32_t i = x.first(); i < x.first() + x.count(); ++i) {
      for (std::uint32_t j = same ? i + 1 : y.first(); j < y.first() + y.count(); ++j) {
        if (boxes_[i].intersects(boxes_[j]) && collinear_[i] == 0 && collinear_[j] == 0) compare(i, j, found);
      }
    }
  }

  /// @param i, j triangles in tree order
  void compare(std::uint32_t i, std::uint32_t j, Found& found) {
    const auto [a, b] = std::minmax(tree_.mesh_triangle()[i], tree_.mesh_triangle()[j]);
    const auto contact = find_contact(mesh_.vertices(), mesh_.triangles()[a], mesh_.triangles()[b]);
    if (!contact) return;
    found.add({.a = a, .b = b, .kind = contact->kind, .point = contact->point});
    const bool across = !group_.empty() && group_[a] != group_[b] && contact->kind != ContactKind::coincident;
    const std::uint8_t bits = across ? SelfContacts::k_within | SelfContacts::k_across : SelfContacts::k_within;
    for (const std::uint32_t t : {a, b}) std::atomic_ref(touched_[t]).fetch_or(bits, std::memory_order_relaxed);
  }

  const Mesh& mesh_;
  const Tree& tree_;
  const std::span<const std::uint32_t> group_;
  const RunOptions& options_;
  // In tree order.
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::uint8_t> collinear_;
  std::vector<std::uint8_t> touched_;  // in the mesh's order
};

}  // namespace

SelfContacts find_self_contacts(const Mesh& mesh, const Tree& tree, std::span<const std::uint32_t> group,
                                const RunOptions& options) {
  SelfContacts contacts;
  parallel::with_threads(options.threads, [&] { contacts = Search(mesh, tree, group, options).run(); });
  return contacts;
}

}  // namespace sixdof
