#include <sixdof/configuration/configuration_set.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>

#include "folder_test.h"
#include "foreign_hdf5.h"
#include "shapes.h"

namespace sixdof {
namespace {

using test::same_bits;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr BucketKey k_near{BucketKind::distance, 5};
constexpr BucketKey k_far{BucketKind::distance, 20};
constexpr BucketKey k_deep{BucketKind::volume, 3};

const Mesh k_a = test::tetrahedron_mesh({0, 0, 0}, 1.7);
const Mesh k_b = test::tetrahedron_mesh({0, 0, 0}, 0.9);

std::vector<double> some_translations(const Grid& grid, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> translations(0.0, 4.0);
  std::vector<double> values(grid.configurations());
  for (double& s : values) s = random() % 5 == 0 ? std::numeric_limits<double>::quiet_NaN() : translations(random);
  return values;
}

BucketSummary some_summary(BucketKey key) {
  return {.key = key,
          .nominal = 0.1,
          .target = 0.1 + 1e-11,
          .tolerance = 1e-9,
          .largest_residual = 3e-13,
          .oracle = "exact",
          .oracle_version = "1.2.3"};
}

void put_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

class ConfigurationSetTest : public test::FolderTest {
 protected:
  SetDescription description() const {
    return {.generator_version = "0.1.0", .a = MeshIdentity::of(k_a), .b = MeshIdentity::of(k_b), .grid = grid_};
  }

  std::filesystem::path write(const std::string& name) const {
    ConfigurationSetWriter writer(folder_ / name, description());
    writer.write(some_summary(k_far), far_);
    writer.write(some_summary(k_near), near_);
    writer.write(some_summary(k_deep), deep_);
    writer.commit();
    return folder_ / name;
  }

