#include "bench/harness/result_journal.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

using Json = ResultJournal::Json;
using ::testing::HasSubstr;

struct Journal : ::testing::Test {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sixdof-journal-" + std::to_string(::getpid()));
  ~Journal() override { std::filesystem::remove(file); }

  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
};

TEST_F(Journal, HasItsLinesWhenOpenedAgain) {
  ResultJournal(file).append({{"row", "a"}});
  ResultJournal again(file);
  again.append({{"row", "line\nbreak"}});
  EXPECT_EQ(again.lines(), std::vector<Json>({{{"row", "a"}}})) << "what was there when it was opened";
  EXPECT_EQ(content(), "{\"row\":\"a\"}\n{\"row\":\"line\\nbreak\"}\n");
}

TEST_F(Journal, DropsALastLineThatWasCutOff) {
  std::ofstream(file) << "{\"row\":1}\n{\"row\":2}\n{\"ro";
  {
    ResultJournal journal(file);
    EXPECT_EQ(journal.lines().size(), 2u);
    journal.append({{"row", 3}});
  }
  EXPECT_EQ(content(), "{\"row\":1}\n{\"row\":2}\n{\"row\":3}\n");
}

TEST_F(Journal, RefusesDamageInTheMiddleByItsLine) {
  std::ofstream(file) << "{\"row\":1}\n{\"row\":\n{\"row\":3}\n";
  EXPECT_THAT([&] { ResultJournal{file}; }, ::testing::ThrowsMessage<BadFile>(HasSubstr("line 2")));
}

TEST_F(Journal, HasOneWriter) {
  const ResultJournal journal(file);
  EXPECT_THAT([&] { ResultJournal{file}; }, ::testing::ThrowsMessage<BadFile>(HasSubstr("in use")));
}

TEST_F(Journal, KeepsItsLinesWhenTheDiskIsFull) {
  ResultJournal journal(file);
  journal.append({{"row", "a"}});
  const std::string before = content();
  // A limit on the size of files stands for a full disk.
  const auto old_action = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ::getrlimit(RLIMIT_FSIZE, &old_limit);
  const rlimit limit{.rlim_cur = before.size() + 5, .rlim_max = old_limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THAT(
      [&] {
        journal.append({{"row", "b"}});
      },
      ::testing::ThrowsMessage<BadFile>(HasSubstr(file.string() + ": cannot be written")));
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_action);
  EXPECT_EQ(content(), before);
}

TEST_F(Journal, NamesTheFileThatCannotBeMade) { EXPECT_THROW(ResultJournal("/no-such-folder/x.journal"), BadFile); }

}  // namespace
}  // namespace sixdof::bench
