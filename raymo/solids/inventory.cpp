#include "raymo/solids/inventory.hpp"

namespace raymo::solids {
namespace {

template <class P>
Result<AnySolid> make(std::span<const Argument> arguments) {
    if (auto checked = check(P::schema(), arguments); !checked) {
        return Failure(std::move(checked).error());
    }
    auto placed = P::prepare(arguments);
    if (!placed) return Failure(std::move(placed).error());
    return AnySolid{placed->kernel, placed->to_object};
}

std::vector<Entry> rows() {
    std::vector<Entry> out;
    Inventory::for_each([&]<class P>() { out.push_back({&P::schema(), &make<P>, &P::examples}); });
    return out;
}

}  // namespace

std::span<const Entry> inventory() {
    static const std::vector<Entry> kRows = rows();
    return kRows;
}

}  // namespace raymo::solids
