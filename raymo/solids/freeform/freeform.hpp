// Solids bounded by bicubic patches: smooth(mesh) and patches(list).
//
// Canonical frame: the centre of the box of the control points in the origin, lengths divided by the power of two that
// brings half its longest side to [1/2, 1).
//
// A point belongs to the solid when the surface winds around it, that is when from far away to there a line crosses the
// surface more often inwards than outwards, or more often outwards. How a line meets the patches: search.cpp; how parity is
// kept: spans.cpp; points: membership.cpp. The faces are the patches. Ref: [Wijk86 6].
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "raymo/solids/freeform/surface.hpp"
#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct RayBlock;
struct SpanBlock;
struct PlaceBlock;

class Freeform {
public:
    Freeform() = default;
    explicit Freeform(std::shared_ptr<const FreeformSurface> surface)
        : surface_(std::move(surface)) {}

    [[nodiscard]] Aabb bounds(const Affine& map) const;
    void spans(const LocalRay<double>& ray, SpanList& out) const;
    /// The same for packets (lanes.cpp): with the same bits, or left over.
    void spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const;
    void spans_in_full(const LocalRay<double>& ray, SpanList& out) const { spans(ray, out); }
    [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
    void normals(PlaceBlock& places, std::uint32_t asked) const;
    [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
    [[nodiscard]] std::span<const std::string_view> faces() const;
    /// Exact but for rounding; parts that the surface winds around twice count twice.
    [[nodiscard]] double volume() const;
    [[nodiscard]] const FreeformSurface& surface() const { return *surface_; }
    /// Memory that all copies share.
    [[nodiscard]] double bytes() const { return surface_->bytes(); }
    friend bool operator==(const Freeform& a, const Freeform& b) {
        return a.surface_ == b.surface_ || a.surface_->shell == b.surface_->shell;
    }

private:
    std::shared_ptr<const FreeformSurface> surface_;
};

/// The kernel of a shell, and the map from its frame to the user's. Error: too many patches, or coordinates that can not be
/// computed with.
[[nodiscard]] Result<Placed<Freeform>> frame_shell(const meshes::Shell& shell);

/// The kernel of one kind of solids of patches.
template <class Solid>
class FreeformKernel : public Freeform {
public:
    using Freeform::Freeform;
    explicit FreeformKernel(Freeform solid) : Freeform(std::move(solid)) {}
};

/// The solid of a shell that was made of the first argument. Errors are those of the shell and of frame_shell(), about this
/// argument, and begin with the solid's name.
template <class Solid>
[[nodiscard]] Result<Placed<FreeformKernel<Solid>>> prepare_shell(
    const Result<meshes::Shell>& shell) {
    const auto refuse = [](Error error) {
        error.message = std::string(Solid::schema().name) + ": " + error.message;
        error.argument = 0;
        return Failure(std::move(error));
    };
    if (!shell) return refuse(shell.error());
    auto placed = frame_shell(*shell);
    if (!placed) return refuse(std::move(placed).error());
    return Placed<FreeformKernel<Solid>>{FreeformKernel<Solid>(std::move(placed->kernel)),
                                         placed->to_object};
}

}  // namespace raymo::solids
