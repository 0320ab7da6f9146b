// The contract of every solid.
#pragma once

#include <concepts>
#include <span>
#include <string_view>

#include "raymo/core/result.hpp"
#include "raymo/math/aabb.hpp"
#include "raymo/math/affine.hpp"
#include "raymo/solids/schema.hpp"
#include "raymo/solids/span.hpp"

namespace raymo::solids {

/// What a prepared solid answers, in its own canonical frame (centred on the origin, of size about 1). Immutable, so
/// safe to share between threads.
template <class K>
concept Kernel = std::copyable<K> &&
    requires(const K k, const LocalRay<double> ray, SpanList& out, Vec3 p, Vec3 e,
             std::uint16_t face, const Affine map) {
    { k.bounds(map) } -> std::same_as<Aabb>;  ///< Exact box of the image of the solid under `map`.
    {
        k.spans(ray, out)
        } -> std::same_as<void>;  ///< Appends spans: ascending in s, disjoint. Cannot fail.
    {
        k.normal(p, face)
        } -> std::same_as<Vec3>;  ///< Outward, of any length > 0, at a point of that face.
    { k.where(p, e) } -> std::same_as<Where>;  ///< `on` when the boundary is within e of p.
    {
        k.faces()
        } -> std::same_as<std::span<
            const std::string_view>>;  ///< Names of the faces; those beyond have the last.
    { k == k } -> std::same_as<bool>;  ///< Equal kernels are stored once.
};

/// Kernels that keep curves also have bytes(): the memory that these take, for the limit of a program.

/// A kernel and the map from its canonical frame to the frame in which the user wrote the solid.
template <class K>
struct Placed {
    K kernel;
    Affine to_object;
};

/// What a user writes down, and the one door from there to a kernel.
template <class P>
concept Primitive = requires(std::span<const Argument> arguments) {
    typename P::Kernel;
    requires Kernel<typename P::Kernel>;
    { P::schema() } -> std::same_as<const Schema&>;
    /// Arguments have passed check(schema()); what is still wrong (a matrix without solid) is an error.
    { P::prepare(arguments) } -> std::same_as<Result<Placed<typename P::Kernel>>>;
    /// Argument lists that the laws are tried on; nasty ones too.
    { P::examples() } -> std::same_as<std::span<const std::vector<Argument>>>;
};

}  // namespace raymo::solids
