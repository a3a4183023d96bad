#include <sixdof/base/hdf5.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::hdf5 {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Hdf5 : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("sixdof_hdf5_" + std::to_string(::getpid()) + ".h5");
  /// A file with what `write` writes.
  template <class Write>
  void make(const Write& write) const {
    AtomicFile output(path_);
    File file = File::create(output);
    write(file);
    file.close();
    output.commit();
  }

  const Session session_;
};

/// While it lives, no file can have more bytes: a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = old_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_action_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_{};
  void (*old_action_)(int);
};

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

/// Random bits, which no filter makes smaller.
std::vector<double> noise(std::size_t count) {
  std::mt19937_64 generator(7);
  std::vector<double> values(count);
  std::ranges::generate(values, [&] { return 1.0 + std::ldexp(static_cast<double>(generator() >> 12), -52); });
  return values;
}

TEST_F(Hdf5, RefusesMoreValuesThanTheFileCanHold) {
  const std::vector<double> zeros(100'000);
  make([&](File& file) {
    file.write_matrix("zeros", zeros.data(), zeros.size(), 1, zeros.size());
    file.write_values("none", std::span<const double>());
  });
  {
    // Chunks that were never written take no room.
    const Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const std::array<hsize_t, 2> size{hsize_t{1} << 20, hsize_t{1} << 12}, chunk{1024, 1};
    const Handle space(H5Screate_simple(2, size.data(), nullptr), H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.id(), 2, chunk.data());
    const Handle dataset(
        H5Dcreate2(file.id(), "huge", H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose);
    ASSERT_GE(dataset.id(), 0);
  }
  const File file = File::open(path_);
  EXPECT_THAT([&] { file.read_matrix("huge"); },
              ThrowsMessage<BadFile>(HasSubstr("huge: 1048576 x 4096 values in 0 bytes?")));
  EXPECT_LT(std::filesystem::file_size(path_), sizeof(double) * zeros.size() / 10);
  EXPECT_EQ(file.read_matrix("zeros"), zeros) << "well compressed, and all there";
  EXPECT_TRUE(file.read_values<double>("none").empty());
}

TEST_F(Hdf5, AFullDiskIsAnErrorAtEverySizeAndLeavesNothingOpen) {
  const std::vector<double> values = noise(4000);
  const auto write = [&](File& file) {
    file.write_attribute("/", "name", std::string("full"));
    file.write_matrix("chunks", values.data(), 1000, 4, 100);
    file.write_values("piece", std::span<const double>(values));
  };
  make(write);
  const std::uintmax_t whole = std::filesystem::file_size(path_);
  const std::size_t before = open_descriptors();
  constexpr rlim_t k_step = 1999;  // no multiple of a block of anything
  for (rlim_t size = 0; size < whole; size += k_step) {
    const FullDisk disk(size);
    EXPECT_THAT([&] { make(write); }, ThrowsMessage<BadFile>(HasSubstr("cannot be written: File too large"))) << size;
    ASSERT_EQ(open_descriptors(), before) << size;
  }
  EXPECT_EQ(std::filesystem::file_size(path_), whole) << "the old file stands";
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0) << "HDF5 has nothing open";
  make(write);
  EXPECT_EQ(File::open(path_).read_values<double>("piece"), values) << "and the process writes as before";
}

TEST_F(Hdf5, RefusesLayoutsWithoutChecksums) {
  {
    const Handle file(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(file.id(), 0);
  }
  EXPECT_THAT([&] { File::open(path_); },
              ThrowsMessage<BadFile>(HasSubstr("not a readable HDF5 file of this project")));
}

}  // namespace
}  // namespace sixdof::hdf5
