#include <sixdof/configuration/bucket.h>

#include <charconv>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

void check_percent(BucketKind kind, int percent) {
  if (percent >= 0 && percent <= BucketKey::k_max_percent) return;
  throw BadArgument(fmt::format("{} {} %: not in 0 .. {}", to_string(kind), percent, BucketKey::k_max_percent));
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
  check_percent(BucketKind::distance, percent);
  const double diagonal = a.diagonal();
  BucketSummary bucket;
  bucket.key = {BucketKind::distance, percent};
  bucket.nominal = diagonal * static_cast<double>(percent) / 100.0;
  bucket.target = percent == 0 ? k_contact_target * diagonal : bucket.nominal;
  bucket.tolerance = k_distance_tolerance * diagonal;
  return bucket;
}

BucketSummary volume_bucket(const Mesh& a, int percent) {
  check_percent(BucketKind::volume, percent);
  BucketSummary bucket;
  bucket.key = {BucketKind::volume, percent};
  bucket.nominal = a.volume() * static_cast<double>(percent) / 100.0;
  bucket.target = bucket.nominal;
  bucket.tolerance = k_volume_tolerance * a.volume();
  return bucket;
}

}  // namespace sixdof
