// Paths of spheres: cubic splines in space whose spheres have a radius of their own at every place [Wijk86 4].
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "raymo/math/vec.hpp"

namespace raymo::curves {

/// Cubics in Bernstein form for the centre and the radius; the radius is nowhere negative on [0, 1].
struct PathSpan {
    std::array<double, 4> x{}, y{}, z{};
    std::array<double, 4> r{};

    friend bool operator==(const PathSpan&, const PathSpan&) = default;
};

/// Spans end to end. Never empty.
struct Path {
    std::vector<PathSpan> spans;
    bool closed =
        false;  ///< the last span ends where the first begins: no ends to be closed by caps

    friend bool operator==(const Path&, const Path&) = default;
};

using PathPtr = std::shared_ptr<const Path>;

}  // namespace raymo::curves
