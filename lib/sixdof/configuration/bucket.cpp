#include <sixdof/configuration/bucket.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// @param scale,tolerance the quantity of 100 percent, and the allowed error in units of it
BucketSummary bucket_of(BucketKey key, double scale, double tolerance) {
  if (parse_percent(key.percent_text()) != key.percent) {
    throw BadArgument(fmt::format("{} {} %: not in 0 .. {}, or more than {} decimals", to_string(key.kind), key.percent,
                                  BucketKey::k_max_percent, BucketKey::k_max_decimals));
  }
  const double nominal = scale * key.percent / 100.0;
  return {.key = key, .nominal = nominal, .target = nominal, .tolerance = tolerance * scale};
}

}  // namespace

std::string to_string(BucketKind kind) { return kind == BucketKind::distance ? "distance" : "volume"; }

std::string BucketKey::name() const { return fmt::format("{}/{}", to_string(kind), percent_text()); }

std::string BucketKey::percent_text() const {
  return percent == std::floor(percent) ? fmt::format("{:02.0f}", percent) : fmt::format("{}", percent);
}

BucketKey BucketKey::parse(std::string_view name) {
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    const std::string prefix = fmt::format("{}/", to_string(kind));
    if (!name.starts_with(prefix)) continue;
    if (const auto percent = parse_percent(name.substr(prefix.size()))) return {kind, *percent};
  }
  throw BadArgument(fmt::format(
      "bucket '{}': not of the form distance/NN or volume/NN, NN from 00 to {} with at most {} decimals (0.5)", name,
      k_max_percent, k_max_decimals));
}

std::optional<double> parse_percent(std::string_view text) {
  const auto all_digits = [](std::string_view part) {
    return !part.empty() && std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
  };
  const std::size_t point = text.find('.');
  if (!all_digits(text.substr(0, point))) return std::nullopt;
  if (point != std::string_view::npos) {
    const std::string_view decimals = text.substr(point + 1);
    if (!all_digits(decimals) || decimals.size() > BucketKey::k_max_decimals) return std::nullopt;
  }
  double percent = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), percent);
  if (error != std::errc() || percent > BucketKey::k_max_percent) return std::nullopt;
  return percent;
}

BucketSummary distance_bucket(const Mesh& a, double percent) {
  BucketSummary bucket = bucket_of({BucketKind::distance, percent}, a.diagonal(), k_distance_tolerance);
  if (percent == 0.0) bucket.target = k_contact_target * a.diagonal();
  return bucket;
}

BucketSummary volume_bucket(const Mesh& a, double percent) {
  return bucket_of({BucketKind::volume, percent}, a.volume(), k_volume_tolerance);
}

}  // namespace sixdof
