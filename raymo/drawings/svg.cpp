#include "raymo/drawings/svg.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "raymo/drawings/svg_document.hpp"

namespace raymo::drawings {
namespace {

using curves::Outline;
using curves::OutlinePtr;

constexpr std::size_t kMostShapes = 1000000;
constexpr std::size_t kMostVisits = 10000000;
constexpr std::size_t kMostUses = 100;
/// Bytes of an id that messages show.
constexpr std::size_t kMostShown = 60;

/// What a view box shows, mapped to a viewport.
Affine2 view_map(const ViewBox& box, Vec2 corner, Vec2 size, const Aspect& aspect) {
    double sx = size.x / box.width;
    double sy = size.y / box.height;
    if (!aspect.is_free) sx = sy = aspect.covers ? std::max(sx, sy) : std::min(sx, sy);
    const Vec2 spare{size.x - sx * box.width, size.y - sy * box.height};
    const double x = corner.x + (aspect.is_free ? 0.0 : aspect.x * spare.x);
    const double y = corner.y + (aspect.is_free ? 0.0 : aspect.y * spare.y);
    return {sx, 0, x - sx * box.x, 0, sy, y - sy * box.y};
}

/// A linear map, its bits in order.
using Key = std::tuple<const SvgElement*, bool, std::array<std::uint64_t, 6>>;

class Walk {
public:
    Walk(const SvgDocument& document, bool takes_unfilled, const GoOn& go_on)
        : document_(document),
          takes_unfilled_(takes_unfilled),
          go_on_(go_on),
          is_open_(document.elements.size()) {}

    Result<Drawn> run(std::uint32_t selected) {
        // From the root to the element: what it lies in moves it and says how it is filled.
        std::vector<std::uint32_t> above;
        for (std::uint32_t e = document_.elements[selected].parent; e != kNoElement;
             e = document_.elements[e].parent) {
            above.push_back(e);
        }
        Frame frame;
        for (auto e = above.rbegin(); e != above.rend(); ++e) enter(*e, frame, kNoElement);
        visit(selected, frame, kNoElement, true);
        while (!open_.empty() && !failed_) {
            const std::uint32_t next = open_.back().next_child;
            if (next == kNoElement) {
                uses_ -= document_.elements[open_.back().element].tag == SvgTag::use ? 1 : 0;
                is_open_[open_.back().element] = false;
                open_.pop_back();
                continue;
            }
            const SvgTag within = document_.elements[open_.back().element].tag;
            const bool is_use = within == SvgTag::use;
            open_.back().next_child = is_use || within == SvgTag::choice
                                          ? kNoElement
                                          : document_.elements[next].next_sibling;
            visit(next, Frame(open_.back()), is_use ? open_.back().element : kNoElement, is_use);
        }
        if (failed_) return Failure(std::move(failure_));
        return finish();
    }

private:
    struct Frame {
        std::uint32_t element = kNoElement;
        std::uint32_t next_child = kNoElement;
        Affine2 map;              ///< to the plane of the contour
        Vec2 viewport{100, 100};  ///< what percentages are parts of [px]
        bool is_filled = true;
        bool is_even_odd = false;
        bool is_visible = true;
    };

    void fail_at(const SvgElement& element, std::string what, std::string hint = {},
                 ErrorCode code = ErrorCode::bad_argument) {
        failed_ = true;
        failure_ = document_.wrong(element.at, std::move(what), std::move(hint), code).value();
    }

    double length(const SvgElement& e, std::size_t i, double whole, double fallback) const {
        return e.lengths[i] ? e.lengths[i]->of(whole) : fallback;
    }
    /// Lengths along x, y, x, y ... as the first four of x y width height.
    double along(const SvgElement& e, std::size_t i, Vec2 viewport, double fallback) const {
        return length(e, i, i % 2 == 0 ? viewport.x : viewport.y, fallback);
    }

