// Runs a fuzzer on committed inputs: in ctest, with any compiler. `fuzz_NAME FILE_OR_FOLDER...`
#include <algorithm>
#include <cstdio>
#include <vector>

#include "fuzz.h"

int main(int count, char** words) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (int i = 1; i < count; ++i) {
    if (!fs::is_directory(words[i])) {
      files.push_back(fs::absolute(words[i]));
      continue;
    }
    for (const auto& entry : fs::directory_iterator(words[i])) files.push_back(fs::absolute(entry.path()));
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const std::string bytes = sixdof::fuzz::read_bytes(file);
    std::fprintf(stderr, "%s: %zu bytes\n", file.c_str(), bytes.size());
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::fprintf(stderr, "%zu inputs\n", files.size());
  return files.empty() ? 1 : 0;
}
