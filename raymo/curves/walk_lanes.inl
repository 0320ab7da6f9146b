// Region::walk for several lines at once (see math/lanes.hpp). Included once per instruction set; needs curves/region.hpp.

/// For the lines that are `asked`: meets(box) and visit(piece index, lines) have a mask. Each line sees what it would see
/// alone. R: with which M goes.
template <class R, class M, class Meets, class Visit>
RAYMO_INLINE void walk_lanes(const curves::Region& region, M asked, Meets&& meets, Visit&& visit) {
    const auto& nodes = region.nodes();
    R resume(0.0);  // node that each goes on with
    for (std::uint32_t i = 0; i < nodes.size();) {
        const curves::Region::Node& node = nodes[i];
        const M here = lane_and(asked, resume <= R(static_cast<double>(i)));
        const M met = lane_and(here, meets(node.box));
        if (!lane_any(met)) {
            // Those that are not here have left out more than this node.
            i = node.skip;
            continue;
        }
        resume =
            lane_select(lane_and(here, lane_not(met)), R(static_cast<double>(node.skip)), resume);
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) visit(k, met);
        ++i;
    }
}
