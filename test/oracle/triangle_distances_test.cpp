#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/triangle_distances.h>

#include "../geometry/shapes.h"
#include "instruction_sets.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using shapes::Generator;

using Soup = std::vector<TriangleCorners>;

TriangleCorners moved(const TriangleCorners& t, const Vector3d& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

TriangleCorners generic(Generator& generator) {
  return {shapes::unit_vector(generator), shapes::unit_vector(generator), shapes::unit_vector(generator)};
}

/// Measures all pairs of a triangle of a and one of b, in both orders. Returns how many were not left over.
int expect_bits(const Soup& a, const Soup& b) {
  int measured = 0;
  TriangleDistances several;
  std::vector<ClosestPoints> truths;
  const auto measure = [&] {
    several.measure();
    for (std::size_t i = 0; i < truths.size(); ++i) {
      if (!several.is_measured(i)) continue;
      ++measured;
      EXPECT_EQ(several.distance(i), truths[i].distance);
      const Vector3d between = truths[i].on_b - truths[i].on_a;
      EXPECT_LE((several.direction(i) - between).norm(), 1e-14 * (1.0 + truths[i].on_b.norm()));
    }
    several.clear();
    truths.clear();
  };
  for (const TriangleCorners& x : a) {
    for (const TriangleCorners& y : b) {
      for (const auto& [first, second] : {std::pair(x, y), std::pair(y, x)}) {
        several.add(first, second);
        truths.push_back(triangle_triangle_distance(first, second));
        if (several.count() == TriangleDistances::k_most) measure();
      }
    }
  }
  if (several.count() > 0) measure();
  return measured;
}

/// Calls make(generator, a, b) for pairs of soups on every instruction set.
/// @param least share of the pairs that are not left over
template <class Make>
void expect_bits_of(std::uint64_t seed, double least, const Make& make) {
  const auto run = [&] {
    Generator generator(seed);
    int measured = 0;
    std::size_t pairs = 0;
    for (int i = 0; i < 300; ++i) {
      Soup a, b;
      make(generator, a, b);
      measured += expect_bits(a, b);
      pairs += 2 * a.size() * b.size();
    }
    EXPECT_GE(measured, least * static_cast<double>(pairs));
  };
  EXPECT_GE(for_each_instruction_set(run), 1);
}

/// Four triangles about `at`, closer to each other than to those at other places.
void add_four(Generator& generator, const Vector3d& at, Soup& soup) {
  for (int k = 0; k < 4; ++k) soup.push_back(moved(generic(generator), at + 0.05 * shapes::unit_vector(generator)));
}

TEST(TriangleDistances, OfGenericTrianglesAtAnyDistance) {
  expect_bits_of(1, 0.999, [](Generator& generator, Soup& a, Soup& b) {
    add_four(generator, Vector3d::Zero(), a);
    add_four(generator, std::pow(10.0, shapes::uniform(generator, 0.5, 3.0)) * shapes::unit_vector(generator), b);
  });
}

TEST(TriangleDistances, OfTrianglesThatTouchOrNearlyDo) {
  expect_bits_of(2, 0.3, [](Generator& generator, Soup& a, Soup& b) {
    add_four(generator, Vector3d::Zero(), a);
    const Vector3d apart = 6.0 * shapes::unit_vector(generator);
    for (const TriangleCorners& t : a) {
      // From a corner or a point of an edge away, by nothing or by a few roundings.
      const double step = shapes::uniform(generator, 0.0, 1.0) < 0.5 ? 0.0 : 1e-15;
      const Vector3d from =
          (shapes::uniform(generator, 0.0, 1.0) < 0.5 ? t[0] : Vector3d(0.5 * (t[0] + t[1]))) + step * apart;
      b.push_back({from, from + apart, from + apart + 0.3 * shapes::unit_vector(generator)});
    }
  });
}

TEST(TriangleDistances, OfNearlyParallelEdgesAndNeedles) {
  // Edges of A and of B face each other and cross in the middle, seen along `up`.
  expect_bits_of(3, 0.05, [](Generator& generator, Soup& a, Soup& b) {
    const Vector3d along = shapes::unit_vector(generator);
    const Vector3d up = along.cross(shapes::unit_vector(generator)).normalized();
    const Vector3d across = along.cross(up);
    for (int k = 0; k < 3; ++k) {
      const double least = shapes::uniform(generator, 0.0, 1.0) < 0.2 ? -17.0 : -5.0;
      const double angle = std::pow(10.0, shapes::uniform(generator, least, 0.0));
      const double width = std::pow(10.0, shapes::uniform(generator, least, 0.0));
      const Vector3d at = 0.3 * k * up;
      const auto triangle = [&](const Vector3d& middle, const Vector3d& edge, const Vector3d& third) {
        return TriangleCorners{middle - 0.5 * edge, middle + 0.5 * edge, middle + width * third};
      };
      a.push_back(triangle(-at, along, -up));
      b.push_back(triangle(at + 0.7 * up, along + angle * across, up));
    }
  });
}

TEST(TriangleDistances, OfCornersOverNeedles) {
  expect_bits_of(5, 0.2, [](Generator& generator, Soup& a, Soup& b) {
    const Vector3d along = shapes::unit_vector(generator);
    const Vector3d up = along.cross(shapes::unit_vector(generator)).normalized();
    const Vector3d width = std::pow(10.0, shapes::uniform(generator, -5.0, -1.0)) * along.cross(up);
    a.push_back({-along, along, width});
    const Vector3d over = 0.3 * width + std::pow(10.0, shapes::uniform(generator, -4.0, 0.0)) * up;
    b.push_back({over, over + up + shapes::unit_vector(generator), over + up + shapes::unit_vector(generator)});
  });
}

TEST(TriangleDistances, OfTrianglesThatAreSegmentsButForRounding) {
  expect_bits_of(4, 0.2, [](Generator& generator, Soup& a, Soup& b) {
    add_four(generator, Vector3d::Zero(), a);
    add_four(generator, 2.5 * shapes::unit_vector(generator), b);
    for (Soup* soup : {&a, &b}) {
      for (TriangleCorners& t : *soup) {
        if (shapes::uniform(generator, 0.0, 1.0) < 0.4) t[2] = 0.3 * t[0] + 0.7 * t[1];
      }
    }
  });
}

}  // namespace
}  // namespace sixdof
