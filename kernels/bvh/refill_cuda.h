// Persistent warps whose lanes fetch rays for themselves: if few of a warp's lanes still have a ray, the others write
// their hits and start new rays, in the middle of the traversals of those few.
//
// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 3.3, and its
// addendum with Karras, 2012, in whose released kernel for Kepler "few" is less than 20 of 32. There, the lanes in the
// loop vote; here, all lanes of a warp stay in the loop, because with independently scheduled lanes (since Volta) a
// vote waits only for the lanes that it names.
#define REFILLS_LANES

#define WHOLE_WARP 0xFFFFFFFFu
#ifndef ENOUGH_LANES                             // a test has fewer
#define ENOUGH_LANES ((5u * warpSize + 7u) / 8u) // 20 of 32
#endif
#define NO_ITEM 0xFFFFFFFFu

// A layout whose lanes go through the loop together defines these instead.
#ifndef TOGETHER_ENTRIES
#define TOGETHER_ENTRIES TRAVERSAL_ENTRIES
#define TOGETHER_GOES_ON TRAVERSAL_GOES_ON
#endif

// Takes `count` numbers from the counter. Returns the first, to the whole warp.
KERNEL_FN uint fetch_items(uint count, uint* counter)
{
    uint first = 0u;
    if (threadIdx.x % warpSize == 0u) first = atomicAdd(counter, count);
    return __shfl_sync(WHOLE_WARP, first, 0);
}

// Traces rays until all are traced. Rays: those of a launch by number, as backends/cuda/kernel.cu has them. counter: 0
// at first.
template <class Rays>
KERNEL_FN void trace_refilled(SceneView scene, TraceParams params, const Rays& rays, uint* counter)
{
    uint item = NO_ITEM; // the lane's ray, whose hit is not written yet
    bool goes_on = false;
    bool any_left = true; // of the rays that no lane has
    RayFrame frame = {};
    Nearest nearest = {};
    STACK(stack, TOGETHER_ENTRIES);
    TRAVERSAL_AT_ROOT(uint)
    for (;;) {
        uint going = __ballot_sync(WHOLE_WARP, goes_on);
        if (bit_count(going) < (any_left ? ENOUGH_LANES : 1u)) {
            if (!goes_on && item != NO_ITEM) rays.write(item, hit_of(scene, rays.ray(item), nearest));
            if (!any_left) return;
            uint first = fetch_items(warpSize - bit_count(going), counter);
            any_left = first + warpSize - bit_count(going) < rays.items();
            if (!goes_on) {
                uint lane = threadIdx.x % warpSize;
                item = first + lane - bit_count(going & ((1u << lane) - 1u));
                goes_on = rays.has(item);
                if (goes_on) {
                    Ray ray = rays.ray(item);
                    frame = frame_of(ray);
                    nearest = no_hit_before(ray, rays.end(item));
                    TRAVERSAL_AT_ROOT()
                } else {
                    item = NO_ITEM;
                }
            }
            going = __ballot_sync(WHOLE_WARP, goes_on);
        }
        if (goes_on) {
#include KERNEL_LOOP_HEADER
            goes_on = TOGETHER_GOES_ON;
        }
    }
}
