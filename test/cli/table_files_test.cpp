// `sixdof table` on files with casts, on files that it refuses, and on hostile names.

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "bench/common/run_guarded.h"

#include "table_command.h"

namespace sixdof::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A row of casts whose every motion has a contact.
Json cast_row(const std::string& algorithm, const std::string& motion, double cpu_ns, int missed, int late) {
  Json json = row("cast", algorithm, "distance", 0, cpu_ns,
                  {{"hits", 64},
                   {"missed_hits", missed},
                   {"late_hits", late},
                   {"late_max", late > 0 ? 0.125 : 0.0},
                   {"early", 0},
                   {"early_max", 0.0},
                   {"phantom_hits", 0},
                   {"false_starts", 0},
                   {"mismatch", missed + late}});
  json["name"] = fmt::format("cast/algorithm:{}/pair:p/motion:{}", algorithm, motion);
  json["sixdof"]["order"] = motion;
  return json;
}

TEST_F(TableCommand, AgainstListsWhereAnAlgorithmIsSlowerTheWorstFirst) {
  const std::string file = write(
      "r.json", {row("distance", "exact", "distance", 1, 1000, {{"p99_ns", 9e4}}),
                 row("distance", "fcl-rss", "distance", 1, 2000), row("distance", "exact", "distance", 5, 1100),
                 row("distance", "fcl-rss", "distance", 5, 1000), row("distance", "exact", "distance", 9, 4000),
                 row("distance", "fcl-rss", "distance", 9, 3000), row("distance", "fcl-obb", "distance", 9, 1000)});
  const std::string all = printed("--against 'fcl-*' --markdown " + file);
  EXPECT_THAT(all, HasSubstr("| p | distance | distance 1 % | 1 | 2 | fcl-rss | 2.0 | 2.0..2.0 |"));
  const std::string slower = printed("--against 'fcl-*' --slower 1 --markdown " + file);
  EXPECT_THAT(slower, Not(HasSubstr("distance 1 %")));
  const std::size_t worst = slower.find("| distance 9 % | 4 | 1 | fcl-obb | 0.25 |");
  const std::size_t next = slower.find("| distance 5 % | 1.1 | 1 | fcl-rss | 0.91 |");
  EXPECT_LT(worst, next) << slower;
  EXPECT_NE(next, std::string::npos) << slower;
  EXPECT_THAT(printed("--against 'fcl-*' --slower 1.2 --markdown " + file), Not(HasSubstr("distance 5 %")));
  EXPECT_THAT(printed("--against 'fcl-*' --slower 1 --p99 --markdown " + file),
              AllOf(HasSubstr("| distance 1 % | 90 | 20 | fcl-rss | 0.22 |"), Not(HasSubstr("distance 9 %"))));
  const std::string few = write("few.json", {row("distance", "exact", "distance", 1, 1, {{"p99_ns", nullptr}}),
                                             row("distance", "fcl-rss", "distance", 1, 2, {{"p99_ns", nullptr}})});
  EXPECT_THAT(table("--against 'fcl-*' --p99 " + few).err, HasSubstr("p99 (of 200 configurations or more)"));
  EXPECT_THAT(table("--against ode " + file).err, HasSubstr("no rows without a fault of both exact and ode"));
}

TEST_F(TableCommand, CastsHaveALinePerMotionAndWhatIsMissed) {
  const std::string file =
      write("r.json", {cast_row("x", "translation/10", 1500, 0, 0), cast_row("x", "tumble/0.01", 4000, 0, 0),
                       cast_row("y", "translation/10", 2000, 3, 2), cast_row("y", "tumble/0.01", 1000, 0, 0),
                       row("distance", "x", "distance", 5, 2000)});
  const std::string out = printed(file);
  EXPECT_THAT(out, HasSubstr("p: cast, motions in percent of A's box diagonal\n"));
  EXPECT_THAT(out, HasSubstr("! y: 5 of 64 wrong (translation 10 %)\n"));
  const std::string markdown = printed("--markdown " + file);
  EXPECT_THAT(markdown,
              HasSubstr("| translation 10 % | \\* | x | 64 | 1.50 | 10.0 | 20.0 | 30.0 | 0 | 64 | 0 | 0 | 0 |"));
  EXPECT_THAT(markdown,
              HasSubstr("| translation 10 % | ! | y | 64 | 2.00 | 10.0 | 20.0 | 30.0 | 0 | 64 | 3 | 2 | 0 | 0 "
                        "| 0 | 12.5 | 0 | 0 |\n"));
  EXPECT_LT(markdown.find("| ! | y | 64 | 2.00"), markdown.find("| tumble 0.01 % | \\* | y"))
      << "motions stay together";
  const std::string overview = printed("--overview --markdown " + file);
  EXPECT_THAT(overview, HasSubstr("first contact, us"));
  EXPECT_THAT(overview, HasSubstr("| x | 2.00 | 2.75 | right |\n"));
  EXPECT_THAT(overview, HasSubstr("| wrong; first contact: 5 of 64 wrong (3 missed, 2 late) |\n"));
  EXPECT_THAT(printed("--wide " + file), HasSubstr("x (tumble 0.01 %)"));
}

