// Every primitive RAYMO knows, in the order of the manual. Adding a solid is one folder and one line here.
#pragma once

#include <type_traits>
#include <variant>

#include "raymo/solids/block/block.hpp"
#include "raymo/solids/cone/cone.hpp"
#include "raymo/solids/conic/conic.hpp"
#include "raymo/solids/cylinder/cylinder.hpp"
#include "raymo/solids/halfspace/halfspace.hpp"
#include "raymo/solids/patches/patches.hpp"
#include "raymo/solids/primitive.hpp"
#include "raymo/solids/prism/prism.hpp"
#include "raymo/solids/quadric/quadric.hpp"
#include "raymo/solids/revolve/revolve.hpp"
#include "raymo/solids/smooth/smooth.hpp"
#include "raymo/solids/sphere/sphere.hpp"
#include "raymo/solids/sweep/sweep.hpp"
#include "raymo/solids/torus/torus.hpp"

namespace raymo::solids {

template <Primitive... Ps>
struct List {
    using Kernels = std::variant<typename Ps::Kernel...>;
    static constexpr std::size_t kSize = sizeof...(Ps);
    /// The number of P among them.
    template <class P>
    static constexpr std::uint32_t index_of() {
        static_assert((std::is_same_v<P, Ps> || ...), "no primitive of the list");
        std::uint32_t i = 0;
        (void)((std::is_same_v<P, Ps> || (++i, false)) || ...);
        return i;
    }
    /// Calls f.template operator()<P>() for every primitive, in order.
    template <class F>
    static constexpr void for_each(F&& f) {
        (f.template operator()<Ps>(), ...);
    }
};

using Inventory = List<Block, Sphere, Cylinder, Cone, Torus, Halfspace, Quadric, Prism, Conic,
                       Revolve, Sweep, Smooth, Patches>;

/// Any kernel of the inventory.
using AnyKernel = Inventory::Kernels;
/// Any prepared primitive.
using AnySolid = Placed<AnyKernel>;

/// One row of the inventory for callers that choose at run time (the language, the manual).
struct Entry {
    const Schema* schema;
    /// check() and prepare().
    Result<AnySolid> (*make)(std::span<const Argument> arguments);
    std::span<const std::vector<Argument>> (*examples)();
};
[[nodiscard]] std::span<const Entry> inventory();

}  // namespace raymo::solids
