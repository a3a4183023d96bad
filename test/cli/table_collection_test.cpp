// `sixdof table --over-objects` and `--growth` on files made here.

#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

Json row(const std::string& query, const std::string& algorithm, const std::string& pair, double us, Json fields) {
  fields.update({{"query", query}, {"algorithm", algorithm}, {"settings", Json::object()}, {"pair", pair}});
  const std::string bucket = query == "distance" ? "/distance:05" : "";
  if (!bucket.empty()) fields["bucket"] = {{"kind", "distance"}, {"percent", 5}};
  return {{"name", fmt::format("{}/algorithm:{}/pair:{}{}", query, algorithm, pair, bucket)},
          {"run_type", "iteration"},
          {"cpu_time", us},
          {"real_time", us},
          {"time_unit", "us"},
          {"configurations", 8},
          {"judged", 8},
          {"sixdof", fields}};
}

Json failed(Json json, const char* why) {
  json.update({{"error_occurred", true}, {"error_message", why}});
  return json;
}

class TableOfObjects : public test::ScratchFolder {
 protected:
  /// The command on a file of these rows.
  test::ProgramResult table(const Json& rows, const std::string& arguments) const {
    std::ofstream(path("r.json")) << Json{{"context", Json::object()}, {"benchmarks", rows}};
    return test::run_program(fmt::format("{} table {} {}", SIXDOF_PROGRAM, path("r.json"), arguments));
  }
};

Json rows_of_objects() {
  Json rows = Json::array();
  for (const auto& [object, us] : {std::pair{"bed", 1.0}, {"cup", 3.0}}) {
    const Json fields = {{"object", object}, {"partner", "self"}, {"kind", "boxy"}, {"triangles", 1000}};
    rows.push_back(row("distance", "exact", object, us, fields));
    rows.push_back(row("set", "sixdof generate", std::string(object) + ".self", 1e6, fields));
    if (object == std::string("cup")) {
      rows.push_back(failed(row("pair", "ist", "cup.self", 0, fields), "not done in 10 s"));
    } else {
      rows.push_back(row("distance", "slow", object, 12345.0, fields));
      rows.push_back(row("distance", "bad", object, 1.0, fields));
      rows.back()["mismatch"] = 2;
    }
  }
  return rows;
}

TEST_F(TableOfObjects, HasMeansRatiosAndWhatIsMissing) {
  const auto result = table(rows_of_objects(), "--over-objects");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, R"(2 pairs of 2 objects.

**distance, self**: mean over 2 objects, us (10 %..90 % of the objects); in square brackets the number of objects where it is less

| algorithm | distance 5 % |
|---|---|
| `exact` | 2 (1.2..2.8) |
| `slow` | 12,345 (12,345..12,345) [1] |

Time / time of `exact` on the same object (geometric mean over buckets and objects):

| partner | query | algorithm | objects | ratio | 10 %..90 % | faster on | worst objects |
|---|---|---|---|---|---|---|---|
| self | distance | `slow` | 1 | 1.23e+04 | 1.23e+04..1.23e+04 | 0 | bed 1.23e+04 |

Algorithms that did not end: 1
  cup.self: ist: not done in 10 s

Faults: 1
  bed.self: distance/algorithm:bad: 2 of 8 wrong
)");
}

TEST_F(TableOfObjects, JsonIsTheMemberOfResultFiles) {
  const auto result = table(rows_of_objects(), "--over-objects --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json summary = Json::parse(result.out).at("collection");
  EXPECT_EQ(summary.at("units"), 2);
  EXPECT_EQ(summary.at("cells").size(), 2u);
  EXPECT_EQ(summary.at("cells")[0].at("greatest_object"), "cup");
}

Json rows_of_shapes() {
  Json rows = Json::array();
  for (const int n : {1000, 2000, 4000}) {
    for (const auto& [shape, factor] : {std::pair{"knot", 2.0}, {"ball", 1.0}}) {
      const std::string pair = fmt::format("{}-{}", shape, n);
      const Json fields = {{"shape", shape}, {"triangles", n}};
      rows.push_back(row("distance", "vps", pair, factor * n / 1000, fields));
      rows.push_back(row("set", "sixdof generate", pair, 1e6 * n * n, fields));
    }
  }
  rows.back() = failed(rows.back(), "no mesh: too few");
  return rows;
}

TEST_F(TableOfObjects, GrowthHasExponentsAndShapesAtOneCount) {
  const auto result = table(rows_of_shapes(), "--growth");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, R"(6 pairs. Exponents of the number of triangles, with 95 % intervals:

| algorithm | prepare | memory | distance | collide | respond |
|---|---|---|---|---|---|
| `vps` | - | - | 1.00 ± 0.00 | - | - |

Making the set (`sixdof generate`): 2.00 ± 0.00

| at 4000 triangles | shapes, us |
|---|---|
| `vps` distance | ball 4, knot 8 |

Sets that were not made as chosen: 1
  ball-4000: no mesh: too few
)");
  EXPECT_EQ(Json::parse(table(rows_of_shapes(), "--growth --json").out).at("growth").size(), 2u);
}

TEST_F(TableOfObjects, OtherRowsAreRefused) {
  for (const auto& [option, said] :
       {std::pair{"--over-objects", "no row has a partner"}, {"--growth", "no row has a shape"}}) {
    const auto result = table(Json::array({row("distance", "exact", "p", 1.0, Json::object())}), option);
    EXPECT_EQ(result.exit_code, k_exit_error);
    EXPECT_THAT(result.err, HasSubstr(said));
  }
}

}  // namespace
}  // namespace sixdof::cli
