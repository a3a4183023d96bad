#include "bench/harness/result_store.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

namespace fs = std::filesystem;
using Json = ResultStore::Json;
using ::testing::HasSubstr;

constexpr ResultFormat k_json = ResultFormat::json;

struct Store : ::testing::Test {
  const fs::path folder = fs::temp_directory_path() / ("sixdof-store-" + std::to_string(::getpid()));
  const fs::path file = folder / "result.json";
  const fs::path journal = folder / "result.json.journal";
  const std::vector<std::string> order{"a", "b", "c"};
  const Json context{{"seed", "7"}, {"commit", "1a2b"}};

  Store() { fs::create_directories(folder); }
  ~Store() override { fs::remove_all(folder); }

  static void measure(ResultStore& store, const std::string& row, double time = 1.0) {
    store.add(row, {{"name", row}, {"run_name", row}, {"family_index", 0}, {"real_time", time}});
    store.commit({});
  }
  static std::vector<std::string> names(const Json& document) {
    std::vector<std::string> list;
    for (const Json& run : document.at("benchmarks")) list.push_back(run.at("name"));
    return list;
  }
  Json result() const {
    std::ifstream in(file);
    return Json::parse(in);
  }
  /// A run that ends without finish().
  void leave_rows(const std::vector<std::string>& rows) const {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    for (const std::string& row : rows) measure(store, row);
  }
};

TEST_F(Store, HasEveryRowOnTheDiskBeforeTheEnd) {
  leave_rows({"c", "a"});
  EXPECT_FALSE(fs::exists(file));
  ResultStore store(order, context);
  store.open(file, k_json, true);
  EXPECT_TRUE(store.has("a"));
  EXPECT_FALSE(store.has("b"));
  EXPECT_TRUE(store.has("c"));
  measure(store, "b");
  store.finish(false);
  EXPECT_FALSE(fs::exists(journal));
  EXPECT_EQ(names(result()), order) << "in the order of the suite";
  EXPECT_EQ(result().at("benchmarks")[2].at("family_index"), 2);
  EXPECT_EQ(result().at("context").at("interrupted"), "false");
}

TEST_F(Store, ContinuesAFileAndItsJournal) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    measure(store, "b", 1.0);
    store.finish(true);
    EXPECT_EQ(result().at("context").at("interrupted"), "true");
  }
  {
    ResultStore store(order, context);
    store.open(file, k_json, true);
    EXPECT_TRUE(store.has("b"));
    measure(store, "c", 3.0);
  }
  ResultStore store({"c"}, context);
  store.open(file, k_json, true);
  EXPECT_EQ(names(store.document(false)), (std::vector<std::string>{"c", "b"})) << "rows that are not chosen come last";
}

TEST_F(Store, MeasuresFailedRowsAgain) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    store.add("a", {{"name", "a"}, {"run_name", "a"}, {"error_occurred", true}});
    store.commit({});
    store.finish(false);
  }
  ResultStore store(order, context);
  store.open(file, k_json, true);
  EXPECT_FALSE(store.has("a"));
  measure(store, "a");
  ASSERT_EQ(store.document(false).at("benchmarks").size(), 1u);
  EXPECT_FALSE(store.document(false).at("benchmarks")[0].contains("error_occurred"));
}

TEST_F(Store, KeepsRepetitionsAndAggregatesTogether) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    for (const char* name : {"a", "a", "a_mean"}) store.add("a", {{"name", name}, {"run_name", "a"}});
    store.commit({});
    store.add("b", {{"name", "b"}, {"run_name", "b"}});  // killed before its row ended
  }
  ResultStore store(order, context);
  store.open(file, k_json, true);
  EXPECT_FALSE(store.has("b"));
  EXPECT_EQ(names(store.document(false)), (std::vector<std::string>{"a", "a", "a_mean"}));
}

TEST_F(Store, RefusesRowsOfAnotherRun) {
  leave_rows({"a"});
  {
    ResultStore other(order, {{"seed", "8"}, {"commit", "1a2b"}});
    EXPECT_THAT([&] { other.open(file, k_json, true); },
                ::testing::ThrowsMessage<BadArgument>(HasSubstr("seed was 7, now it is 8")));
  }
  ResultStore fresh(order, context);
  EXPECT_THAT([&] { fresh.open(file, k_json, false); }, ::testing::ThrowsMessage<BadFile>(HasSubstr("--resume")));
  EXPECT_TRUE(fs::exists(journal));
}

TEST_F(Store, RefusesRowsOfOtherMeshes) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    store.add("a", {{"name", "a"}, {"run_name", "a"}});
    store.commit({{"mesh:ship", "00ff"}});
  }
  ResultStore store(order, context);
  store.open(file, k_json, true);
  store.add("b", {{"name", "b"}, {"run_name", "b"}});
  EXPECT_THAT(
      [&] {
        store.commit({{"mesh:ship", "11ee"}});
      },
      ::testing::ThrowsMessage<BadArgument>(HasSubstr("mesh:ship was 00ff, now it is 11ee")));
}

