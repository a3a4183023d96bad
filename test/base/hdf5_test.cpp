#include <sixdof/base/hdf5.h>

#include <unistd.h>

#include <filesystem>

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
  const Session session_;
};

TEST_F(Hdf5, RefusesMoreValuesThanTheFileCanHold) {
  const std::vector<double> zeros(100'000);
  {
    File file = File::create(path_, path_);
    file.write_matrix("zeros", zeros.data(), zeros.size(), 1, zeros.size());
    file.write_values("none", std::span<const double>());
    file.close();
  }
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