    /// Makes a frame that of an element: what it says of itself, its transformation and its viewport. `user`: the `use` that
    /// shows it.
    void enter(std::uint32_t index, Frame& frame, std::uint32_t user) {
        const SvgElement& e = document_.elements[index];
        frame.element = index;
        frame.next_child = e.first_child;
        frame.is_filled = e.style.is_filled.value_or(frame.is_filled);
        frame.is_even_odd = e.style.is_even_odd.value_or(frame.is_even_odd);
        frame.is_visible = e.style.is_visible.value_or(frame.is_visible);
        if (index == 0) enter_page(e, frame);
        frame.map = frame.map * e.transform;
        if (index == 0) return;
        if (e.style.is_placed && e.tag != SvgTag::text && e.tag != SvgTag::image) ++drawn_.placed;
        if (e.tag == SvgTag::svg || e.tag == SvgTag::symbol) {
            // A symbol that is selected where it is defined is as it is written.
            if (e.tag == SvgTag::symbol && user == kNoElement) return;
            Vec2 corner{along(e, 0, frame.viewport, 0.0), along(e, 1, frame.viewport, 0.0)};
            Vec2 size{along(e, 2, frame.viewport, frame.viewport.x),
                      along(e, 3, frame.viewport, frame.viewport.y)};
            if (user != kNoElement) {
                const SvgElement& u = document_.elements[user];
                size = {along(u, 2, frame.viewport, size.x), along(u, 3, frame.viewport, size.y)};
            }
            set_viewport(e, corner, size, frame);
        } else if (e.tag == SvgTag::use) {
            frame.map = frame.map * Affine2{1, 0, along(e, 0, frame.viewport, 0.0),
                                            0, 1, along(e, 1, frame.viewport, 0.0)};
        }
    }

    void set_viewport(const SvgElement& e, Vec2 corner, Vec2 size, Frame& frame) {
        frame.map = frame.map * (e.view_box ? view_map(*e.view_box, corner, size, e.aspect)
                                            : Affine2{1, 0, corner.x, 0, 1, corner.y});
        frame.viewport = e.view_box ? Vec2{e.view_box->width, e.view_box->height} : size;
    }

    /// The root's size is the page's; where it has none, that of its view box in px. In millimetres, so that a page that is
    /// so large as its view box says keeps all numbers.
    void enter_page(const SvgElement& root, Frame& frame) {
        const auto side = [&](std::size_t i) {
            const std::optional<Length>& length = root.lengths[i];
            return length && !length->is_part() ? std::optional(length->millimetres())
                                                : std::nullopt;
        };
        const std::optional<double> width = side(2);
        const std::optional<double> height = side(3);
        constexpr double k = Length::kPixel;
        const Affine2 upwards{1, 0, 0, 0, -1, 0};
        if (!root.view_box) {
            frame.map =
                Affine2{1, 0, 0, 0, 1, height.value_or(0.0)} * upwards * Affine2{k, 0, 0, 0, k, 0};
            frame.viewport = {width.value_or(100.0 * k) / k, height.value_or(100.0 * k) / k};
            return;
        }
        const ViewBox& box = *root.view_box;
        // With one side given, the other follows in proportion.
        const Vec2 size{width    ? *width
                        : height ? *height * (box.width / box.height)
                                 : box.width * k,
                        height  ? *height
                        : width ? *width * (box.height / box.width)
                                : box.height * k};
        frame.map = Affine2{1, 0, 0, 0, 1, size.y} * upwards * view_map(box, {}, size, root.aspect);
        frame.viewport = {box.width, box.height};
    }

    void visit(std::uint32_t index, Frame frame, std::uint32_t user, bool is_called) {
        constexpr std::size_t kBetweenQuestions = 1024;
        if (++visits_ % kBetweenQuestions == 0 && !go_on_(bytes_)) {
            failed_ = true;
            failure_.code = ErrorCode::cancelled;
            return;
        }
        const SvgElement& e = document_.elements[index];
        if (visits_ > kMostVisits) {
            fail_at(e, "the drawing shows more than 10 million elements", "draw less with `use`",
                    ErrorCode::limit);
            return;
        }
        // What shows only where it is asked for: by `use`, or by its id.
        const bool is_apart = e.tag == SvgTag::hidden || e.tag == SvgTag::symbol;
        if ((is_apart && !is_called) ||
            (!e.style.is_shown.value_or(true) && !(is_called && user == kNoElement)))
            return;
        enter(index, frame, user);
        switch (e.tag) {
            case SvgTag::choice:
                frame.next_child = chosen(e);
                push(frame);
                return;
            case SvgTag::group:
            case SvgTag::svg:
            case SvgTag::symbol:
            case SvgTag::hidden:
                push(frame);
                return;
            case SvgTag::use:
                open_use(e, frame);
                return;
            case SvgTag::text:
                drawn_.texts += frame.is_visible ? 1 : 0;
                return;
            case SvgTag::image:
                drawn_.images += frame.is_visible ? 1 : 0;
                return;
            default:
                add_shape(e, frame);
        }
    }

