// What is told of the surfaces that a packet meets in a simple solid; included by walk.cpp once per instruction set, inside
// HWY_NAMESPACE.

/// The material that the surface of leaf `index` shows.
HWY_INLINE csg::MaterialId material_shown(const Walker<kRays>& w, std::uint32_t index) {
    const CompiledSolid& base = *w.contexts[0].solid;
    const Look& look = w.data->looks[base.leaves[index].look];
    if (!look.borrows) return look.material;
    // The ray is in all positive leaves of the product here: the leftmost that has a material lends it.
    csg::MaterialId material = look.material;
    std::uint32_t first = base.groups[base.leaves[index].parent].core;
    if (first == kNone) first = index;
    while (base.leaves[first].unit == 0) --first;
    std::uint32_t order = kNone;
    for (std::uint32_t k = first; k < first + base.leaves[first].unit; ++k) {
        const Look& other = w.data->looks[base.leaves[k].look];
        if (other.cuts || other.material == csg::kNoMaterial || base.leaves[k].order >= order)
            continue;
        order = base.leaves[k].order;
        material = other.material;
    }
    return material;
}

/// Puts a number into the lanes `lanes`.
HWY_INLINE void put(std::uint32_t value, std::uint32_t lanes, std::uint32_t* to) {
    const hn::CappedTag<std::uint32_t, kRays> u;
    for (std::size_t first = 0; first < kRays; first += hn::Lanes(u)) {
        const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes >> first),
                                       static_cast<std::uint8_t>(lanes >> first >> 8)};
        const auto mask = hn::LoadMaskBits(u, bytes);
        hn::Store(hn::IfThenElse(mask, hn::Set(u, value), hn::Load(u, to + first)), u, to + first);
    }
}

/// Fills in what is told of the rays `same`, which all meet the surface of one leaf. `number`: as in Nearest::leaf.
HWY_INLINE void finish_leaf(const Walker<kRays>& w, double number, std::uint32_t same,
                            HitPacket& hits) {
    const Nearest& n = w.nearest;
    const Context<kRays>& c = w.contexts[0];
    const CompiledSolid& base = *c.solid;
    const auto index = static_cast<std::uint32_t>(number);
    const bool entering = number == static_cast<double>(index);
    const Leaf& leaf = base.leaves[index];
    const Frame& frame = w.data->frames[leaf.frame];
    const csg::MaterialId material = material_shown(w, index);
    std::uint32_t part = leaf.parent;
    while (part >= base.parts) part = base.groups[part].parent;
    put(part, same, hits.part);
    put(material, same, hits.material);
    put(Hit::kAir, same, hits.medium_before);
    put(entering ? material : Hit::kAir, same, hits.medium_after);
    put(base.first_leaf + index, same, hits.leaf);
    put(0, same, hits.instance);
    hits.entering = (hits.entering & ~same) | (entering ? same : 0U);
    std::uint32_t inside = 0;
    for (int i = 0; i < kRays; i += kLanes) inside |= bits(load(n.inside + i) >= Lanes(0.0)) << i;
    for (inside &= same; inside != 0; inside &= inside - 1) {
        const int i = __builtin_ctz(inside);
        const Leaf& around = base.leaves[static_cast<std::uint32_t>(n.inside[i])];
        hits.medium_before[i] = w.data->looks[around.look].material;
    }

    const Lanes sign(w.data->looks[leaf.look].cuts ? -1.0 : 1.0);
    for (int first = 0; first < kRays; first += kLanes) {
        const std::uint32_t here = (same >> first) & ((1U << kLanes) - 1U);
        if (here == 0) continue;
        const Mask mask = mask_of(here);
        const Triple<Lanes> o{load(c.o[0] + first), load(c.o[1] + first), load(c.o[2] + first)};
        const Triple<Lanes> d{load(c.d[0] + first), load(c.d[1] + first), load(c.d[2] + first)};
        const Lanes t = load(n.t + first);
        const Lanes face = load(n.face + first);
        Triple<Lanes> normal{Lanes(0.0), Lanes(0.0), Lanes(0.0)};
        if (!kFlatFaces[frame.type]) {
            const Local<Lanes> local =
                localise<Lanes>(frame, leaf, o.x, o.y, o.z, d.x, d.y, d.z, load(c.error + first));
            normal = place_in_leaf(local, t);
        }
        if (frame.in_blocks) {
            solids::PlaceBlock places;
            store(normal.x, places.p[0]);
            store(normal.y, places.p[1]);
            store(normal.z, places.p[2]);
            store(face, places.face);
            block_normals(w.data->kernels, frame, places, here);
            normal = {load(places.p[0]), load(places.p[1]), load(places.p[2])};
        } else {
            visit_kernel(w, frame, [&]<class K>(const K& kernel) {
                if constexpr (kSpansInLanes < K >> 0 && !BlockKernel<K>)
                    lane_normal(kernel, face, normal.x, normal.y, normal.z);
            });
        }
        normal = normal_outside(frame, normal);
        const Surface<Lanes> surface = surface_at(base, o, d, normal, t, load(n.error + first),
                                                  load(n.shift + first), load(n.t_per_s + first));
        const auto put_lanes = [&](Lanes value, double* to) {
            store(lane_select(mask, value, load(to + first)), to + first);
        };
        put_lanes(sign * normal.x, hits.normal[0]);
        put_lanes(sign * normal.y, hits.normal[1]);
        put_lanes(sign * normal.z, hits.normal[2]);
        put_lanes(surface.t, hits.t);
        put_lanes(surface.error, hits.error);
        put_lanes(surface.x, hits.point[0]);
        put_lanes(surface.y, hits.point[1]);
        put_lanes(surface.z, hits.point[2]);
        put_lanes(surface.point_error, hits.point_error);
    }
    for (std::uint32_t rest = same; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        hits.face[i] = static_cast<std::uint32_t>(n.face[i]);
    }
}

/// Fills in what is told of the surfaces that the rays `lanes` meet, leaf by leaf.
HWY_INLINE void finish_surfaces(const Walker<kRays>& w, std::uint32_t lanes, HitPacket& hits) {
    const Nearest& n = w.nearest;
    for (std::uint32_t rest = lanes; rest != 0;) {
        const double number = n.leaf[__builtin_ctz(rest)];
        std::uint32_t same = 0;
        for (int i = 0; i < kRays; i += kLanes)
            same |= bits(load(n.leaf + i) == Lanes(number)) << i;
        same &= rest;
        rest &= ~same;
        finish_leaf(w, number, same, hits);
    }
}
