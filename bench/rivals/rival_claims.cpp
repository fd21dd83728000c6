#include "bench/rivals/rival_claims.h"

namespace tetrace {

namespace {

using enum RayKind;

constexpr OldRun on_xeon = {"Xeon", "4 views of smoke at 1024x1024, in which 55 % of the rays miss the domain, on "
                                    "two cores of a Xeon with AVX-512; bvh2 was scalar code, and Embree had single "
                                    "rays and packets of 16 (results/intel-xeon-amx-2-cores/2026-11-26-aaacd62.json)"};
constexpr OldRun given_on_xeon = {"Xeon, other rays", "the same Xeon and rivals, 4 views of smoke at 512x512 "
                                                      "(results/intel-xeon-amx-2-cores/2026-11-26-bfa0c14-rays.json)"};
constexpr OldRun by_a_referee = {"Zen 3", "one thread's CPU time, ratios of pairs, two cores of an AMD EPYC (Zen 3, "
                                          "AVX2), commit 260c903 (docs/rows.md)"};
constexpr OldRun computed = {"computed", "from builds of 4.4 s (bunny) and 3.4 s (armadillo), and the ratios of rates "
                                         "of Zen 3 (docs/tets-for-rays.md)"};
constexpr OldRun of_table6 = {"Table 6, Zen 4", "65 views of flight at 256x256, against only the scalar bvh2 and cwbvh "
                                                "(docs/spec/rays-tets.md)"};
constexpr OldRun on_h100 = {"H100", "4 views of smoke at 1024x1024, one launch for each "
                                    "(results/nvidia-h100-80gb/2026-11-23-47c6ed2.json)"};
constexpr OldRun given_on_h100 = {"H100, other rays",
                                  "0.45 to 0.73 million shadow, ao and diffuse rays and 4.19 million "
                                  "random rays in four launches, bunny "
                                  "(results/nvidia-h100-80gb/2026-11-23-47c6ed2-rays.json)"};
constexpr OldRun in_the_limit = {"H100, limit",
                                 "the cost per million rays, by a line through launches of 1024x1024 and "
                                 "2048x2048 (results/nvidia-h100.md)"};
constexpr OldRun in_flight_on_h100 = {"H100, views in flight",
                                      "4 views of frame at 1024x1024 in flight together, only CUDA "
                                      "(results/nvidia-h100-80gb/2026-11-27-8858bfc-bunny.json)"};
constexpr OldRun of_table6_on_h100 = {"Table 6, H100", "33 views of flight at 1024x1024, one launch for each "
                                                       "(results/nvidia-h100-80gb/2026-11-23-40a3608-table6.json)"};

constexpr std::string_view on_a_cpu = "results/tets-for-rays.md, docs/spec/rays-tets.md",
                           in_readme = "README.md, docs/bench-table.md, results/tets-for-rays.md",
                           on_a_gpu = "results/nvidia-h100.md";

const std::vector<std::string_view> closed = {"bunny", "armadillo"}, papers = {"banana", "bunny", "armadillo"};

/// A claim about processors.
RivalClaim on_cpu(std::string_view id, std::string_view text, std::string_view made_in, std::string_view then,
                  const OldRun& old, Walk walk, Rival rival, RayKind rays, double boundary)
{
    return {id, text, made_in, then, &old, walk, rival, DeviceKind::cpu, {}, closed, {rays}, boundary};
}

/// A claim that packets are faster or slower than the fastest BVH of a processor.
RivalClaim packets_are(bool is_faster, std::string_view id, std::string_view text, std::string_view then,
                       const std::vector<std::string_view>& scenes, RayKind rays = primary)
{
    RivalClaim claim =
        on_cpu(id, text, "README.md, docs/tets-for-rays.md", then, by_a_referee, Walk::packets, Rival::any, rays, 1);
    claim.scenes = scenes;
    claim.is_below = !is_faster;
    return claim;
}

/// A claim about the seconds of tracing after which the tets have paid, through packets.
RivalClaim pays_within(std::string_view id, std::string_view text, std::string_view then, Rival rival, double seconds)
{
    RivalClaim claim =
        on_cpu(id, text, "README.md, docs/tets-for-rays.md", then, computed, Walk::packets, rival, primary, seconds);
    claim.measure = Measure::break_even;
    claim.is_below = true;
    return claim;
}

/// A claim about GPUs that a backend emulates, primary rays.
RivalClaim emulated(std::string_view id, std::string_view text, std::string_view then, Walk walk,
                    std::string_view backend, double boundary)
{
    return {id,      text,   on_a_cpu,  then,    &on_xeon, walk, Rival::any, DeviceKind::emulated,
            backend, closed, {primary}, boundary};
}

/// A claim about GPUs.
RivalClaim on_gpu(std::string_view id, std::string_view text, std::string_view made_in, std::string_view then,
                  const OldRun& old, Walk walk, const std::vector<std::string_view>& scenes, RayKind rays,
                  double boundary)
{
    return {id, text, made_in, then, &old, walk, Rival::any, DeviceKind::gpu, {}, scenes, {rays}, boundary};
}

std::vector<RivalClaim> make_claims()
{
    constexpr auto half32 = Walk::half32, tet64 = Walk::tet64, packets = Walk::packets;
    constexpr auto ours = Rival::our_single, embree = Rival::embree_single, any = Rival::any;
    return {
        // One ray at a time, primary rays.
        on_cpu("half32-over-our-bvh", "half32 is 1.4 to 1.6 times as fast as bvh2, one ray at a time", in_readme,
               "1.57 bunny, 1.41 armadillo", on_xeon, half32, ours, primary, 1.4),
        on_cpu("tet64-over-our-bvh", "tet64 is 1.4 to 1.6 times as fast as bvh2, one ray at a time", in_readme,
               "1.61 bunny, 1.42 armadillo", on_xeon, tet64, ours, primary, 1.4),
        on_cpu("half32-over-embree-single", "half32 has 0.85 to 0.93 of the rate of Embree's single rays", in_readme,
               "0.93 bunny, 0.85 armadillo", on_xeon, half32, embree, primary, 0.85),
        on_cpu("tet64-over-embree-single", "tet64 has 0.86 to 0.96 of the rate of Embree's single rays", in_readme,
               "0.96 bunny, 0.86 armadillo", on_xeon, tet64, embree, primary, 0.85),
        // Packets, primary rays.
        on_cpu("packets-over-the-fastest-bvh",
               "packets are 1.7 to 1.8 times as fast as Embree's packets of 16, the fastest BVH", in_readme,
               "1.84 bunny, 1.72 armadillo; 65 views of orbit 2.01 and 1.77; one thread 1.88 and 1.56", on_xeon,
               packets, any, primary, 1.7),
        on_cpu("packets-over-embrees-best", "packets are 1.1 to 1.3 times as fast as Embree's fastest entry point",
               "README.md, docs/rows.md", "1.29 bunny, 1.12 armadillo, over coherent streams", by_a_referee, packets,
               any, primary, 1.1),
        packets_are(true, "packets-win-on-closed-objects",
                    "on closed objects seen from outside, packets are faster than Embree",
                    "1.29 bunny, 1.12 armadillo, over coherent streams", closed),
        // Against a BVH that has code for processors.
        on_cpu("half32-over-bvh2-with-sse2", "half32 has 0.86 to 0.91 of the rate of bvh2 with an SSE2 box test",
               "README.md, docs/rows.md", "0.91 bunny, 0.86 armadillo", by_a_referee, half32, ours, primary, 0.85),
        on_cpu("tet64-over-bvh2-with-sse2", "tet64 has 0.97 to 1.03 of the rate of bvh2 with an SSE2 box test",
               "README.md, docs/rows.md", "1.03 bunny, 0.97 armadillo", by_a_referee, tet64, ours, primary, 0.95),
        // Where tets lose.
        packets_are(false, "packets-lose-elsewhere", "packets are slower than Embree in a hall, on spheres and grass",
                    "hall of columns 0.75, 1,000 spheres 0.77, grass 0.42, over packets of 16",
                    {"atrium", "spheres", "grass"}),
        packets_are(false, "packets-lose-on-a-small-object",
                    "packets are slower than Embree in a wide scene seen close",
                    "bunny in a stadium 0.34, over packets of 16", {"city"}),
        packets_are(false, "packets-lose-in-a-hall-diffuse", "packets are slower than Embree on diffuse rays in a hall",
                    "0.60, over packets of 16", {"atrium"}, diffuse),
        packets_are(true, "packets-win-on-terrain", "packets are faster than Embree on a terrain",
                    "1.64 at 845,000 triangles, over packets of 16", {"terrain"}),
        // What building costs.
        pays_within("tets-pay-against-our-bvhs", "tets pay off after about 5 s of tracing against our BVHs",
                    "5 s, bunny, 4.4 s to build, packets 6.9 times as fast as bvh2", ours, 6),
        pays_within("tets-pay-against-embree", "tets pay off after 15 to 28 s of tracing against Embree's best",
                    "15 s bunny, 28 s armadillo; 37 s with the bunny's build and the armadillo's ratio", any, 30),
        // Other rays: packets.
        on_cpu("packets-shadow", "shadow rays: packets are 2.1 times as fast as Embree's packets of 16", on_a_cpu,
               "2.15 bunny, 2.22 armadillo", given_on_xeon, packets, any, shadow, 2.1),
        on_cpu("packets-ao", "ao rays: packets are 2.7 times as fast as Embree's packets of 16", on_a_cpu,
               "2.79 bunny, 2.75 armadillo", given_on_xeon, packets, any, ao, 2.7),
        on_cpu("packets-diffuse", "diffuse rays: packets are 3.2 times as fast as Embree's packets of 16", on_a_cpu,
               "3.27 bunny, 3.30 armadillo", given_on_xeon, packets, any, diffuse, 3.2),
        on_cpu("packets-random", "random rays: packets are 1.7 times as fast as Embree's packets of 16", on_a_cpu,
               "2.02 bunny, 1.70 armadillo", given_on_xeon, packets, any, random, 1.7),
        // Other rays: one at a time.
        on_cpu("half32-shadow", "shadow rays: half32 is 1.3 times as fast as bvh2", on_a_cpu,
               "1.54 bunny, 1.37 armadillo", given_on_xeon, half32, ours, shadow, 1.3),
        on_cpu("half32-ao", "ao rays: half32 is 1.2 times as fast as bvh2", on_a_cpu, "1.39 bunny, 1.25 armadillo",
               given_on_xeon, half32, ours, ao, 1.2),
        on_cpu("half32-diffuse", "diffuse rays: half32 is 1.2 times as fast as bvh2", on_a_cpu,
               "1.38 bunny, 1.25 armadillo", given_on_xeon, half32, ours, diffuse, 1.2),
        on_cpu("half32-random", "random rays: half32 has 0.6 of the rate of bvh2", on_a_cpu,
               "0.77 bunny, 0.61 armadillo", given_on_xeon, half32, ours, random, 0.6),
        on_cpu("tet64-shadow", "shadow rays: tet64 is 1.6 times as fast as bvh2", on_a_cpu,
               "1.80 bunny, 1.60 armadillo", given_on_xeon, tet64, ours, shadow, 1.6),
        on_cpu("tet64-ao", "ao rays: tet64 is 1.6 times as fast as bvh2", on_a_cpu, "1.67 bunny, 1.63 armadillo",
               given_on_xeon, tet64, ours, ao, 1.6),
        on_cpu("tet64-diffuse", "diffuse rays: tet64 is 1.6 times as fast as bvh2", on_a_cpu,
               "1.74 bunny, 1.65 armadillo", given_on_xeon, tet64, ours, diffuse, 1.6),
        on_cpu("tet64-random", "random rays: tet64 has 0.8 of the rate of bvh2", on_a_cpu, "1.00 bunny, 0.87 armadillo",
               given_on_xeon, tet64, ours, random, 0.8),
        // Which structure is faster at all.
        {"table6-on-a-cpu",
         "a walk of one ray at a time through tets for rays is faster than each of our BVHs on a CPU (Table 6)",
         "docs/paper.md, docs/spec/rays-tets.md",
         "1.37 banana, 1.26 bunny, 1.16 armadillo",
         &of_table6,
         Walk::single,
         any,
         DeviceKind::cpu,
         {},
         papers,
         {primary},
         1},
        {"a-walk-is-the-fastest-row",
         "the fastest row of a CPU is a walk through tets",
         "README.md, docs/bench-table.md",
         "bunny and armadillo, primary rays; stated without naming scenes on which it does not hold",
         &on_xeon,
         Walk::any,
         any,
         DeviceKind::cpu,
         {},
         {},
         {primary, shadow, ao, diffuse, random},
         1,
         {}},
        // Emulated GPUs.
        emulated("half32-on-pocl", "PoCL: half32 is as fast as bvh2", "1.16 bunny, 1.02 armadillo", half32, "opencl",
                 1.0),
        emulated("tet64-on-pocl", "PoCL: tet64 is 1.1 times as fast as bvh2", "1.28 bunny, 1.11 armadillo", tet64,
                 "opencl", 1.1),
        emulated("half32-on-lavapipe", "lavapipe: half32 is 1.3 times as fast as bvh2", "1.48 bunny, 1.32 armadillo",
                 half32, "vulkan", 1.3),
        emulated("tet64-on-lavapipe", "lavapipe: tet64 is 1.3 times as fast as bvh2", "1.47 bunny, 1.34 armadillo",
                 tet64, "vulkan", 1.3),
        // GPUs.
        on_gpu("half32-on-a-gpu", "half32 is 2 times as fast as the better BVH on an H100",
               "README.md, docs/tets-for-rays.md, results/nvidia-h100.md",
               "2.22 bunny (16.9 over 7.6 Grays/s), 2.01 armadillo, 2.09 banana; bunny at 2048x2048 1.84", on_h100,
               half32, papers, primary, 2.0),
        on_gpu("shadow-on-a-gpu", "shadow rays: half32 is 2.3 times as fast as the better BVH on an H100", on_a_gpu,
               "2.37", given_on_h100, half32, {"bunny"}, shadow, 2.3),
        on_gpu("ao-on-a-gpu", "ao rays: half32 is 2.5 times as fast as the better BVH on an H100", on_a_gpu, "2.60",
               given_on_h100, half32, {"bunny"}, ao, 2.5),
        on_gpu("diffuse-on-a-gpu", "diffuse rays: half32 is 2.7 times as fast as the better BVH on an H100", on_a_gpu,
               "2.75", given_on_h100, half32, {"bunny"}, diffuse, 2.7),
        on_gpu("random-on-a-gpu", "random rays: half32 is 2.4 times as fast as the better BVH on an H100", on_a_gpu,
               "2.45", given_on_h100, half32, {"bunny"}, random, 2.4),
        on_gpu("table6-on-a-gpu", "the paper's method is faster than bvh2 and cwbvh on an H100 if tets are for rays",
               on_a_gpu, "1.60 banana, 1.70 bunny, 1.49 armadillo over bvh2", of_table6_on_h100, Walk::maria, papers,
               primary, 1),
        on_gpu("half32-throughput-on-a-gpu", "half32 has 1.57 times the throughput of bvh2 on an H100", on_a_gpu,
               "1.57 bunny", in_the_limit, half32, {"bunny"}, primary, 1.5),
        on_gpu("half32-in-flight-on-a-gpu",
               "half32 has 1.97 times the throughput of the fastest of our BVHs on an H100",
               "README.md, docs/tets-for-rays.md, results/nvidia-h100.md", "1.97 bunny", in_flight_on_h100, half32,
               {"bunny"}, primary, 1.9),
        on_gpu("maria-throughput-on-a-gpu", "maria on tet96 has 1.80 times the throughput of bvh2 on an H100", on_a_gpu,
               "1.80 bunny", in_the_limit, Walk::maria, {"bunny"}, primary, 1.7),
        {"cdt-on-a-gpu",
         "through TetGen's CDT, half32 is 1.2 to 1.5 times as fast as the better BVH on an H100",
         on_a_gpu,
         "1.49 bunny, 1.29 armadillo, 1.41 banana",
         &on_h100,
         half32,
         any,
         DeviceKind::gpu,
         {},
         papers,
         {primary},
         1.2,
         TetsKind::cdt},
        {"cdt-other-rays-on-a-gpu",
         "through TetGen's CDT, half32 is 1.1 to 1.7 times as fast as the better BVH for other rays on an H100",
         on_a_gpu,
         "1.41 shadow, 1.72 ao, 1.46 diffuse, 1.14 random",
         &given_on_h100,
         half32,
         any,
         DeviceKind::gpu,
         {},
         {"bunny"},
         {shadow, ao, diffuse, random},
         1.1,
         TetsKind::cdt},
    };
}

} // namespace

bool is_scene(std::string_view label, std::string_view name)
{
    constexpr std::string_view for_rays = "-rays";
    label = label.substr(0, label.find('@'));
    if (label.ends_with(for_rays)) label.remove_suffix(for_rays.size());
    return label == name;
}

const std::vector<RivalClaim>& rival_claims()
{
    static const std::vector<RivalClaim> claims = make_claims();
    return claims;
}

const std::vector<RivalScene>& rival_scenes()
{
    static const std::vector<RivalScene> scenes = {
        {"bunny", true},          {"armadillo", true},      {"atrium", false, true}, {"city", false, true},
        {"terrain", false, true}, {"spheres", false, true}, {"grass", false, true}};
    return scenes;
}

} // namespace tetrace
