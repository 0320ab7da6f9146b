// The state of up to L rays on their way through a scene, and what does not depend on the
// instruction set: events, Booleans, and the choice of the surface. The walk itself is in walk.cpp.
//
// Each leaf that a ray meets gives events: it is entered or left at t, known to within an error.
// Events are sorted by the earliest t they may stand at. Events whose uncertain places overlap form
// a cluster: all of them are applied before the solid is asked whether anything changed. So faces
// that coincide cancel, and a part thinner than the error is nothing. A cluster is final once no
// unopened box may still add to it.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "raymo/math/lanes.hpp"
#include "raymo/trace/data.hpp"
#include "raymo/trace/packet.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::trace {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Mode : std::uint8_t {
    first,  ///< the first change of any part after the start
    any,    ///< whether an opaque part is met between start and limit
    all,    ///< every change along the whole line
    /// As any, but the transparent parts on the way are told; for packets through simple solids only.
    through,
};

/// A leaf is entered or left. t is along the ray of the base frame (see RayState::shift).
struct Event {
    double lo;  ///< t - error: events are sorted by this
    double t;
    double error;  ///< of an uncertain event: how far to step aside, instead
    double near;   ///< lo, if the ray starts on a surface to within RayQuery::start_error
    std::uint32_t leaf;
    std::uint32_t context;
    std::uint16_t face;
    bool enter;
    bool uncertain;  ///< no crossing: the ray runs in the leaf's boundary from here on
    bool idle;       ///< nothing changes, but the leaf may be touched here: joins what it overlaps

    [[nodiscard]] double hi() const { return t + error; }
};

/// A part's boundary is crossed: the event that shows it and the media on both sides.
struct Crossing {
    Event event;
    std::uint32_t part;
    bool entering;
    csg::MaterialId material, before, after;
};

/// A part that the ray is in, with the material of the surface through which it came.
struct Medium {
    std::uint32_t part;
    csg::MaterialId material;
};

/// One ray.
struct Lane {
    std::vector<Event> events;  ///< sorted from `head` on; before it, those already applied
    std::size_t head = 0;
    std::vector<Medium> inside;       ///< latest last
    std::vector<Crossing> crossings;  ///< mode first: at most one; mode all: all
    double start = 0.0;               ///< t of the ray's own start
    double limit = kInfinity;         ///< t of its end
    bool done = false;
    bool blocked = false;        ///< mode any: the answer
    bool stepped_aside = false;  ///< the answer is void: the ray ran in a boundary
    bool is_blurred = false;     ///< or might have met things in another order than was told
    double step = 0.0;           ///< and should be moved sideways by this much (base frame)

    void reset(double from, double to) {
        events.clear();
        head = 0;
        inside.clear();
        crossings.clear();
        start = from;
        limit = to;
        done = blocked = stepped_aside = is_blurred = false;
        step = 0.0;
    }
    void insert(const Event& event) {
        std::size_t i = events.size();
        events.push_back(event);
        while (i > head && events[i - 1].lo > event.lo) {
            events[i] = events[i - 1];
            --i;
        }
        events[i] = event;
    }
};

/// The rays as seen in the frame of one compiled solid: context 0 is the base, others are opened
/// instances.
template <int L>
struct alignas(64) Context {
    double o[3][L], d[3][L];
    float fo[3][L], inverse[3][L];  ///< for boxes
    float from[L], to[L];           ///< start and limit in this frame
    double t0[L];                   ///< t of the base = t0 + t of this frame
    double error[L];                ///< of the ray's place, in this frame
    double start_error[L];          ///< of the ray's start on its surface, in this frame
    double size;                    ///< of one unit of this frame, in the base frame
    const CompiledSolid* solid;
    std::uint32_t parent;  ///< context
    std::uint32_t leaf;    ///< the instance, in the parent's solid
    std::uint32_t path;    ///< tells instances apart
    bool cuts;
    csg::MaterialId material;  ///< of leaves without one
};

/// A lower bound of t0 + t, for a t in a context that was found in floats (its own rounding is
/// covered by the boxes).
[[nodiscard]] inline double base_t(double t0, double t) {
    return (t0 + t) - 0x1p-50 * (t0 < 0.0 ? -t0 : t0);
}

