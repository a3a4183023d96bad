#include "bench/harness/result_text.h"

#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

TEST(ResultText, OfCsvHasAColumnForEveryKeyOfAnyRow) {
  const Json document{
      {"context", {{"seed", "7"}}},
      {"benchmarks",
       {{{"name", "a"}, {"real_time", 1.5}, {"label", "x=1,y=\"2\""}},
        {{"name", "b"}, {"error_occurred", true}, {"sixdof", {{"bucket", {{"percent", 5}}}}}, {"mean", nullptr}}}}};
  EXPECT_EQ(result_text(document, ResultFormat::csv),
            "name,real_time,label,error_occurred,sixdof.bucket.percent,mean\n"
            "a,1.5,\"x=1,y=\"\"2\"\"\",,,\n"
            "b,,,true,5,\n");
}

TEST(ResultText, OfJsonIsTheDocumentWithItsChecksum) {
  const Json document{{"context", Json::object()}, {"benchmarks", Json::array()}};
  Json written = Json::parse(result_text(document, ResultFormat::json));
  EXPECT_EQ(written.at("context").erase("checksum"), 1u);
  EXPECT_EQ(written, document);
}

}  // namespace
}  // namespace sixdof::bench
