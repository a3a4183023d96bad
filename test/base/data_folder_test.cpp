#include <sixdof/base/data_folder.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace sixdof {
namespace {

using Path = std::filesystem::path;

/// Unsets SIXDOF_DATA and has two folders that exist.
class DataFolder : public ::testing::Test {
 protected:
  DataFolder() {
    std::filesystem::create_directories(folder("one"));
    std::filesystem::create_directories(folder("two"));
    ::unsetenv("SIXDOF_DATA");
  }
  ~DataFolder() override {
    ::unsetenv("SIXDOF_DATA");
    const LinkedDataFolder none("");
    std::filesystem::remove_all(root_);
  }
  Path folder(const std::string& name) const { return root_ / name; }

 private:
  const Path root_ = std::filesystem::canonical(std::filesystem::temp_directory_path()) /
                     ("sixdof-data-" + std::to_string(::getpid()));
};

TEST_F(DataFolder, IsThatOfTheLinkedPackageIfItIsThere) {
  const Path beside_program = data_folder();
  EXPECT_TRUE(beside_program.string().ends_with("share/sixdof")) << beside_program;
  const LinkedDataFolder linked(folder("one"));
  EXPECT_EQ(data_folder(), folder("one"));
  const LinkedDataFolder gone(folder("gone"));
  EXPECT_EQ(data_folder(), beside_program);
}

TEST_F(DataFolder, IsThatOfTheEnvironmentFirst) {
  const LinkedDataFolder linked(folder("one"));
  ::setenv("SIXDOF_DATA", folder("two").c_str(), 1);
  EXPECT_EQ(data_folder(), folder("two"));
  ::setenv("SIXDOF_DATA", "", 1);
  EXPECT_EQ(data_folder(), folder("one"));
}

}  // namespace
}  // namespace sixdof