/// Fills the float copies of ray `i` of a context from o, d and t0.
template <int L>
inline void set_box_ray(Context<L>& c, int i, double start, double limit, bool whole_line) {
    for (int a = 0; a < 3; ++a) {
        // A direction along the box is tilted a little, so that no product of 0 and infinity
        // arises.
        constexpr double kTilt = 1e-20;
        const double d = c.d[a][i];
        const double tilted = d < 0.0 ? (d > -kTilt ? -kTilt : d) : (d < kTilt ? kTilt : d);
        c.fo[a][i] = static_cast<float>(c.o[a][i]);
        c.inverse[a][i] = static_cast<float>(1.0 / tilted);
    }
    const double slack = 0x1p-20 * (c.t0[i] < 0.0 ? -c.t0[i] : c.t0[i]);
    const double from = start - c.t0[i];
    const double to = limit - c.t0[i];
    c.from[i] = whole_line
                    ? -std::numeric_limits<float>::infinity()
                    : static_cast<float>(from - slack - 0x1p-20 * (from < 0.0 ? -from : from));
    c.to[i] = whole_line ? std::numeric_limits<float>::infinity()
                         : static_cast<float>(to + slack + 0x1p-20 * (to < 0.0 ? -to : to));
}

/// Counters of the groups that the rays have touched, by context and group.
template <int L>
class Counters {
public:
    void reset() {
        if (++stamp_ == 0) {
            for (Slot& slot : slots_) slot.stamp = 0;
            stamp_ = 1;
        }
        used_ = 0;
    }
    /// The counters of a group, set to `initial` at the first touch. Valid until the next call.
    [[nodiscard]] std::int32_t* find(std::uint32_t context, std::uint32_t group,
                                     std::int32_t initial) {
        const std::uint64_t key = (std::uint64_t{context} << 32) | group;
        if (2 * (used_ + 1) > slots_.size()) grow();
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t i = hash(key) & mask;; i = (i + 1) & mask) {
            Slot& slot = slots_[i];
            if (slot.stamp == stamp_ && slot.key == key) return slot.count;
            if (slot.stamp != stamp_) {
                slot.stamp = stamp_;
                slot.key = key;
                for (std::int32_t& c : slot.count) c = initial;
                ++used_;
                return slot.count;
            }
        }
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t stamp = 0;
        std::int32_t count[L];
    };
    static std::size_t hash(std::uint64_t key) {
        return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> 40);
    }
    void grow() {
        std::vector<Slot> old = std::move(slots_);
        slots_.assign(old.empty() ? 64 : old.size() * 2, {});
        const std::size_t mask = slots_.size() - 1;
        for (const Slot& slot : old) {
            if (slot.stamp != stamp_) continue;
            std::size_t i = hash(slot.key) & mask;
            while (slots_[i].stamp == stamp_) i = (i + 1) & mask;
            slots_[i] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
    std::uint32_t stamp_ = 1;
};

/// A box yet to be opened. `t`: no lane of `lanes` enters it earlier (base frame).
struct Unopened {
    double t;
    std::uint32_t ref;
    std::uint32_t context;
    std::uint8_t count;   ///< leaves; 0: a node
    std::uint32_t lanes;  ///< bit i: ray i meets the box
};

/// The same in the walk of a simple solid. Two words, so that what has just been put on a list can be read from the
/// processor's store buffer.
struct NearBox {
    std::uint64_t where, who;

    NearBox() = default;
    NearBox(float at, std::uint32_t ref, std::uint32_t count, std::uint32_t lanes)
        : where(static_cast<std::uint64_t>(ref) << 32 | std::bit_cast<std::uint32_t>(at)),
          who(static_cast<std::uint64_t>(count) << 32 | lanes) {}
    /// Where the first of the rays enters it, at the earliest.
    [[nodiscard]] float t() const {
        return std::bit_cast<float>(static_cast<std::uint32_t>(where));
    }
    [[nodiscard]] std::uint32_t ref() const { return static_cast<std::uint32_t>(where >> 32); }
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(who >> 32); }
    [[nodiscard]] std::uint32_t lanes() const { return static_cast<std::uint32_t>(who); }
};

/// A box of a tree of cutters, and the rays of a packet that look for some there.
struct CutterNode {
    std::uint32_t ref;
    std::uint32_t count;  ///< leaves; 0: a node
    std::uint32_t lanes;
};

/// How near a box is.
[[nodiscard]] inline double entry(const Unopened& box) { return box.t; }
[[nodiscard]] inline float entry(const NearBox& box) { return box.t(); }

