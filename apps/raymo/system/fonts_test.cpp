// Fonts of the package fonts-dejavu-core, by name.
#include "apps/raymo/system/fonts.hpp"

#include <doctest/doctest.h>

namespace raymo::app {
namespace {

std::string error(const std::string& name) {
    const auto found = find_font(name);
    return found ? "none" : found.error().message;
}

TEST_CASE("fonts are found by family, and by what tells them from others of it") {
    const auto sans = find_font("DejaVu Sans");
    REQUIRE(sans.has_value());
    CHECK(sans->bytes.size() > 100000);
    CHECK(sans->face == 0);
    const auto bold = find_font("DejaVu Sans:bold");
    REQUIRE(bold.has_value());
    CHECK(bold->bytes != sans->bytes);
    CHECK(find_font("DejaVu Sans:style=Bold")->bytes == bold->bytes);
    CHECK(find_font("dejavu sans:bold")->bytes == bold->bytes);
    CHECK(find_font("DejaVu Serif").has_value());
}

TEST_CASE("no other font stands in for one that is not there") {
    CHECK(error("No Such Font At All") ==
          "there is no font \"No Such Font At All\" on this machine");
    CHECK(error("DejaVu Sans:style=Wobbly") ==
          "there is no font \"DejaVu Sans:style=Wobbly\" on this machine");
    CHECK(find_font("DejaVu Sanz").error().hint == "did you mean `DejaVu Sans`?");
    CHECK(find_font("DejaVu Sans:style=Wobbly").error().hint.find("DejaVu Sans:style=Bold") !=
          std::string::npos);
    for (const std::string& name :
         {std::string(":bold"), std::string("A,B"), std::string("a\0b", 3), std::string("-12"),
          std::string(100000, 'x'), std::string("\xff\xfe"), std::string(":"),
          std::string("a:style="), std::string("\\")}) {
        CHECK(error(name) != "none");
    }
    for (const char* name :
         {"DejaVu Sans:index=7", "DejaVu Sans:foo=bar", "DejaVu Sans:charset=4e00",
          "DejaVu Sans:lang=zz", "DejaVu Sans:matrix=2 0 0 2", "DejaVu Sans-12",
          "DejaVu Sans:bold:light", "DejaVu Sans:weight=[80 200]", "DejaVu Sans:size=3"}) {
        CAPTURE(name);
        CHECK(error(name) != "none");
    }
    CHECK(find_font("DejaVu Sans:weight=200:slant=0").has_value());
}

}  // namespace
}  // namespace raymo::app
