#include <sixdof/base/hash.h>

#include <string_view>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST(ContentHash, MatchesThePublishedValueOfTheEmptyInput) {
  // XXH3 128 bits, seed 0, empty input: xxHash's own sanity check table.
  EXPECT_EQ(ContentHash().hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, DoesNotDependOnHowTheInputIsCut) {
  ContentHash whole, parts, other;
  whole.add(bytes("six degrees of freedom"));
  parts.add(bytes("six degrees"));
  parts.add(bytes(" of freedom"));
  other.add(bytes("six degrees of freedoM"));
  EXPECT_EQ(whole.hex(), parts.hex());
  EXPECT_NE(whole.hex(), other.hex());
}

}  // namespace
}  // namespace sixdof
