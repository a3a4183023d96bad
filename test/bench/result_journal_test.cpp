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

  void write_rows() const {
    ResultJournal journal(file);
    for (const int row : {1, 2, 3}) journal.append({{"row", row}});
  }
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
  std::istringstream lines(content());
  for (const char* row : {"a", "line\nbreak"}) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    const Json value = Json::parse(line);
    EXPECT_EQ(value.at("row"), row);
    EXPECT_EQ(value.at("checksum").get<std::string>().size(), 32u);
  }
}

TEST_F(Journal, DropsALastLineThatWasCutOff) {
  write_rows();
  const std::string whole = content();
  std::ofstream(file, std::ios::app) << "{\"ro";
  {
    ResultJournal journal(file);
    EXPECT_EQ(journal.lines().size(), 3u);
    journal.append({{"row", 4}});
  }
  EXPECT_TRUE(content().starts_with(whole + "{\"row\":4,"));
  EXPECT_EQ(ResultJournal(file).lines().size(), 4u);
}

TEST_F(Journal, RefusesWhateverWasChangedByItsLine) {
  write_rows();
  const std::string whole = content();
  const auto refuses = [&](const std::string& text, int line) {
    std::ofstream(file) << text;
    EXPECT_THAT([&] { ResultJournal{file}; },
                ::testing::ThrowsMessage<BadFile>(HasSubstr(file.string() + ": line " + std::to_string(line) + ": ")))
        << text;
  };
  // Every byte, to one that leaves valid JSON where it is a digit.
  int line = 1;
  for (std::size_t i = 0; i + 1 < whole.size(); ++i) {
    if (whole[i] == '\n') {
      ++line;
      continue;
    }
    std::string damaged = whole;
    damaged[i] = damaged[i] == '1' ? '2' : '1';
    refuses(damaged, line);
  }
  std::vector<std::string> lines;
  std::istringstream in(whole);
  for (std::string one; std::getline(in, one);) lines.push_back(one + "\n");
  refuses(lines[0] + lines[2], 2);             // one taken out
  refuses(lines[1] + lines[0] + lines[2], 1);  // moved
  refuses(lines[0] + lines[0], 2);             // repeated
  refuses(lines[0] + "{\"row\":2}\n", 2);      // added by hand
  std::ofstream(file) << whole;
  EXPECT_EQ(ResultJournal(file).lines().size(), 3u);
}

TEST_F(Journal, FollowsNoLink) {
  const std::filesystem::path precious = file.string() + ".precious";
  std::ofstream(precious) << "precious";
  std::filesystem::create_symlink(precious, file);
  EXPECT_THAT([&] { ResultJournal{file}; }, ::testing::ThrowsMessage<BadFile>(HasSubstr("is a link")));
  std::filesystem::remove(file);
  std::filesystem::create_hard_link(precious, file);
  EXPECT_THAT([&] { ResultJournal{file}; }, ::testing::ThrowsMessage<BadFile>(HasSubstr("other names")));
  EXPECT_EQ(content(), "precious");
  std::filesystem::remove(precious);
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
