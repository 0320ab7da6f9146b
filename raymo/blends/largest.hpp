// The largest number that works, as it is told: of three digits.
//
// Numbers of three digits m 10^e, 100 <= m < 1000, are numbered by 900 e + m - 100. From the one that is too large the search goes
// down until one works, by powers of two that grow as Fibonacci's numbers (1, 1, 2, 3, 5, ...), and tries the least of all at last; then
// between by halving of the numbers. What is told has been tried itself, and the next number has been found too large.
#pragma once

#include <functional>

namespace raymo::blends {

/// The largest number of three digits with least <= x <= most that works, where all smaller ones work, too; otherwise one that
/// works and the next of which does not, or 0: there is none, or it was not found. Requires 1e-307 <= least, most <= 1e300.
/// Cost: some 20 calls for most / least of 2^24, 30 for 2^1000.
[[nodiscard]] double largest_that(const std::function<bool(double)>& works, double least,
                                  double most);

}  // namespace raymo::blends
