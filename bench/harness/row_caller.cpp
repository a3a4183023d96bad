#include "bench/harness/row_caller.h"

#include <algorithm>
#include <exception>
#include <limits>

#include <sixdof/base/error.h>
#include "bench/common/interrupt.h"

namespace sixdof::bench {

void RowCaller::call(const PlannedRow& row, benchmark::State& state) {
  InterruptGuard::check();
  before_row_();
  begun_.insert(row.name);
  progress_.show(begun_.size() - 1, rows_, row.name);
  try {
    const std::size_t configurations = plan_.configurations(row, [this] { return row_budget_s(); });
    row.run(state, {.seconds = row_budget_s(), .configurations = configurations});
  } catch (const Interrupted&) {
    throw;  // through the library, which ends the run with the rows that are finished
  } catch (const NeedsSolid& e) {
    left_out.insert(row.name);
    not_solid.insert(e.what());
    state.SkipWithError(e.what());
  } catch (const std::exception& e) {
    state.SkipWithError(e.what());
  } catch (...) {
    state.SkipWithError("an exception of unknown type was thrown");
  }
  progress_.clear();
  InterruptGuard::check();
}

/// Equal parts of the time that is left.
double RowCaller::row_budget_s() const {
  if (budget_s_ == 0.0) return std::numeric_limits<double>::infinity();
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::size_t left = rows_ > begun_.size() ? rows_ - begun_.size() + 1 : 1;
  return std::max(0.0, budget_s_ - elapsed) / static_cast<double>(left);
}

}  // namespace sixdof::bench
