// trace [SCENE [BACKEND]]: nine parallel rays through a scene's box.
#include <tetrace/tetrace.hpp>

#include <cstdio>

int main(int argc, char** argv)
try {
    const tetrace::Scene scene(argc > 1 ? argv[1] : "cubes");
    const tetrace::Tracer tracer(scene, argc > 2 ? argv[2] : "openmp");
    const auto [triangles, tets, low, high] = scene.info();
    std::printf("%llu triangles, %llu tets\n", (unsigned long long)triangles, (unsigned long long)tets);
    std::vector<tetrace::Ray> rays;
    for (int i = 1; i < 10; ++i) { // from the box's left side to its right side
        const double y = low[1] + i * (high[1] - low[1]) / 10, z = low[2] + i * (high[2] - low[2]) / 10;
        rays.push_back({{float(low[0]), float(y), float(z)}, 0, {1, 0, 0}, 1e30f});
    }
    for (const tetrace::Hit& hit : tracer.trace(rays))
        if (hit.triangle == TETRACE_NO_HIT) std::puts("no hit");
        else std::printf("triangle %u at t = %.6f, u = %.4f, v = %.4f\n", hit.triangle, hit.t, hit.u, hit.v);
} catch (const tetrace::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
