// Arithmetic of numbers, shared by the paths that evaluate it.
#pragma once

#include <cmath>
#include <cstdint>

#include "raymo/sml/ast.hpp"

namespace raymo::sml {

/// The remainder takes the sign of the divisor, so that i % n is an index for negative i too. b is not 0.
[[nodiscard]] inline double remainder_of(double a, double b) {
    // Of whole numbers below 2^53 the integers' remainder is the same number.
    if (a > 0.0 && b > 0.0 && a < 0x1p53 && b < 0x1p53) {
        const auto i = static_cast<std::int64_t>(a);
        const auto j = static_cast<std::int64_t>(b);
        if (static_cast<double>(i) == a && static_cast<double>(j) == b)
            return static_cast<double>(i % j);
    }
    const double r = std::fmod(a, b);
    return r != 0.0 && (r < 0.0) != (b < 0.0) ? r + b : r;
}

/// x op y for + - * / % where that is a finite number. False: it is not, or the operator is another one.
[[nodiscard]] inline bool quick_arithmetic(Operator op, double x, double y, double& out) {
    switch (op) {
        case Operator::add:
            out = x + y;
            break;
        case Operator::subtract:
            out = x - y;
            break;
        case Operator::multiply:
            out = x * y;
            break;
        case Operator::divide:
            if (y == 0.0) return false;
            out = x / y;
            break;
        case Operator::modulo:
            if (y == 0.0) return false;
            out = remainder_of(x, y);
            break;
        default:
            return false;
    }
    return std::isfinite(out);
}

}  // namespace raymo::sml
