#include <sixdof/oracle/crossing_parts.h>

namespace sixdof::detail {
namespace {

/// Parts of a search, at least, where its trees have as many pairs of volumes: so many that threads end at about the
/// same time, and so few that a part takes longer than its start.
constexpr std::size_t k_parts = 64;

/// Candidates of a part, more than which would keep the thread that sums up. The others are fetched once, not twice.
constexpr std::size_t k_many = 256;

/// States at its end that a part is done, also if its search throws: else the thread of next() would wait forever.
class Completion {
 public:
  explicit Completion(std::atomic<bool>& is_done) : is_done_(is_done) {}
  ~Completion() {
    is_done_.store(true, std::memory_order_release);
    is_done_.notify_one();
  }
  Completion(const Completion&) = delete;
  Completion& operator=(const Completion&) = delete;

 private:
  std::atomic<bool>& is_done_;
};

}  // namespace

void CrossingParts::start(const Solid& a, const Solid& b, const Pose& X_AB) {
  a_ = &a;
  b_ = &b;
  divide_search(a.tree(), b.tree(), X_AB, k_parts, scratch_, pairs_, wider_);
  count_ = pairs_.size();
  while (parts_.size() < count_) parts_.emplace_back();
  for (std::size_t i = 0; i < count_; ++i) {
    parts_[i].pair = pairs_[count_ - 1 - i];  // a search takes the last of its pairs first
    parts_[i].is_done.store(false, std::memory_order_relaxed);
  }
  X_AB_ = X_AB;
  axes_ = scratch_.axes;
  given_ = 0;
  taken_.store(0, std::memory_order_relaxed);
}

bool CrossingParts::search_one(CandidateAxes& axes) {
  const std::size_t i = taken_.fetch_add(1, std::memory_order_relaxed);
  if (i >= count_) return false;
  Part& part = parts_[i];
  const Completion completion(part.is_done);
  part.search.start(X_AB_, part.pair, axes);
  part.search.advance(a_->tree(), b_->tree(), CandidateSearch::k_whole);
  part.is_decided = part.search.pairs.size() > k_many;
  if (part.is_decided) keep_crossings(*a_, *b_, X_AB_, part.search.pairs);
  axes = part.search.scratch.axes;
  return true;
}

void CrossingParts::help() {
  CandidateAxes axes = scratch_.axes;
  while (search_one(axes)) {
  }
}

PairPiece CrossingParts::next() {
  for (; given_ < count_; ++given_) {
    Part& part = parts_[given_];
    while (!part.is_done.load(std::memory_order_acquire) && search_one(axes_)) {
    }
    part.is_done.wait(false, std::memory_order_acquire);
    if (part.search.pairs.empty()) continue;
    ++given_;
    return {part.search.pairs, part.is_decided};
  }
  return {};
}

std::size_t CrossingParts::bytes() const {
  std::size_t sum = scratch_.bytes() + (pairs_.capacity() + wider_.capacity()) * sizeof(pairs_[0]);
  for (const Part& part : parts_) {
    sum += sizeof(Part) + part.search.scratch.bytes() + part.search.pairs.capacity() * sizeof(TrianglePair);
  }
  return sum;
}

}  // namespace sixdof::detail
