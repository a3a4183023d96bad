#include <sixdof/query/registrar.h>

#include <exception>
#include <new>
#include <string>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>

namespace sixdof {
namespace {

class WithVisibleWords final : public Algorithm {
 public:
  explicit WithVisibleWords(std::unique_ptr<Algorithm> algorithm)
      : algorithm_(std::move(algorithm)), traits_(algorithm_->traits()) {
    traits_.version = visible_words(traits_.version);
    traits_.summary = visible_words(traits_.summary);
    for (Parameter& parameter : traits_.parameters) {
      parameter.meaning = visible_words(parameter.meaning);
      parameter.unit = visible_words(parameter.unit);
    }
  }

  const Traits& traits() const override { return traits_; }

  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    try {
      return algorithm_->prepare(a, b, settings);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      const std::string words = visible_words(e.what());
      if (words == e.what()) throw;  // of whatever type
      if (dynamic_cast<const BadMesh*>(&e) != nullptr) throw BadMesh(words);
      if (dynamic_cast<const BadArgument*>(&e) != nullptr) throw BadArgument(words);
      throw Error(words);
    }
  }

 private:
  const std::unique_ptr<Algorithm> algorithm_;
  Traits traits_;
};

}  // namespace

std::unique_ptr<Algorithm> with_visible_words(std::unique_ptr<Algorithm> algorithm) {
  if (!algorithm) return algorithm;
  return std::make_unique<WithVisibleWords>(std::move(algorithm));
}

}  // namespace sixdof
