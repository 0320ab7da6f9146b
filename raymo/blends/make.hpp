// Primitives by their types, for blends that build solids of others.
#pragma once

#include "raymo/csg/model.hpp"

namespace raymo::blends {

template <solids::Primitive P>
[[nodiscard]] Result<csg::Solid> make(std::initializer_list<solids::Argument> arguments,
                                      SourceSpan span) {
    return csg::primitive(solids::Inventory::index_of<P>(), {arguments.begin(), arguments.size()},
                          span);
}

/// Takes (x, y, z) to origin + x u + y v + z w.
[[nodiscard]] inline Affine frame(Vec3 u, Vec3 v, Vec3 w, Vec3 origin) {
    Affine map;
    for (int i = 0; i < 3; ++i) map.linear.row[static_cast<std::size_t>(i)] = {u[i], v[i], w[i]};
    map.offset = origin;
    return map;
}

}  // namespace raymo::blends
