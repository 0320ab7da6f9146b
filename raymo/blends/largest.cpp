#include "raymo/blends/largest.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace raymo::blends {
namespace {

constexpr int kNumbers = 900;  // of three digits, for each power of ten

double value_of(int number) {
    const int e = number >= 0 ? number / kNumbers : -((kNumbers - 1 - number) / kNumbers);
    const double m = number - e * kNumbers + 100;
    // Powers of ten are exact up to the 22nd, those of a tenth are not. No power is larger than all numbers.
    if (e < -300) return m / 1e300 / std::pow(10.0, -300 - e);
    return e < 0 ? m / std::pow(10.0, -e) : m * std::pow(10.0, e);
}

/// The last number that is not larger than x.
int number_below(double x) {
    const int e = static_cast<int>(std::floor(std::log10(x))) - 2;
    int number = e * kNumbers + static_cast<int>(x / std::pow(10.0, e)) - 100;
    // Roundings may have it one off.
    while (value_of(number) > x) --number;
    while (value_of(number + 1) <= x) ++number;
    return number;
}

}  // namespace

double largest_that(const std::function<bool(double)>& works, double least, double most) {
    int too_large = number_below(most) + 1;  // as are all numbers after it
    int smallest = number_below(least);
    if (value_of(smallest) < least) ++smallest;
    int good = 0;
    bool found = false;
    double tried = most;
    for (int stride = 1, next = 1; !found; next += std::exchange(stride, next)) {
        tried = std::ldexp(tried, -stride);
        const int number = std::max(tried > least ? number_below(tried) : smallest, smallest);
        if (number >= too_large) return 0.0;
        found = works(value_of(number));
        (found ? good : too_large) = number;
    }
    while (too_large - good > 1) {
        const int middle = good + (too_large - good) / 2;
        (works(value_of(middle)) ? good : too_large) = middle;
    }
    return value_of(good);
}

}  // namespace raymo::blends
