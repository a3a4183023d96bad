#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/query/algorithm.h>

/// When the surfaces of two meshes first touch while one of them moves: one search of both trees, ordered by time.
///
/// Each pair of volumes, or of triangles, waits with a time up to which it is proven apart. The pair with the least
/// time is next. It is bounded at the pose of that time: along an axis n its gap g closes at a speed of at most s for a
/// while, and of at most mu at all times, so it stays apart for h = max(g / mu, root of g = s h + a h^2 / 2). If that
/// reaches the end of the motion, the pair is dropped; if h is long against the volumes, the pair waits until then;
/// else the larger volume is replaced by its children. As all other pairs are apart for longer, the first pair of
/// triangles that touches is the first contact.
///
/// Bounds. A point r of B, relative to the reference point, has the velocity v + w x r. Along n it closes at
/// -n.v - r.(n x w), and r.(n x w) changes no faster than a = |w| |n x w| rho, where rho is the distance of r from the
/// axis of rotation, which does not change. So mu = max(0, -n.v + |n x w| rho). The directional bound mu is that of
/// C2A (Tang, Kim and Manocha 2009); s and a make steps near contact nearly as long as the time that is left. Gaps are
/// lowered by the rounding of volumes and of poses.

namespace sixdof {

/// By how much gaps of two meshes may be off along a motion (length): the rounding of poses and of coordinates.
double cast_margin(const Motion& motion, const Tree& a, const Tree& b);

/// Work of one search.
struct CastSearchCounts {
  std::uint64_t pairs = 0;      ///< Pairs of volumes that were bounded.
  std::uint64_t triangles = 0;  ///< Pairs of triangles whose distance was measured.
};

/// Searches of one pair of meshes; used by one thread at a time.
class CastSearch {
 public:
  /// Pairs taken from the queue after which a search gives up: some seconds.
  static constexpr std::uint64_t k_most_pairs = 5'000'000;
  /// A contact is found when exact yes/no says that the triangles touch within this part of the motion.
  static constexpr double k_resolution = 1e-10;

  /// Both trees outlive it.
  CastSearch(const Tree& a, const Tree& b);

  /// The first contact of the surfaces, which are apart at the start. The time is not later than the contact and at
  /// most k_resolution earlier, or eight times the time in which B moves by the rounding of its poses.
  /// @return Status::failed if the search gave up
  Outcome<Impact> find(const Motion& motion);

  /// The same of surfaces that are known to be apart up to a time below 1.
  /// @param next a pair of triangles that probably touches first
  Outcome<Impact> find_after(const Motion& motion, double apart, TrianglePair next);

  /// Of the last search.
  const CastSearchCounts& counts() const { return counts_; }

  /// For tests: bounds on speeds are multiplied by it, and are unsafe below 1.
  double speed_factor = 1.0;

 private:
  struct Waiting {
    double t;                 ///< Apart up to here.
    std::uint32_t a, b;       ///< Numbered as in detail::NodePair.
    double first_wait = 0.0;  ///< Of two volumes: for how long they were known to be apart at first.
    /// The top of a heap is the largest.
    friend bool operator<(const Waiting& x, const Waiting& y) { return x.t > y.t; }
  };
  class Moment;

  bool begin(const Motion& motion);
  Outcome<Impact> search(const Waiting& first);
  void push(const Waiting& pair);
  Waiting pop();
  bool waits_again(const Moment& moment, const Waiting& pair);
  void split(const Moment& moment, std::uint32_t a, std::uint32_t b);
  void wait(const Moment& moment, std::uint32_t a, std::uint32_t b);
  static double time_along_edges(const Moment& moment, const Tree::Corners& a, const Tree::Corners& b);
  bool is_contact(const Moment& moment, std::uint32_t a, std::uint32_t b, Impact& impact);
  Impact impact_of(std::uint32_t a, std::uint32_t b, double t) const;

  const Tree& a_;
  const Tree& b_;
  std::vector<Waiting> queue_;  ///< A heap: the least time first.
  Motion motion_;
  double margin_ = 0.0;         ///< Rounding of gaps (length).
  double stretch_ = 1.0;        ///< Largest factor by which the start's matrix lengthens a vector.
  double largest_speed_ = 0.0;  ///< Of a point of B (length per t).
  double least_time_ = 0.0;     ///< Time in which B moves by several roundings of its poses.
  CastSearchCounts counts_;
};

}  // namespace sixdof
