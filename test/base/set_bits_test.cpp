#include <sixdof/base/set_bits.h>

#include <bit>
#include <cstddef>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(SetBits, AreThoseOfTheNumberAscending) {
  for (std::size_t number = 0; number < k_set_bits.size(); ++number) {
    std::size_t sum = 0;
    for (int i = 0; i < std::popcount(number); ++i) {
      const auto& bits = k_set_bits[number];
      const auto place = static_cast<std::size_t>(i);
      sum += std::size_t{1} << bits[place];
      if (i > 0) {
        EXPECT_GT(bits[place], bits[place - 1]) << number;
      }
    }
    EXPECT_EQ(sum, number);
  }
}

}  // namespace
}  // namespace sixdof
