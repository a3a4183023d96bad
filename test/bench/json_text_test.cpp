#include "bench/common/json_text.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sixdof {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_replaced = "h\xEF\xBF\xBDll";  // U+FFFD

TEST(JsonText, ReplacesBytesThatAreNoUtf8) {
  const Json read = Json::parse(json_text({{"name", "h\xFFll"}, {"h\xFFll", 1}}));
  EXPECT_EQ(read, Json({{"name", k_replaced}, {k_replaced, 1}}));
}

TEST(JsonText, HasNullForWhatIsNoNumber) {
  EXPECT_EQ(json_text({1.5, std::nan(""), -std::numeric_limits<double>::infinity()}, -1), "[1.5,null,null]");
}

}  // namespace
}  // namespace sixdof
