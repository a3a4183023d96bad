// The command line of `sixdof`, in this process and a folder of its own. The lines of an input are the words. Not
// asked: what names other folders, starts programs, makes large meshes or prepares an algorithm with 10,000 spheres.
// Commands that measure for minutes read their words and print their help; `generate` plans.
//
// A command ends with one of the documented exit codes; an error is on stderr and begins with the program's name; no
// temporary file stays.
#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <sixdof/geometry/save.h>

#include "bench/cli/commands.h"
#include "bench/common/run_guarded.h"
#include "fuzz.h"
#include "small_meshes.h"
#include "small_set.h"

namespace sixdof::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path& box_folder() {
  static const fs::path folder = [] {
    const auto made = scratch_folder() / "box";
    fs::create_directories(made);
    // Nothing outside of the folder is found or written.
    ::setenv("SIXDOF_CACHE", "off", 1);
    ::setenv("SIXDOF_MODELS", made.c_str(), 1);
    ::setenv("SIXDOF_DATA", made.c_str(), 1);
    return made;
  }();
  return folder;
}

/// Files that words may name: whole ones, and others.
const std::vector<std::pair<std::string, std::string>>& files() {
  static const auto list = [] {
    std::vector<std::pair<std::string, std::string>> made;
    const auto keep = [&](const fs::path& file) { made.emplace_back(file.filename().string(), read_bytes(file)); };
    const auto& folder = scratch_folder();
    save_mesh(box(), folder / "a.ply");
    save_mesh(tetrahedron(), folder / "b.obj");
    save_mesh(tetrahedron(), folder / "c.stl");
    for (const char* name : {"a.ply", "b.obj", "c.stl"}) keep(folder / name);
    keep(write_small_set(folder));
    keep(write_small_shard(folder));
    made.emplace_back("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    made.emplace_back("empty.ply", "");
    made.emplace_back("poses.csv",
                      "frame,body,mesh,tx,ty,tz,qw,qx,qy,qz\n0,1,a.ply,0,0,0,1,0,0,0\n0,2,b.obj,1,0,0,1,0,0,0\n");
    made.emplace_back("r.json",
                      R"({"context":{},"benchmarks":[{"name":"distance/algorithm:exact/pair:a/distance:05",)"
                      R"("real_time":10.5,"cpu_time":10.25,"time_unit":"us","sixdof":{"query":"distance",)"
                      R"("algorithm":"exact","pair":"a","bucket":{"kind":"distance","percent":5},)"
                      R"("configurations":16,"order":"random","cache":"warm"},"p50":9,"p99":20,"failed":0}]})");
    return made;
  }();
  return list;
}

void restore_files() {
  for (const auto& entry : fs::directory_iterator(box_folder())) fs::remove_all(entry.path());
  for (const auto& [name, bytes] : files()) write_bytes(box_folder() / name, bytes);
}

bool is_allowed(const std::string& word) {
  for (const char* part :
       {"/", "..", "external", "serve-algorithm", "isolate", ",ist", "=ist", ",vps", "=vps", "-1m", "00k", "10k"}) {
    if (word.find(part) != std::string::npos) return false;
  }
  if (word.starts_with("ist") || word.starts_with("vps")) return false;
  // A count of more than four digits is work.
  std::size_t digits = 0;
  for (const char c : word) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (digits > 4 || c == '\0') return false;
  }
  return true;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words{"sixdof"};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (words.size() < 2) return words;
  const std::set<std::string> measuring{"precision", "recommend", "equivalent", "stress", "quality", "agree"};
  const auto is_measuring = [&](const std::string& word) { return measuring.contains(word); };
  if (std::ranges::any_of(words, is_measuring)) words.emplace_back("--help");
  if (std::ranges::find(words, "generate") != words.end()) words.insert(words.end(), {"--plan", "--plan-seconds", "0"});
  return words;
}

/// What is printed on a descriptor while an object exists.
class Captured {
 public:
  explicit Captured(int descriptor) : descriptor_(descriptor), kept_(::dup(descriptor)) {
    file_ = ::memfd_create("printed", MFD_CLOEXEC);
    ::dup2(file_, descriptor_);
  }
  ~Captured() {
    ::dup2(kept_, descriptor_);
    ::close(kept_);
    ::close(file_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  std::string text() const {
    std::string bytes(static_cast<std::size_t>(::lseek(file_, 0, SEEK_END)), '\0');
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::pread(file_, bytes.data(), bytes.size(), 0))));
    return bytes;
  }

 private:
  const int descriptor_, kept_;
  int file_ = -1;
};

struct Result {
  int code = 0;
  std::string errors;
};

Result run(const std::vector<std::string>& words) {
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  const Captured out(STDOUT_FILENO), err(STDERR_FILENO);
  Result result;
  result.code = cli::run(static_cast<int>(pointers.size()), pointers.data());
  std::fflush(stdout);
  std::fflush(stderr);
  result.errors = err.text();
  return result;
}

void check(const Result& result) {
  constexpr std::array k_codes{0, k_exit_error, k_exit_usage, k_exit_defects};
  require(std::ranges::find(k_codes, result.code) != k_codes.end(), "the exit code is a documented one");
  if (result.code != 0) {
    require(result.errors.starts_with("sixdof"), "an error begins with the program's name: " + result.errors);
    require(result.errors.ends_with("\n"), "an error is a line");
  }
  for (const auto& entry : fs::recursive_directory_iterator(box_folder())) {
    require(entry.path().extension() != ".partial", "no temporary file stays");
  }
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof::fuzz;
  const auto words = words_of({reinterpret_cast<const char*>(data), size});
  if (!std::ranges::all_of(words, is_allowed)) return 0;
  restore_files();
  fs::current_path(box_folder());
  check(run(words));
  return 0;
}
