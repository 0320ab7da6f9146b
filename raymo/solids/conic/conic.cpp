#include "raymo/solids/conic/conic.hpp"

#include "raymo/curves/samples.hpp"

namespace raymo::solids {

const Schema& Conic::schema() {
    static const std::array<Param, 4> kParams{
        Param{.name = "contour",
              .words = "contour",
              .kind = ParamKind::contour,
              .doc = "closed curves in the plane z = 0"},
        Param{
            .name = "h", .words = "height", .kind = ParamKind::length, .doc = "height", .min = 0.0},
        Param{.name = "top",
              .words = "top scale",
              .kind = ParamKind::number,
              .doc = "how large the contour is at z = h, seen from the z axis; 0: a point",
              .min = 0.0,
              .min_included = true,
              .fallback = 0.0},
        Param{.name = "center",
              .words = "center",
              .kind = ParamKind::flag,
              .doc = "true: its middle at z = 0; false: standing on the plane z = 0",
              .fallback = false}};
    static const Schema kSchema{"conic",
                                "A contour swept up while it is scaled about the z axis, from 1 at "
                                "z = 0 to `top` at z = h.",
                                kParams,
                                "let foot = rectangle(24, 16, radius: 5, center: true)\n"
                                "conic(foot - circle(5), 14, top: 0.6).paint(\"olivedrab\")"};
    return kSchema;
}

Result<Placed<Conic::Kernel>> Conic::prepare(std::span<const Argument> arguments) {
    const double half = 0.5 * std::get<double>(arguments[1]);
    const double top = std::get<double>(arguments[2]);
    // Straight up, the contour may as well be brought to the middle.
    const bool straight = top == 1.0;
    auto framed = frame_region(*std::get<curves::OutlinePtr>(arguments[0]), straight);
    if (!framed) return Failure(std::move(framed).error());
    // The larger end is always the lower one.
    const bool flipped = top > 1.0;
    const double size = framed->size * (flipped ? top : 1.0);
    Affine map = scaling({size, size, flipped ? -half : half});
    map.offset = {framed->centre.x, framed->centre.y, std::get<bool>(arguments[3]) ? 0.0 : half};
    return Placed<Kernel>{Kernel(std::move(framed->region), flipped ? 1.0 / top : top, flipped),
                          map};
}

std::span<const std::vector<Argument>> Conic::examples() {
    static const std::array<std::vector<Argument>, 8> kExamples{
        {{curves::sample_disc(), 7.0, 0.4, true},
         {curves::sample_rectangle(), 3.0, 0.0, false},
         {curves::sample_washer(), 4.0, 0.0, false},
         {curves::sample_pentagram(curves::Fill::even_odd), 2.0, 2.5, false},
         {curves::sample_pentagram(curves::Fill::non_zero), 9.0, 0.0, false},
         {curves::sample_rosette(), 30.0, 0.999999, true},
         {curves::sample_rosette(), 5.0, 1e3, false},
         {curves::sample_loop(), 5.0, 0.1, false}}};
    return kExamples;
}

}  // namespace raymo::solids
