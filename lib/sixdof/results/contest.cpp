#include <sixdof/results/contest.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace sixdof::results {
namespace {

double time_of(const RowGroup* entry) { return entry->mean_time()->value; }

}  // namespace

bool Contest::is_clear() const { return entries[0]->mean_time()->high < entries[1]->mean_time()->low; }

double Contest::factor() const { return time_of(entries[1]) / time_of(entries[0]); }

std::vector<Contest> contests(std::span<const RowGroup> groups) {
  std::vector<Contest> all;
  std::map<std::tuple<std::size_t, std::string, std::string, std::string, BucketKey>, std::size_t> index;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (!fields.bucket || fields.cache == "cold" || !group.mean_time() || !group.faults.empty()) continue;
    const std::string order = fields.order.empty() ? "random" : fields.order;
    const auto [place, is_new] =
        index.try_emplace({group.row().file, fields.query, bodies_of(fields), order, *fields.bucket}, all.size());
    if (is_new) all.push_back({group.row().file, fields.query, bodies_of(fields), order, *fields.bucket, {}});
    all[place->second].entries.push_back(&group);
  }
  for (Contest& contest : all) std::ranges::stable_sort(contest.entries, {}, time_of);
  return all;
}

}  // namespace sixdof::results
