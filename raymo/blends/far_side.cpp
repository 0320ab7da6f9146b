#include "raymo/blends/far_side.hpp"

#include <cmath>

namespace raymo::blends {

bool FarSide::place(const Station& station, Vec3 end_a, Vec3 end_b, FarPlace& out) const {
    const std::size_t n = chains_.arcs;
    out.resize(6 * n + 1);
    const Segment& segment = spine_.segment();
    const Vec3 edge = segment.point(station.t);
    Vec3 behind = edge;
    const double s = -segment.sign() * depth();
    if (!to_distances(spine_.surface(0), s * spine_.side(0), spine_.surface(1), s * spine_.side(1),
                      segment.tangent(station.t), behind)) {
        return false;
    }
    for (std::size_t which = 0; which < 2; ++which) {
        const auto corner = [&](std::size_t k) -> Vec3& { return out[which == 0 ? k : 6 * n - k]; };
        const Vec3 contact = station.contact[which];
        // Along the face in a plane through contact and edge: unit, towards the edge.
        const Vec3 across = cross(spine_.surface(which).normal(contact), edge - contact);
        const auto way_at = [&](Vec3 p) {
            return unit(cross(across, spine_.surface(which).normal(p)));
        };
        corner(0) = which == 0 ? end_a : end_b;
        corner(3 * n) = behind;
        for (std::size_t k = 1; k < n; ++k) {
            Vec3& p = corner(3 * k);
            p = contact + (edge - contact) * (static_cast<double>(k) / static_cast<double>(n));
            if (!to_depth(which, unit(across), p)) return false;
        }
        for (std::size_t k = 0; k < n; ++k) {
            const Vec3 p = corner(3 * k);
            const Vec3 q = corner(3 * k + 3);
            const Vec3 from = way_at(p);
            const Vec3 to = way_at(q);
            const double handle = round_handle(p, from, q, to);
            corner(3 * k + 1) = p + from * handle;
            corner(3 * k + 2) = q - to * handle;
        }
    }
    return true;
}

bool FarSide::to_depth(std::size_t which, Vec3 across, Vec3& p) const {
    const Surface& surface = spine_.surface(which);
    for (int i = 0; i < 20; ++i) {
        const double off = depth() - beyond(which, p);
        if (std::fabs(off) <= 0x1p-10 * depth()) return true;
        const Vec3 n = surface.normal(p) * (-spine_.segment().sign() * spine_.side(which));
        const Vec3 within = n - across * dot(n, across);
        p = p + within * (off / dot(within, within));
        if (!is_finite(p)) return false;
    }
    return false;
}

bool FarSide::is_beyond(const std::vector<Cubic>& lines, double u) const {
    const double least = 2.0 * kBeyond * spine_.radius();
    for (std::size_t k = 0; k < arcs(); ++k) {
        const std::size_t which = k < chains_.arcs ? 0 : 1;
        Cubic arc;
        for (std::size_t j = 0; j < 4; ++j) arc[j] = value_at(lines[3 * k + j], u);
        for (const double v : {0.0, 0.125, 0.25, 0.5, 0.75, 0.875, 1.0}) {
            if (!(beyond(which, value_at(arc, v)) > least)) return false;
        }
    }
    return true;
}

}  // namespace raymo::blends
