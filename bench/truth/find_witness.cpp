// Where to look for a witness. All of it is a guess in double precision: is_witness() decides.
#include "bench/truth/tube.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace tetrace {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

using namespace tube;

// The space along a line between two facets that it passes through.
struct Gap {
    double from, to;
    std::uint32_t next; // the triangle at its far end; NO_HIT: none
};

class Search {
public:
    Search(const TriangleMesh& mesh, const WitnessQuestion& question)
        : mesh_(mesh), question_(question), frame_(question.ray), radius_(question.bound * 0.98)
    {
        for (const std::uint32_t triangle : question.obstacles)
            add_facet(triangle);
        find_lines();
    }

    [[nodiscard]] Witness run()
    {
        if (is_closed()) return {};
        for (const std::size_t most : {std::size_t{6}, std::size_t{24}}) {
            places_.clear();
            choose_places(most);
            if (Witness straight = straight_witness(); !straight.empty()) return straight;
            if (lines_.size() <= most) break;
        }
        for (const std::size_t most : {std::size_t{6}, std::size_t{16}}) {
            places_.clear();
            choose_places(most);
            if (Witness bent = bent_witness(); !bent.empty()) return bent;
            if (lines_.size() <= most) break;
        }
        return {};
    }

private:
    void add_facet(std::uint32_t triangle)
    {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        facets_.push_back(
            {triangle,
             {frame_.local(mesh_.vertices[a]), frame_.local(mesh_.vertices[b]), frame_.local(mesh_.vertices[c])}});
    }

    struct Ranked {
        EdgeLine line;
        double rank;
    };

