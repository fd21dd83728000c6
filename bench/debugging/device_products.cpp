#include "bench/debugging/device_products.h"

#include <algorithm>
#include <bit>

namespace tetrace {

namespace {

using Numbers = std::vector<float>;

std::uint32_t bits(float number)
{
    return std::bit_cast<std::uint32_t>(number);
}

/// Sums and products of many pairs of numbers, by the device.
class Arithmetic {
public:
    explicit Arithmetic(const RunOperations& run) : run_(run) {}

    [[nodiscard]] Numbers sum(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_ADD, bits(x), bits(y), 0}; });
    }
    /// -b is exact on the host.
    [[nodiscard]] Numbers difference(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_ADD, bits(x), bits(-y), 0}; });
    }
    [[nodiscard]] Numbers product(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_MULTIPLY, bits(x), 0, bits(y)}; });
    }

private:
    template <class Operation>
    [[nodiscard]] Numbers each(const Numbers& a, const Numbers& b, const Operation& operation) const
    {
        std::vector<Quad> quads;
        for (std::size_t i = 0; i < a.size(); ++i)
            quads.push_back(operation(a[i], b[i]));
        Numbers results;
        for (const std::uint32_t word : run_(quads))
            results.push_back(std::bit_cast<float>(word));
        results.resize(a.size());
        return results;
    }

    const RunOperations& run_;
};

/// The vectors after one another, so that one program computes them all.
Numbers joined(const std::vector<Numbers>& parts)
{
    Numbers all;
    for (const Numbers& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Numbers> parted(const Numbers& all, std::size_t parts)
{
    std::vector<Numbers> result;
    const auto size = static_cast<std::ptrdiff_t>(all.size() / parts);
    for (std::size_t i = 0; i < parts; ++i) {
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(i) * size;
        result.emplace_back(first, first + size);
    }
    return result;
}

} // namespace

std::vector<float> side_products(const Float3& origin, const Float3& direction, const std::vector<PassedEdge>& edges,
                                 const RunOperations& run)
{
    if (edges.empty()) return {};
    const Arithmetic device(run);
    std::vector<Numbers> ends, origins, directions; // a.x, a.y, a.z, b.x, b.y, b.z
    for (const auto end : {&PassedEdge::a, &PassedEdge::b})
        for (int axis = 0; axis < 3; ++axis) {
            Numbers& numbers = ends.emplace_back();
            for (const PassedEdge& edge : edges)
                numbers.push_back((edge.*end)[axis]);
            origins.emplace_back(edges.size(), origin[axis]);
        }
    for (int axis = 0; axis < 3; ++axis)
        directions.emplace_back(edges.size(), direction[axis]);
    const auto p = parted(device.difference(joined(ends), joined(origins)), 6);
    // The products of p x q: y z, z x, x y, then z y, x z, y x.
    const Numbers left = joined({p[1], p[2], p[0], p[2], p[0], p[1]}),
                  right = joined({p[5], p[3], p[4], p[4], p[5], p[3]});
    const auto terms = parted(device.product(left, right), 2);
    const Numbers cross = device.difference(terms[0], terms[1]);
    const auto weighted = parted(device.product(joined(directions), cross), 3);
    return device.sum(device.sum(weighted[0], weighted[1]), weighted[2]);
}

} // namespace tetrace
