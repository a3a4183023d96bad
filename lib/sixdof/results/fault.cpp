#include <sixdof/results/fault.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace sixdof::results {

std::string to_string(const Fault& fault) {
  return fault.of == 0 ? fault.what : fmt::format("{} of {} {}", fault.count, fault.of, fault.what);
}

std::string to_string(std::span<const Fault> faults) {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : ", ") + to_string(fault);
  return text;
}

std::vector<Fault> mistakes(std::span<const Fault> faults) {
  std::vector<Fault> found;
  std::ranges::remove_copy_if(faults, std::back_inserter(found), &Fault::is_approximation);
  return found;
}

std::vector<Fault> own_faults(const Row& row) {
  // A scene's pairs are counted in its words.
  if (!row.error.empty()) return {{is_scene(row.fields) ? row.error : "not run: " + row.error, "", 0, 0}};
  const auto count = [&](const char* counter) { return static_cast<std::uint64_t>(row.count(counter)); };
  const bool is_study = row.fields.query == "precision", has_force = is_study || row.fields.query == "respond";
  const std::uint64_t asked = row.fields.configurations.value_or(count("configurations"));
  std::vector<Fault> faults{{"failed", "failed", count("failed"), asked},
                            {"crashed", "crashed", count("crashed"), asked},
                            {"timed out", "timed_out", count("timed_out"), asked},
                            {"out of memory", "out_of_memory", count("out_of_memory"), asked}};
  const bool is_apart = has_force && row.fields.bucket && row.fields.bucket->kind == BucketKind::distance;
  const bool approximate = row.fields.approximates && (row.fields.query == "distance" || is_apart);
  if (!is_study)
    faults.push_back({approximate                      ? k_approximate
                      : is_apart                       ? "with a force though the bodies are apart"
                      : row.fields.query == "contacts" ? "without a contact, or with one off both bodies or reversed"
                      : row.fields.query == "depth"    ? "with a depth outside of the proven interval"
                                                       : "wrong",
                      "mismatch", count("mismatch"), count("judged")});
  if (has_force) {
    const std::uint64_t answered = asked - std::min(asked, count("failed"));
    faults.push_back({"without a force though the bodies overlap", "misses", count("misses"), answered});
  }
  std::erase_if(faults, [](const Fault& fault) { return fault.count == 0; });
  return faults;
}

}  // namespace sixdof::results
