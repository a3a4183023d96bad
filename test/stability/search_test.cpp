#include <sixdof/stability/search.h>

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "exact_algorithm.h"

namespace sixdof::stability {
namespace {

/// Off by more, the nearer bodies are to a height that no sample is likely to meet.
class Resonant : public Query {
 public:
  Resonant(const Mesh& a, const Mesh& b) : inner_(prepare_exact(a, b)) {}
  Outcome<Separation> distance(const Pose& X) override {
    Outcome<Separation> answer = inner_->distance(X);
    const double off = X.t.x() - 0.1;
    if (answer.ok()) answer.value.distance += 1e-6 * std::exp(-100.0 * off * off);
    return answer;
  }

 private:
  std::unique_ptr<Query> inner_;
};

const Prepare k_prepare = [](const Mesh& a, const Mesh& b) { return std::make_unique<Resonant>(a, b); };

Traits distances_only() {
  Traits traits = exact_traits();
  traits.answers = {.distance = true};
  return traits;
}

const JudgeCase k_judge = [](const Genes&, const Case& member) { return judge(member, distances_only(), k_prepare); };

Judged start() {
  const Family& family = find_family("grazing");
  Judged judged{.genes = sample_genes(family, 4, 0, 1), .member = {}, .judgement = {}};
  Draw draw(judged.genes);
  judged.member = family.make(draw);
  judged.judgement = judge(judged.member, distances_only(), k_prepare);
  return judged;
}

Judged search(std::uint64_t seed) {
  return search_worst(find_family("grazing"), start(), k_judge, worse_answer, 6, 6, seed);
}

TEST(Search, FindsAWorseCaseThanItsStart) {
  const Finding before = start().judgement.worst(), after = search(2).judgement.worst();
  EXPECT_TRUE(after.worse_than(before));
  EXPECT_GT(after.excess, 2.0 * before.excess);
}

TEST(Search, IsDeterministicBySeedAndItsGenesGiveItsCase) {
  const Judged one = search(3), two = search(3);
  EXPECT_EQ(one.genes, two.genes);
  EXPECT_EQ(one.judgement.worst().value, two.judgement.worst().value);
  Draw draw(one.genes);
  const Case again = find_family("grazing").make(draw);
  EXPECT_EQ(again.shots.front().X_AB.t, one.member.shots.front().X_AB.t);
  EXPECT_NE(search(5).genes, one.genes);
}

TEST(Search, WithoutGenerationsReturnsTheStart) {
  EXPECT_EQ(search_worst(find_family("grazing"), start(), k_judge, worse_answer, 0, 6, 1).genes, start().genes);
}

}  // namespace
}  // namespace sixdof::stability
