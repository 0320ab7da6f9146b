#include "raymo/drawings/svg.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "raymo/curves/region.hpp"
#include "raymo/drawings/svg_document.hpp"

namespace raymo::drawings {
namespace {

bool always(double) { return true; }
constexpr double kPx = 25.4 / 96.0;

std::string drawing(std::string_view inside, std::string_view attributes = "") {
    return "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' " +
           std::string(attributes) + ">" + std::string(inside) + "</svg>";
}

Drawn read(std::string text, std::string_view id = "", bool takes_unfilled = false) {
    const auto made = Drawing::read("a.svg", std::move(text), &always);
    REQUIRE_MESSAGE(made.has_value(), made.error().message);
    auto drawn = (*made)->contour(id, takes_unfilled, &always);
    REQUIRE_MESSAGE(drawn.has_value(), drawn.error().message);
    return *std::move(drawn);
}

std::string error(std::string text, std::string_view id = "") {
    const auto made = Drawing::read("a.svg", std::move(text), &always);
    if (!made) return made.error().message;
    const auto drawn = (*made)->contour(id, false, &always);
    return drawn ? "none" : drawn.error().message;
}

void check_box(const Drawn& drawn, Vec2 lo, Vec2 hi) {
    REQUIRE(drawn.contour != nullptr);
    const Box2 box = curves::box_of(drawn.contour);
    CHECK(box.lo.x == doctest::Approx(lo.x).epsilon(1e-13));
    CHECK(box.lo.y == doctest::Approx(lo.y).epsilon(1e-13));
    CHECK(box.hi.x == doctest::Approx(hi.x).epsilon(1e-13));
    CHECK(box.hi.y == doctest::Approx(hi.y).epsilon(1e-13));
}

TEST_CASE("the page's lower left corner is the origin, y points upwards, lengths are millimetres") {
    const std::string rect = "<rect x='10' y='20' width='30' height='5'/>";
    check_box(read(drawing(rect, "viewBox='0 0 100 50' width='100mm' height='50mm'")), {10, 25},
              {40, 30});
    check_box(read(drawing(rect, "viewBox='0 0 100 50' width='200mm' height='100mm'")), {20, 50},
              {80, 60});
    // One side gives the other.
    check_box(read(drawing(rect, "viewBox='0 0 100 50' width='200mm'")), {20, 50}, {80, 60});
    check_box(read(drawing(rect, "viewBox='0 0 100 50' height='10cm' width='100%'")), {20, 50},
              {80, 60});
    // A view box alone is in px; so is a size alone.
    check_box(read(drawing(rect, "viewBox='0 0 100 50'")), Vec2{10, 25} * kPx, Vec2{40, 30} * kPx);
    check_box(read(drawing(rect, "width='100' height='50'")), Vec2{10, 25} * kPx,
              Vec2{40, 30} * kPx);
    // Without a page the origin stays.
    check_box(read(drawing(rect)), Vec2{10, -25} * kPx, Vec2{40, -20} * kPx);
    // Of another shape: in the middle, or as it is told.
    check_box(read(drawing(rect, "viewBox='0 0 100 50' width='100mm' height='100mm'")), {10, 50},
              {40, 55});
    check_box(read(drawing(rect,
                           "viewBox='0 0 100 50' width='100mm' height='100mm' "
                           "preserveAspectRatio='xMinYMax'")),
              {10, 25}, {40, 30});
    check_box(read(drawing(rect,
                           "viewBox='0 0 100 50' width='100mm' height='100mm' "
                           "preserveAspectRatio='none'")),
              {10, 50}, {40, 60});
    check_box(read(drawing(rect, "viewBox='10 20 100 50' width='100mm' height='50mm'")), {0, 45},
              {30, 50});
}

TEST_CASE("shapes: their boxes, percentages and radii") {
    const std::string page = "viewBox='0 0 200 100' width='200mm' height='100mm'";
    check_box(read(drawing("<circle cx='50' cy='60' r='10'/>", page)), {40, 30}, {60, 50});
    check_box(read(drawing("<ellipse cx='50' cy='60' rx='10' ry='20'/>", page)), {40, 20},
              {60, 60});
    check_box(read(drawing("<rect width='50%' height='50%'/>", page)), {0, 50}, {100, 100});
    const Box2 half =
        curves::box_of(read(drawing("<circle cx='50%' cy='50%' r='50%'/>",
                                    "viewBox='0 0 100 100' width='100mm' height='100mm'"))
                           .contour);
    CHECK(half.lo == Vec2{0, 0});
    CHECK(half.hi == Vec2{100, 100});
    check_box(read(drawing("<polygon points='1,2 5,2 5,8'/>", page)), {1, 92}, {5, 98});
    check_box(read(drawing("<polyline points='1,2 5,2 5,8'/>", page)), {1, 92}, {5, 98});
    const Drawn round = read(drawing("<rect width='20' height='10' rx='2'/>", page));
    CHECK((*curves::Region::make(*round.contour->outline, {}, 1.0))->signed_area() ==
          doctest::Approx(-(200 - 16 + 4 * std::numbers::pi)).epsilon(1e-13));
    for (const char* nothing :
         {"<line x2='5' y2='5'/>", "<rect width='5'/>", "<circle r='0'/>", "<path/>",
          "<path d=''/>", "<ellipse rx='3' ry='0'/>", "<polygon points='1 1 2 2'/>",
          "<g transform='scale(0)'><rect width='5' height='5'/></g>"})
        CHECK(read(drawing(nothing, page)).contour == nullptr);
}

TEST_CASE("groups are nested, shapes unite, and each is filled by its own rule") {
    const Drawn drawn =
        read(drawing("<g transform='translate(10 10)' fill-rule='evenodd'><g transform='scale(2)'>"
                     "<path d='M0 0h9v9h-9z M3 3h3v3h-3z'/></g><rect width='1' height='1' "
                     "fill-rule='nonzero'/></g>",
                     "viewBox='0 0 100 100' width='100mm' height='100mm'"));
    CHECK(drawn.shapes == 2);
    CHECK(drawn.contour->op == curves::ContourOp::unite);
    CHECK(drawn.contour->operands[0]->outline->fill == curves::Fill::even_odd);
    CHECK(drawn.contour->operands[1]->outline->fill == curves::Fill::non_zero);
    check_box(drawn, {10, 72}, {28, 90});
    CHECK(drawn.bytes == curves::bytes_of(drawn.contour));
}

TEST_CASE("what is not filled, not visible or not shown is left out") {
    const std::string r = "<rect width='5' height='5' ";
    for (const char* out :
         {"fill='none'", "style='fill:none'", "visibility='hidden'", "display='none'",
          "style='display:none'", "class='no'", "fill='transparent'"}) {
        CAPTURE(out);
        CHECK(read(drawing("<style>.no { fill: none }</style>" + r + out + "/>")).contour ==
              nullptr);
    }
    for (const char* in :
         {"fill='none' style='fill:red'", "fill='none' class='yes'", "fill='red'"}) {
        CAPTURE(in);
        CHECK(read(drawing("<style>.yes { fill: blue }</style>" + r + in + "/>")).shapes == 1);
    }
    const std::string group = "<g fill='none'>" + r + "/>" + r + "fill='red'/></g>";
    CHECK(read(drawing(group)).shapes == 1);
    CHECK(read(drawing(group)).unfilled == 1);
    CHECK(read(drawing(group), "", true).shapes == 2);
    CHECK(read(drawing("<defs>" + r + "/></defs><clipPath>" + r + "/></clipPath><symbol>" + r +
                       "/></symbol><metadata>" + r + "/></metadata>"))
              .contour == nullptr);
    const Drawn others = read(drawing("<text>a</text><image/><text display='none'>b</text>"));
    CHECK(others.texts == 1);
    CHECK(others.images == 1);
}

TEST_CASE("elements that CSS moves or sizes are counted, as far as they are shown") {
    const std::string r = "<rect width='5' height='5' ";
    for (const char* placed : {"style='transform:scale(2)'", "style='WIDTH: 3px'", "class='far'",
                               "transform-origin='3 3'"}) {
        CAPTURE(placed);
        CHECK(read(drawing("<style>.far { translate: 3px }</style>" + r + placed + "/>")).placed ==
              1);
    }
    CHECK(read(drawing(r + "style='transform:none;fill:red' transform='scale(2)'/><defs>" + r +
                           "style='r:3'/></defs><text style='x:3'/>",
                       "style='width:100%;height:auto'"))
              .placed == 0);
}

TEST_CASE("a switch shows the first of its elements that may show") {
    const std::string page = "viewBox='0 0 100 100' width='100mm' height='100mm'";
    const std::string choices =
        "<switch><foreignObject requiredExtensions='x'><rect width='9' height='9'/></foreignObject>"
        "<rect systemLanguage='de' width='8' height='8'/><desc/><g><rect width='2' height='2'/>"
        "<rect x='3' width='2' height='2'/></g><rect id='last' width='7' height='7'/></switch>";
    const Drawn drawn = read(drawing(choices, page));
    CHECK(drawn.shapes == 2);
    check_box(drawn, {0, 98}, {5, 100});
    CHECK(read(drawing(choices, page), "last").shapes == 1);
    CHECK(read(drawing("<switch><rect systemLanguage='de' width='8' height='8'/></switch>", page))
              .contour == nullptr);
}

TEST_CASE("an id selects an element where it lies, hidden or not") {
    const std::string text = drawing(
        "<g transform='translate(10 0)'><rect id='a' x='1' width='5' height='5'/><g id='b' "
        "display='none'>"
        "<rect width='2' height='2'/><rect x='4' width='2' height='2'/></g></g>"
        "<defs transform='translate(3 0)'><path id='c' d='M0 0h1v1z'/></defs>",
        "viewBox='0 0 100 100' width='100mm' height='100mm'");
    check_box(read(text, "a"), {11, 95}, {16, 100});
    check_box(read(text, "b"), {10, 98}, {16, 100});
    check_box(read(text, "c"), {3, 99}, {4, 100});
    CHECK(read(text).shapes == 1);
    CHECK(error(text, "d") == "a.svg has no element with the id \"d\"");
}

TEST_CASE("use: moved, turned, nested, of symbols, and shared") {
    const std::string page = "viewBox='0 0 100 100' width='100mm' height='100mm'";
    const std::string defs =
        "<defs><rect id='r' width='2' height='1'/><g id='two'><use href='#r'/>"
        "<use href='#r' x='3'/></g></defs>";
    const Drawn drawn =
        read(drawing(defs + "<use xlink:href='#two' x='10' y='20'/><use href='#two'/>"
                            "<use href='#r' transform='rotate(90)' x='5'/>",
                     page));
    CHECK(drawn.shapes == 5);
    const auto& shapes = drawn.contour->operands;
    for (std::size_t i = 1; i < 4; ++i) CHECK(shapes[i]->outline == shapes[0]->outline);
    CHECK(shapes[4]->outline != shapes[0]->outline);
    check_box(drawn, {-1, 79}, {15, 100});
    // A symbol fits into the size that it is used at.
    check_box(
        read(drawing("<symbol id='s' viewBox='0 0 10 10'><rect width='10' height='10'/></symbol>"
                     "<use href='#s' x='5' width='20' height='20'/>",
                     page)),
        {5, 80}, {25, 100});
    // Fill comes from where it is used.
    CHECK(read(drawing(defs + "<use href='#two' fill='none'/>", page)).unfilled == 2);
}

TEST_CASE("use: of itself, of nothing, nested too deep, and too often") {
    CHECK(error(drawing("<g id='a'><use href='#a'/></g>"))
              .ends_with("`use` of \"#a\" within itself"));
    CHECK(error(drawing("<use id='a' href='#a'/>")).ends_with("`use` of \"#a\" within itself"));
    CHECK(error(drawing("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>"))
              .ends_with("within itself"));
    CHECK(error(drawing("<use href='#a'/>")).ends_with("`use` of \"#a\", which is not there"));
    CHECK(error(drawing("<use href='b.svg#a'/>")).ends_with("which is another file"));
    CHECK(error(drawing("<use/>")) == "none");
    std::string bomb = "<rect id='e0' width='1' height='1'/>";
    for (int i = 1; i < 30; ++i) {
        bomb += "<g id='e" + std::to_string(i) + "'>";
        for (int k = 0; k < 10; ++k) bomb += "<use href='#e" + std::to_string(i - 1) + "'/>";
        bomb += "</g>";
    }
    CHECK(error(drawing("<defs>" + bomb + "</defs><use href='#e29'/>"))
              .ends_with("the drawing has more than a million shapes"));
    // At the bottom of ten thousand groups: each `use` asks one element whether it is open.
    std::string deep, ends, uses;
    for (int i = 0; i < 9000; ++i) {
        deep += "<g>";
        ends += "</g>";
    }
    for (int i = 0; i < 100000; ++i) uses += "<use href='#r'/>";
    CHECK(read(drawing("<defs><rect id='r' width='1' height='1'/></defs>" + deep + uses + ends))
              .shapes == 100000);
    std::string chain = "<g id='e0'/>";
    for (int i = 1; i < 200; ++i)
        chain += "<use id='e" + std::to_string(i) + "' href='#e" + std::to_string(i - 1) + "'/>";
    CHECK(error(drawing("<defs>" + chain + "</defs><use href='#e199'/>"))
              .ends_with("`use` is nested more than 100 deep"));
}

TEST_CASE("errors name line and column of what is wrong") {
    CHECK(error("") == "a.svg, line 1, column 1: not well-formed XML: no element found");
    CHECK(error("<svg>\n <g>\n</svg>")
              .starts_with("a.svg, line 3, column 3: not well-formed XML: mismatched tag"));
    CHECK(error("<html/>") == "a.svg, line 1, column 1: this is no SVG: it begins with <html>");
    CHECK(error("<svg>\n  <path id='é' d='M0 0\n L1 x'/></svg>") ==
          "a.svg, line 3, column 5: in `d`, a number is missing before \"x\"");
    CHECK(error("<svg>\n  <path d = \"M0 0&#10;L1 x\"/></svg>") ==
          "a.svg, line 2, column 26: in `d`, a number is missing before \"x\"");
    CHECK(error("<svg><rect width='3' height=\"3 parsecs\"/></svg>") ==
          "a.svg, line 1, column 31: in `height`, \" parsecs\" is none of the units px, mm, cm, "
          "in, pt, pc, Q and %");
    CHECK(error("<svg><rect width='-3'/></svg>") ==
          "a.svg, line 1, column 19: `width` must be at least 0, not \"-3\"");
    CHECK(Drawing::read("a", "<svg><circle r='-3mm'/></svg>", &always).error().hint ==
          "write a radius without its sign");
    CHECK(error("<svg><g transform='spin(3)'/></svg>")
              .starts_with("a.svg, line 1, column 20: in `transform`"));
    CHECK(error("<svg viewBox='0 0 1'/>").starts_with("a.svg, line 1, column 15: in `viewBox`"));
    CHECK(error("<svg><polygon points='1 2 3'/></svg>") ==
          "a.svg, line 1, column 28: in `points`, the last point has no y");
    // Attributes of other languages, and those that are not known, are theirs.
    CHECK(error("<svg xmlns:i='x'><i:path d='?' transform='?'/><g data-d='?'/></svg>") == "none");
    CHECK(error("<svg>&none;</svg>").find("undefined entity") != std::string::npos);
}

TEST_CASE("messages show whole characters") {
    CHECK(shortened("abc", 3) == "abc");
    CHECK(shortened("a\n\tc", 3) == "a  ...");
    CHECK(shortened("aéé", 4) == "aé...");
    CHECK(shortened("\u20ac", 2) == "...");
    CHECK(shortened("", 2).empty());
    std::string many = "a";
    for (int i = 0; i < 40; ++i) many += "é";
    const std::string shown = "a" + many.substr(1, 58) + "...";
    CHECK(error(drawing("<use href='" + many + "'/>"))
              .ends_with("`use` of \"" + shown + "\", which is another file"));
    CHECK(error(drawing("<g/>"), many).ends_with("the id \"" + shown + "\""));
    CHECK(
        error(drawing("<rect width='3" + many + "'/>")).find("\"" + many.substr(0, 15) + "...\"") !=
        std::string::npos);
    CHECK(error("<" + many + "/>").ends_with("begins with <" + many.substr(0, 39) + "...>"));
}

TEST_CASE("files of any size and shape: limits hold") {
    std::string laughs = "<!DOCTYPE svg [<!ENTITY a0 'ha'>";
    for (int i = 1; i < 30; ++i) {
        laughs += "<!ENTITY a" + std::to_string(i) + " '";
        for (int k = 0; k < 10; ++k) laughs += "&a" + std::to_string(i - 1) + ";";
        laughs += "'>";
    }
    CHECK(error(laughs + "]><svg>&a29;</svg>").find("amplification") != std::string::npos);
    // Editors name their own entities.
    CHECK(error("<!DOCTYPE svg [<!ENTITY ns 'http://www.w3.org/2000/svg'>]><svg xmlns='&ns;'/>") ==
          "none");
    std::string deep;
    for (int i = 0; i < 20000; ++i) deep += "<g>";
    CHECK(error(drawing(deep)).ends_with("its elements are nested more than 10000 deep"));
    std::string nested;
    for (int i = 0; i < 9000; ++i) nested += "<g>";
    nested += "<rect width='1' height='1'/>";
    for (int i = 0; i < 9000; ++i) nested += "</g>";
    CHECK(read(drawing(nested)).shapes == 1);
    double most = 0.0;
    std::string many;
    for (int i = 0; i < 50000; ++i) many += "<g/>";
    CHECK(Drawing::read("a", drawing(many),
                        [&](double bytes) {
                            most = bytes;
                            return bytes < 1e6;
                        })
              .error()
              .code == ErrorCode::cancelled);
    CHECK(most < 3e7);
    // Two bytes a character.
    std::string wide = "\xff\xfe";
    for (const char c : drawing("<path d='M0 0 L x'/>")) {
        wide += c;
        wide += '\0';
    }
    CHECK(error(wide).find("a number is missing before \"x\"") != std::string::npos);
}

}  // namespace
}  // namespace raymo::drawings
