#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "bench/harness/options.h"

namespace sixdof::bench {

/// Text of a result: JSON with checksums (result_checksums.h); as CSV (RFC 4180) one line for each of "benchmarks" and
/// a column for every key that any of them has, empty where a row has no such key. Keys of objects inside are joined by
/// dots. CSV has no context.
std::string result_text(nlohmann::ordered_json document, ResultFormat format);

}  // namespace sixdof::bench
