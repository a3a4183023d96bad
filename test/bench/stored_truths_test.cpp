#include "bench/harness/stored_truths.h"

#include <cmath>
#include <span>

#include "own_truths.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_kind = "test-truth";

struct Stored : OwnTruths {
  Stored() : OwnTruths("stored_truths_cache") {}
};

TEST_F(Stored, ComesBackAsItWas) {
  EXPECT_FALSE(load_truths(k_kind, "key", 2, 3));
  store_truths(k_kind, "key", {{0.1, -0.0, 3.0, 4.0, 5.0, 6.0}, {1, 2}});
  const auto found = load_truths(k_kind, "key", 2, 3);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->numbers, (std::vector<double>{0.1, -0.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(found->flags, (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(Stored, OfAnotherFormIsNone) {
  store_truths(k_kind, "key", {{0.1, 0.2}, {1, 2}});
  EXPECT_TRUE(load_truths(k_kind, "key", 2, 1));
  EXPECT_FALSE(load_truths(k_kind, "key", 1, 2)) << "flags of two poses";
  EXPECT_FALSE(load_truths(k_kind, "key", 2, 2));
  EXPECT_FALSE(load_truths(k_kind, "another key", 2, 1));
}

TEST_F(Stored, EveryBitOfAPoseCounts) {
  std::vector<Pose> list = poses(3);
  const std::string before = hash_of(list);
  EXPECT_EQ(hash_of(poses(3)), before);
  list[2].t.z() = std::nextafter(list[2].t.z(), 9.0);
  EXPECT_NE(hash_of(list), before);
  EXPECT_NE(hash_of(std::span(list).first(2)), before);
}

}  // namespace
}  // namespace sixdof::bench
