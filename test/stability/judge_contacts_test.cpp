#include <sixdof/stability/judge_contacts.h>

#include <functional>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/stability/families.h>

namespace sixdof::stability {
namespace {

constexpr std::size_t k_samples = 24;

/// Contacts from exact geometry, changed.
class Changed final : public Query {
 public:
  using Change = std::function<void(Contacts&, const Pose&)>;
  Changed(const Mesh& a, const Mesh& b, Change change)
      : algorithm_(make_exact_contacts_algorithm()),
        inner_(algorithm_->prepare(a, b, algorithm_->settings())),
        change_(std::move(change)) {}

  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    Outcome<Contacts> answer = inner_->contacts(X_AB, most);
    if (answer.ok()) change_(answer.value, X_AB);
    return answer;
  }

 private:
  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<Query> inner_;
  Change change_;
};

Traits gives_contacts(ContactDepth depth = ContactDepth::local) {
  return {.name = "changed", .version = "1", .answers = {.contacts = true}, .depth = depth};
}

/// Metrics of the wrong findings over the family.
std::set<std::string> wrong_in(const Changed::Change& change, const Traits& traits = gives_contacts()) {
  const Prepare prepare = [&](const Mesh& a, const Mesh& b) { return std::make_unique<Changed>(a, b, change); };
  const Family& family = find_family("contacts");
  std::set<std::string> metrics;
  for (std::size_t i = 0; i < k_samples; ++i) {
    const Genes genes = sample_genes(family, 5, i, k_samples);
    Draw draw(genes);
    for (const Finding& finding : judge(family.make(draw), traits, prepare).findings) {
      if (is_red(finding.verdict)) metrics.insert(finding.metric);
    }
  }
  return metrics;
}

TEST(JudgeContacts, RightContactsHaveNoFault) {
  EXPECT_EQ(wrong_in([](Contacts&, const Pose&) {}), std::set<std::string>());
}

TEST(JudgeContacts, MissingContactsAreFound) {
  EXPECT_TRUE(wrong_in([](Contacts& contacts, const Pose&) { contacts.list.clear(); }).contains("no contact"));
}

TEST(JudgeContacts, ReversedNormalsAreFound) {
  const auto found = wrong_in([](Contacts& contacts, const Pose&) {
    for (Contact& each : contacts.list) each.normal *= -1.0;
  });
  EXPECT_TRUE(found.contains("reversed normal"));
  EXPECT_TRUE(found.contains("mean normal"));
}

TEST(JudgeContacts, PointsOffBothBodiesAreFound) {
  const auto found = wrong_in([](Contacts& contacts, const Pose&) {
    for (Contact& each : contacts.list) each.point += Eigen::Vector3d(9.0, 8.0, 7.0);
  });
  EXPECT_TRUE(found.contains("off bodies"));
}

/// As where a library compares the bodies by their sizes and forgets which is first.
TEST(JudgeContacts, NormalsThatDependOnTheOrderAreFound) {
  int calls = 0;
  const auto found = wrong_in([&](Contacts& contacts, const Pose&) {
    if (++calls % 3 != 2) return;  // the second shot of a case has the bodies exchanged
    for (Contact& each : contacts.list) each.normal *= -1.0;
  });
  EXPECT_TRUE(found.contains("same normal"));
}

TEST(JudgeContacts, HalvedDepthsOfBodiesAreFound) {
  const auto halved = [](Contacts& contacts, const Pose&) {
    for (Contact& each : contacts.list) each.depth *= 0.5;
  };
  EXPECT_TRUE(wrong_in(halved, gives_contacts(ContactDepth::bodies)).contains("depth"));
  EXPECT_FALSE(wrong_in(halved, gives_contacts(ContactDepth::triangles)).contains("depth")) << "another meaning";
}

}  // namespace
}  // namespace sixdof::stability
