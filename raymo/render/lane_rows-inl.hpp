// Rows of whole numbers, one for each ray of a packet; included once per instruction set, inside HWY_NAMESPACE.

/// Where a row is what it is at `lane`.
HWY_INLINE LaneBits equal_in_row(const std::uint32_t (&row)[kRays], int lane) {
    const hn::CappedTag<std::uint32_t, kRays> tag;
    const auto wanted = hn::Set(tag, row[lane]);
    LaneBits equal = 0;
    for (std::size_t first = 0; first < kRays; first += hn::Lanes(tag)) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(tag, hn::Eq(hn::Load(tag, row + first), wanted), bytes);
        equal |= static_cast<LaneBits>(bytes[0] | bytes[1] << 8) << first;
    }
    return equal;
}