  const Grid grid_ = make_grid("60");
  const std::vector<double> near_ = some_translations(grid_, 1);
  const std::vector<double> far_ = some_translations(grid_, 2);
  const std::vector<double> deep_ = some_translations(grid_, 3);
};

TEST_F(ConfigurationSetTest, ComesBackBitForBit) {
  const ConfigurationSet set(write("set.h5"));
  EXPECT_TRUE(same_bits(set.read(k_near), near_));
  EXPECT_TRUE(same_bits(set.read(k_far), far_));
  EXPECT_TRUE(same_bits(set.read(k_deep), deep_));

  EXPECT_EQ(set.grid(BucketKind::distance).directions, grid_.directions);
  EXPECT_EQ(set.grid(BucketKind::distance).rotations, grid_.rotations);
  EXPECT_EQ(set.grid(BucketKind::distance).spec, "60");
  EXPECT_EQ(set.grid(BucketKind::distance).sampler, grid_.sampler);
  EXPECT_EQ(set.grid(BucketKind::distance).rotation_step_degrees, 60.0);
  EXPECT_EQ(set.description().generator_version, "0.1.0");
  EXPECT_EQ(set.description().a.name, "tetrahedron");
  EXPECT_EQ(set.description().a.hash, k_a.hash());
  EXPECT_EQ(set.description().b.hash, k_b.hash());
  EXPECT_EQ(set.description().b.triangles, 4u);
  EXPECT_EQ(set.description().b.volume, k_b.volume());
  EXPECT_EQ(set.description().a.box_min, k_a.box().min());
  EXPECT_EQ(set.description().a.diagonal(), k_a.diagonal());

  ASSERT_EQ(set.buckets().size(), 3u);
  EXPECT_EQ(set.buckets()[0].key, k_near);
  EXPECT_EQ(set.buckets()[1].key, k_far);
  EXPECT_EQ(set.buckets()[2].key, k_deep);
  const BucketSummary& bucket = set.summary(k_near);
  EXPECT_EQ(bucket.nominal, 0.1);
  EXPECT_EQ(bucket.target, 0.1 + 1e-11);
  EXPECT_EQ(bucket.tolerance, 1e-9);
  EXPECT_EQ(bucket.largest_residual, 3e-13);
  EXPECT_EQ(bucket.oracle, "exact");
  EXPECT_EQ(bucket.oracle_version, "1.2.3");
  EXPECT_EQ(bucket.reachable,
            static_cast<std::uint64_t>(std::ranges::count_if(near_, [](double s) { return !std::isnan(s); })));
}

TEST_F(ConfigurationSetTest, ReadsOnlyTheBucketItIsAskedFor) {
  const auto path = write("set.h5");
  // With the data of one bucket damaged the set still opens and the others are read. The data's position is found by
  // comparing with a set that differs in this bucket only.
  std::string bytes = test::bytes_of(path);
  {
    ConfigurationSetWriter writer(folder_ / "other.h5", description());
    writer.write(some_summary(k_far), far_);
    writer.write(some_summary(k_near), far_);
    writer.write(some_summary(k_deep), deep_);
    writer.commit();
  }
  const std::string other = test::bytes_of(folder_ / "other.h5");
  std::size_t first = 0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < std::min(bytes.size(), other.size()); ++i) {
    run = bytes[i] != other[i] ? run + 1 : 0;
    if (run == 64) {
      first = i;
      break;
    }
  }
  ASSERT_NE(first, 0u);
  bytes[first] = static_cast<char>(~bytes[first]);
  put_bytes(path, bytes);
  const ConfigurationSet damaged(path);
  EXPECT_TRUE(same_bits(damaged.read(k_far), far_));
  EXPECT_TRUE(same_bits(damaged.read(k_deep), deep_));
  EXPECT_THAT([&] { damaged.read(k_near); },
              ThrowsMessage<BadFile>(AllOf(HasSubstr(path.string()), HasSubstr("distance/05"), HasSubstr("checksum"))));
}

TEST_F(ConfigurationSetTest, TheSameInputGivesTheSameBytes) {
  EXPECT_EQ(test::bytes_of(write("first.h5")), test::bytes_of(write("second.h5")));
  EXPECT_EQ(ConfigurationSet(folder_ / "first.h5").hash(), ConfigurationSet(folder_ / "second.h5").hash());
}

TEST_F(ConfigurationSetTest, TheHashDependsOnValuesAndDescription) {
  const std::string hash = ConfigurationSet(write("set.h5")).hash();
  SetDescription other = description();
  std::swap(other.a, other.b);
  std::vector<double> moved = deep_;
  moved.back() = std::isnan(moved.back()) ? 1.0 : std::nextafter(moved.back(), 9.0);
  const auto hash_with = [&](const SetDescription& set, const std::vector<double>& deep) {
    ConfigurationSetWriter writer(folder_ / "other.h5", set);
    writer.write(some_summary(k_near), near_);
    writer.write(some_summary(k_far), far_);
    writer.write(some_summary(k_deep), deep);
    writer.commit();
    return ConfigurationSet(folder_ / "other.h5").hash();
  };
  EXPECT_EQ(hash_with(description(), deep_), hash);  // The order of writing does not matter.
  EXPECT_NE(hash_with(description(), moved), hash);
  EXPECT_NE(hash_with(other, deep_), hash);
  other = description();
  other.volume_grid = grid_;
  EXPECT_NE(hash_with(other, deep_), hash);
}

TEST_F(ConfigurationSetTest, AppearsWholeOrNotAtAll) {
  {
    ConfigurationSetWriter writer(folder_ / "set.h5", description());
    writer.write(some_summary(k_near), near_);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  EXPECT_THROW(ConfigurationSetWriter(folder_ / "absent" / "set.h5", description()), BadFile);
}

TEST_F(ConfigurationSetTest, RefusesWhatCannotBeWritten) {
  ConfigurationSetWriter writer(folder_ / "set.h5", description());
  std::vector<double> translations = near_;
  translations.pop_back();
  EXPECT_THROW(writer.write(some_summary(k_near), translations), BadArgument);
  translations.push_back(-0.1);
  EXPECT_THROW(writer.write(some_summary(k_near), translations), BadArgument);
  translations.back() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(writer.write(some_summary(k_near), translations), BadArgument);
  writer.write(some_summary(k_near), near_);
  EXPECT_THROW(writer.write(some_summary(k_near), near_), BadArgument);
  EXPECT_THROW(writer.write(some_summary({BucketKind::volume, 101}), near_), BadArgument);
  EXPECT_THROW(ConfigurationSetWriter(folder_ / "empty.h5", SetDescription{}), BadArgument);
}

TEST_F(ConfigurationSetTest, RefusesForeignFiles) {
  const auto path = folder_ / "foreign.h5";
  EXPECT_THAT([&] { ConfigurationSet set(path); }, ThrowsMessage<BadFile>(HasSubstr("no such file")));
  EXPECT_THAT([&] { ConfigurationSet set(folder_); }, ThrowsMessage<BadFile>(HasSubstr("not a regular file")));
  for (const std::string_view content : {"", "solid hull\nendsolid\n", "\x89HDF\r\n\x1a\n"}) {
    put_bytes(path, content);
    EXPECT_THAT([&] { ConfigurationSet set(path); },
                ThrowsMessage<BadFile>(AllOf(HasSubstr(path.string()), HasSubstr("HDF5"))));
  }
  test::write_hdf5(path, [](hdf5::File& file) { file.make_group("distance"); });
  EXPECT_THAT([&] { ConfigurationSet set(path); }, ThrowsMessage<BadFile>(HasSubstr("attribute format")));
  test::write_hdf5(path, [](hdf5::File& file) { file.write_attribute("/", "format", std::string("weather")); });
  EXPECT_THAT([&] { ConfigurationSet set(path); }, ThrowsMessage<BadFile>(HasSubstr("not a sixdof configuration set")));
  for (const std::uint64_t version : {1, 2, 4}) {
    test::write_hdf5(path, [&](hdf5::File& file) {
      file.write_attribute("/", "format", std::string("sixdof-configuration-set"));
      file.write_attribute("/", "format_version", version);
    });
    EXPECT_THAT([&] { ConfigurationSet set(path); },
                ThrowsMessage<BadFile>(AllOf(HasSubstr("format version " + std::to_string(version)),
                                             HasSubstr("reads version 3"), HasSubstr("sixdof generate"))));
  }
}

TEST_F(ConfigurationSetTest, RefusesEveryTruncation) {
  const std::string bytes = test::bytes_of(write("set.h5"));
  const auto path = folder_ / "short.h5";
  std::mt19937_64 random(11);
  for (int repeat = 0; repeat < 60; ++repeat) {
    put_bytes(path, std::string_view(bytes).substr(0, random() % bytes.size()));
    EXPECT_THROW(ConfigurationSet set(path), BadFile);
  }
  put_bytes(path, std::string_view(bytes).substr(0, bytes.size() - 1));
  EXPECT_THROW(ConfigurationSet set(path), BadFile);
}

TEST_F(ConfigurationSetTest, FindsEveryFlippedByteThatMatters) {
  const std::string bytes = test::bytes_of(write("set.h5"));
  const auto path = folder_ / "flipped.h5";
  std::mt19937_64 random(12);
  int found = 0;
  constexpr int k_flips = 600;
  for (int repeat = 0; repeat < k_flips; ++repeat) {
    // Every second flip goes to the beginning, where the structures are.
    const std::size_t where = random() % (repeat % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096));
    std::string damaged = bytes;
    damaged[where] = static_cast<char>(damaged[where] ^ (1 << (random() % 8)));
    put_bytes(path, damaged);
    try {
      const ConfigurationSet set(path);
      const bool same = same_bits(set.read(k_near), near_) && same_bits(set.read(k_far), far_) &&
                        same_bits(set.read(k_deep), deep_) && set.buckets().size() == 3 &&
                        set.grid(BucketKind::distance).rotations == grid_.rotations &&
                        set.description().a.hash == k_a.hash();
      EXPECT_TRUE(same) << "byte " << where << " was not checked";
    } catch (const BadFile& e) {
      EXPECT_THAT(e.what(), HasSubstr(path.string()));
      ++found;
    }
  }
  // Flips that are not found are in the unused space between HDF5's structures.
  EXPECT_GT(found, k_flips / 2);
}

TEST_F(ConfigurationSetTest, FindsEditsWithValidHdf5Checksums) {
  const auto path = write("set.h5");
  {
    const hdf5::Session session;
    const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hdf5::Handle data(H5Dopen2(file.id(), "/distance/05", H5P_DEFAULT), H5Dclose);
    std::vector<double> edited = near_;
    edited[3] = 0.25;
    ASSERT_GE(H5Dwrite(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, edited.data()), 0);
  }
  const ConfigurationSet set(path);
  EXPECT_TRUE(same_bits(set.read(k_far), far_));
  EXPECT_THAT([&] { set.read(k_near); }, ThrowsMessage<BadFile>(AllOf(HasSubstr("distance/05"), HasSubstr("hash"))));
  {
    const hdf5::Session session;
    const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Ldelete(file.id(), "/distance/05", H5P_DEFAULT), 0);
  }
  EXPECT_THAT([&] { ConfigurationSet edited(path); }, ThrowsMessage<BadFile>(HasSubstr("hash")));
}

