// Faults as they are found in collision libraries, planted into the reference: the family meant for each sees it.

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/stability/families.h>

#include "exact_algorithm.h"

namespace sixdof::stability {
namespace {

constexpr std::size_t k_samples = 24;

/// The reference with its questions and answers changed.
class Faulty : public Query {
 public:
  Faulty(const Mesh& a, const Mesh& b) : inner_(prepare_exact(a, b)) {}

  Outcome<bool> collide(const Pose& X) override { return inner_->collide(asked(X)); }
  Outcome<Separation> distance(const Pose& X) override {
    Outcome<Separation> answer = inner_->distance(asked(X));
    if (answer.ok()) spoil_distance(X, answer.value);
    return answer;
  }
  Outcome<Response> respond(const Pose& X) override {
    Outcome<Response> answer = inner_->respond(asked(X));
    if (answer.ok()) spoil_response(X, answer.value);
    return answer;
  }

 protected:
  virtual Pose asked(const Pose& X) const { return X; }
  virtual void spoil_distance(const Pose&, Separation&) {}
  virtual void spoil_response(const Pose&, Response&) {}

 private:
  std::unique_ptr<Query> inner_;
};

/// The translation passes through a float.
struct Float : Faulty {
  using Faulty::Faulty;
  Pose asked(const Pose& X) const override { return {X.R, X.t.cast<float>().cast<double>()}; }
};

/// What is nearer than a fixed length counts as contact.
struct AbsoluteEpsilon : Faulty {
  using Faulty::Faulty;
  void spoil_distance(const Pose&, Separation& answer) override {
    if (answer.distance < 1e-7) answer.distance = 0.0;
  }
};

/// The larger body is put first, and the force is not turned back.
class MissingSwap : public Query {
 public:
  MissingSwap(const Mesh& a, const Mesh& b)
      : swapped_(a.volume() < b.volume()), inner_(swapped_ ? prepare_exact(b, a) : prepare_exact(a, b)) {}

  Outcome<Response> respond(const Pose& X) override {
    if (!swapped_) return inner_->respond(X);
    Outcome<Response> answer = inner_->respond(X.inverse());
    answer.value.force = X.R * answer.value.force;
    return answer;
  }

 private:
  bool swapped_;
  std::unique_ptr<Query> inner_;
};

/// Faces in one plane are taken to be outside of each other, on all sides.
struct WrongTie : Faulty {
  WrongTie(const Mesh& a, const Mesh& b) : Faulty(a, b), same_(a.hash() == b.hash()) {}
  void spoil_response(const Pose& X, Response& answer) override {
    if (same_ && X.t.norm() < 1e-12) answer.volume = answer.penalty = 0.0;
  }
  bool same_;
};

/// Parallel edges are divided by the sine of their angle.
struct ParallelDivision : Faulty {
  using Faulty::Faulty;
  void spoil_distance(const Pose& X, Separation& answer) override {
    const double cosine = std::abs(X.R(0, 0));
    if (1.0 - cosine * cosine < 1e-14) answer.distance = std::numeric_limits<double>::quiet_NaN();
  }
};

/// State that stays from the last query.
struct StaleState : Faulty {
  using Faulty::Faulty;
  void spoil_distance(const Pose&, Separation& answer) override { answer.distance += 1e-6 * asked_++; }
  int asked_ = 0;
};

/// A distance in steps of a table.
struct Quantised : Faulty {
  using Faulty::Faulty;
  void spoil_distance(const Pose&, Separation& answer) override {
    answer.distance = std::round(answer.distance * 1e5) / 1e5;
    answer.has_witnesses = false;
  }
};

/// An iteration that ends too early by a relative tolerance.
struct EarlyEnd : Faulty {
  using Faulty::Faulty;
  void spoil_distance(const Pose&, Separation& answer) override { answer.distance *= 1.0 + 1e-6; }
};

template <class Fault>
std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b) {
  return std::make_unique<Fault>(a, b);
}

/// The worst finding of a family.
Finding worst_of(const char* name, const Prepare& prepare, const Traits& traits) {
  const Family& family = find_family(name);
  Finding worst;
  for (std::size_t i = 0; i < k_samples; ++i) {
    const Genes genes = sample_genes(family, 21, i, k_samples);
    Draw draw(genes);
    const Judgement judgement = judge(family.make(draw), traits, prepare);
    if (i == 0 || judgement.worst().worse_than(worst)) worst = judgement.worst();
  }
  return worst;
}

Traits responds_only() {
  Traits traits = exact_traits();
  traits.answers = {.respond = true};
  return traits;
}

TEST(Faults, TheReferenceItselfHasNone) {
  for (const char* family :
       {"scale", "offset", "motion", "identical", "parallel", "repeat", "lipschitz", "near-aligned"}) {
    const Finding worst = worst_of(family, prepare_exact, exact_traits());
    EXPECT_LE(worst.verdict, Verdict::resolution) << family << ": " << worst.metric << " " << worst.words;
  }
}

TEST(Faults, AFloatIsSeenByTheOffset) {
  const Finding found = worst_of("offset", prepare<Float>, exact_traits());
  EXPECT_EQ(found.verdict, Verdict::wrong);
  EXPECT_GT(found.excess, 1e3);
}

TEST(Faults, AnAbsoluteEpsilonIsSeenByTheScale) {
  EXPECT_EQ(worst_of("scale", prepare<AbsoluteEpsilon>, exact_traits()).verdict, Verdict::wrong);
}

TEST(Faults, AMissingSwapIsSeenByTheMotion) {
  const Finding found = worst_of("motion", prepare<MissingSwap>, responds_only());
  EXPECT_EQ(found.verdict, Verdict::wrong);
  EXPECT_THAT(found.metric, ::testing::AnyOf("direction", "turned force", "same force"));
}

TEST(Faults, AWrongTieIsSeenByIdenticalBodies) {
  const Finding found = worst_of("identical", prepare<WrongTie>, exact_traits());
  EXPECT_EQ(found.verdict, Verdict::wrong);
  EXPECT_EQ(found.metric, "volume");
}

TEST(Faults, ADivisionByTheSineIsSeenByParallelEdges) {
  EXPECT_EQ(worst_of("parallel", prepare<ParallelDivision>, exact_traits()).verdict, Verdict::non_finite);
}

TEST(Faults, StaleStateIsSeenByTheRepetition) {
  EXPECT_EQ(worst_of("repeat", prepare<StaleState>, exact_traits()).verdict, Verdict::wrong);
}

TEST(Faults, StepsAreSeenByTheLipschitzPath) {
  const Finding found = worst_of("lipschitz", prepare<Quantised>, exact_traits());
  EXPECT_EQ(found.verdict, Verdict::wrong);
  EXPECT_EQ(found.metric, "slope of the distance");
}

TEST(Faults, AnEarlyEndIsSeenByNearlyAlignedBoxes) {
  EXPECT_EQ(worst_of("near-aligned", prepare<EarlyEnd>, exact_traits()).verdict, Verdict::wrong);
}

}  // namespace
}  // namespace sixdof::stability
