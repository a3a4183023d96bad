#include <sixdof/base/cache.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

namespace fs = std::filesystem;

/// A cache of its own for each test.
class Cache : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sixdof-cache-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    directory_ = name;
    ::setenv("SIXDOF_CACHE", (directory_ / "made/on/demand").c_str(), 1);
    entry_.put<std::int32_t>("table", {3, -7, 2000000000});
    entry_.put<std::uint32_t>("words", {0xffffffffu, 1u});
    entry_.put<std::uint64_t>("counts", {std::uint64_t{1} << 60});
    entry_.put<float>("radii", {0.1f, -2.5e-30f});
    entry_.put<double>("areas", {});
  }
  void TearDown() override {
    ::unsetenv("SIXDOF_CACHE");
    fs::remove_all(directory_);
  }
  fs::path directory_;
  CacheEntry entry_;
};

TEST_F(Cache, LoadsWhatWasStored) {
  EXPECT_FALSE(load_cached("kind", "key").has_value());
  ASSERT_TRUE(store_cached("kind", "key", entry_));
  std::optional<CacheEntry> loaded = load_cached("kind", "key");
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->arrays(), entry_.arrays());
  EXPECT_EQ(loaded->take<float>("radii"), (std::vector<float>{0.1f, -2.5e-30f}));
  EXPECT_THROW(loaded->take<double>("radii"), BadFile);
  EXPECT_THROW(loaded->take<double>("nothing"), BadFile);
}

TEST_F(Cache, DistinguishesKindsAndKeys) {
  ASSERT_TRUE(store_cached("kind", "key", entry_));
  EXPECT_FALSE(load_cached("kind", "key2").has_value());
  EXPECT_FALSE(load_cached("kind2", "key").has_value());
  // The file of another key: the key inside does not match.
  fs::copy_file(cache_file("kind", "key"), cache_file("kind", "other"));
  EXPECT_FALSE(load_cached("kind", "other").has_value());
}

TEST_F(Cache, DetectsEveryDamagedByteOfAnArray) {
  ASSERT_TRUE(store_cached("kind", "key", entry_));
  const fs::path path = cache_file("kind", "key");
  std::string bytes;
  {
    std::ifstream in(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  // The position of an array in the file, found by its content.
  const std::string words("\xff\xff\xff\xff\x01\0\0\0", 8);
  const std::size_t at = bytes.find(words);
  ASSERT_NE(at, std::string::npos);
  for (std::size_t i = at; i < at + words.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    std::ofstream(path, std::ios::binary) << damaged;
    EXPECT_FALSE(load_cached("kind", "key").has_value()) << "byte " << i;
  }
  // Truncated, empty, and not HDF5.
  for (const std::string& wrong : {bytes.substr(0, bytes.size() / 2), std::string(), std::string("not a cache")}) {
    std::ofstream(path, std::ios::binary) << wrong;
    EXPECT_FALSE(load_cached("kind", "key").has_value());
  }
  ASSERT_TRUE(store_cached("kind", "key", entry_));
  EXPECT_TRUE(load_cached("kind", "key").has_value());
}

TEST_F(Cache, IsOffOnRequestAndWithoutAWritableDirectory) {
  ::setenv("SIXDOF_CACHE", "off", 1);
  EXPECT_TRUE(cache_file("kind", "key").empty());
  EXPECT_FALSE(store_cached("kind", "key", entry_));
  EXPECT_FALSE(load_cached("kind", "key").has_value());

  std::ofstream(directory_ / "file") << "not a directory";
  ::setenv("SIXDOF_CACHE", (directory_ / "file").c_str(), 1);
  EXPECT_FALSE(store_cached("kind", "key", entry_));
  EXPECT_FALSE(load_cached("kind", "key").has_value());
}

TEST_F(Cache, IsNotUsedWhereOthersCanWriteIt) {
  ASSERT_TRUE(store_cached("kind", "key", entry_));
  const fs::path folder = cache_file("kind", "key").parent_path();
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all) << "whatever the umask is";
  for (const mode_t mode : {0777u, 01777u, 0770u, 0702u}) {
    ASSERT_EQ(::chmod(folder.c_str(), mode), 0);
    EXPECT_FALSE(load_cached("kind", "key").has_value());
    EXPECT_FALSE(store_cached("kind", "other", entry_));
    EXPECT_THAT(cache_refusal(), ::testing::HasSubstr(folder.string() + ": is not used as cache: others can write it"));
  }
  ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
  EXPECT_TRUE(load_cached("kind", "key").has_value());
  EXPECT_FALSE(load_cached("kind", "other").has_value()) << "was not kept";
  if (::geteuid() != 0) GTEST_SKIP() << "a folder of another user needs root";
  constexpr uid_t k_stranger = 65534;
  ASSERT_EQ(::chown(folder.c_str(), k_stranger, k_stranger), 0);
  EXPECT_FALSE(load_cached("kind", "key").has_value());
  EXPECT_FALSE(store_cached("kind", "key", entry_));
  EXPECT_THAT(cache_refusal(), ::testing::HasSubstr("it belongs to another user (uid 65534)"));
}

TEST_F(Cache, FollowsTheUsersDirectories) {
  ::unsetenv("SIXDOF_CACHE");
  const char* const old = std::getenv("XDG_CACHE_HOME");
  const std::optional<std::string> kept = old == nullptr ? std::nullopt : std::optional<std::string>(old);
  ::setenv("XDG_CACHE_HOME", "/somewhere", 1);
  EXPECT_EQ(cache_file("kind", "key").parent_path(), "/somewhere/sixdof");
  kept ? ::setenv("XDG_CACHE_HOME", kept->c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace sixdof
