#include "raymo/solids/prism/prism.hpp"

#include "raymo/curves/samples.hpp"

namespace raymo::solids {

const Schema& Prism::schema() {
    static const std::array<Param, 3> kParams{
        Param{.name = "contour",
              .words = "contour",
              .kind = ParamKind::contour,
              .doc = "closed curves in the plane z = 0"},
        Param{
            .name = "h", .words = "height", .kind = ParamKind::length, .doc = "height", .min = 0.0},
        Param{.name = "center",
              .words = "center",
              .kind = ParamKind::flag,
              .doc = "true: its middle at z = 0; false: standing on the plane z = 0",
              .fallback = false}};
    static const Schema kSchema{
        "prism", "A contour swept straight up, from z = 0 to h.", kParams,
        "let cam = bspline([(-14, 0), (0, -16), (36, -8), (36, 8), (0, 16)], closed: true)\n"
        "prism(cam - circle(5), 8).paint(\"orange\")",
        true};
    return kSchema;
}

Result<Placed<Prism::Kernel>> Prism::prepare(std::span<const Argument> arguments) {
    auto framed = frame_region(*std::get<curves::OutlinePtr>(arguments[0]), true);
    if (!framed) return Failure(std::move(framed).error());
    const double half = 0.5 * std::get<double>(arguments[1]);
    Affine map = scaling({framed->size, framed->size, half});
    map.offset = {framed->centre.x, framed->centre.y, std::get<bool>(arguments[2]) ? 0.0 : half};
    return Placed<Kernel>{Kernel(std::move(framed->region), 1.0, false), map};
}

std::span<const std::vector<Argument>> Prism::examples() {
    static const std::array<std::vector<Argument>, 7> kExamples{
        {{curves::sample_rectangle(), 3.0, false},
         {curves::sample_disc(), 1.0, true},
         {curves::sample_washer(), 4.0, false},
         {curves::sample_pentagram(curves::Fill::even_odd), 2.0, false},
         {curves::sample_pentagram(curves::Fill::non_zero), 1e-3, false},
         {curves::sample_rosette(), 30.0, true},
         {curves::sample_loop(), 5.0, false}}};
    return kExamples;
}

}  // namespace raymo::solids