TEST_F(Store, RefusesEveryRowAndContextThatWasChanged) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    for (const char* row : {"a", "b", "c"}) measure(store, row, 1.25);
    store.finish(false);
  }
  const Json whole = result();
  const auto resume = [&](const std::string& text) {
    std::ofstream(file) << text;
    ResultStore store(order, context);
    store.open(file, k_json, true);
    return names(store.document(false));
  };
  const auto refuses = [&](const Json& changed, const std::string& words) {
    EXPECT_THAT([&] { resume(changed.dump(2)); }, ::testing::ThrowsMessage<BadFile>(::testing::AllOf(
                                                      HasSubstr(file.string() + ": line "), HasSubstr(words))));
  };
  EXPECT_EQ(resume(whole.dump(2)), order);
  EXPECT_EQ(resume(whole.dump()), order) << "blanks and breaks are no values";
  Json changed = whole;
  changed["benchmarks"][1]["real_time"] = 1.0;
  refuses(changed, "row b does not have its checksum");
  changed = whole;
  changed["benchmarks"][2]["label"] = "added";
  refuses(changed, "row c does not have its checksum");
  changed = whole;
  changed["context"]["commit"] = "3c4d";
  refuses(changed, "the context does not have its checksum");
  changed = whole;
  changed["benchmarks"][0].erase("checksum");
  refuses(changed, "row a has no checksum");
  // A row of another run, whole in itself.
  const fs::path other = folder / "other.json";
  {
    ResultStore store(order, {{"seed", "7"}, {"commit", "5e6f"}});
    store.open(other, k_json, false);
    measure(store, "a", 1.25);
    store.finish(false);
  }
  std::ifstream in(other);
  changed = whole;
  changed["benchmarks"][0] = Json::parse(in).at("benchmarks")[0];
  refuses(changed, "row a does not have its checksum");
}

TEST_F(Store, NamesTheLineOfARowThatWasChanged) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    measure(store, "a", 1.25);
    measure(store, "b", 7.5);
    store.finish(false);
  }
  std::ostringstream content;
  content << std::ifstream(file).rdbuf();
  std::string text = content.str();
  const std::size_t at = text.find("7.5");
  text[at] = '8';
  std::ofstream(file) << text;
  ResultStore store(order, context);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("checksum", at)), '\n');
  EXPECT_THAT([&] { store.open(file, k_json, true); },
              ::testing::ThrowsMessage<BadFile>(HasSubstr("line " + std::to_string(line) + ": ")));
}

TEST_F(Store, RefusesWhatIsNoResult) {
  for (const char* text : {"", "[]", "{\"context\": {}}", "{\"benchmarks\": []}"}) {
    std::ofstream(file) << text;
    ResultStore store(order, Json::object());
    EXPECT_THROW(store.open(file, k_json, true), BadFile) << text;
  }
  ResultStore store(order, context);
  EXPECT_THROW(store.open("/dev/null", k_json, false), BadFile);
  EXPECT_THROW(store.open(folder, k_json, false), BadFile);
  EXPECT_THROW(store.open("/no-such-folder/x.json", k_json, false), BadFile);
}

TEST_F(Store, ContinuesTheRunThatWasToReplaceAFile) {
  {
    ResultStore older(order, {{"seed", "8"}});
    older.open(file, k_json, false);
    measure(older, "b");
    older.finish(false);
  }
  leave_rows({"a"});
  ResultStore store(order, context);
  store.open(file, k_json, true);
  EXPECT_TRUE(store.has("a"));
  EXPECT_FALSE(store.has("b")) << "a row of the older result";
}

TEST_F(Store, ForgetsARunThatEndedBeforeItsFirstRow) {
  ResultJournal(journal).append({{"context", {{"seed", "8"}}}, {"continues", false}});
  leave_rows({"a"});
  ResultStore store(order, context);
  store.open(file, k_json, true);
  EXPECT_TRUE(store.has("a"));
}

TEST_F(Store, KnowsTheFieldsOfRowsThatAreMeasured) {
  {
    ResultStore store(order, context);
    store.open(file, k_json, false);
    measure(store, "a");  // without fields
    const Json fields = results::to_json_object({.query = "collide", .algorithm = "exact", .configurations = 32});
    store.add("b", {{"name", "b"}, {"run_name", "b"}, {results::k_row_fields_key, fields}});
    store.commit({});
    store.add("c", {{"name", "c"}, {"run_name", "c"}, {results::k_row_fields_key, fields}, {"error_occurred", true}});
    store.commit({});
  }
  ResultStore store(order, context);
  store.open(file, k_json, true);
  ASSERT_EQ(store.fields().size(), 1u);
  EXPECT_EQ(store.fields()[0].query, "collide");
  EXPECT_EQ(store.fields()[0].configurations, 32u);
}

TEST_F(Store, LeavesNoJournalWithoutRows) {
  leave_rows({});
  EXPECT_FALSE(fs::exists(journal));
}

TEST_F(Store, KeepsTheJournalOfACsvFileThatIsNotComplete) {
  {
    ResultStore store(order, context);
    store.open(file, ResultFormat::csv, false);
    measure(store, "a");
    store.finish(true);
  }
  EXPECT_TRUE(fs::exists(file));
  ResultStore store(order, context);
  store.open(file, ResultFormat::csv, true);
  EXPECT_TRUE(store.has("a"));
  store.finish(false);
  EXPECT_FALSE(fs::exists(journal));
}

}  // namespace
}  // namespace sixdof::bench
