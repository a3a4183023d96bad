#include <sixdof/algorithm/embree/embree.h>

#include <memory>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <sixdof/algorithm/embree/embree_mesh.h>
#include <sixdof/algorithm/library_query.h>

namespace sixdof {
namespace {

constexpr const char* k_profile = "profile";
class EmbreeQuery final : public LibraryQuery {
 public:
  EmbreeQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : triangles_(a.triangles().size() + b.triangles().size()), device_(rtcNewDevice("threads=1")) {
    check_embree(nullptr);
    for (const Mesh* mesh : {&a, &b}) require_embree_range(*mesh);
    const bool tuned = settings.choice(k_profile) == "tuned";
    one_thread_.execute([&] {
      a_ = std::make_unique<EmbreeMesh>(device_.get(), a, RTC_SCENE_FLAG_NONE,
                                        tuned ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_LOW,
                                        RTC_BUILD_QUALITY_MEDIUM);
      b_ = std::make_unique<EmbreeMesh>(device_.get(), b, tuned ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE,
                                        RTC_BUILD_QUALITY_LOW,
                                        tuned ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
    });
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<bool> {
      found_ = false;
      const char* const why_not = one_thread_.execute([&] {
        const char* const why = b_->move(X_AB);
        if (why == nullptr) rtcCollide(a_->scene(), b_->scene(), &receive, this);
        return why;
      });
      if (why_not != nullptr) return fail(Status::failed, why_not);
      check_embree(device_.get());
      return found_;
    });
  }

  /// Embree does not tell the size of its trees.
  Footprint footprint() const override { return {0, {{"triangles", static_cast<double>(triangles_)}}}; }

 private:
  static void receive(void* self, RTCCollision* pairs, unsigned count) {
    auto& query = *static_cast<EmbreeQuery*>(self);
    for (unsigned i = 0; i < count && !query.found_; ++i) {
      query.found_ = triangles_meet(query.a_->corners(pairs[i].primID0), query.b_->corners(pairs[i].primID1));
    }
  }

  const std::size_t triangles_;
  tbb::task_arena one_thread_{1};
  const EmbreeDevice device_;
  std::unique_ptr<EmbreeMesh> a_, b_;
  bool found_ = false;
};

}  // namespace

std::unique_ptr<Algorithm> make_embree_algorithm() {
  return make_algorithm<EmbreeQuery>(
      {.name = "embree",
       .version = RTC_VERSION_STRING " float",
       .summary = "Embree's rtcCollide with this project's exact test of triangles; every query moves and refits B",
       .answers = {.collide = true},
       .limits = {.surfaces_only = {.collide = true}},
       .parameters = {Parameter::choice(k_profile, "default: Embree's tutorial; tuned: its manual's advice", "default",
                                        {"default", "tuned"})}});
}

void register_embree_algorithms(Registry& registry) { registry.add(make_embree_algorithm()); }

}  // namespace sixdof
