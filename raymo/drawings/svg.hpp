// Drawings in SVG, as contours: what is filled in them, with the curves that they are drawn with.
//
// A contour is the union of all shapes that are filled, each by its own rule. Colours, strokes, masks and clips do not matter:
// a white area over a black one does not cut it. The page's lower left corner comes to the origin and y points upwards;
// lengths are those of the page, 96 px to an inch, so 1 px is 25.4 / 96 mm [SVG11 7].
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/curves/contour.hpp"
#include "raymo/drawings/svg_path.hpp"

namespace raymo::drawings {

struct SvgDocument;

/// What a drawing shows, or one element of it.
struct Drawn {
    curves::Contour contour;   ///< null when nothing is filled
    double bytes = 0.0;        ///< that were made for it
    std::size_t shapes = 0;    ///< that it is the union of
    std::size_t unfilled = 0;  ///< shapes left out since they are not filled
    std::size_t flat = 0;      ///< shapes left out since a page or a scale of 0 makes them flat
    std::size_t texts = 0;     ///< left out: letters are no curves in SVG
    std::size_t images = 0;    ///< left out
    std::size_t placed = 0;    ///< elements that are moved or sized by CSS, which is not followed
    std::size_t rules = 0;  ///< of the file's style sheets that say what is filled and are left out
};

/// An SVG file that has been read. Immutable.
class Drawing {
public:
    /// `bytes` may be anything. Errors name line and column: see read_svg(). `go_on` is asked now and then.
    [[nodiscard]] static Result<std::shared_ptr<const Drawing>> read(std::string name,
                                                                     std::string bytes,
                                                                     const GoOn& go_on);
    explicit Drawing(std::unique_ptr<const SvgDocument> document);
    ~Drawing();

    /// The element with that id and what is in it, where it lies on the page; all of it for an empty id. A shape that is used
    /// several times is made once for each size and turn. `takes_unfilled`: shapes that are not filled, too.
    /// Errors: name, when there is no such id; bad_argument for a `use` of what is not there or of itself; limit beyond 10^6
    /// shapes or 10^7 elements passed, or `use` nested more than 100 deep; cancelled when `go_on` says no.
    /// Cost: 0.2 us an element and 0.5 us a curve.
    [[nodiscard]] Result<Drawn> contour(std::string_view id, bool takes_unfilled,
                                        const GoOn& go_on) const;
    /// All ids, for hints; in no order.
    [[nodiscard]] std::vector<std::string_view> ids() const;
    /// Memory it takes.
    [[nodiscard]] double bytes() const;

private:
    std::unique_ptr<const SvgDocument> document_;
};

using DrawingPtr = std::shared_ptr<const Drawing>;

}  // namespace raymo::drawings
