#include "raymo/blends/near_side.hpp"

namespace raymo::blends {
namespace {

/// How far the ruled surfaces may pass the contacts by, as part of the radius.
constexpr double kContact = 0x1p-16;

class BallSide final : public NearSide {
public:
    BallSide(const Spine& spine, double depth) : spine_(spine), depth_(depth) {}

    bool place(const Station& station, NearPlace& out) const override {
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3 contact = station.contact[i];
            out.ends[i] = contact + (contact - station.centre) * depth_;
        }
        return true;
    }

    bool append(const Station& a, const NearPlace& from, const Station& middle,
                const NearPlace& middle_near, const Station& b, const NearPlace& to, Cubic ends[2],
                std::vector<meshes::GivenNet>& nets) const override {
        static_cast<void>(middle);
        static_cast<void>(middle_near);
        const Cubic path = path_between(a, b);
        const auto beside = spine_.between(a, b, value_at(path, 0.5));
        if (!beside) return false;
        const double ahead = norm(path[1] - path[0]);
        const double behind = norm(path[3] - path[2]);
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3 p = from.ends[i];
            const Vec3 q = to.ends[i];
            const double out = 1.0 + depth_;
            const Vec3 way_p = a.tangent + (a.way[i] - a.tangent) * out;
            const Vec3 way_q = b.tangent + (b.way[i] - b.tangent) * out;
            ends[i] = {p, p + way_p * ahead, q - way_q * behind, q};
            if (!meets(path, ends[i], *beside, i)) return false;
        }
        nets.push_back(ruled(path, ends[0]));
        nets.push_back(ruled(ends[1], path));
        return true;
    }

private:
    /// Whether the ruled surface between two lines meets the contact at the middle.
    [[nodiscard]] bool meets(const Cubic& path, const Cubic& line, const Station& middle,
                             std::size_t which) const {
        const Vec3 c = value_at(path, 0.5);
        const Vec3 out = unit(value_at(line, 0.5) - c);
        const Vec3 d = middle.contact[which] - c;
        // Along the path it does not matter.
        Vec3 off = d - out * dot(d, out);
        off = off - middle.tangent * dot(off, middle.tangent);
        return norm(off) <= kContact * spine_.radius();
    }

    const Spine& spine_;
    double depth_;
};

}  // namespace

std::unique_ptr<NearSide> ball_side(const Spine& spine, double depth) {
    return std::make_unique<BallSide>(spine, depth);
}

}  // namespace raymo::blends
