// The largest number that works, as it is told: of three digits.
//
// Numbers of three digits m 10^e, 100 <= m < 1000, are numbered by 900 e + m - 100. Halves of the one that is too large are
// tried until one works, and those in between by halving of their numbers: after a factor of 2 these are at most 500, so
// nine of them settle it. What is told has been tried itself, and the next number has been found too large.
#pragma once

#include <functional>

namespace raymo::blends {

/// The largest number of three digits with least <= x <= most that works; of several ranges that work, one that is found. 0 when
/// none does. Requires 1e-307 <= least, most <= 1e300. Cost: log2(most / least) + 10 calls.
[[nodiscard]] double largest_that(const std::function<bool(double)>& works, double least,
                                  double most);

}  // namespace raymo::blends