    /// What a `switch` shows.
    std::uint32_t chosen(const SvgElement& e) {
        std::uint32_t child = e.first_child;
        for (; child != kNoElement; child = document_.elements[child].next_sibling) {
            const SvgElement& c = document_.elements[child];
            if (!c.is_conditional && c.tag != SvgTag::hidden) break;
            ++visits_;
        }
        return child;
    }

    void push(const Frame& frame) {
        is_open_[frame.element] = true;
        open_.push_back(frame);
    }

    void open_use(const SvgElement& e, Frame frame) {
        if (e.href.empty()) return;
        if (e.href[0] != '#') {
            fail_at(e, "`use` of \"" + shortened(e.href, kMostShown) + "\", which is another file",
                    "copy what is used into this one");
            return;
        }
        const auto found = document_.ids.find(e.href.substr(1));
        if (found == document_.ids.end()) {
            fail_at(e, "`use` of \"" + shortened(e.href, kMostShown) + "\", which is not there",
                    "copy what is used into this file, or leave out the `use`");
            return;
        }
        if (is_open_[found->second]) {
            fail_at(e, "`use` of \"" + shortened(e.href, kMostShown) + "\" within itself",
                    "take it out of what it shows");
            return;
        }
        if (++uses_ > kMostUses) {
            fail_at(e, "`use` is nested more than 100 deep", "let it show the shape itself",
                    ErrorCode::limit);
            return;
        }
        frame.next_child = found->second;
        push(frame);
    }

    void add_shape(const SvgElement& e, const Frame& frame) {
        if (!frame.is_visible) return;
        if (frame.map.determinant() == 0.0) {
            ++drawn_.flat;
            return;
        }
        OutlinePtr drawn = e.outline;
        if (drawn == nullptr) drawn = drawn_outline(e, frame);
        if (drawn == nullptr) return;
        if (!frame.is_filled && !takes_unfilled_) {
            ++drawn_.unfilled;
            return;
        }
        if (shapes_.size() >= kMostShapes) {
            fail_at(e, "the drawing has more than a million shapes", "draw less with `use`",
                    ErrorCode::limit);
            return;
        }
        const Affine2 turn{frame.map.xx, frame.map.xy, 0, frame.map.yx, frame.map.yy, 0};
        // Percentages may make different shapes of one element.
        const Vec2 part = e.outline != nullptr ? Vec2{} : frame.viewport;
        OutlinePtr& image =
            images_[{&e,
                     frame.is_even_odd,
                     {std::bit_cast<std::uint64_t>(turn.xx), std::bit_cast<std::uint64_t>(turn.xy),
                      std::bit_cast<std::uint64_t>(turn.yx), std::bit_cast<std::uint64_t>(turn.yy),
                      std::bit_cast<std::uint64_t>(part.x), std::bit_cast<std::uint64_t>(part.y)}}];
        if (image == nullptr) {
            Outline outline = *drawn;
            for (curves::Curve& curve : outline.curves) {
                for (curves::Span2& span : curve.spans) span = curves::mapped(span, turn);
            }
            outline.fill = frame.is_even_odd ? curves::Fill::even_odd : curves::Fill::non_zero;
            bytes_ += curves::bytes_of(outline);
            image = std::make_shared<const Outline>(std::move(outline));
        }
        shapes_.push_back(curves::contour_of(image, {frame.map.x, frame.map.y}));
        bytes_ += curves::bytes_of(*shapes_.back());
    }