/// What is written to the file "r.json", and what stands on stderr behind the file's name.
class RefusedFiles : public TableCommand {
 protected:
  std::string message(const std::string& text) const {
    const auto result = table(write_text("r.json", text));
    EXPECT_EQ(result.exit_code, k_exit_error) << text;
    EXPECT_EQ(result.out, "") << text;
    const std::string start = "sixdof: " + path("r.json") + ": ";
    EXPECT_THAT(result.err, StartsWith(start));
    return result.err.substr(std::min(start.size(), result.err.size()));
  }
  /// The second row is changed by a patch.
  std::string message_of_row(const Json& patch) const {
    Json bad = row("collide", "x", "distance", 5, 1.0);
    bad.merge_patch(patch);
    return message(Json({{"benchmarks", {row("collide", "y", "distance", 5, 1.0), bad}}}).dump());
  }
};

TEST_F(RefusedFiles, AreNamedWithTheCause) {
  EXPECT_EQ(message(""), "is empty\n");
  EXPECT_EQ(message(" \n"), "is empty\n");
  EXPECT_THAT(message("{\"benchmarks\":\n ["), StartsWith("not JSON: parse error at line 2, column 3: "));
  EXPECT_THAT(message("\xFF"), StartsWith("not JSON: parse error at line 1, column 1: "));
  for (const char* other : {"[]", "{}", "7", R"({"benchmarks": 7})"}) {
    EXPECT_THAT(message(other), StartsWith("neither a result of sixdof-bench or a study"));
  }
  EXPECT_EQ(message(R"([{"family": "scale", "algorithm": "x", "verdict": "exact"}])"),
            "not a result file of sixdof-bench: it has no array \"benchmarks\"\n");
  EXPECT_THAT(table("no-such-file.json").err, HasSubstr("no-such-file.json: cannot be opened\n"));
  EXPECT_EQ(table("").exit_code, k_exit_usage);
}

TEST_F(RefusedFiles, AreNamedWithTheRow) {
  EXPECT_EQ(message(R"({"benchmarks": [7]})"), "benchmarks[0]: not an object\n");
  EXPECT_THAT(message(R"({"benchmarks": [{"name": "BM_sort/8", "cpu_time": 3}]})"),
              StartsWith("benchmarks[0] (BM_sort/8): no \"sixdof\" object: not a row of sixdof-bench"));
  const std::string place = "benchmarks[1] (collide/algorithm:x/pair:p/distance:5): ";
  EXPECT_EQ(message_of_row({{"cpu_time", nullptr}}), place + "no number \"cpu_time\"\n");
  EXPECT_EQ(message_of_row({{"time_unit", "days"}}), place + "time_unit \"days\" is none of ns, us, ms, s\n");
  EXPECT_THAT(message_of_row({{"sixdof", {{"bucket", {{"kind", "depth"}}}}}}),
              StartsWith(place + "sixdof.bucket: bucket 'depth/5'"));
  EXPECT_THAT(message_of_row({{"sixdof", {{"query", 7}}}}), StartsWith(place + "sixdof.query: "));
  const std::string other = "collide/algorithm:y/pair:p/distance:5";
  EXPECT_EQ(message_of_row({{"name", other}, {"sixdof", {{"algorithm", "y"}, {"settings", {{"size", 9}}}}}}),
            "benchmarks[1] (" + other + "): y has the settings size=9 here and size=0.5 in an earlier row\n");
}

TEST_F(TableCommand, ShowsWhatATerminalOrMarkdownWouldObey) {
  const std::string hostile = "x\x1B]0;title\x07\n\xE2\x80\xAE| a |`b`<script>[c](d)";
  Json bad = failed_row("distance", hostile, "distance", 5), good = row("distance", "y", "distance", 5, 1500.0);
  bad["error_message"] = hostile;
  bad["sixdof"]["pair"] = good["sixdof"]["pair"] = hostile;
  good["sixdof"]["settings"] = {{hostile, hostile}};
  const std::string file = write("results.json", {bad, good}, {{"date", hostile}, {"commit", hostile}});
  const auto is_control = [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == '\x7F'; };
  for (const std::string options : {"", "--markdown ", "--wide ", "--wide --markdown ", "--json "}) {
    const std::string text = printed(options + file);
    EXPECT_TRUE(std::ranges::none_of(text, is_control)) << options << text;
    EXPECT_EQ(text.find("\xE2\x80\xAE"), std::string::npos) << options;
    if (options == "--json ") continue;
    EXPECT_THAT(text, HasSubstr("x1B]0;title")) << options;
  }
  for (const std::string options : {"--markdown ", "--wide --markdown "}) {
    const std::string text = printed(options + file);
    for (const char c : {'`', '<', '['}) {
      for (std::size_t at = text.find(c); at != std::string::npos; at = text.find(c, at + 1)) {
        EXPECT_EQ(text.at(at - 1), '\\') << options << text;
      }
    }
    EXPECT_THAT(text, HasSubstr(R"(\| a \|\`b\`\<script\>\[c](d))")) << options;
  }
}

}  // namespace
}  // namespace sixdof::cli