TEST_F(ConfigurationSetTest, RefusesOtherMeshesAndBuckets) {
  const ConfigurationSet set(write("set.h5"));
  EXPECT_NO_THROW(set.check_meshes(k_a, k_b));
  EXPECT_THAT([&] { set.check_meshes(k_b, k_b); },
              ThrowsMessage<BadArgument>(AllOf(HasSubstr("another mesh A"), HasSubstr(k_b.hash()))));
  EXPECT_THAT([&] { set.check_meshes(k_a, k_a); }, ThrowsMessage<BadArgument>(HasSubstr("another mesh B")));
  EXPECT_THAT(
      [&] {
        set.read({BucketKind::volume, 5});
      },
      ThrowsMessage<BadArgument>(AllOf(HasSubstr("no bucket volume/05"), HasSubstr("distance/20"))));
}

TEST_F(ConfigurationSetTest, TellsASetFromOtherFilesByItsFirstBytes) {
  EXPECT_TRUE(looks_like_configuration_set(write("set.h5")));
  put_bytes(folder_ / "mesh.off", "OFF\n3 1 0\n");
  EXPECT_FALSE(looks_like_configuration_set(folder_ / "mesh.off"));
  EXPECT_FALSE(looks_like_configuration_set(folder_ / "absent"));
}