    // The lines of edges within the bound: the answer's own first, then the nearest.
    void find_lines()
    {
        std::map<std::pair<std::uint32_t, std::uint32_t>, Ranked> edges;
        for (const Facet& facet : facets_) {
            const auto& vertices = mesh_.triangles[facet.triangle];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3;
                const Double2 p = across(facet.corners[i]), pq = across(facet.corners[j]) - p;
                const double square = dot(pq, pq);
                const double s = square > 0 ? std::clamp(-dot(p, pq) / square, 0.0, 1.0) : 0;
                const double distance = length(p + pq * s);
                if (distance > question_.bound || square == 0) continue;
                const double rank = facet.triangle == question_.answer ? -1 : distance;
                const auto [place, is_new] = edges.try_emplace(std::minmax(vertices[i], vertices[j]),
                                                               Ranked{{p, pq * (1 / std::sqrt(square))}, rank});
                if (!is_new) place->second.rank = std::min(place->second.rank, rank);
            }
        }
        std::vector<Ranked> ranked;
        for (const auto& [vertices, edge] : edges)
            ranked.push_back(edge);
        if (question_.part.start != NO_HIT) add_start_lines(ranked);
        std::ranges::stable_sort(ranked, {}, &Ranked::rank);
        for (const Ranked& edge : ranked)
            lines_.push_back(edge.line);
    }

    // Where the planes of triangles are met at the origin's depth. On one side of such a line a triangle is farther
    // than a curve's start, on the other ahead.
    void add_start_lines(std::vector<Ranked>& ranked) const
    {
        const std::size_t edges = ranked.size();
        for (const Facet& facet : facets_) {
            const Double3 normal = cross(facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]);
            const double slope = length(across(normal));
            if (slope == 0) continue;
            const Double2 unit = across(normal) * (1 / slope);
            const double distance = dot(normal, facet.corners[0]) / slope;
            if (std::abs(distance) > question_.bound) continue;
            const EdgeLine line{unit * distance, {-unit.y, unit.x}};
            const bool is_there = std::any_of(ranked.begin() + static_cast<std::ptrdiff_t>(edges), ranked.end(),
                                              [&](const Ranked& other) {
                                                  return std::abs(cross(other.line.along, line.along)) < 1e-12 &&
                                                         std::abs(other.line.side(line.point)) < radius_ * 1e-9;
                                              });
            if (!is_there) ranked.push_back({line, std::abs(distance)});
        }
    }

    // A point of the answer's triangle inside the tube, and one near the origin where curves begin anywhere there.
    void add_answer_places()
    {
        for (const Facet& facet : facets_) {
            if (facet.triangle != question_.answer) continue;
            const auto& [first, second, third] = facet.corners;
            std::tie(answer_from_, answer_to_) = std::minmax({first.z, second.z, third.z});
            const double reach = radius_ * 0.98;
            if (question_.part.start != NO_HIT)
                add_places_at(facet, point_within(facet, reach, [](Double3 point) { return point; }));
            add_places_at(facet, point_within(facet, reach, across));
        }
    }

    // That of the answer's triangle, and both sides of it, where a triangle seen edge-on is met at its depth.
    void add_places_at(const Facet& facet, const std::optional<Double3>& point)
    {
        if (!point) return;
        const auto& [first, second, third] = facet.corners;
        const Double2 slope = across(cross(second - first, third - first));
        const Double2 aside = slope * (radius_ / (1024 * std::max(length(slope), 1e-300)));
        for (const Double2 place : {across(*point), across(*point) + aside, across(*point) - aside})
            if (length(place) <= radius_) places_.push_back(place);
        answer_depth_ = point->z;
    }

    // Whether one triangle covers the tube's cross-section before the answer's triangle: then there is no way.
    [[nodiscard]] bool is_closed() const
    {
        double answer = never;
        for (const Facet& facet : facets_)
            if (facet.triangle == question_.answer)
                answer = std::min({facet.corners[0].z, facet.corners[1].z, facet.corners[2].z});
        const double end = question_.part.has_end() && question_.answer == NO_HIT ? end_depth() : never;
        for (const Facet& facet : facets_) {
            if (facet.triangle == question_.answer) continue;
            const auto [low, high] = depths_across(facet, question_.bound);
            if (low > starts_by() && high < std::min(answer, end)) return true;
        }
        return false;
    }
    [[nodiscard]] double starts_by() const { return question_.part.start == NO_HIT ? 0 : question_.bound; }
    [[nodiscard]] double end_depth() const
    {
        return static_cast<double>(question_.part.end) * tetrace::length(to_double(question_.ray.direction));
    }

    // Places on both sides of each piece into which the lines cut each other inside the tube: every cell that the lines
    // make has one. With few of the lines, cells are missed.
    void choose_places(std::size_t max_lines)
    {
        places_.push_back({});
        add_answer_places();
        for (const auto& [x, y] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}})
            places_.push_back(Double2{0.5 * x + 0.25 * y, 0.5 * y - 0.25 * x} * radius_);
        const std::size_t count = std::min(lines_.size(), max_lines);
        for (std::size_t i = 0; i < count; ++i) {
            const EdgeLine& line = lines_[i];
            const Double2 foot = line.point - line.along * dot(line.point, line.along);
            const double square = radius_ * radius_ - dot(foot, foot);
            if (square <= 0) continue;
            std::vector<double> cuts{-std::sqrt(square), std::sqrt(square)};
            for (std::size_t j = 0; j < count; ++j) {
                const double turn = cross(lines_[j].along, line.along);
                if (j == i || std::abs(turn) < 1e-12) continue;
                const double at = -lines_[j].side(foot) / turn;
                if (std::abs(at) < cuts[1]) cuts.push_back(at);
            }
            std::ranges::sort(cuts);
            for (std::size_t k = 1; k < cuts.size(); ++k)
                if (cuts[k] > cuts[k - 1])
                    add_both_sides(line, foot + line.along * ((cuts[k] + cuts[k - 1]) / 2), count);
        }
        // On a line, double precision cannot decide what is met.
        std::erase_if(places_, [&](Double2 place) {
            return std::ranges::any_of(
                lines_, [&](const EdgeLine& line) { return std::abs(line.side(place)) < radius_ * 1e-9; });
        });
    }

    void add_both_sides(const EdgeLine& line, Double2 middle, std::size_t count)
    {
        for (const double sense : {-1.0, 1.0}) {
            const Double2 normal{-line.along.y * sense, line.along.x * sense};
            double clear = radius_ / 16;
            for (std::size_t j = 0; j < count; ++j) {
                const double approach = cross(lines_[j].along, normal), side = lines_[j].side(middle);
                if (std::abs(side) < radius_ * 1e-9 || approach * side >= 0)
                    continue; // that line itself, or moving away
                clear = std::min(clear, -side / approach);
            }
            const Double2 place = middle + normal * (clear / 2);
            if (length(place) <= radius_) places_.push_back(place);
        }
    }

    // What a line along the ray passes through, ascending, as the gaps between.
    [[nodiscard]] std::vector<Gap> gaps_at(Double2 place) const
    {
        std::vector<std::pair<double, std::uint32_t>> depths;
        for (const Facet& facet : facets_)
            if (const auto depth = depth_at(facet, place)) depths.emplace_back(*depth, facet.triangle);
        std::ranges::sort(depths);
        std::vector<Gap> gaps;
        double from = -never;
        for (const auto& [depth, triangle] : depths) {
            gaps.push_back({from, depth, triangle});
            from = depth;
        }
        gaps.push_back({from, never, NO_HIT});
        return gaps;
    }

    // Where a curve may begin on the line through a place: the origin's depth, or anywhere within the bound of it.
    struct Start {
        double from, to;
    };
    [[nodiscard]] Start start_at(Double2 place) const
    {
        if (question_.part.start == NO_HIT) return {0, 0};
        const double reach = std::sqrt(std::max(0.0, radius_ * radius_ - dot(place, place)));
        return {-reach, reach};
    }

    [[nodiscard]] double last_depth() const
    {
        double last = question_.bound;
        for (const Facet& facet : facets_)
            for (const Double3& corner : facet.corners)
                last = std::max(last, corner.z + question_.bound);
        return question_.part.has_end() ? std::min(last, end_depth() * (1 + 1e-14) + 1e-15) : last;
    }

    // The depth at which the line through a place ends, past the gap's far end; or nothing if that is another
    // triangle's.
    [[nodiscard]] std::optional<double> finish(const std::vector<Gap>& gaps, std::size_t gap) const
    {
        const bool ends_before = question_.part.has_end() && gaps[gap].to > end_depth();
        if (question_.answer == NO_HIT)
            return gaps[gap].next == NO_HIT || ends_before ? std::optional(last_depth()) : std::nullopt;
        if (gaps[gap].next != question_.answer) return std::nullopt;
        const double beyond = gap + 1 < gaps.size() ? gaps[gap + 1].to - gaps[gap].to : never;
        return gaps[gap].to + std::min(beyond / 2, question_.bound);
    }

    [[nodiscard]] Witness checked(const std::vector<std::pair<Double2, double>>& points) const
    {
        Witness witness;
        if (question_.part.start == NO_HIT) witness.push_back({});
        double least = question_.part.start == NO_HIT ? 4e-15 : -never; // rounding must not turn the curve back
        for (const auto& [place, wanted] : points) {
            const double depth = std::max(wanted, least);
            witness.push_back(frame_.corner(place, depth));
            least = depth + 4e-15 * (1 + std::abs(depth));
        }
        return is_witness(mesh_, question_, witness) ? witness : Witness{};
    }

    [[nodiscard]] Witness straight_witness() const
    {
        for (const Double2 place : places_) {
            const auto gaps = gaps_at(place);
            const Start start = start_at(place);
            for (std::size_t gap = 0; gap < gaps.size(); ++gap) {
                const double from = std::max(gaps[gap].from, start.from), to = std::min(gaps[gap].to, start.to);
                if (from > to) continue;
                const auto end = finish(gaps, gap);
                if (!end) continue;
                const double begin = from == gaps[gap].from || to == gaps[gap].to ? (from + to) / 2 : to;
                Witness found = checked({{place, begin}, {place, *end}});
                if (!found.empty()) return found;
            }
        }
        return {};
    }

    struct Node {
        std::size_t place, gap;
        double arrival = never;
        std::size_t before = SIZE_MAX;
        bool is_done = false;
    };

    [[nodiscard]] bool is_free(Double3 from, Double3 to) const
    {
        return std::ranges::none_of(facets_, [&](const Facet& facet) { return is_met(facet, from, to); });
    }

    // Moves from gap to gap of neighbouring lines, always to the gap that is reached first.
    [[nodiscard]] Witness bent_witness() const
    {
        std::vector<std::vector<Gap>> gaps;
        std::vector<Node> nodes;
        for (std::size_t place = 0; place < places_.size(); ++place) {
            gaps.push_back(gaps_at(places_[place]));
            const Start start = start_at(places_[place]);
            for (std::size_t gap = 0; gap < gaps.back().size(); ++gap) {
                const Gap& here = gaps.back()[gap];
                const double from = std::max(here.from, start.from), to = std::min(here.to, start.to);
                Node node{place, gap};
                const bool starts =
                    question_.part.start != NO_HIT ? from < to : from <= to && is_free({}, at(place, 1e-14));
                if (starts) node.arrival = from == here.from ? from + (to - from) / 1024 : from;
                nodes.push_back(node);
            }
        }
        int moves_left = 60'000;
        while (moves_left > 0) {
            std::size_t next = SIZE_MAX;
            for (std::size_t i = 0; i < nodes.size(); ++i)
                if (!nodes[i].is_done && nodes[i].arrival < (next == SIZE_MAX ? never : nodes[next].arrival)) next = i;
            if (next == SIZE_MAX) return {};
            nodes[next].is_done = true;
            if (const auto end = finish(gaps[nodes[next].place], nodes[next].gap)) {
                Witness found = checked(way_to(nodes, next, *end));
                if (!found.empty()) return found;
            }
            for (Node& other : nodes) {
                if (other.is_done || other.place == nodes[next].place) continue;
                if (Witness found = move(nodes, next, other, gaps, moves_left); !found.empty()) return found;
            }
        }
        return {};
    }

    [[nodiscard]] Double3 at(std::size_t place, double depth) const
    {
        return {places_[place].x, places_[place].y, depth};
    }

    // What a segment meets: nothing, only the answer's triangle, or another one.
    enum class Meets { nothing, answer, another };
    [[nodiscard]] Meets meets(Double3 from, Double3 to) const
    {
        Meets met = Meets::nothing;
        for (const Facet& facet : facets_) {
            if (!is_met(facet, from, to)) continue;
            if (facet.triangle != question_.answer) return Meets::another;
            met = Meets::answer;
        }
        return met;
    }

    // Moves across at one depth, early or late, where the gaps overlap. Returns a witness if the move meets the
    // answer's triangle: one that is seen edge-on is met only from its side.
    [[nodiscard]] Witness move(const std::vector<Node>& nodes, std::size_t from, Node& to,
                               const std::vector<std::vector<Gap>>& gaps, int& moves_left) const
    {
        const Node& node = nodes[from];
        const Gap& here = gaps[node.place][node.gap];
        const Gap& there = gaps[to.place][to.gap];
        const double early = std::max({here.from, there.from, node.arrival});
        double late = std::min(here.to, there.to);
        if (late == never) late = early + 4 * question_.bound;
        Witness found;
        const auto try_move = [&](double depth) {
            const bool may_meet_answer = depth >= answer_from_ && depth <= answer_to_;
            if (depth >= to.arrival && !may_meet_answer) return;
            --moves_left;
            const Meets met = meets(at(node.place, depth), at(to.place, depth));
            if (met == Meets::answer && found.empty()) {
                auto way = way_to(nodes, from, depth);
                way.emplace_back(places_[to.place], depth);
                found = checked(way);
            }
            if (met != Meets::nothing || depth >= to.arrival) return;
            to.arrival = depth;
            to.before = from;
        };
        if (early < late) {
            for (const double share : {1.0 / 1024, 0.5, 1023.0 / 1024})
                try_move(early + (late - early) * share);
            if (answer_depth_ > early && answer_depth_ < std::min(here.to, there.to)) try_move(answer_depth_);
        }
        return found;
    }

    [[nodiscard]] std::vector<std::pair<Double2, double>> way_to(const std::vector<Node>& nodes, std::size_t last,
                                                                 double end) const
    {
        std::vector<std::pair<Double2, double>> points{{places_[nodes[last].place], end}};
        for (std::size_t i = last; i != SIZE_MAX; i = nodes[i].before) {
            points.emplace_back(places_[nodes[i].place], nodes[i].arrival);
            if (nodes[i].before != SIZE_MAX)
                points.emplace_back(places_[nodes[nodes[i].before].place], nodes[i].arrival);
        }
        std::ranges::reverse(points);
        return points;
    }

    const TriangleMesh& mesh_;
    const WitnessQuestion& question_;
    Frame frame_;
    double radius_;
    std::vector<Facet> facets_;
    std::vector<EdgeLine> lines_;
    std::vector<Double2> places_;
    double answer_from_ = never, answer_to_ = -never; ///< the depths of the answer's triangle
    double answer_depth_ = never; ///< of a point of the answer's triangle in the tube, if an edge of it is there
};

} // namespace

Witness find_witness(const TriangleMesh& mesh, const WitnessQuestion& question)
{
    return Search(mesh, question).run();
}

} // namespace tetrace
