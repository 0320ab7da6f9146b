// Four solids, each both as RAYMO has it and as triangles of any fineness.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "raymo/scene/scene.hpp"

namespace raymo::bench {

/// Triangles with shared vertices, in single precision as Embree takes them.
struct Mesh {
    struct Vertex {
        float x, y, z;
    };
    std::vector<Vertex> places;   ///< on the exact surface, to rounding
    std::vector<Vertex> normals;  ///< of the exact surface there: unit, outwards
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Shape {
    std::string_view name;
    std::string_view what;
    Result<csg::Solid> (*exact)();
    /// About `triangles` of them, spread so that chords in both directions deviate equally from the surface.
    Mesh (*tessellate)(double triangles);
    scene::Camera camera;  ///< sees the solid in about half of the picture
};

[[nodiscard]] std::span<const Shape> shapes();

}  // namespace raymo::bench
