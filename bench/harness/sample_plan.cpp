#include "bench/harness/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/results/row.h>
#include "bench/common/interrupt.h"

namespace sixdof::bench {
namespace {

/// PlannedRow::trial(), 0 where the row cannot be run: it says so itself when it is called.
double trial(const PlannedRow& row, double seconds) {
  InterruptGuard::check();
  try {
    return row.trial(seconds);
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    return 0.0;
  }
}

}  // namespace

std::string group_of(const results::RowFields& fields) {
  if (!fields.bucket) return {};
  return fmt::format("{}/{}/{}/{}/{}/{}", fields.query, bodies_of(fields), fields.bucket->name(), fields.order,
                     fields.cache, fields.sample_limit.value_or(0));
}

SamplePlan::SamplePlan(const std::vector<const PlannedRow*>& rows) {
  for (const PlannedRow* const row : rows) {
    if (row->trial) rows_[group_of(row->fields)].push_back(row);
  }
}

void SamplePlan::keep(const results::RowFields& measured) {
  const std::string group = group_of(measured);
  if (!group.empty() && measured.configurations) configurations_.emplace(group, *measured.configurations);
}

std::size_t SamplePlan::configurations(const PlannedRow& row, const std::function<double()>& row_seconds) {
  const std::string group = group_of(row.fields);
  const auto members = rows_.find(group);
  std::size_t count = row.fields.sample_limit.value_or(Share().configurations);
  if (members == rows_.end()) return count;
  if (const auto found = configurations_.find(group); found != configurations_.end()) return found->second;
  if (std::isfinite(row_seconds())) {
    double seconds_each = 0.0;
    for (const PlannedRow* const member : members->second) seconds_each += trial(*member, row_seconds());
    // After the trials, which prepared structures: what they took is gone.
    const double most = row_seconds() * static_cast<double>(members->second.size()) / seconds_each;
    if (most < static_cast<double>(count)) count = std::max(k_fewest, static_cast<std::size_t>(most));
  }
  configurations_.emplace(group, count);
  return count;
}

}  // namespace sixdof::bench