/// Boxes to be opened, sorted with the nearest last.
template <class Box>
struct BoxList {
    std::vector<Box> room = std::vector<Box>(64);
    std::size_t count = 0;

    void make_room(std::size_t more) {
        if (count + more > room.size()) room.resize(2 * room.size() + more);
    }
    /// Puts a box in its place among those from number `base` on. There must be room.
    RAYMO_INLINE void put(const Box& box, std::size_t base = 0) {
        Box* list = room.data();
        std::size_t i = count++;
        while (i > base && entry(list[i - 1]) < entry(box)) {
            list[i] = list[i - 1];
            --i;
        }
        list[i] = box;
    }
    [[nodiscard]] const Box& last() const { return room[count - 1]; }
};

/// The nearest surface of each ray of a packet, as nearest-inl.hpp finds it; what the names mean is told there.
struct alignas(64) Nearest {
    double lo[kRays], t[kRays], hi[kRays], error[kRays], face[kRays], leaf[kRays];
    double inside[kRays];  ///< leaf that the ray starts in, or -1
    double second_lo[kRays], start_hi[kRays], trouble_lo[kRays];
    double start[kRays], limit[kRays], shift[kRays], t_per_s[kRays];
    std::uint32_t found;
    std::uint32_t deferred;
    bool on_surface;  ///< some ray starts on a surface
};

/// Spans of transparent parts on the way of a packet, in their order; see passages-inl.hpp.
struct Passages {
    static constexpr int kMost = PassagePacket::kMost / 2;
    struct alignas(64) End {
        double lo[kRays], hi[kRays], t[kRays], error[kRays], face[kRays];
        LaneBits lanes;  ///< rays that cross it
    };
    struct Span {
        End enter, exit;
        std::uint32_t leaf;
    };
    Span spans[kMost];
    int count;
    LaneBits overflown;  ///< rays that cross more
};

template <int L>
struct Walker {
    const CompiledScene::Data* data = nullptr;
    Mode mode = Mode::first;
    bool ignore_uncertain = false;  ///< after too many steps aside: take crossings as they are
    bool ignore_blur = false;       ///< the same of those that are blurred
    std::uint32_t active = 0;       ///< bit i: ray i is in use and not done
    Lane lanes[L];
    std::vector<Context<L>> contexts;
    Counters<L> counters;
    BoxList<Unopened> unopened;
    std::uint64_t boxes = 0, leaves = 0;
    Nearest nearest;                       ///< packets only
    Passages passages;                     ///< mode through
    BoxList<NearBox> near_boxes;           ///< of the walk of a simple solid
    std::vector<CutterNode> cutter_nodes;  ///< of a product, level by level

    /// Applies all clusters of a ray that end before `horizon`, until it is done.
    void advance(int lane, double horizon);
    /// The ray has met everything: settles what is left.
    void finish(int lane);

    [[nodiscard]] const Leaf& leaf_of(const Event& e) const {
        return contexts[e.context].solid->leaves[e.leaf];
    }
    [[nodiscard]] bool is_opaque(csg::MaterialId m) const { return !data->is_transparent(m); }

private:
    struct Change {
        std::uint32_t part;
        bool inside;
    };
    /// A group whose value changed within the cluster in hand, and may have changed back.
    struct Turned {
        std::uint32_t context;
        std::uint32_t group;
        bool before;
    };
    void flip(int lane, const Event& event);
    void settle(int lane, std::size_t end);
    [[nodiscard]] double blurred(int lane, std::size_t end) const;
    [[nodiscard]] const Event& shown_by(int lane, std::size_t end, const Change& change);
    [[nodiscard]] std::uint32_t part_of(const Event& event) const;
    [[nodiscard]] csg::MaterialId material_of(const Lane& lane, const Event& event,
                                              std::size_t end) const;

    /// The group above a group or instance; false at the root of a part.
    [[nodiscard]] bool climb(std::uint32_t& context, std::uint32_t& group) const;
    [[nodiscard]] bool turned(int lane, const Event& event);
    [[nodiscard]] bool below(const Event& event, std::uint32_t context, std::uint32_t group) const;
    [[nodiscard]] bool left_of(const Event& a, const Event& b) const;

    std::vector<Change> changes_;
    std::vector<Turned> turned_;
};

extern template struct Walker<1>;
extern template struct Walker<kRays>;

}  // namespace raymo::trace
