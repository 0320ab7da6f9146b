#include "raymo/sml/suggest.hpp"

#include <doctest/doctest.h>

#include <initializer_list>

namespace raymo::sml {
namespace {

std::string hint(std::string_view written, std::initializer_list<std::string_view> known) {
    Suggestion s(written);
    for (const auto k : known) s.consider(k);
    return s.hint();
}

}  // namespace

TEST_CASE("suggest: slips of the finger are found, other words are not") {
    CHECK(hint("spere", {"sphere", "sweep", "scale"}) == "did you mean `sphere`?");
    CHECK(hint("mvoe", {"move", "mirror"}) == "did you mean `move`?");
    CHECK(hint("Sphere", {"sphere", "there"}) == "did you mean `sphere`?");
    CHECK(hint("banana", {"sphere", "move"}).empty());
    CHECK(hint("x", {"y"}).empty());
    CHECK(hint(std::string(5000, 'a'), {"aaa"}).empty());
}

}  // namespace raymo::sml