    OutlinePtr drawn_outline(const SvgElement& e, const Frame& frame) const {
        const Vec2 view = frame.viewport;
        PathPen pen;
        if (e.tag == SvgTag::rectangle) {
            const Vec2 size{along(e, 2, view, 0.0), along(e, 3, view, 0.0)};
            if (!(size.x > 0.0 && size.y > 0.0)) return nullptr;
            // One radius stands for both.
            const double rx = along(e, 4, view, along(e, 5, view, 0.0));
            const double ry = along(e, 5, view, rx);
            draw_rectangle(pen, {along(e, 0, view, 0.0), along(e, 1, view, 0.0)}, size, {rx, ry});
        } else if (e.tag == SvgTag::circle || e.tag == SvgTag::ellipse) {
            // That of a square to the last digit.
            const double diagonal = view.x == view.y ? view.x : norm(view) / std::numbers::sqrt2;
            Vec2 r{length(e, 2, diagonal, 0.0), length(e, 2, diagonal, 0.0)};
            if (e.tag == SvgTag::ellipse) {
                r.x = length(e, 2, view.x, length(e, 3, view.y, 0.0));
                r.y = length(e, 3, view.y, r.x);
            }
            if (!(r.x > 0.0 && r.y > 0.0)) return nullptr;
            draw_ellipse(pen, {along(e, 0, view, 0.0), along(e, 1, view, 0.0)}, r);
        } else {
            return nullptr;
        }
        return std::make_shared<const Outline>(pen.take());
    }

    Result<Drawn> finish() {
        drawn_.shapes = shapes_.size();
        if (!shapes_.empty()) {
            const bool is_many = shapes_.size() > 1;
            drawn_.contour = curves::combined(curves::ContourOp::unite, std::move(shapes_));
            if (is_many) bytes_ += curves::bytes_of(*drawn_.contour);
        }
        drawn_.bytes = bytes_;
        drawn_.rules = document_.left_out_rules;
        return std::move(drawn_);
    }

    const SvgDocument& document_;
    bool takes_unfilled_;
    const GoOn& go_on_;
    std::vector<Frame> open_;
    std::vector<bool> is_open_;  ///< by element: whether a frame of it is open
    std::vector<curves::Contour> shapes_;
    std::map<Key, OutlinePtr> images_;
    Drawn drawn_;
    Error failure_;
    bool failed_ = false;
    std::size_t visits_ = 0;
    std::size_t uses_ = 0;
    double bytes_ = 0.0;
};

}  // namespace

Drawing::Drawing(std::unique_ptr<const SvgDocument> document) : document_(std::move(document)) {}
Drawing::~Drawing() = default;

Result<DrawingPtr> Drawing::read(std::string name, std::string bytes, const GoOn& go_on) {
    auto document = read_svg(std::move(name), std::move(bytes), go_on);
    if (!document) return Failure(std::move(document).error());
    return std::make_shared<const Drawing>(
        std::make_unique<const SvgDocument>(*std::move(document)));
}

Result<Drawn> Drawing::contour(std::string_view id, bool takes_unfilled, const GoOn& go_on) const {
    std::uint32_t selected = 0;
    if (!id.empty()) {
        const auto found = document_->ids.find(std::string(id));
        if (found == document_->ids.end()) {
            return fail(ErrorCode::name, document_->name + " has no element with the id \"" +
                                             shortened(id, kMostShown) + "\"");
        }
        selected = found->second;
    }
    return Walk(*document_, takes_unfilled, go_on).run(selected);
}

std::vector<std::string_view> Drawing::ids() const {
    std::vector<std::string_view> out;
    for (const auto& [id, element] : document_->ids) out.push_back(id);
    return out;
}

double Drawing::bytes() const {
    double bytes = static_cast<double>(document_->text.size() +
                                       document_->elements.capacity() * sizeof(SvgElement));
    for (const SvgElement& element : document_->elements) {
        if (element.outline != nullptr) bytes += curves::bytes_of(*element.outline);
    }
    return bytes;
}

}  // namespace raymo::drawings
