#include <sixdof/configuration/bucket.h>

#include <charconv>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// @param scale,tolerance the quantity of 100 percent, and the allowed error in units of it
BucketSummary bucket_of(BucketKey key, double scale, double tolerance) {
  if (key.percent < 0 || key.percent > BucketKey::k_max_percent) {
    throw BadArgument(
        fmt::format("{} {} %: not in 0 .. {}", to_string(key.kind), key.percent, BucketKey::k_max_percent));
  }
  const double nominal = scale * static_cast<double>(key.percent) / 100.0;
  return {.key = key, .nominal = nominal, .target = nominal, .tolerance = tolerance * scale};
}

}  // namespace

std::string to_string(BucketKind kind) { return kind == BucketKind::distance ? "distance" : "volume"; }

std::string BucketKey::name() const { return fmt::format("{}/{:02}", to_string(kind), percent); }

BucketKey BucketKey::parse(std::string_view name) {
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    const std::string prefix = fmt::format("{}/", to_string(kind));
    if (!name.starts_with(prefix)) continue;
    const std::string_view digits = name.substr(prefix.size());
    BucketKey key{kind, 0};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), key.percent);
    if (error == std::errc() && end == digits.data() + digits.size() && key.percent >= 0 &&
        key.percent <= k_max_percent) {
      return key;
    }
  }
  throw BadArgument(
      fmt::format("bucket '{}': not of the form distance/NN or volume/NN, NN from 00 to {}", name, k_max_percent));
}

BucketSummary distance_bucket(const Mesh& a, int percent) {
  BucketSummary bucket = bucket_of({BucketKind::distance, percent}, a.diagonal(), k_distance_tolerance);
  if (percent == 0) bucket.target = k_contact_target * a.diagonal();
  return bucket;
}

BucketSummary volume_bucket(const Mesh& a, int percent) {
  return bucket_of({BucketKind::volume, percent}, a.volume(), k_volume_tolerance);
}

}  // namespace sixdof
