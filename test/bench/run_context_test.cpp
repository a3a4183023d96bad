#include "bench/harness/run_context.h"

#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

const Json k_context{{"date", "today"},  {"num_cpus", 2},
                     {"commit", "1a2b"}, {"settings:vps", "depth=2"},
                     {"sample", "64"},   {"benchmark_flags", "--benchmark_min_time=0.1"},
                     {"budget_s", "0"},  {"arguments", "--sample 64"}};

Json with(const std::string& key, const Json& value) {
  Json context = k_context;
  context[key] = value;
  return context;
}

TEST(DifferenceOfContexts, NamesWhatARowDependsOn) {
  EXPECT_EQ(difference_of_contexts(k_context, with("num_cpus", 4)), "num_cpus was 2, now it is 4");
  EXPECT_EQ(difference_of_contexts(k_context, with("sample", "32")), "sample was 64, now it is 32");
  EXPECT_EQ(difference_of_contexts(k_context, with("settings:vps", "depth=3")),
            "settings:vps was depth=2, now it is depth=3");
  EXPECT_EQ(difference_of_contexts(with("fcl_build", "1, SSE 0"), with("fcl_build", "1, SSE 1")),
            "fcl_build was 1, SSE 0, now it is 1, SSE 1");
  EXPECT_EQ(difference_of_contexts(k_context, with("isolated", "ode")), "isolated was missing, now it is ode");
  EXPECT_EQ(difference_of_contexts(k_context, with("algorithm:mine", "1")), "algorithm:mine was missing, now it is 1");
  EXPECT_EQ(difference_of_contexts(with("algorithm:mine", "1"), k_context), "algorithm:mine was 1, now it is missing");
  Json both = with("commit", "3c4d");
  both["sample"] = "1";
  EXPECT_EQ(difference_of_contexts(k_context, both), "commit was 1a2b, now it is 3c4d; sample was 64, now it is 1");
}

TEST(DifferenceOfContexts, LeavesOutWhatMayChange) {
  for (const char* key : {"date", "budget_s", "arguments", "load_avg", "mesh:ship"}) {
    EXPECT_EQ(difference_of_contexts(k_context, with(key, "other")), "") << key;
  }
}

TEST(DifferenceOfHashes, ComparesWhatBothHave) {
  const Json before{{"mesh:ship", "00ff"}, {"set:ship", "1234"}};
  EXPECT_EQ(difference_of_hashes(before, {{"mesh:ship", "00ff"}, {"mesh:bunny", "5678"}}), "");
  EXPECT_EQ(difference_of_hashes(before, {{"set:ship", "4321"}}), "set:ship was 1234, now it is 4321");
}

}  // namespace
}  // namespace sixdof::bench
