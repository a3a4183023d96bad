#include <sixdof/base/atomic_file.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = std::filesystem::temp_directory_path() / ("sixdof_atomic_" + std::to_string(::getpid()));
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  static std::string content(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory_), {}));
  }

  std::filesystem::path directory_;
};

TEST_F(AtomicFileTest, WritesTheFileAndLeavesNoOther) {
  const auto target = directory_ / "result.json";
  write_file_atomically(target, "first");
  write_file_atomically(target, "second");
  EXPECT_EQ(content(target), "second");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldContentStays) {
  const auto target = directory_ / "result.json";
  write_file_atomically(target, "old");
  {
    AtomicFile file(target);
    std::ofstream(file.temporary_path()) << "half of the ne";
    EXPECT_EQ(file_count(), 2u);
  }
  EXPECT_EQ(content(target), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, TwoWritersHaveDifferentTemporaryFiles) {
  AtomicFile one(directory_ / "x"), two(directory_ / "x");
  EXPECT_NE(one.temporary_path(), two.temporary_path());
}

TEST_F(AtomicFileTest, RemovesTemporaryFilesOfKilledWriters) {
  const auto target = directory_ / "x";
  const pid_t killed = ::fork();
  if (killed == 0) {
    const AtomicFile file(target);
    std::ofstream(file.temporary_path()) << "half";
    std::_Exit(0);  // no destructor runs
  }
  ::waitpid(killed, nullptr, 0);
  const AtomicFile alive(target);
  std::ofstream(alive.temporary_path()) << "half";
  const AtomicFile another(directory_ / "x.y");
  std::ofstream(another.temporary_path()) << "half";
  std::ofstream(directory_ / ".x.backup.partial") << "foreign";
  ASSERT_EQ(file_count(), 4u);
  remove_stale_partials(target);
  EXPECT_EQ(file_count(), 3u);
  EXPECT_TRUE(std::filesystem::exists(alive.temporary_path()));
  EXPECT_TRUE(std::filesystem::exists(another.temporary_path()));
}

TEST_F(AtomicFileTest, RemovesTheTemporaryFilesOfThisProcess) {
  write_file_atomically(directory_ / "x", "whole");
  AtomicFile file(directory_ / "y");
  std::ofstream(file.temporary_path()) << "half";
  {
    AtomicFile committed(directory_ / "z");
    std::ofstream(committed.temporary_path()) << "whole";
    committed.commit();
    ASSERT_EQ(file_count(), 3u);
    remove_own_partials();
  }
  EXPECT_EQ(file_count(), 2u);
  EXPECT_THROW(file.commit(), BadFile);
}

TEST_F(AtomicFileTest, NamesTheFileThatCannotBeWritten) {
  try {
    write_file_atomically(directory_ / "absent" / "x.json", "");
    FAIL();
  } catch (const BadFile& e) {
    EXPECT_NE(std::string(e.what()).find("x.json"), std::string::npos) << e.what();
  }
  std::filesystem::create_directories(directory_ / "taken" / "by a folder");
  EXPECT_THROW(write_file_atomically(directory_ / "taken", ""), BadFile);
  EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace sixdof
