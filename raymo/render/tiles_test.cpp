#include "raymo/render/tiles.hpp"

#include <doctest/doctest.h>

using namespace raymo;
using namespace raymo::render;

TEST_CASE("tiles: cover every cell once, whatever the size") {
    for (const auto& [w, h, size] :
         {std::array{1, 1, 32}, {33, 64, 32}, {100, 7, 8}, {31, 500, 32}}) {
        std::vector<int> seen(static_cast<std::size_t>(w * h), 0);
        for (const Rect& tile : tiles_of(w, h, size)) {
            for_each_cell(tile, [&](int x, int y) { ++seen[static_cast<std::size_t>(y * w + x)]; });
        }
        int wrong = 0;
        for (const int n : seen) wrong += n != 1;
        CHECK(wrong == 0);
    }
}

TEST_CASE("tiles: the first four are a square") {
    const auto tiles = tiles_of(256, 256, 32);
    CHECK(tiles[1].x0 == 32);
    CHECK(tiles[1].y0 == 0);
    CHECK(tiles[2].x0 == 0);
    CHECK(tiles[2].y0 == 32);
    CHECK(tiles[3].x0 == 32);
    CHECK(tiles[3].y0 == 32);
}

TEST_CASE("differ: by surface, by bend, and by a visible step") {
    const Signature up{5, {0, 0, 127}};
    const Signature aside{5, {127, 0, 0}};
    const Signature other{7, {0, 0, 127}};
    const float grey[3] = {0.5F, 0.5F, 0.5F};
    const float brighter[3] = {0.51F, 0.5F, 0.5F};
    const float bright[3] = {0.5F, 0.5F, 0.7F};
    CHECK_FALSE(differ(up, grey, up, grey));
    CHECK_FALSE(differ(up, grey, up, brighter));
    CHECK(differ(up, grey, up, bright));
    CHECK(differ(up, grey, aside, grey));
    CHECK(differ(up, grey, other, grey));
    CHECK(differ(up, grey, {}, grey));
    CHECK_FALSE(differ({}, grey, {}, grey));
}
