#include "bench/study/measurement_store.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "../cli/scratch_folder.h"

namespace sixdof::study {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Json = MeasurementStore::Json;

constexpr double k_no_short_number = 0.1 + 0.2;
const MeasurementStore::Key k_first("Ia", "vps", {0.01, k_no_short_number}), k_second("II", "ist", {100.0, 7.0});

MeasurementStore::Entry entry(double eta) {
  return {.measured = {.at = std::get<2>(k_first),
                       .time_ns = 1e3 * k_no_short_number,
                       .eta = eta,
                       .bytes = 4096.0,
                       .counters = {{"sigma_F", k_no_short_number}, {"misses", 0.0}}},
          .seconds = 2.5};
}

class MeasurementStores : public test::ScratchFolder {
 protected:
  MeasurementStores() : file_(folder() / "equivalent.json"), journal_(folder() / "equivalent.json.journal") {}

  static Json context(const char* sample = "1") { return {{"sample", sample}, {"date", "today"}}; }

  /// A run that ends after one measurement.
  void break_off(bool resume = false, const MeasurementStore::Key& key = k_first, double eta = 0.5) const {
    MeasurementStore store(context());
    store.open(file_, resume);
    store.add(key, entry(eta));
  }

  const std::filesystem::path file_, journal_;
};

TEST_F(MeasurementStores, TakeOverTheBitsOfARunThatBrokeOff) {
  break_off();
  ASSERT_TRUE(std::filesystem::exists(journal_));
  MeasurementStore store(context());
  store.open(file_, true);
  const auto* const found = store.find(k_first);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->seconds, 2.5);
  EXPECT_EQ(found->measured.at, std::get<2>(k_first));
  EXPECT_EQ(found->measured.time_ns, entry(0.5).measured.time_ns);
  EXPECT_EQ(found->measured.eta, 0.5);
  EXPECT_EQ(found->measured.bytes, 4096.0);
  EXPECT_EQ(found->measured.counters, entry(0.5).measured.counters);
  EXPECT_EQ(store.find(k_second), nullptr);
  store.finish();
  EXPECT_FALSE(std::filesystem::exists(journal_));
}

TEST_F(MeasurementStores, KeepAnEtaThatIsNotDefined) {
  break_off(false, k_first, std::numeric_limits<double>::quiet_NaN());
  MeasurementStore store(context());
  store.open(file_, true);
  ASSERT_NE(store.find(k_first), nullptr);
  EXPECT_TRUE(std::isnan(store.find(k_first)->measured.eta));
}

TEST_F(MeasurementStores, TakeOverTheResultAndTheJournalThatContinuesIt) {
  break_off();
  {
    MeasurementStore store(context());
    store.open(file_, true);
    std::ofstream(file_) << Json{{"context", context()}, {"measurements", store.as_json()}};
    store.finish();
  }
  break_off(true, k_second);
  MeasurementStore store(context());
  store.open(file_, true);
  EXPECT_EQ(store.entries().size(), 2u);
}

TEST_F(MeasurementStores, LeaveAResultThatWasToBeReplaced) {
  break_off();
  {
    MeasurementStore store(context());
    store.open(file_, true);
    std::ofstream(file_) << Json{{"context", context()}, {"measurements", store.as_json()}};
    store.finish();
  }
  break_off(false, k_second);
  MeasurementStore store(context());
  store.open(file_, true);
  EXPECT_EQ(store.find(k_first), nullptr);
  EXPECT_NE(store.find(k_second), nullptr);
}

TEST_F(MeasurementStores, RefuseWhatDoesNotBelongTogether) {
  break_off();
  EXPECT_THAT([&] { MeasurementStore(context()).open(file_, false); },
              ThrowsMessage<BadFile>(HasSubstr("--resume continues it")));
  EXPECT_THAT([&] { MeasurementStore(context("2")).open(file_, true); },
              ThrowsMessage<BadArgument>(HasSubstr("cannot be continued: sample was 1, now it is 2")));
  std::filesystem::remove(journal_);
  for (const char* const text : {"", "[]", "{\"context\": {}, \"benchmarks\": []}", "{\"measurements\": []}"}) {
    std::ofstream(file_) << text;
    EXPECT_THAT([&] { MeasurementStore(context()).open(file_, true); },
                ThrowsMessage<Error>(HasSubstr("cannot be continued")))
        << text;
  }
}

TEST_F(MeasurementStores, LeaveNoJournalWithoutMeasurements) {
  {
    MeasurementStore store(context());
    store.open(file_, false);
    EXPECT_TRUE(std::filesystem::exists(journal_));
  }
  EXPECT_FALSE(std::filesystem::exists(journal_));
}

}  // namespace
}  // namespace sixdof::study