TEST_F(ConfigurationSetTest, KeepsWhereMeshesAreApartFromItsContent) {
  const std::string hash = ConfigurationSet(write("set.h5")).hash();
  SetDescription set = description();
  set.a.path = "parts/a.ply";
  set.a.absolute_path = "/home/parts/a.ply";
  ConfigurationSetWriter writer(folder_ / "places.h5", set);
  writer.write(some_summary(k_near), near_);
  writer.write(some_summary(k_far), far_);
  writer.write(some_summary(k_deep), deep_);
  writer.commit();
  const ConfigurationSet read(folder_ / "places.h5");
  EXPECT_EQ(read.description().a.path, set.a.path);
  EXPECT_EQ(read.description().a.absolute_path, set.a.absolute_path);
  EXPECT_EQ(read.description().b.path + read.description().b.absolute_path, "");
  EXPECT_EQ(read.hash(), hash);
}

TEST_F(ConfigurationSetTest, HasBucketsOfPartsOfAPercent) {
  const BucketKey half{BucketKind::distance, 0.5}, close{BucketKind::distance, 0.125};
  ConfigurationSetWriter writer(folder_ / "set.h5", description());
  writer.write(some_summary(k_near), near_);
  writer.write(some_summary(half), far_);
  writer.write(some_summary(close), deep_);
  EXPECT_THROW(writer.write(some_summary({BucketKind::distance, 0.0625}), near_), BadArgument);
  writer.commit();
  const ConfigurationSet set(folder_ / "set.h5");
  ASSERT_EQ(set.buckets().size(), 3u);
  EXPECT_EQ(set.buckets()[0].key, close);
  EXPECT_EQ(set.buckets()[1].key, half);
  EXPECT_EQ(set.buckets()[2].key, k_near);
  EXPECT_TRUE(same_bits(set.read(half), far_));
}

TEST_F(ConfigurationSetTest, RefusesABucketOfAnotherName) {
  const auto path = write("set.h5");
  {
    const hdf5::Session session;
    const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Lmove(file.id(), "/distance/05", file.id(), "/distance/5.0", H5P_DEFAULT, H5P_DEFAULT), 0);
  }
  EXPECT_THAT([&] { ConfigurationSet set(path); },
              ThrowsMessage<BadFile>(AllOf(HasSubstr("distance/5.0"), HasSubstr("no name of a bucket"))));
}

TEST(BucketKey, NamesComeBack) {
  for (const BucketKey key : {BucketKey{BucketKind::distance, 0}, k_near, k_deep, BucketKey{BucketKind::volume, 100},
                              BucketKey{BucketKind::volume, 0.1}, BucketKey{BucketKind::distance, 12.345}}) {
    EXPECT_EQ(BucketKey::parse(key.name()), key);
  }
  EXPECT_EQ((BucketKey{BucketKind::distance, 0.5}).name(), "distance/0.5");
  EXPECT_EQ(k_near.name(), "distance/05");
  for (const char* name : {"", "distance", "distance/", "distance/x", "distance/-1", "distance/101", "depth/05",
                           "distance/.5", "distance/5.", "distance/0.0001", "distance/100.1", "distance/1e1"}) {
    EXPECT_THROW(BucketKey::parse(name), BadArgument) << name;
  }
}

}  // namespace
}  // namespace sixdof
