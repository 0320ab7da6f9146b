// Points that cover a square evenly, however many of them are taken, and the same ones for the same
// seed everywhere.
//
// The first two dimensions of Sobol's sequence: of the first 2^(a+b) points each of the 2^a x 2^b
// equal rectangles holds one. Scrambling all digits at random, each depending on the ones before
// it, keeps that [Owen95]; a hash does it to all bits at once [LaineKarras11], and scrambling the
// index in the same way makes independent sets of them [Burley20].
#pragma once

#include <cstdint>

namespace raymo::render {

/// A well mixed function of x.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
    // The finaliser of [Stafford11], variant 13.
    x ^= x >> 30U;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27U;
    x *= 0x94d049bb133111ebULL;
    return x ^ (x >> 31U);
}

struct Point2 {
    double u;  ///< 0 <= u < 1
    double v;
};

[[nodiscard]] constexpr std::uint32_t reversed_bits(std::uint32_t x) {
    x = (x << 16U) | (x >> 16U);
    x = ((x & 0x00ff00ffU) << 8U) | ((x & 0xff00ff00U) >> 8U);
    x = ((x & 0x0f0f0f0fU) << 4U) | ((x & 0xf0f0f0f0U) >> 4U);
    x = ((x & 0x33333333U) << 2U) | ((x & 0xccccccccU) >> 2U);
    return ((x & 0x55555555U) << 1U) | ((x & 0xaaaaaaaaU) >> 1U);
}

/// Owen's scramble of the digits of x, lowest bit first: bit i of the result depends on bits 0..i
/// of x only, since sums and products carry upwards, and products with even numbers leave bit i's
/// own value to be flipped or not.
[[nodiscard]] constexpr std::uint32_t scrambled_upwards(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return x;
}

/// Point `index` of the set of points named by `seed`.
[[nodiscard]] constexpr Point2 sample_point(std::uint32_t index, std::uint64_t seed) {
    const std::uint64_t h = mix(seed);
    const std::uint64_t g = mix(h + 0x9e3779b97f4a7c15ULL);
    const std::uint32_t i =
        reversed_bits(scrambled_upwards(reversed_bits(index), static_cast<std::uint32_t>(h)));
    // Dimension 1 is the radical inverse of i: with bits reversed, i itself. Dimension 2 has
    // direction numbers whose bit k of number j, reversed, is the parity of "j over k", which is
    // odd when the bits of k are among those of j. So bit k of the sum is the parity of i over all
    // j that contain k, and summing over supersets takes a step a bit of j.
    std::uint32_t second = i;
    second ^= (second >> 1U) & 0x55555555U;
    second ^= (second >> 2U) & 0x33333333U;
    second ^= (second >> 4U) & 0x0f0f0f0fU;
    second ^= (second >> 8U) & 0x00ff00ffU;
    second ^= (second >> 16U) & 0x0000ffffU;
    const std::uint32_t a =
        reversed_bits(scrambled_upwards(i, static_cast<std::uint32_t>(h >> 32U)));
    const std::uint32_t b = reversed_bits(scrambled_upwards(second, static_cast<std::uint32_t>(g)));
    return {static_cast<double>(a) * 0x1p-32, static_cast<double>(b) * 0x1p-32};
}

}  // namespace raymo::render
