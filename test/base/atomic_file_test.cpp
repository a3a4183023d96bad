#include <sixdof/base/atomic_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
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
    const auto lock = remove_own_partials();
  }
  EXPECT_EQ(file_count(), 2u);
  EXPECT_THROW(file.commit(), BadFile);
}

TEST_F(AtomicFileTest, NoneIsMadeByOtherThreadsWhileAProgramEnds) {
  const pid_t ending = ::fork();
  if (ending == 0) {
    std::atomic<int> made{0};
    std::thread work([&] {
      for (;;) {
        const AtomicFile file(directory_ / "x");
        const PrivateFolder folder(directory_ / "y");
        ++made;
      }
    });
    while (made < 10) std::this_thread::yield();
    const auto lock = remove_own_partials();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::_Exit(0);
  }
  ::waitpid(ending, nullptr, 0);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(AtomicFileTest, KeepsTheModeOfAFileThatItReplaces) {
  const auto mode = [&](const char* name) {
    struct stat state = {};
    EXPECT_EQ(::stat((directory_ / name).c_str(), &state), 0);
    return state.st_mode & 0777;
  };
  const mode_t mask = ::umask(027);
  write_file_atomically(directory_ / "new", "x");
  EXPECT_EQ(mode("new"), 0640u);
  ASSERT_EQ(::chmod((directory_ / "new").c_str(), 0604), 0);
  write_file_atomically(directory_ / "new", "y");
  EXPECT_EQ(mode("new"), 0604u);
  ::umask(mask);
}

TEST_F(AtomicFileTest, WritesThroughTheUsersOwnLinks) {
  std::filesystem::create_directory(directory_ / "far");
  std::filesystem::create_directory_symlink("far", directory_ / "near");
  std::filesystem::create_symlink("near/../near/file", directory_ / "link");
  for (const char* text : {"made", "replaced"}) {
    write_file_atomically(directory_ / "link", text);
    EXPECT_EQ(content(directory_ / "far" / "file"), text);
    EXPECT_TRUE(std::filesystem::is_symlink(directory_ / "link"));
  }
  std::filesystem::create_symlink("round", directory_ / "round");
  EXPECT_THROW(write_file_atomically(directory_ / "round", ""), BadFile);
  EXPECT_THROW(write_file_atomically("/dev/null", "a device is no file to replace"), BadFile);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

/// Another user, as root can be.
constexpr uid_t k_stranger = 65534;

TEST_F(AtomicFileTest, FollowsNoLinkThatAStrangerPutIntoAFolderOfEveryone) {
  if (::geteuid() != 0) GTEST_SKIP() << "links of another user need root";
  const auto shared = directory_ / "shared";
  std::filesystem::create_directory(shared);
  std::filesystem::create_directory(directory_ / "mine");
  write_file_atomically(directory_ / "mine" / "precious", "precious");
  std::filesystem::create_symlink("../mine/precious", shared / "file");
  std::filesystem::create_symlink("../mine", shared / "folder");
  for (const char* name : {"file", "folder"}) {
    ASSERT_EQ(::lchown((shared / name).c_str(), k_stranger, k_stranger), 0);
  }
  for (const mode_t mode : {0777u, 01777u}) {
    ASSERT_EQ(::chmod(shared.c_str(), mode), 0);
    for (const char* name : {"file", "folder/precious"}) {
      EXPECT_THAT([&] { write_file_atomically(shared / name, "overwritten"); },
                  ::testing::ThrowsMessage<BadFile>(::testing::HasSubstr("link of another user")));
    }
  }
  EXPECT_EQ(content(directory_ / "mine" / "precious"), "precious");
  ASSERT_EQ(::lchown((shared / "file").c_str(), 0, 0), 0);
  write_file_atomically(shared / "file", "by its owner");
  EXPECT_EQ(content(directory_ / "mine" / "precious"), "by its owner");
}

TEST_F(AtomicFileTest, TemporaryNamesCannotBeForetold) {
  std::set<std::string> names;
  constexpr std::size_t k_count = 1000;
  for (std::size_t i = 0; i < k_count; ++i) {
    const AtomicFile file(directory_ / "x");
    names.insert(file.temporary_path().filename().string());
    EXPECT_EQ(::fcntl(file.descriptor(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  }
  EXPECT_EQ(names.size(), k_count);
  const std::string start = ".x." + std::to_string(::getpid()) + ".";
  std::set<char> digits;
  for (const std::string& name : names) {
    ASSERT_TRUE(name.starts_with(start)) << name;
    digits.insert(name[start.size()]);  // the highest, which a counter would leave 0
  }
  EXPECT_EQ(digits.size(), 16u);
}

TEST_F(AtomicFileTest, APrivateFolderIsItsOwnersAloneUntilItIsWhole) {
  {
    const PrivateFolder given_up(directory_ / "project");
    std::ofstream(given_up.path() / "file") << "half";
    EXPECT_EQ(std::filesystem::status(given_up.path()).permissions(), std::filesystem::perms::owner_all);
  }
  EXPECT_EQ(file_count(), 0u);
  PrivateFolder folder(directory_ / "project");
  std::ofstream(folder.path() / "file") << "whole";
  folder.commit(directory_ / "project");
  EXPECT_EQ(content(directory_ / "project" / "file"), "whole");
  EXPECT_EQ(file_count(), 1u);
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
