#include <sixdof/base/hash.h>

#include <xxhash.h>

#include <new>

#include <fmt/format.h>

namespace sixdof {

struct ContentHash::State {
  XXH3_state_t* xxh;
};

ContentHash::ContentHash() : state_(new State{XXH3_createState()}) {
  if (state_->xxh == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_->xxh);
}

ContentHash::~ContentHash() {
  XXH3_freeState(state_->xxh);
  delete state_;
}

void ContentHash::add(std::span<const std::byte> bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

std::string ContentHash::hex() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(state_->xxh);
  return fmt::format("{:016x}{:016x}", digest.high64, digest.low64);
}

}  // namespace sixdof
