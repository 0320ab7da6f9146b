// libFuzzer: whatever the bytes, a drawing is read or refused, and what it shows is finite, closed curves.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "raymo/drawings/svg.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace raymo;
    int questions = 0;
    const drawings::GoOn go_on = [&](double bytes) { return bytes < 3e7 && ++questions < 2000; };
    const auto drawing = drawings::Drawing::read(
        "fuzz.svg", std::string(reinterpret_cast<const char*>(data), size), go_on);
    if (!drawing) {
        if (drawing.error().message.empty()) __builtin_trap();
        return 0;
    }
    const auto judge = [&](std::string_view id, bool takes_unfilled) {
        const auto drawn = (*drawing)->contour(id, takes_unfilled, go_on);
        if (!drawn || drawn->contour == nullptr) return;
        if (curves::is_open(drawn->contour)) __builtin_trap();
        if (drawn->bytes < curves::bytes_of(drawn->contour) * 0.5) __builtin_trap();
        curves::visit(drawn->contour, [](const curves::ContourNode& node) {
            if (node.op != curves::ContourOp::outline) return;
            for (const curves::Curve& curve : node.outline->curves) {
                if (curve.spans.empty()) __builtin_trap();
                for (std::size_t i = 0; i < curve.spans.size(); ++i) {
                    const curves::Span2& span = curve.spans[i];
                    const curves::Span2& next = curve.spans[(i + 1) % curve.spans.size()];
                    // Numbers beyond 1e300 may overflow; extents are checked above the layer.
                    for (std::size_t k = 0; k < 4; ++k) {
                        if (!(span.w[k] > 0.0 && span.w[k] <= 1.0)) __builtin_trap();
                    }
                    const Vec2 a = span.point(3), b = next.point(0);
                    if (is_finite(a) && is_finite(b) && !(a == b)) __builtin_trap();
                }
            }
        });
        static_cast<void>(curves::extent_of(drawn->contour));
    };
    judge("", false);
    judge("", true);
    for (const std::string_view id : (*drawing)->ids()) judge(id, true);
    return 0;
}
