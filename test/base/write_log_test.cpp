#include <sixdof/base/write_log.h>

#include <unistd.h>

#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

/// A file without a name, and what is written to it.
class WriteLogTest : public ::testing::Test {
 protected:
  WriteLogTest() {
    std::string name = "/tmp/sixdof-write-log-XXXXXX";
    descriptor_ = ::mkstemp(name.data());
    ::unlink(name.c_str());
  }
  ~WriteLogTest() override { ::close(descriptor_); }

  void write(std::uint64_t at, const std::string& bytes) {
    log_.add(at, std::as_bytes(std::span(bytes)));
    spoil(at, bytes);
  }
  /// Changes the file behind the log's back.
  void spoil(std::uint64_t at, const std::string& bytes) const {
    ASSERT_EQ(::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at)),
              static_cast<ssize_t>(bytes.size()));
  }
  bool matches() const { return log_.matches(descriptor_); }

  int descriptor_ = -1;
  WriteLog log_;
};

TEST_F(WriteLogTest, ComparesTheLastBytesOfEveryPlace) {
  EXPECT_TRUE(matches());
  write(10, "abcdefgh");
  write(12, "XY");
  write(0, "0123456789AB");  // over "ab"
  write(30, "end");
  EXPECT_TRUE(matches());
  spoil(20, "z");  // nobody wrote there
  EXPECT_TRUE(matches());
  for (const std::uint64_t at : {0, 9, 10, 11, 12, 13, 14, 17, 30, 32}) {
    char before = 0;
    ASSERT_EQ(::pread(descriptor_, &before, 1, static_cast<off_t>(at)), 1);
    spoil(at, "!");
    EXPECT_FALSE(matches()) << at;
    spoil(at, std::string(1, before));
    EXPECT_TRUE(matches()) << at;
  }
}

TEST_F(WriteLogTest, LooksAtNothingBehindTheEnd) {
  write(0, "abc");
  write(100, "gone");
  ASSERT_EQ(::ftruncate(descriptor_, 50), 0);
  EXPECT_TRUE(matches());
  ASSERT_EQ(::ftruncate(descriptor_, 2), 0);
  EXPECT_TRUE(matches());
}

TEST_F(WriteLogTest, OfLongWritesComparesTheHash) {
  const std::string much(3 * WriteLog::k_longest_kept, 'm');
  write(5, much);
  EXPECT_TRUE(matches());
  spoil(much.size() / 2, "!");
  EXPECT_FALSE(matches());
  write(100, "on top");  // covers a part: the rest is not compared
  EXPECT_TRUE(matches());
  spoil(103, "!");
  EXPECT_FALSE(matches());
}

TEST_F(WriteLogTest, AnyOneByteOfRandomWritesCounts) {
  std::mt19937 generator(5);
  std::string file(400, '\0');
  for (int i = 0; i < 60; ++i) {
    const std::size_t at = generator() % 380, size = 1 + generator() % 20;
    const std::string bytes(size, static_cast<char>('a' + i % 26));
    write(at, bytes);
    file.replace(at, size, bytes);
  }
  ASSERT_TRUE(matches());
  for (std::size_t at = 0; at < file.size(); ++at) {
    if (file[at] == '\0') continue;
    spoil(at, "!");
    EXPECT_FALSE(matches()) << at;
    spoil(at, std::string(1, file[at]));
  }
  EXPECT_TRUE(matches());
}

}  // namespace
}  // namespace sixdof
