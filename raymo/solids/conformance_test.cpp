// Every solid obeys the laws of conformance.hpp; a solid is tested the moment it is in the inventory.
#include "raymo/solids/conformance.hpp"

#include <doctest/doctest.h>

namespace raymo::solids {
namespace {

TEST_CASE("every solid: spans along hard lines are certain to within their errors") {
    Inventory::for_each([]<class P>() {
        const conformance::Tally tally = conformance::judge_primitive<P>(20000, 1);
        CAPTURE(P::schema().name);
        INFO(tally.first_fault);
        CHECK(tally.faults == 0);
        CHECK(tally.spans > tally.rays / 20);
        CHECK(tally.degenerate < tally.rays / 4);
    });
}

}  // namespace
}  // namespace raymo::solids
